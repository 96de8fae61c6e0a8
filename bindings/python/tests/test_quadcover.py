"""The installed package: remeshing, stages, errors, arrays, interruption."""
import gc
import inspect
import os
import signal
import tempfile
import threading
import unittest
import warnings

import numpy as np
import quadcover as qc


def square(n):
    """A flat square of 2 n^2 triangles."""
    x = np.linspace(0, 1, n + 1)
    v = np.array([[a, b, 0] for b in x for a in x])
    f = [[i + j * (n + 1), i + 1 + j * (n + 1), i + (j + 1) * (n + 1)] for j in range(n) for i in range(n)]
    f += [[i + 1 + j * (n + 1), i + 1 + (j + 1) * (n + 1), i + (j + 1) * (n + 1)]
          for j in range(n) for i in range(n)]
    return v, np.array(f)


class Remeshing(unittest.TestCase):
    def test_torus_becomes_quads(self):
        mesh = qc.shape("torus", resolution=2000)
        vertices, quads = result = qc.remesh(mesh, quads=400)
        self.assertEqual(quads.shape[1], 4)
        self.assertLess(abs(len(quads) - 400), 20)
        edges = {tuple(sorted((q[i], q[i - 1]))) for q in quads for i in range(4)}
        self.assertEqual(len(vertices) - len(edges) + len(quads), 0)
        inside = result.barycentric
        self.assertTrue((inside > -1e-9).all() and np.allclose(inside.sum(1), 1))
        points = np.einsum("nk,nkd->nd", inside, mesh.vertices[mesh.faces[result.source_face]])
        self.assertEqual(points.shape, vertices.shape)
        self.assertEqual(result.uv.n_faces, result.mesh.n_faces)

    def test_attributes_come_through(self):
        v, f = square(20)
        weights = np.stack([1 - v[:, 0], v[:, 0]], 1)
        part = (v[f].mean(1)[:, 0] > 0.5).astype(int)
        result = qc.remesh(v, f, quads=100, mode="fast", face_group=1 + part, keep_materials=True,
                           vertex_attributes={"skin": weights, "heat": v[:, 1],
                                              "colour": np.full((len(v), 3), 51, np.uint8),
                                              "normal": np.tile([0, 0, 1.0], (len(v), 1))},
                           face_attributes={"part": part})
        a = result.attributes
        self.assertTrue(np.allclose(a["skin"].sum(1), 1))
        self.assertTrue(np.allclose(a["skin"][:, 1], result.vertices[:, 0]))
        self.assertTrue(np.allclose(a["heat"], result.vertices[:, 1]))
        self.assertTrue(np.allclose(a["normal"], [0, 0, 1]))
        self.assertTrue(np.allclose(a["colour"], 0.2))
        part = result.face_attributes["part"]
        self.assertEqual(part.dtype.kind, "i")
        self.assertTrue((result.polygons.face_group == 1 + part).all())
        x = result.vertices[result.quads][:, :, 0]
        self.assertTrue(np.where(part == 1, x.min(1) > 0.5 - 1e-9, x.max(1) < 0.5 + 1e-9).all())
        with self.assertRaises(ValueError):
            qc.remesh(v, f, vertex_attributes={"heat": v[:5, 0]})
        with self.assertRaises(ValueError):
            qc.remesh(qc.shape("torus", resolution=500), vertex_attributes={"heat": v[:, 0]})

    def test_attributes_go_through_files(self):
        v, f = square(2)
        mesh = qc.PolygonMesh.from_arrays(v, f, {"w": v[:, :2], "id": np.arange(len(v))},
                                          {"area": np.full(len(f), 0.125)})
        with tempfile.TemporaryDirectory() as folder:
            mesh.write(folder + "/a.ply", "a comment")
            back = qc.PolygonMesh.read(folder + "/a.ply")
        self.assertTrue((back.vertex_attributes["w"] == v[:, :2]).all())
        self.assertTrue((back.vertex_attributes["id"] == np.arange(len(v))).all())
        self.assertTrue((back.face_attributes["area"] == 0.125).all())

    def test_statistics_are_those_of_the_program(self):
        v, f = square(12)
        stats = qc.remesh(v, f, quads=64, mode="fast").stats
        self.assertEqual(stats["quadcover"], qc.__version__)
        self.assertEqual(stats["mode"], "fast")
        self.assertEqual(stats["density"]["target_quads"], 64)
        self.assertEqual(stats["quads"]["euler"], 1)
        self.assertEqual(stats["quads"]["non_quads"], 0)
        self.assertGreater(stats["seconds"]["total"], 0)
        self.assertIn("qc.round", stats["versions"])
        self.assertEqual(stats["warnings"], [])

    def test_same_bytes_for_any_threads(self):
        mesh = qc.shape("sphere", resolution=1500)
        first = qc.remesh(mesh.vertices, mesh.faces, quads=300)
        qc.set_threads(1)
        second = qc.remesh(mesh.vertices, mesh.faces, quads=300)
        qc.set_threads(0)
        self.assertEqual(first.vertices.tobytes(), second.vertices.tobytes())
        self.assertEqual(first.quads.tobytes(), second.quads.tobytes())

    def test_pipeline_can_be_changed(self):
        steps = qc.default_pipeline(quads=300, mode="fast")
        self.assertIn('"qc.hodge"', steps)
        a = qc.remesh(qc.shape("torus", resolution=1500), pipeline=steps)
        b = qc.remesh(qc.shape("torus", resolution=1500), quads=300, mode="fast",
                      set={"smooth.lambda": 0.5})
        self.assertEqual(a.quads.shape[1], 4)
        self.assertEqual(b.quads.shape[1], 4)

    def test_progress_and_cancel(self):
        seen = []
        qc.remesh(qc.shape("torus", resolution=1500), quads=300,
                  progress=lambda fraction, stage: seen.append((fraction, stage)))
        fractions = [f for f, _ in seen]
        self.assertEqual(fractions, sorted(fractions))
        self.assertIn("hodge", {s for _, s in seen})
        with self.assertRaises(qc.Cancelled):
            qc.remesh(qc.shape("torus", resolution=1500), progress=lambda fraction, stage: False)

    def test_exception_of_the_callback_comes_through(self):
        def broken(fraction, stage):
            raise KeyError("mine")

        with self.assertRaisesRegex(KeyError, "mine"):
            qc.remesh(qc.shape("torus", resolution=1500), progress=broken)
        self.assertEqual(qc.remesh(qc.shape("torus", resolution=1500), quads=300).quads.shape[1], 4)

    def test_interrupt_ends_the_call(self):
        if not hasattr(signal, "raise_signal") or signal.getsignal(signal.SIGINT) is None:
            self.skipTest("no signals here")
        mesh = qc.shape("torus", resolution=100000)
        timer = threading.Timer(0.3, os.kill, (os.getpid(), signal.SIGINT))
        before = signal.signal(signal.SIGINT, signal.default_int_handler)
        timer.start()
        try:
            with self.assertRaises(KeyboardInterrupt):
                for _ in range(100):
                    qc.remesh(mesh, quads=20000)
        finally:
            timer.cancel()
            signal.signal(signal.SIGINT, before)

    def test_other_threads_run_meanwhile(self):
        results = {}

        def run(name):
            results[name] = qc.remesh(qc.shape("torus", resolution=1500), quads=300)

        threads = [threading.Thread(target=run, args=(i,)) for i in range(3)]
        for t in threads:
            t.start()
        for t in threads:
            t.join()
        self.assertEqual({r.vertices.tobytes() for r in results.values()},
                         {results[0].vertices.tobytes()})


