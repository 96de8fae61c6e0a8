"""quadcover.sparse: properties of the factorisation on scipy matrices."""
import unittest

import numpy as np
import scipy.sparse

import quadcover
from quadcover.sparse import Cholesky, lattice_round


def grid_matrix(n, dtype):
    """Laplacian of an n x n grid with a shift; Hermitian with random phases when complex."""
    random = np.random.default_rng(1)
    index = np.arange(n * n).reshape(n, n)
    i = np.concatenate([index[:, :-1].ravel(), index[:-1].ravel()])
    j = np.concatenate([index[:, 1:].ravel(), index[1:].ravel()])
    w = -np.ones(len(i), dtype)
    if np.issubdtype(dtype, np.complexfloating):
        w = w * np.exp(2j * np.pi * random.random(len(i)))
    A = scipy.sparse.coo_matrix((w, (i, j)), (n * n, n * n))
    return (A + A.getH() + 4.1 * scipy.sparse.identity(n * n)).tocsc()


class Factors(unittest.TestCase):
    def test_solves(self):
        for dtype in (np.float64, np.complex128):
            A = grid_matrix(20, dtype)
            random = np.random.default_rng(2)
            for ordering in ("auto", "natural", "amd", "dissection"):
                factor = Cholesky(A, ordering)
                b = random.standard_normal((400, 3)).astype(dtype)
                x = factor.solve(b)
                self.assertLess(np.abs(A @ x - b).max(), 1e-12)
                self.assertLess(np.abs(A @ factor.solve(b[:, 0]) - b[:, 0]).max(), 1e-12)
                y = factor.forward(b[:, 0])
                self.assertAlmostEqual(np.vdot(y, y).real, np.vdot(b[:, 0], x[:, 0]).real, 9)
            self.assertEqual(sorted(factor.permutation), list(range(400)))
            sign, logdet = np.linalg.slogdet(A.toarray())
            self.assertAlmostEqual(factor.logdet(), logdet, 8)
            self.assertGreater(factor.condition(A), 1)
            self.assertGreaterEqual(factor.info["nnz_l"], scipy.sparse.triu(A).nnz)

    def test_update_and_downdate(self):
        A = grid_matrix(12, np.complex128)
        factor = Cholesky(A)
        w = np.zeros(144, complex)
        w[[3, 4]] = [0.5 + 1j, -0.25]
        b = np.arange(144.0)
        before = factor.solve(b)
        factor.update([3, 4], w[[3, 4]])
        x = factor.solve(b)
        self.assertLess(np.abs((A.toarray() + np.outer(w, w.conj())) @ x - b).max(), 1e-11)
        factor.rollback()
        self.assertEqual(factor.solve(b).tobytes(), before.tobytes())
        factor.modify([(1, [3, 4], w[[3, 4]]), (-1, [3, 4], w[[3, 4]])])
        self.assertLess(np.abs(factor.solve(b) - before).max(), 1e-11)

    def test_a_failed_block_is_undone(self):
        A = grid_matrix(8, np.float64)
        factor = Cholesky(A)
        b = np.ones(64)
        before = factor.solve(b)
        with self.assertRaises(quadcover.NotPositiveDefinite):
            with factor.transaction():
                factor.update([0, 1], [1.0, 1.0])
                factor.downdate([0], [100.0])
        self.assertEqual(factor.solve(b).tobytes(), before.tobytes())

    def test_flip(self):
        A = grid_matrix(6, np.complex128).tolil()
        factor = Cholesky(A.tocsc())
        d = A[0, 1] * (1j - 1)
        factor.flip(0, 1, d, 6, 0)
        A[0, 1] += d
        A[1, 0] += np.conj(d)
        b = np.arange(36.0)
        self.assertLess(np.abs(A @ factor.solve(b) - b).max(), 1e-11)

    def test_errors_name_the_place(self):
        A = grid_matrix(5, np.float64).tolil()
        A[7, 7] = -1
        with self.assertRaises(quadcover.NotPositiveDefinite) as caught:
            Cholesky(A.tocsc(), "natural")
        self.assertEqual(caught.exception.where, 7)
        with self.assertRaises(ValueError):
            Cholesky(grid_matrix(5, np.float64)).solve(np.ones(3))

    def test_lattice(self):
        P = np.array([[2.0, 0.9], [0.9, 1.0]])
        z, energy = lattice_round(P, [0.4, 1.6])
        best = min((0.5 * (d := np.array([i, j]) - [0.4, 1.6]) @ P @ d, (i, j))
                   for i in range(-3, 4) for j in range(-3, 5))
        self.assertAlmostEqual(energy, best[0])
        self.assertEqual(tuple(z), best[1])


if __name__ == "__main__":
    unittest.main()
