"""Meshes, fields and maps: counted references whose arrays numpy sees without copies."""
import numpy as np

from ._c import ffi, lib
from ._context import session, text

_types = {
    "double": np.float64, "int32_t": np.int32, "int8_t": np.int8, "uint8_t": np.uint8,
    "struct qc_complex": np.complex128,
}


class _View:
    """The array interface of memory inside an object, which stays alive with the array."""

    def __init__(self, owner, pointer, shape):
        kind = ffi.typeof(pointer).item.cname
        self.owner = owner
        self.__array_interface__ = {
            "version": 3, "shape": shape, "typestr": np.dtype(_types[kind]).str,
            "data": (int(ffi.cast("uintptr_t", pointer)), True)}


def _size(owner, size):
    """A number, or the value of a member: "n_faces", "n_faces+1"."""
    if isinstance(size, int):
        return size
    name, _, more = size.partition("+")
    return getattr(owner, name) + int(more or 0)


def _array(member, *shape):
    """A property: the read-only array `member` with the given shape, None where it is absent."""

    def get(self):
        pointer = getattr(self._c, member)
        if pointer == ffi.NULL:
            return None
        sizes = tuple(_size(self, n) for n in shape)
        if 0 in sizes:
            return np.zeros(sizes, _types[ffi.typeof(pointer).item.cname])
        return np.asarray(_View(self, pointer, sizes))

    return property(get, doc="array (%s)" % ", ".join(str(n) for n in shape))


def _number(member):
    return property(lambda self: getattr(self._c, member))


def _child(member):
    """A property: the object another one holds."""

    def get(self):
        pointer = getattr(self._c, member)
        return None if pointer == ffi.NULL else wrap(lib.qc_object_retain(pointer))

    return property(get)


class Object:
    """Base of everything that travels through the ports of stages. Immutable."""

    struct, type = "qc_object", None

    def __init__(self, pointer):
        """Takes over the reference."""
        self._c = ffi.gc(ffi.cast(self.struct + " *", pointer), lib.qc_object_release)

    def __repr__(self):
        return "<quadcover.%s>" % type(self).__name__


class _Attribute:
    """The numbers of one attribute inside a mesh, which stays alive with the array."""

    def __init__(self, mesh, c):
        n = {lib.QC_AT_VERTEX: mesh.n_vertices, lib.QC_AT_FACE: mesh.n_faces,
             lib.QC_AT_CORNER: mesh.n_corners}[c.at]
        shape = (n,) if c.width == 1 else (n, c.width)
        array = np.asarray(_View(mesh, c.value, shape)) if n else np.zeros(shape)
        self.name, self.at = text(c.name), c.at
        self.array = array.astype(np.int64) if c.kind == lib.QC_ATTRIBUTE_LABEL else array


def _attributes(at):
    """A property: {name: array} of what elements of one kind have."""

    def get(self):
        all_ = (_Attribute(self, self._c.attribute[i]) for i in range(self._c.n_attributes))
        return {a.name: a.array for a in all_ if a.at == at}

    return property(get, doc="{name: array (n,) or (n, k)}; whole numbers for labels")