class Errors(unittest.TestCase):
    def test_a_bad_coordinate_is_named(self):
        v, f = square(4)
        v[7, 1] = np.nan
        with self.assertRaises(qc.Error) as caught:
            qc.Mesh.from_arrays(v, f)
        self.assertEqual(caught.exception.where, 7)
        self.assertIsInstance(caught.exception, ValueError)

    def test_stage_and_place_are_told(self):
        faces = np.array([[0, 1, 2], [0, 1, 3], [0, 1, 4]])
        with self.assertRaises(qc.Error) as caught:
            qc.remesh(np.eye(5, 3), faces)
        self.assertEqual(caught.exception.stage, "repair")

    def test_missing_files_and_names(self):
        with self.assertRaises(OSError):
            qc.remesh("no such file.obj")
        with self.assertRaisesRegex(LookupError, "torus"):
            qc.shape("toru")
        with self.assertRaisesRegex(ValueError, "fast"):
            qc.remesh(qc.shape("torus"), mode="fats")
        with self.assertRaisesRegex(qc.Error, "lambda"):
            mesh = qc.shape("torus", resolution=200)
            qc.stages.field_smooth(field=qc.FaceField.create(mesh, np.ones(mesh.n_faces)), lambda_=2.0)


class Stages(unittest.TestCase):
    def test_functions_are_made_from_the_tables(self):
        hodge = qc.stages.hodge
        self.assertIn("matching", inspect.signature(hodge).parameters)
        self.assertIn("Source: ", hodge.__doc__)
        self.assertIn("field_smooth", qc.stages.__all__)

    def test_stages_one_by_one(self):
        mesh = qc.shape("sphere", resolution=1200)
        field = qc.stages.field_smoothest(mesh=mesh)
        matching = qc.stages.matching(field=field)
        self.assertEqual(matching.index4_sum, 8)
        self.assertEqual(matching.index4.sum(), 8)
        sizing = qc.stages.size(mesh=mesh, quads=300)
        seamless = qc.stages.hodge(matching=matching, sizing=sizing)
        rounded = qc.stages.round(map=seamless)
        self.assertEqual(rounded.uv.shape, (mesh.n_faces, 3, 2))
        with self.assertRaises(TypeError):
            qc.stages.hodge(matching=matching)


