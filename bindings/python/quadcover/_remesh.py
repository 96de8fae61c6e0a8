"""The main job: triangles in, quads out."""
import json
import os
import time

import numpy as np

from ._c import ffi, lib
from ._context import session, text
from ._objects import FaceField, Mesh, PolygonMesh, RepairReport, wrap
from .stages import _as_text

_modes = {"fast": lib.QC_MODE_FAST, "relocate": lib.QC_MODE_RELOCATE, "best": lib.QC_MODE_BEST}


class RemeshResult:
    """What a run made.

    vertices   (n, 3) positions of the quads
    quads      (m, 4) their corners
    source_face, barycentric   where on the input each vertex lies
    mesh       the repaired triangle mesh
    uv         the parameterization: a PolygonMesh with one uv per corner
    field      the cross field on `mesh`
    attributes, face_attributes, corner_attributes   {name: array} of the input, on the quads
    stats      the statistics of docs/files.md as a dict
    repairs    {what: how often}
    warnings   lines about components without a result
    """

    def __init__(self, result, stats):
        self.stats = stats

        def take(pointer):
            return wrap(lib.qc_object_retain(pointer)) if pointer != ffi.NULL else None

        self.mesh: Mesh = take(result.mesh)
        self.polygons: PolygonMesh = take(result.quads)
        self.uv: PolygonMesh = take(result.uv)
        self.field: FaceField = take(result.field)
        repairs: RepairReport = take(result.repairs)
        self.repairs = repairs.counts if repairs else {}
        self.warnings = [text(result.warning[i]) for i in range(result.n_warnings)]
        none = self.polygons is None
        self.vertices = None if none else self.polygons.position
        self.quads = None if none else self.polygons.faces
        self.attributes = {} if none else self.polygons.vertex_attributes
        self.face_attributes = {} if none else self.polygons.face_attributes
        self.corner_attributes = {} if none else self.polygons.corner_attributes
        self.source_face = None if none else self.polygons.source_face
        self.barycentric = None if none else self.polygons.source_barycentric

    def __iter__(self):
        """vertices, quads = remesh(...)"""
        return iter((self.vertices, self.quads))

    def __repr__(self):
        return "<quadcover.RemeshResult: %d quads>" % (0 if self.quads is None else len(self.quads))


def _input(vertices, faces, **attributes):
    if faces is None and any(a is not None for a in attributes.values()):
        raise ValueError("attributes need vertices and faces; files and meshes bring their own")
    if isinstance(vertices, PolygonMesh):
        return vertices
    if isinstance(vertices, Mesh):
        return PolygonMesh.from_arrays(vertices.vertices, vertices.faces)
    if faces is None:
        return PolygonMesh.read(vertices)
    return PolygonMesh.from_arrays(vertices, faces, **attributes)


def default_pipeline(*, quads=0.0, edge_length=0.0, edge_length_rel=0.0, mode="best", sharp=0.0,
                     features=True, field=None, seed=0, keep_materials=False):
    """The steps of `remesh` as JSON, to be changed and given back as `pipeline`."""
    s = session()
    return _print(s, _default(s, quads, edge_length, edge_length_rel, mode, sharp, features, field,
                              seed, keep_materials))


def _default(s, quads, edge_length, edge_length_rel, mode, sharp, features, field, seed,
             keep_materials):
    if mode not in _modes:
        raise ValueError("mode is %r; give one of %s" % (mode, ", ".join(_modes)))
    path = ffi.NULL if field is None else ffi.new("char[]", os.fsencode(field))
    options = ffi.new("qc_default_pipeline_options *", {
        "struct_size": ffi.sizeof("qc_default_pipeline_options"), "quads": quads or 0.0,
        "edge_length": edge_length, "edge_length_rel": edge_length_rel,
        "crease_angle": sharp if features else -1.0, "field_path": path, "seed": seed,
        "mode": _modes[mode], "keep_groups": int(keep_materials)})
    return s.make("qc_pipeline", lib.qc_pipeline_free, lib.qc_default_pipeline, s.ctx, s.registry,
                  options)


def _print(s, pipeline):
    out = ffi.new("char **")
    s.check(lib.qc_pipeline_print(pipeline, out))
    try:
        return text(out[0])
    finally:
        lib.qc_text_free(out[0])


