"""Field-guided parameterization and quad meshing on branched coverings.

    import quadcover
    vertices, quads = quadcover.remesh("model.obj", quads=5000)

`quadcover.stages` has every stage as a function, `quadcover.sparse` the Cholesky factorisation.
Results do not depend on the number of threads (set_threads, QUADCOVER_THREADS).
"""
from . import stages
from ._c import lib as _lib
from ._context import (Cancelled, Error, NotPositiveDefinite, QuadcoverWarning, set_threads)
from ._context import text as _text
from ._objects import (CornerMap, FaceField, Features, Matching, Mesh, Object, PolygonMesh,
                       RepairReport, Report, SeamlessMap, Sizing)
from ._remesh import RemeshResult, default_pipeline, remesh, shape, shapes

__version__ = _text(_lib.qc_version())
__all__ = [
    "Cancelled", "CornerMap", "Error", "FaceField", "Features", "Matching", "Mesh",
    "NotPositiveDefinite", "Object", "PolygonMesh", "QuadcoverWarning", "RemeshResult",
    "RepairReport", "Report", "SeamlessMap", "Sizing", "default_pipeline", "remesh", "set_threads",
    "shape", "shapes", "stages",
]