class Arrays(unittest.TestCase):
    def test_arrays_keep_their_object_alive_and_copy_nothing(self):
        mesh = qc.Mesh.from_arrays(*square(10))
        vertices = mesh.vertices
        address = vertices.__array_interface__["data"][0]
        self.assertEqual(address, mesh.vertices.__array_interface__["data"][0])
        self.assertFalse(vertices.flags.writeable)
        del mesh
        gc.collect()
        [np.ones(1000) for _ in range(100)]
        self.assertEqual(vertices[-1].tolist(), [1, 1, 0])

    def test_polygons_round_trip(self):
        v, f = square(3)
        soup = qc.PolygonMesh.from_arrays(v, [list(f[0]), [0, 1, 5, 4]])
        self.assertEqual(soup.face_offset.tolist(), [0, 3, 7])
        self.assertEqual(soup.position.tolist(), v.tolist())

    def test_own_field_and_sizing(self):
        mesh = qc.Mesh.from_arrays(*square(8))
        with self.assertRaises(ValueError):
            qc.FaceField.create(mesh, np.ones(3))
        field = qc.FaceField.create(mesh, 2 * np.ones(mesh.n_faces))
        self.assertTrue(np.allclose(np.abs(field.x), 1))
        sizing = qc.Sizing.create(mesh, 0.1, length=np.full(mesh.n_faces, 0.1))
        self.assertEqual(sizing.length.shape, (mesh.n_faces,))
        self.assertIsNone(sizing.stretch)
        stretch = np.full(mesh.n_faces, 0.5j)
        sizing = qc.Sizing.create(mesh, 0.1, stretch=stretch)
        self.assertEqual(sizing.stretch.tolist(), stretch.tolist())
        with self.assertRaises(ValueError):
            qc.Sizing.create(mesh, 0.1, stretch=stretch[1:])

    def test_one_half_is_mirrored(self):
        mesh = qc.shape("sphere", resolution=1000)
        vertices, quads = qc.remesh(mesh, quads=200, symmetry="x")
        there = {tuple(v) for v in vertices.tolist()}
        self.assertEqual({(-x, y, z) for x, y, z in there}, there)
        self.assertEqual(len(vertices) - len(quads), 2)
        with self.assertRaises(qc.Error):
            qc.remesh(mesh, quads=200, symmetry="sideways")

    def test_repairs_warn(self):
        v, f = square(6)
        with warnings.catch_warnings(record=True) as caught:
            warnings.simplefilter("always")
            result = qc.remesh(v, np.vstack([f, f[:1]]), quads=30, mode="fast")
        self.assertIn(1, result.repairs.values())
        self.assertTrue(any(issubclass(w.category, qc.QuadcoverWarning) for w in caught))


if __name__ == "__main__":
    unittest.main()