def remesh(vertices, faces=None, *, quads=0.0, edge_length=0.0, edge_length_rel=0.0, mode="best",
           sharp=0.0, features=True, field=None, seed=0, keep_materials=False, pipeline=None,
           set=None, strict=False, symmetry=None, progress=None, vertex_attributes=None,
           face_attributes=None, corner_attributes=None, face_group=None):
    """A triangle mesh becomes a pure quad mesh.

    vertices, faces   positions (n, 3) and corners (m, 3) or a list of polygons; or a PolygonMesh, a
                      Mesh or the path of a file alone
    quads, edge_length, edge_length_rel   density: at most one of number of quads, length, length
                      relative to the bounding box diagonal
    mode              "fast", "relocate" or "best": how branch points are optimised
    sharp             crease angle in degrees, 0 = 35; features=False: neither creases nor boundaries
    field             path of a .rawfield or .rosy to use
    keep_materials    no quad crosses a border between groups (face_group, or those of a file)
    pipeline          JSON of the steps instead of the default ones (see default_pipeline)
    set               {"step.parameter": value}
    strict            a component which fails fails the call
    symmetry          "auto", "x", "y", "z" or a plane "nx,ny,nz,d": one half is remeshed and mirrored
    progress          progress(fraction, stage); False cancels (Cancelled), as Ctrl-C does
    vertex_attributes, face_attributes, corner_attributes, face_group   see PolygonMesh.from_arrays;
                      the result has them on the quads
    Returns a RemeshResult. Raises Error with .where and .stage.
    """
    s = session()
    start, lines = time.monotonic(), []
    soup = _input(vertices, faces, vertex_attributes=vertex_attributes,
                  face_attributes=face_attributes, corner_attributes=corner_attributes,
                  face_group=face_group)
    read = time.monotonic() - start
    if pipeline is None:
        steps = _default(s, quads, edge_length, edge_length_rel, mode, sharp, features, field, seed,
                         keep_materials)
    else:
        steps = s.make("qc_pipeline", lib.qc_pipeline_free, lib.qc_pipeline_parse, s.registry,
                       pipeline.encode())
    for name, value in (set or {}).items():
        step, _, parameter = name.rpartition(".")
        s.check(lib.qc_pipeline_set(steps, step.encode(), parameter.encode(),
                                    _as_text(value).encode()))
    plane = ffi.NULL if symmetry is None else ffi.new("char[]", symmetry.encode())
    options = ffi.new("qc_remesh_options *", {"struct_size": ffi.sizeof("qc_remesh_options"),
                                              "strict": int(strict), "symmetry": plane})
    result = ffi.gc(ffi.new("qc_remesh_result *"), lib.qc_remesh_result_clear)
    with s.reporting(progress, lines):
        s.call(lib.qc_remesh, steps, soup._c, options, result)
    lines += [text(result.warning[i]) for i in range(result.n_warnings)]
    name = os.fspath(vertices) if isinstance(vertices, (str, os.PathLike)) else ""
    stats = _stats(s, result.report, steps, name, "pipeline" if pipeline else mode, lines,
                   time.monotonic() - start, read)
    return RemeshResult(result, stats)


def _stats(s, report, steps, name, mode, lines, total, read):
    if report == ffi.NULL:
        return None
    texts = [ffi.new("char[]", line.encode()) for line in lines]
    array = ffi.new("char *[]", texts)
    keep = ffi.new("char[]", name.encode("utf-8", "replace")), ffi.new("char[]", mode.encode())
    options = ffi.new("qc_stats_options *", {
        "struct_size": ffi.sizeof("qc_stats_options"), "input": keep[0], "mode": keep[1],
        "total": total, "read": read, "n_warnings": len(texts),
        "warning": ffi.cast("const char *const *", array)})
    out = ffi.new("char **")
    s.call(lib.qc_stats_json, report, steps, options, out)
    try:
        return json.loads(text(out[0]))
    finally:
        lib.qc_text_free(out[0])


def shape(name, *, resolution=0, noise=0.0, retriangulate=False, genus=2, seed=1):
    """One of the papers' surfaces as a Mesh; shapes() lists them."""
    options = ffi.new("qc_shape_options *", {
        "struct_size": ffi.sizeof("qc_shape_options"), "resolution": resolution, "noise": noise,
        "retriangulate": int(retriangulate), "genus": genus, "seed": seed})
    out = ffi.new("qc_mesh **")
    session().call(lib.qc_shape_create, name.encode(), options, out)
    return wrap(out[0])


def shapes():
    """{name: description} of the surfaces `shape` makes."""
    count = ffi.new("size_t *")
    table = lib.qc_shape_list(count)
    return {text(table[i].name): text(table[i].doc) for i in range(count[0])}
