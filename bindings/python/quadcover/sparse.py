"""Sparse Cholesky with up- and downdates on scipy.sparse matrices, and closest lattice vectors.

    factor = Cholesky(A)              # Hermitian or real symmetric, positive definite
    x = factor.solve(b)
    factor.update([3, 7], [1.0, -1.0])     # A + w w^H on a fixed pattern
    with factor.transaction():             # undone when the block raises
        factor.downdate([3, 7], [1.0, -1.0])
"""
import contextlib

import numpy as np
import scipy.sparse

from ._c import ffi, lib
from ._context import session

_orderings = {
    "auto": lib.QC_ORDER_AUTO, "natural": lib.QC_ORDER_NATURAL, "given": lib.QC_ORDER_GIVEN,
    "amd": lib.QC_ORDER_AMD, "quotient": lib.QC_ORDER_QUOTIENT,
    "dissection": lib.QC_ORDER_DISSECTION,
}


class _Scalar:
    """The functions and types for real or complex numbers."""

    def __init__(self, dtype, view, entry, suffix):
        self.dtype, self.view, self.entry = np.dtype(dtype), view, entry
        for name in ("analyze", "factorize", "refactorize", "solve", "solve_forward", "updown_many",
                     "condition"):
            setattr(self, name, getattr(lib, "qc_" + name + suffix))

    def pointer(self, array):
        return ffi.cast(self.entry + " *", ffi.from_buffer(array))


_real = _Scalar(np.float64, "qc_symmetric", "double", "_real")
_complex = _Scalar(np.complex128, "qc_hermitian", "qc_complex", "")


class _Matrix:
    """The upper triangle of a matrix as the library's view, valid as long as this object."""

    def __init__(self, A, scalar):
        upper = scipy.sparse.triu(A, format="csc")
        upper.sum_duplicates()
        upper.sort_indices()
        self.colptr = np.ascontiguousarray(upper.indptr, np.int64)
        self.row = np.ascontiguousarray(upper.indices, np.int32)
        self.value = np.ascontiguousarray(upper.data, scalar.dtype)
        self.c = ffi.new(scalar.view + " *", {
            "n": upper.shape[0], "colptr": ffi.from_buffer("int64_t[]", self.colptr),
            "row": ffi.from_buffer("int32_t[]", self.row), "val": scalar.pointer(self.value)})


