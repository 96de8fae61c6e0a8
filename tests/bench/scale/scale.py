#!/usr/bin/env python3
"""Time and memory of `quadcover remesh --mode fast` over the number of faces: a smooth surface at four resolutions and
a mesh with creases whose faces are split into k^2, one run each on one thread. Prints two tables in Markdown. Standard
library only.

The program's own seconds of the stages are wall-clock; here they are scaled to the CPU time of the run. The exponent is
that of the line in logarithms through the last two rows of a surface: 1 is linear."""
import argparse
import json
import math
import os
import subprocess
import sys
import tempfile

ROOT = os.path.join(os.path.dirname(os.path.abspath(__file__)), *[os.pardir] * 3)
STAGES = ("repair", "features", "refine", "curvature", "smooth", "matching", "split", "hodge", "round", "untangle",
          "extract", "finish", "measure")


def parse():
    p = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    p.add_argument("--program", default=os.path.join(ROOT, "build/bin/quadcover"))
    p.add_argument("--meshes", default=os.path.join(
        os.environ.get("QC_TEST_DATA", os.path.join(ROOT, "../shared")), "meshes"))
    p.add_argument("--faces", default="1000,10000,100000,1000000", help="of the torus")
    p.add_argument("--split", default="1,3,8", help="pieces into which each edge of the fandisk is cut")
    p.add_argument("--quads", type=int, default=10000)
    return p.parse_args()


def read_off(path):
    with open(path) as f:
        words = f.read().split()
    n, m, at = int(words[1]), int(words[2]), 4
    points = [[float(x) for x in words[at + 3 * i:at + 3 * i + 3]] for i in range(n)]
    at += 3 * n
    return points, [[int(x) for x in words[at + 4 * i + 1:at + 4 * i + 4]] for i in range(m)]


def split(points, faces, k):
    """Each triangle in k^2 of its shape."""
    points, inner, small = list(points), {}, []

    def edge(a, b):
        low, high = min(a, b), max(a, b)
        if (low, high) not in inner:
            inner[low, high] = range(len(points), len(points) + k - 1)
            p, q = points[low], points[high]
            points.extend([(x * (k - i) + y * i) / k for x, y in zip(p, q)] for i in range(1, k))
        return list(inner[low, high])[::1 if a < b else -1]

    for a, b, c in faces:
        left, right, rows = edge(a, c), edge(b, c), [[a, *edge(a, b), b]]
        for j in range(1, k):
            middle = range(len(points), len(points) + k - j - 1)
            points.extend([((k - j - i) * x + i * y + j * z) / k for x, y, z in zip(points[a], points[b], points[c])]
                          for i in range(1, k - j))
            rows.append([left[j - 1], *middle, right[j - 1]])
        rows.append([c])
        for low, high in zip(rows, rows[1:]):
            small += [(low[i], low[i + 1], high[i]) for i in range(len(high))]
            small += [(low[i + 1], high[i + 1], high[i]) for i in range(len(high) - 1)]
    return points, small


def write_obj(path, points, faces):
    with open(path, "w") as f:
        f.writelines("v %.9g %.9g %.9g\n" % tuple(p) for p in points)
        f.writelines("f %d %d %d\n" % (a + 1, b + 1, c + 1) for a, b, c in faces)


def surfaces(a, folder):
    """(surface, file) by rising size."""
    for n in filter(None, a.faces.split(",")):
        path = os.path.join(folder, f"torus-{n}.obj")
        subprocess.run([a.program, "shape", "torus", "--resolution", n, "-o", path], check=True)
        yield "torus", path
    source = os.path.join(a.meshes, "fandisk.off")
    for k in map(int, filter(None, a.split.split(","))):
        if not os.path.exists(source):
            print(f"no {source}: torus only (set QC_TEST_DATA)", file=sys.stderr)
            return
        path = os.path.join(folder, f"fandisk-{k}.obj")
        write_obj(path, *split(*read_off(source), k))
        yield "fandisk", path


def run(a, folder, surface, path):
    """Figures of one run."""
    stats = os.path.join(folder, "stats.json")
    child = subprocess.Popen([a.program, "remesh", path, "-o", os.path.join(folder, "out.obj"), "--quads", str(a.quads),
                              "--mode", "fast", "--threads", "1", "--progress", "none", "--stats", stats],
                             stderr=subprocess.DEVNULL)
    usage = os.wait4(child.pid, 0)
    child.returncode = os.waitstatus_to_exitcode(usage[1])
    if child.returncode:
        sys.exit(f"{os.path.basename(path)}: status {child.returncode}")
    with open(stats) as f:
        found = json.load(f)
    cpu, wall = usage[2].ru_utime + usage[2].ru_stime, found["seconds"]["total"]
    return {"surface": surface, "faces": found["input"]["faces"], "quads": found["quads"]["faces"],
            "irregular": found["quads"]["irregular"], "cpu": cpu, "memory": usage[2].ru_maxrss * 1024,
            "stages": {k: v * cpu / wall for k, v in found["seconds"]["stages"].items()}}


def table(*rows):
    for i, row in enumerate(rows):
        print("| " + " | ".join(map(str, row)) + " |")
        if i == 0:
            print("|---|" + "---:|" * (len(row) - 1))


def exponent(first, last, value):
    return math.log(value(last) / max(value(first), 1e-3)) / math.log(last["faces"] / first["faces"])


def show(runs):
    print()
    table(["surface", "faces", "quads", "irregular", "CPU s", "us a face", "peak MB", "bytes a face"],
          *([r["surface"], r["faces"], r["quads"], r["irregular"], f"{r['cpu']:.2f}", f"{1e6 * r['cpu'] / r['faces']:.1f}",
             f"{r['memory'] / 1e6:.0f}", f"{r['memory'] / r['faces']:.0f}"] for r in runs))
    print("\nCPU seconds by stage, and the exponent between the two largest sizes where a stage takes a second:\n")
    rows = []
    for surface in dict.fromkeys(r["surface"] for r in runs):
        some = [r for r in runs if r["surface"] == surface]
        rows += [[f"{surface} {r['faces']}", *(f"{r['stages'].get(s, 0):.2f}" for s in STAGES)] for r in some]
        if len(some) > 1:
            rows.append([f"{surface}, exponent", *(
                f"{exponent(some[-2], some[-1], lambda r, s=s: r['stages'].get(s, 0)):.2f}"
                if some[-1]["stages"].get(s, 0) >= 1 else "" for s in STAGES)])
    table(["run", *STAGES], *rows)


def main():
    a = parse()
    with tempfile.TemporaryDirectory() as folder:
        show([run(a, folder, *s) for s in surfaces(a, folder)])


main()