class PolygonMesh(Object):
    """Any polygon mesh: what files hold, and the quads which come out."""

    struct, type = "qc_polygon_mesh", "qc.polygon_mesh/1"
    n_vertices, n_faces = _number("n_vertices"), _number("n_faces")
    n_corners, n_uvs, n_lines = _number("n_corners"), _number("n_uvs"), _number("n_lines")
    position = _array("position", "n_vertices", 3)
    face_offset = _array("face_offset", "n_faces+1")
    face_vertex = _array("face_vertex", "n_corners")
    uv = _array("uv", "n_uvs", 2)
    corner_uv = _array("corner_uv", "n_corners")
    line = _array("line", "n_lines", 2)
    face_group = _array("face_group", "n_faces")
    source_face = _array("source_face", "n_vertices")
    source_barycentric = _array("source_barycentric", "n_vertices", 3)
    vertex_attributes = _attributes(lib.QC_AT_VERTEX)
    face_attributes = _attributes(lib.QC_AT_FACE)
    corner_attributes = _attributes(lib.QC_AT_CORNER)

    @property
    def group_names(self):
        """The OBJ statements of groups 1, 2, ..."""
        return [text(self._c.group_name[i]) for i in range(self._c.n_groups)]

    @property
    def faces(self):
        """n x k corners when all faces have k, else the flat `face_vertex`."""
        sizes = np.diff(self.face_offset)
        if len(sizes) and (sizes == sizes[0]).all():
            return self.face_vertex.reshape(-1, int(sizes[0]))
        return self.face_vertex

    @classmethod
    def from_arrays(cls, vertices, faces, vertex_attributes=None, face_attributes=None,
                    corner_attributes=None, face_group=None):
        """From positions (n x 3) and corners: an array (m x k) or a list of lists.

        Attributes are {name: array (n,) or (n, k)}: whole numbers are labels, "normal" is a
        direction, all else can be interpolated; "colour" is 0..1, or bytes. face_group: one number a face, 0 = none."""
        vertices = np.ascontiguousarray(vertices, np.float64)
        if vertices.ndim != 2 or vertices.shape[1] != 3:
            raise ValueError("vertices have shape %s; give (n, 3)" % (vertices.shape,))
        rows = [np.asarray(f, np.int32) for f in faces] if not isinstance(faces, np.ndarray) else faces
        sizes = [len(f) for f in rows]
        s = session()
        out = ffi.new("qc_polygon_mesh **")
        s.call(lib.qc_polygon_mesh_create, len(vertices), len(rows), sum(sizes), 0, 0,
               0 if face_group is None else lib.QC_POLYGON_FACE_GROUP, out)
        mesh = cls(out[0])
        c = mesh._c
        ffi.memmove(c.position, np.ascontiguousarray(vertices), vertices.nbytes)
        offset = np.concatenate([[0], np.cumsum(sizes)]).astype(np.int32)
        corner = (np.concatenate(rows) if len(rows) else np.zeros(0)).astype(np.int32)
        ffi.memmove(c.face_offset, offset, offset.nbytes)
        ffi.memmove(c.face_vertex, corner, corner.nbytes)
        if face_group is not None:
            group = np.ascontiguousarray(face_group, np.int32)
            if group.shape != (len(rows),):
                raise ValueError("face_group has shape %s; give (%d,)" % (group.shape, len(rows)))
            ffi.memmove(c.face_group, group, group.nbytes)
        for at, n, given in ((lib.QC_AT_VERTEX, len(vertices), vertex_attributes),
                             (lib.QC_AT_FACE, len(rows), face_attributes),
                             (lib.QC_AT_CORNER, len(corner), corner_attributes)):
            for name, array in (given or {}).items():
                mesh._add(name, at, n, np.asarray(array))
        return mesh

    def _add(self, name, at, n, array):
        if array.ndim not in (1, 2) or len(array) != n or 0 in array.shape[1:]:
            raise ValueError("attribute %r has shape %s; give (%d,) or (%d, k)"
                             % (name, array.shape, n, n))
        if name == "colour" and array.dtype == np.uint8:
            array = array / 255
        kind = (lib.QC_ATTRIBUTE_LABEL if array.dtype.kind in "iub" else
                lib.QC_ATTRIBUTE_DIRECTION if name == "normal" else lib.QC_ATTRIBUTE_LINEAR)
        values, out = np.ascontiguousarray(array, np.float64), ffi.new("double **")
        session().call(lib.qc_polygon_mesh_add_attribute, self._c, name.encode(), at, kind,
                       1 if array.ndim == 1 else array.shape[1], out)
        ffi.memmove(out[0], values, values.nbytes)

    @classmethod
    def read(cls, path):
        """From an OBJ, OFF, PLY or STL file."""
        out = ffi.new("qc_polygon_mesh **")
        session().call(lib.qc_polygon_mesh_read, str(path).encode(), out)
        return cls(out[0])

    def write(self, path, comment=None):
        """As PLY, OFF or OBJ, by extension, through a temporary."""
        session().call(lib.qc_polygon_mesh_write, self._c, str(path).encode(),
                       ffi.NULL if comment is None else comment.encode())