class Cholesky:
    """P A P^T = L D L^H. A: scipy sparse matrix whose upper triangle is read.

    ordering: "auto", "natural", "amd", "quotient" (with `group`), "dissection" (with `position`,
    n x 3, optional) or "given" (with `permutation`). Raises NotPositiveDefinite with .where = row.
    One factor belongs to one thread while it is modified.
    """

    def __init__(self, A, ordering="auto", *, permutation=None, group=None, position=None):
        if A.shape[0] != A.shape[1]:
            raise ValueError("A has shape %s; give a square matrix" % (A.shape,))
        if ordering not in _orderings:
            raise ValueError("ordering is %r; give one of %s" % (ordering, ", ".join(_orderings)))
        self.n = A.shape[0]
        self._t = _complex if np.issubdtype(A.dtype, np.complexfloating) else _real
        self.dtype = self._t.dtype
        s, matrix = session(), _Matrix(A, self._t)
        hints = {"permutation": ("int32_t[]", permutation, np.int32, self.n),
                 "group": ("int32_t[]", group, np.int32, self.n),
                 "position": ("double[]", position, np.float64, 3 * self.n)}
        options = ffi.new("qc_analyze_options *", {
            "struct_size": ffi.sizeof("qc_analyze_options"), "ordering": _orderings[ordering]})
        keep = []
        for name, (kind, value, dtype, size) in hints.items():
            if value is None:
                continue
            array = np.ascontiguousarray(value, dtype).reshape(-1)
            if array.size != size:
                raise ValueError("%s has %d numbers; give %d" % (name, array.size, size))
            keep.append(array)
            setattr(options, name, ffi.from_buffer(kind, array))
        self._symbolic = s.make("qc_symbolic", lib.qc_symbolic_free, self._t.analyze, s.ctx,
                                matrix.c, options)
        self._factor = s.make("qc_factor", lib.qc_factor_free, self._t.factorize, s.ctx,
                              self._symbolic, matrix.c)
        del keep

    def refactorize(self, A):
        """New values on the same pattern (or a subset of it)."""
        matrix = _Matrix(A, self._t)
        session().call(self._t.refactorize, self._factor, matrix.c)

    def _columns(self, b):
        """A copy as columns, Fortran order, and how to shape the answer."""
        b = np.asarray(b)
        if b.ndim not in (1, 2) or b.shape[0] != self.n:
            raise ValueError("b has shape %s; give (%d,) or (%d, k)" % (b.shape, self.n, self.n))
        if self._t is _real and np.issubdtype(b.dtype, np.complexfloating):
            raise ValueError("b is complex and the factor real; solve for both parts")
        return np.array(b, self.dtype, order="F", ndmin=1), 1 if b.ndim == 1 else b.shape[1]

    def _solve(self, function, b):
        x, columns = self._columns(b)
        memory = x if x.ndim == 1 else x.T  # C-contiguous view of the same numbers
        session().call(function, self._factor, columns, self._t.pointer(memory))
        return x

    def solve(self, b):
        """A^{-1} b for a vector or the columns of a matrix."""
        return self._solve(self._t.solve, b)

    def forward(self, b):
        """y = D^{-1/2} L^{-1} P b: |y|^2 = b^H A^{-1} b."""
        return self._solve(self._t.solve_forward, b)

    def _updown(self, sigma, vectors):
        rows = [np.asarray(r, np.int32).reshape(-1) for r, _ in vectors]
        values = [np.asarray(w, self.dtype).reshape(-1) for _, w in vectors]
        for r, w in zip(rows, values):
            if len(r) != len(w):
                raise ValueError("%d rows and %d values" % (len(r), len(w)))
        start = np.concatenate([[0], np.cumsum([len(r) for r in rows])]).astype(np.int32)
        row = np.ascontiguousarray(np.concatenate(rows))
        w = np.ascontiguousarray(np.concatenate(values))
        sign = np.asarray(sigma, np.intc)
        session().call(self._t.updown_many, self._factor, len(vectors),
                       ffi.from_buffer("int[]", sign), ffi.from_buffer("int32_t[]", start),
                       ffi.from_buffer("int32_t[]", row), self._t.pointer(w))

    def update(self, row, w):
        """A <- A + w w^H, w with the given values in the given rows (a clique of A)."""
        self._updown([1], [(row, w)])

    def downdate(self, row, w):
        """A <- A - w w^H; when A would not stay positive definite the factor keeps as it was."""
        self._updown([-1], [(row, w)])

    def modify(self, terms):
        """A <- A + sum of sigma w w^H in one sweep; terms: (sigma, row, w), sigma = +1 or -1."""
        terms = list(terms)
        if terms:
            self._updown([s for s, _, _ in terms], [(r, w) for _, r, w in terms])

    def flip(self, k, l, dl, m, dm):
        """A(k,l) += dl, A(k,m) += dm and the conjugates: the matching flip (thesis 6.2.1)."""
        if self._t is _real:
            raise ValueError("flip needs a complex factor")
        pair = [ffi.new("qc_complex *", {"re": complex(z).real, "im": complex(z).imag})[0]
                for z in (dl, dm)]
        session().call(lib.qc_flip, self._factor, k, l, pair[0], m, pair[1])

    @contextlib.contextmanager
    def transaction(self):
        """Modifications within are undone, bit for bit, when the block raises."""
        session().call(lib.qc_factor_begin, self._factor)
        try:
            yield self
        except BaseException:
            session().call(lib.qc_factor_rollback, self._factor)
            raise
        session().call(lib.qc_factor_commit, self._factor)

    def rollback(self):
        """Undoes the last modification."""
        session().call(lib.qc_factor_rollback, self._factor)

    def logdet(self):
        """log(det A)."""
        return lib.qc_factor_logdet(self._factor)

    def condition(self, A):
        """An estimate of the condition number in the 1-norm, from below."""
        out, matrix = ffi.new("double *"), _Matrix(A, self._t)
        session().call(self._t.condition, self._factor, matrix.c, out)
        return out[0]

    @property
    def permutation(self):
        """permutation[k] = row eliminated k-th."""
        p = np.empty(self.n, np.int32)
        lib.qc_symbolic_get_permutation(self._symbolic, ffi.from_buffer("int32_t[]", p))
        return p

    @property
    def info(self):
        """Counts of the analysis: nnz_l, stored, flops, supernodes, largest_front."""
        out = ffi.new("qc_symbolic_info *", {"struct_size": ffi.sizeof("qc_symbolic_info")})
        lib.qc_symbolic_get_info(self._symbolic, out)
        return {name: getattr(out, name)
                for name in ("n", "supernodes", "largest_front", "nnz_l", "stored", "flops")}


def lattice_round(P, target, *, start=1, radius=3, budget=-1, seed=0):
    """Integers z with small 1/2 (z - t)^T P (z - t), and that energy. P: real, symmetric, dense."""
    P = np.ascontiguousarray(P, np.float64)
    t = np.ascontiguousarray(target, np.float64)
    if P.shape != (t.size, t.size):
        raise ValueError("P has shape %s; give (%d, %d)" % (P.shape, t.size, t.size))
    z = np.empty_like(t)
    options = ffi.new("qc_lattice_options *", {
        "struct_size": ffi.sizeof("qc_lattice_options"), "start": start, "radius": radius,
        "budget": budget, "seed": seed})
    result = ffi.new("qc_lattice_result *")
    session().call(lib.qc_lattice_round, t.size, ffi.from_buffer("double[]", P),
                   ffi.from_buffer("double[]", t), options, ffi.from_buffer("double[]", z), result)
    return z, result.energy
