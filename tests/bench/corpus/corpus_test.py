#!/usr/bin/env python3
"""corpus_test.py QUADCOVER: the generator makes the same bytes again, every class has what its name says, the counts
find what is no manifold, and the acceptance runs take up where they stopped."""
import json
import os
import subprocess
import sys
import tempfile
import unittest

try:
    import numpy as np
except ImportError:
    print("numpy is missing")
    sys.exit(77)

HERE = os.path.dirname(os.path.abspath(__file__))
sys.path.insert(0, HERE)
import corpus      # noqa: E402
import edit        # noqa: E402
import implicit    # noqa: E402
import functions   # noqa: E402
import mesh        # noqa: E402
import solids      # noqa: E402

PROGRAM = sys.argv.pop(1)
FEW = "slivers-01,slivers-02,genus-05,needle-02"


def generate(folder):
    subprocess.run([sys.executable, os.path.join(HERE, "corpus.py"), folder, "--only", FEW], check=True)
    with open(os.path.join(folder, "corpus.jsonl")) as lines:
        return [json.loads(line) for line in lines]


def accept(folder):
    script = os.path.join(HERE, os.pardir, "acceptance", "acceptance.py")
    return subprocess.run([sys.executable, script, "--program", PROGRAM, "--corpus", folder, "--modes", "fast",
                           "--quads", "500", "--only", "genus", "--results", os.path.join(folder, "results.jsonl")],
                          capture_output=True, text=True, check=True).stdout


class Corpus(unittest.TestCase):
    def test_classes(self):
        names = [n[0] for n in corpus.names()]
        self.assertEqual(300, len(names))
        self.assertEqual(300, len(set(names)))
        self.assertIn("genus-50", names)

    def test_same_bytes(self):
        with tempfile.TemporaryDirectory() as one, tempfile.TemporaryDirectory() as two:
            found = generate(one)
            self.assertEqual(found, generate(two))
            self.assertEqual(-8, next(m["euler"] for m in found if m["name"] == "genus-05"))
            for m in found:
                with open(os.path.join(one, m["name"] + ".obj")) as a, open(os.path.join(two, m["name"] + ".obj")) as b:
                    self.assertEqual(a.read(), b.read(), m["name"])

    def test_takes_up(self):
        with tempfile.TemporaryDirectory() as folder:
            generate(folder)
            self.assertIn("genus-05", accept(folder))
            again = accept(folder)
            self.assertNotRegex(again, r"genus-05 +\d")
            self.assertIn("of 1 runs good", again)


class Pieces(unittest.TestCase):
    def test_topology_finds_defects(self):
        p, f = solids.boxes(np.ones((2, 1, 1), dtype=bool), [np.arange(3.0)] * 3)
        self.assertEqual({"faces": 20, "euler": 2, "components": 1, "boundaries": 0}, mesh.topology(p, f))
        self.assertEqual(1, mesh.topology(p, f[1:])["boundaries"])
        for bad in (np.vstack([f, f[:1]]), np.vstack([f[:, ::-1][:1], f[1:]])):
            with self.assertRaises(ValueError):
                mesh.topology(p, bad)
        diagonal = np.array([[[1], [0]], [[0], [1]]], dtype=bool)
        with self.assertRaises(ValueError):
            mesh.topology(*solids.boxes(diagonal, [np.arange(3.0)] * 3))

    def test_marching_tetrahedra(self):
        p, f = implicit.surface(functions.ring(0.7, 0.3), [-1.2] * 3, [1.2] * 3, 16)
        self.assertEqual(0, mesh.topology(p, f)["euler"])
        volume = np.linalg.det(p[f]).sum() / 6
        self.assertAlmostEqual(1, volume / (2 * np.pi ** 2 * 0.7 * 0.3 ** 2), delta=0.1)

    def test_edits_keep_topology(self):
        p, f = implicit.surface(functions.ring(0.7, 0.3), [-1.2] * 3, [1.2] * 3, 14)
        self.assertEqual(0, mesh.topology(*edit.refined(p, f, 0.1))["euler"])
        p, f = edit.decimated(p, f, 300)
        self.assertEqual(0, mesh.topology(p, f)["euler"])
        self.assertLess(len(f), 400)

    def test_extruded_hole(self):
        square = np.array([[0, 0], [4, 0], [4, 4], [0, 4]], dtype=float)
        p, f = solids.extrude([square, square / 4 + 1, square / 4 + [2.5, 1]], 2.0)
        self.assertEqual(-2, mesh.topology(p, f)["euler"])
        self.assertAlmostEqual(2 * (16 - 2), np.linalg.det(p[f]).sum() / 6)


if __name__ == "__main__":
    unittest.main()