class Mesh(Object):
    """An oriented manifold triangle mesh; see qc/mesh.h for the numbering of halfedges."""

    struct, type = "qc_mesh", "qc.mesh/1"
    n_vertices, n_faces, n_edges = _number("n_vertices"), _number("n_faces"), _number("n_edges")
    n_boundary_edges, n_components = _number("n_boundary_edges"), _number("n_components")
    n_boundary_loops, euler, genus = _number("n_boundary_loops"), _number("euler"), _number("genus")
    diagonal, area = _number("diagonal"), _number("area")
    mean_edge_length = _number("mean_edge_length")
    vertices = _array("position", "n_vertices", 3)
    faces = _array("face_vertex", "n_faces", 3)
    twin = _array("twin", "n_faces", 3)
    halfedge_edge = _array("halfedge_edge", "n_faces", 3)
    edge_halfedge = _array("edge_halfedge", "n_edges", 2)
    edge_vertex = _array("edge_vertex", "n_edges", 2)
    vertex_corner = _array("vertex_corner", "n_vertices")
    face_component = _array("face_component", "n_faces")
    source_face = _array("source_face", "n_faces")
    source_vertex = _array("source_vertex", "n_vertices")

    @classmethod
    def from_arrays(cls, vertices, faces):
        """From positions (n x 3) and triangles (m x 3) that are manifold already; else see
        stages.repair."""
        v = np.ascontiguousarray(vertices, np.float64)
        f = np.ascontiguousarray(faces, np.int32)
        if v.ndim != 2 or v.shape[1] != 3 or f.ndim != 2 or f.shape[1] != 3:
            raise ValueError("give vertices (n, 3) and faces (m, 3)")
        out = ffi.new("qc_mesh **")
        session().call(lib.qc_mesh_create, len(v), ffi.from_buffer("double[]", v), len(f),
                       ffi.from_buffer("int32_t[]", f), out)
        return cls(out[0])


class _OnMesh(Object):
    """An object with a mesh; shapes may name the mesh's numbers."""

    mesh = _child("mesh")
    n_vertices = property(lambda self: self.mesh.n_vertices)
    n_faces = property(lambda self: self.mesh.n_faces)
    n_edges = property(lambda self: self.mesh.n_edges)


class Features(_OnMesh):
    """Flags of crease and boundary edges."""

    struct, type = "qc_features", "qc.features/1"
    n_feature_edges, n_creases = _number("n_feature_edges"), _number("n_creases")
    n_corners = _number("n_corners")
    edge = _array("edge", "n_edges")
    vertex = _array("vertex", "n_vertices")


class RepairReport(Object):
    """What was changed to make a mesh of a soup."""

    struct, type = "qc_repair_report", "qc.repair_report/1"

    @property
    def counts(self):
        """{what: how often}, what did not happen left out."""
        return {text(lib.qc_repair_kind_name(k)): self._c.count[k]
                for k in range(lib.QC_REPAIR_KINDS) if self._c.count[k]}


class Sizing(_OnMesh):
    """How dense the quads are to be."""

    struct, type = "qc_sizing", "qc.sizing/1"
    edge_length, target_quads = _number("edge_length"), _number("target_quads")
    length = _array("length", "n_faces")
    stretch = _array("stretch", "n_faces")

    @classmethod
    def create(cls, mesh, edge_length, target_quads=0.0, length=None, stretch=None):
        """One length everywhere, or one for each face; with stretch, complex numbers
        log(a / b) / 2 * d**2, edges along the direction d of each face are longer than those
        across by the factor a / b, sqrt(a b) being the length."""
        given = None if length is None else np.ascontiguousarray(length, np.float64)
        if given is not None and given.shape != (mesh.n_faces,):
            raise ValueError("length has shape %s; give (%d,)" % (given.shape, mesh.n_faces))
        out = ffi.new("qc_sizing **")
        session().call(lib.qc_sizing_create, mesh._c, edge_length, target_quads,
                       ffi.NULL if given is None else ffi.from_buffer("double[]", given), out)
        sizing = cls(out[0])
        if stretch is not None:
            stretch = np.ascontiguousarray(stretch, np.complex128)
            if stretch.shape != (mesh.n_faces,):
                raise ValueError("stretch has shape %s; give (%d,)"
                                 % (stretch.shape, mesh.n_faces))
            session().call(lib.qc_sizing_set_stretch, out[0],
                           ffi.cast("qc_complex *", ffi.from_buffer(stretch)))
        return sizing


