"""The page holds the run: its quads, its map, its cones, its figures; nothing refers to a network."""

import json
import math
import os
import re
import sys
import tempfile

from page import read, run

ROOT = os.path.join(os.path.dirname(os.path.abspath(__file__)), "../..")


def read_obj(path):
    points, faces = [], []
    with open(path, encoding="utf-8") as file:
        for line in file:
            words = line.split()
            if words[:1] == ["v"]:
                points.append([float(x) for x in words[1:4]])
            elif words[:1] == ["f"]:
                faces.append([int(w.split("/")[0]) - 1 for w in words[1:]])
    return points, faces


def quantised(points, arrays, name):
    """Positions agree with one step, found by regression, and a shift for each coordinate."""
    got = arrays[name]
    assert len(got) == 3 * len(points)
    mean_p = [sum(p[c] for p in points) / len(points) for c in range(3)]
    mean_q = [sum(got[c::3]) / len(points) for c in range(3)]
    pairs = [(p[c] - mean_p[c], q - mean_q[c]) for c in range(3) for p, q in zip(points, got[c::3])]
    step = sum(p * q for p, q in pairs) / sum(q * q for _, q in pairs)
    assert all(abs(p - step * q) <= 0.6 * step for p, q in pairs), name


def cones_are_those_of_the_quads(report, arrays):
    index = arrays["cones"][3::4]
    counts = {k: n for k, n in report["stats"]["field"]["index4"].items() if n}
    assert {str(k): index.count(k) for k in set(index)} == counts, (counts, index)
    assert len(index) == report["stats"]["quads"]["irregular"]


def area_of_the_grid(report, arrays):
    """As many unit squares as quads."""
    scale, uv = report["geometry"]["uv_scale"], arrays["grid_uv"]
    area = 0
    for i in range(0, len(uv), 6):
        a, b, c, d = uv[i + 2] - uv[i], uv[i + 3] - uv[i + 1], uv[i + 4] - uv[i], uv[i + 5] - uv[i + 1]
        assert a * d - b * c >= -4 * max(map(abs, (a, b, c, d)))
        area += (a * d - b * c) / 2
    quads = report["stats"]["quads"]["faces"]
    assert abs(area / scale ** 2 - quads) < 0.01 * quads, (area / scale ** 2, quads)


def histograms(report):
    corners = 4 * report["stats"]["quads"]["faces"]
    for name, mark in (("edge", 1), ("angle", 90)):
        h = report["histograms"][name]
        n = len(h["count"])
        middle = [h["lo"] + (i + 0.5) * (h["hi"] - h["lo"]) / n for i in range(n)]
        assert sum(h["count"]) == corners
        mean = sum(x * k for x, k in zip(middle, h["count"])) / corners
        assert abs(mean - mark) < 0.03 * mark, (name, mean)
    rsd = report["stats"]["quads"]["rsd_angle"] / 100 * 90
    square = sum((x - 90) ** 2 * k for x, k in zip(middle, h["count"])) / corners
    assert abs(math.sqrt(square) - rsd) < 0.1 * rsd + 0.5, (math.sqrt(square), rsd)


def field_follows_the_map(report, arrays):
    """On a face the cross and the grid have about the same directions."""
    p, t, angle = arrays["input_positions"], arrays["input_faces"], arrays["field"]
    assert arrays["grid_faces"] == t
    uv, off = arrays["grid_uv"], []
    for f, a in enumerate(angle):
        i = 6 * f
        du, dv = uv[i + 4] - uv[i + 2], uv[i + 5] - uv[i + 3]
        # The edge from corner 1 to 2 lies at atan2(dv, du) from the isolines of v.
        turn = (a / 256 + math.atan2(dv, du) / (math.pi / 2)) % 1
        off.append(min(turn, 1 - turn) * 90)
    off.sort()
    assert off[len(off) // 2] < 8, off[len(off) // 2]


def curves_of_figure_6_1(program, name):
    """Steps which optimise, evaluations and E_D of each run of one; without that, none."""
    run(program, "remesh", name, "--quads", "500", "--mode", "best", "--report", "best.html")
    report, _ = read("best.html")
    assert [part["step"] for part in report["trace"]] == ["cancel", "curl", "balance"]
    for part in report["trace"]:
        energy, points = part["curves"]["E_D_rel"], part["curves"]["branch_points"]
        assert [x for x, _ in energy] == [x for x, _ in points] == sorted(x for x, _ in energy)
        if part["step"] == "curl":
            assert all(a[1] >= b[1] for a, b in zip(energy, energy[1:]))


def poles_of_height(program):
    """Two poles and two saddles of the graph of sin u cos v (second paper, Figure 10)."""
    pipeline = os.path.join(ROOT, "docs/pipelines/height-function.json")
    run(program, "shape", "sin-u-cos-v", "--resolution", "3000", "-o", "graph.obj")
    run(program, "remesh", "graph.obj", "--pipeline", pipeline, "--set", "size.quads=1000", "--report", "graph.html")
    report, arrays = read("graph.html")
    index = arrays["cones"][3::4]
    assert sorted(index) == [-4, -4, 4, 4], index
    assert report["stats"]["field"]["index4"] == {"-4": 2, "-1": 0, "1": 0, "4": 2}
    # Cells of the quads at the poles, in which the map is bilinear, are triangles here.
    assert len(arrays["grid_faces"]) > len(arrays["input_faces"]) and len(arrays["grid_faces"]) % 3 == 0
    assert len(arrays["grid_uv"]) == 2 * len(arrays["grid_faces"])
    assert 3 * max(arrays["grid_faces"]) < len(arrays["grid_positions"])


def no_address(path):
    with open(path, encoding="utf-8") as file:
        text = file.read()
    known = {"http://www.w3.org/2000/svg", "http://www.w3.org/1999/xhtml"}  # names, not addresses
    assert set(re.findall(r"https?://[A-Za-z0-9./_-]+", text)) <= known
    assert not re.search(r'(src|href)="(?!data:)', text.split("<script", 1)[0])
    assert "default-src 'none'" in text
    assert text.count("</script>") == 3


def main(program):
    with tempfile.TemporaryDirectory() as folder:
        os.chdir(folder)
        name = "a <b> & 'c'.obj"
        run(program, "shape", "ellipsoid", "--resolution", "1500", "-o", name)
        run(program, "remesh", name, "-o", "quads.obj", "--quads", "500", "--mode", "fast",
            "--report", "page.html", "--stats", "stats.json", "--threads", "1")
        report, arrays = read("page.html")
        with open("stats.json", encoding="utf-8") as file:
            assert report["stats"] == json.load(file)
        assert report["command"].startswith("quadcover remesh 'a <b> & '\\''c'\\''.obj' -o quads.obj")
        points, faces = read_obj("quads.obj")
        assert arrays["quads_faces"] == [v for f in faces for v in f]
        quantised(points, arrays, "quads_positions")
        points, faces = read_obj(name)
        assert arrays["input_faces"] == [v for f in faces for v in f]
        quantised(points, arrays, "input_positions")
        cones_are_those_of_the_quads(report, arrays)
        area_of_the_grid(report, arrays)
        histograms(report)
        field_follows_the_map(report, arrays)
        no_address("page.html")
        assert report["trace"] == []
        curves_of_figure_6_1(program, name)
        poles_of_height(program)
        run(program, "remesh", name, "--quads", "500", "--mode", "fast", "--report", "again.html",
            "--threads", "2")
        assert read("again.html")[1] == arrays, "depends on the number of threads"


main(os.path.abspath(sys.argv[1]))