class FaceField(_OnMesh):
    """One cross a face: a unit complex number in the frame of the face."""

    struct, type = "qc_face_field", "qc.face_field/1"
    x = _array("x", "n_faces")
    weight = _array("weight", "n_faces")
    trusted = _array("trusted", "n_faces")

    @classmethod
    def create(cls, mesh, x):
        """From complex numbers, one for each face."""
        x = np.ascontiguousarray(x, np.complex128)
        if x.shape != (mesh.n_faces,):
            raise ValueError("x has shape %s; give (%d,)" % (x.shape, mesh.n_faces))
        out = ffi.new("qc_face_field **")
        session().call(lib.qc_face_field_create, mesh._c,
                       ffi.cast("qc_complex *", ffi.from_buffer(x)), ffi.NULL, ffi.NULL, out)
        return cls(out[0])

    def write(self, path):
        """As .rosy when the path ends so, else as .rawfield."""
        session().call(lib.qc_face_field_write, self._c, str(path).encode())


class Matching(_OnMesh):
    """Which directions of neighbouring crosses belong together, and the indices of vertices."""

    struct, type = "qc_matching", "qc.matching/1"
    field = _child("field")
    mesh = property(lambda self: self.field.mesh)
    m = _array("m", "n_edges")
    theta = _array("theta", "n_edges")
    index4 = _array("index4", "n_vertices")
    n_singular, index4_sum = _number("n_singular"), _number("index4_sum")


class SeamlessMap(_OnMesh):
    """The integral of the curl-free field on the cut surface; translations are still real."""

    struct, type = "qc_seamless_map", "qc.seamless_map/1"
    matching, sizing = _child("matching"), _child("sizing")
    mesh = property(lambda self: self.matching.mesh)
    z = _array("z", "n_faces", 3)
    f = _array("f", "n_faces", 3)
    cut = _array("cut", "n_edges")
    face_turn = _array("face_turn", "n_faces")
    field_energy, curl_energy = _number("field_energy"), _number("curl_energy")


class CornerMap(_OnMesh):
    """Parameters (u, v) at the corners of faces."""

    struct, type = "qc_corner_map", "qc.corner_map/1"
    uv = _array("uv", "n_faces", 3, 2)
    edge_length = _number("edge_length")
    field_energy, curl_energy = _number("field_energy"), _number("curl_energy")
    harmonic_energy = _number("harmonic_energy")
    harmonic_energy_direct = _number("harmonic_energy_direct")

    @classmethod
    def create(cls, mesh, uv, edge_length=0.0):
        """From an array (n_faces, 3, 2)."""
        uv = np.ascontiguousarray(uv, np.float64)
        if uv.shape != (mesh.n_faces, 3, 2):
            raise ValueError("uv has shape %s; give (%d, 3, 2)" % (uv.shape, mesh.n_faces))
        out = ffi.new("qc_corner_map **")
        session().call(lib.qc_corner_map_create, mesh._c, ffi.from_buffer("double[]", uv),
                       edge_length, ffi.NULL, out)
        return cls(out[0])


class Report(Object):
    """Figures of a run."""

    struct, type = "qc_report", "qc.report/1"


_by_type = {c.type: c for c in (PolygonMesh, Mesh, Features, RepairReport, Sizing, FaceField,
                                Matching, SeamlessMap, CornerMap, Report)}


def wrap(pointer):
    """The Python object of a C object, whose reference it takes over; None for NULL."""
    if pointer == ffi.NULL:
        return None
    kind = text(ffi.cast("qc_object *", pointer).type)
    return _by_type.get(kind, Object)(pointer)
