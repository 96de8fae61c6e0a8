"""The nine classes of the corpus. A maker takes a random state and the number of the model within its class, and
returns points and faces; it may raise ValueError for an unlucky draw, and is called again with the next one."""
import numpy as np

import edit
import functions as fn
import graph
import solids
from implicit import surface
from mesh import compact, face_normals, join, labels, mean_edge, topology, vertex_normals


def largest_part(points, faces):
    tail, head = faces.ravel(), np.roll(faces, -1, axis=1).ravel()
    part = labels(len(points), np.stack([tail, head], axis=1))[faces[:, 0]]
    return compact(points, faces[part == np.bincount(part).argmax()])


def lump(rng, cells, **options):
    """A smooth closed surface: a lump, a knotted tube or a torus."""
    kind = rng.randint(5)
    f = fn.blob(rng, rng.randint(2, 9)) if kind < 3 else fn.knotted(rng) if kind == 3 else fn.ring(0.8, 0.3)
    return largest_part(*surface(f, [-1.35] * 3, [1.35] * 3, cells, **options))


def csg(rng, number):
    cells = rng.randint(15, 27) if number % 8 else 34
    points, faces = surface(fn.solid(rng, rng.randint(2, 8)), [-1.7] * 3, [1.7] * 3, cells, sharp=True)
    return largest_part(points, faces)


def polygon_with_holes(rng, holes):
    """A star with round holes on a jittered lattice inside; holes is how many, if they fit."""
    side = int(np.ceil(np.sqrt(max(holes, 1))))
    pitch = 1.2 / side
    places = [(i, j) for i in range(side) for j in range(side)]
    loops = [solids.star(rng, rng.randint(8, 24), 1.6, depth=0.2)]
    for k in rng.permutation(len(places))[:holes]:
        centre = (np.array(places[k]) - (side - 1) / 2 + 0.15 * rng.uniform(-1, 1, 2)) * pitch
        loops.append(solids.star(rng, rng.randint(5, 13), pitch * rng.uniform(0.2, 0.33), centre, 0.3))
    return loops


def box_union(rng):
    axes = [np.cumsum(rng.uniform(0.1, 0.5, 9)) for _ in range(3)]
    cells = np.zeros((8, 8, 8), dtype=bool)
    for k in range(rng.randint(3, 9)):
        low = rng.randint(0, 6, 3)
        high = low + rng.randint(2, 6, 3)
        cells[tuple(slice(a, b) for a, b in zip(low, high))] = k < 2 or rng.rand() < 0.7
    points, faces = solids.boxes(cells, axes)
    topology(points, faces)
    return largest_part(points, faces)


def profile(rng):
    """Of a turned part: a polyline from the axis to the axis, or a closed one beside it."""
    if rng.rand() < 0.4:
        p = solids.star(rng, rng.randint(5, 12), 0.6, (1.0, 0.0))
        return p
    z = np.sort(rng.uniform(-1, 1, rng.randint(2, 7)))
    r = rng.uniform(0.2, 0.8, len(z))
    steps = np.array([[r[k], z[j]] for k in range(len(z)) for j in (k, k + 1) if j < len(z)])
    return np.vstack([[[0, z[0]]], steps, [[0, z[-1]]]])


def tessellation(rng, number):
    """A solid with exact creases as it comes from CAD."""
    kind = number % 4
    if kind == 0:
        return solids.extrude(polygon_with_holes(rng, rng.randint(0, 7)), rng.uniform(0.1, 1.5))
    if kind == 1:
        return solids.turned(profile(rng), rng.randint(12, 48))
    if kind == 2:
        return box_union(rng)
    return solids.extrude([solids.star(rng, rng.randint(3, 12), 1.0)], rng.uniform(0.5, 3), rng.uniform(-2, 2),
                          rng.uniform(0.4, 1.2), rng.randint(4, 20))


def sized(points, faces, count):
    """Refined to roughly as many faces."""
    area = np.linalg.norm(face_normals(points, faces), axis=1).sum() / 2
    return edit.refined(points, faces, 2.4 * np.sqrt(area / count))


def cad(rng, number):
    return sized(*tessellation(rng, number), rng.randint(1000, 6000) if number % 10 else 16000)


def noisy(rng, number):
    points, faces = lump(rng, rng.randint(16, 30)) if number % 3 else cad(rng, number // 3)
    amplitude = mean_edge(points, faces) * rng.choice([0.02, 0.05, 0.1, 0.2, 0.3])
    if number % 2:
        return points + amplitude * rng.standard_normal(points.shape), faces
    return points + amplitude * rng.standard_normal((len(points), 1)) * vertex_normals(points, faces), faces


def random_edits(e, rng, count, flips, splits, collapses):
    """Edges at random, each flipped, split or collapsed by the given chances."""
    edges = e.edges()
    for _ in range(count):
        a, b = edges[rng.randint(len(edges))]
        if (a, b) not in e.apex or (b, a) not in e.apex:
            continue
        x = rng.rand() * (flips + splits + collapses)
        if x < flips:
            e.flip(a, b, 0.3)
        elif x < flips + splits:
            e.split(a, b, rng.uniform(0.2, 0.8))
        else:
            e.collapse(a, b, 0.5)


def graded(e, rng, ratio):
    """Edges halved until they are no longer than the distance from one of a few points allows."""
    centre = np.array(e.point)[rng.randint(len(e.point), size=2)]
    longest = max(e.length(a, b) for a, b in e.edges())
    while e.count() < 6000:
        some = []
        for a, b in e.edges():
            far = np.linalg.norm(centre - e.point[a], axis=1).min()
            if e.length(a, b) > max(longest / ratio, 0.3 * far):
                some.append((a, b))
        if not some:
            return
        for a, b in some:
            if (a, b) in e.apex:
                e.split(a, b)
        edit.improve(e, 0.95, 1)


def remeshed(rng, number):
    points, faces = lump(rng, rng.randint(14, 26)) if number % 2 else cad(rng, number // 2)
    e = edit.Editor(points, faces)
    kind = number // 2 % 5
    if kind == 0:
        random_edits(e, rng, 2 * e.count(), 1, 0, 0)
    elif kind == 1:
        random_edits(e, rng, e.count(), 1, 2, 1)
    elif kind == 2:
        random_edits(e, rng, 2 * e.count(), 1, 1, 3)
    elif kind == 3:
        graded(e, rng, rng.choice([30, 100, 1000]))
    else:
        return edit.decimated(points, faces, rng.randint(300, 1500), 0.02)
    return e.result()


def slivers(rng, number):
    kind = number % 6
    if kind == 0:
        return lump(rng, rng.randint(14, 24), margin=0.0)
    if kind == 1:
        return tessellation(rng, number // 6)
    if kind == 2:                                 # a turned surface with far more points one way than the other
        t = np.linspace(0, np.pi, rng.randint(60, 300))
        outline = np.stack([(0.6 + 0.3 * np.sin(3 * t)) * np.sin(t), -np.cos(t)], axis=1)
        outline[[0, -1], 0] = 0
        return solids.turned(outline, rng.randint(6, 16))
    points, faces = lump(rng, rng.randint(12, 20)) if number % 12 < 6 else cad(rng, number // 12)
    if kind == 3:
        return points * [1, rng.choice([0.3, 1]), rng.choice([0.02, 0.05, 0.1])], faces
    e = edit.Editor(points, faces)
    thin = rng.choice([1e-1, 1e-2, 1e-4])
    if kind == 4:                                 # needles: vertices next to others
        for a, b in e.edges():
            if rng.rand() < 0.2 and (a, b) in e.apex:
                e.split(a, b, thin)
    else:                                         # caps: vertices next to edges
        for a, b in e.edges():
            if rng.rand() < 0.2 and (a, b) in e.apex:
                e.split_face(a, b, e.apex[a, b], (0.5 - thin / 2, 0.5 - thin / 2, thin))
    return e.result()


def beams(points, edges, rng):
    """The graph as a lattice of beams with square sections."""
    cells = np.zeros(2 * points.max(axis=0) + 1, dtype=bool)
    cells[tuple(2 * points[np.unique(edges)].T)] = True
    for a, b in edges:
        cells[tuple(points[a] + points[b])] = True
    axes = [np.cumsum(np.append(0, np.where(np.arange(n) % 2, rng.uniform(0.8, 1.6), 0.6))) for n in cells.shape]
    return solids.boxes(cells, axes)


def tubes(points, edges, rng):
    """The graph as a union of round tubes, decimated."""
    p = points + 0.15 * rng.uniform(-1, 1, points.shape)
    parts = [fn.segment(p[a], p[b], rng.uniform(0.17, 0.24)) for a, b in edges]
    low, high = p.min(axis=0) - 0.4, p.max(axis=0) + 0.4
    return surface(fn.union(*parts), low, high, 9 * (high - low).max(), rounds=1)


def genus(rng, number):
    """A surface of this genus."""
    g, kind = number, number % 3
    if kind == 0:
        points, faces = tubes(*graph.random_graph(g, rng), rng)
        points, faces = edit.decimated(points, faces, min(len(faces), 1500 + 130 * g))
    elif kind == 1:
        points, faces = solids.extrude(polygon_with_holes(rng, g), rng.uniform(0.1, 0.4))
        points, faces = sized(points, faces, 1500 + 60 * g)
    else:
        points, faces = beams(*graph.random_graph(g, rng), rng)
        points, faces = sized(points, faces, 1500 + 100 * g)
    found = topology(points, faces)
    if found["euler"] != 2 - 2 * g or found["components"] != 1:
        raise ValueError(f"genus {1 - found['euler'] / 2}")
    return points, faces


def height_field(rng, loops, count):
    points, faces = sized(*[np.column_stack([p, np.zeros(len(p))]) if k == 0 else p
                            for k, p in enumerate(solids.triangulate(loops))], count)
    for _ in range(rng.randint(0, 6)):
        wave = rng.uniform(-3, 3, 2)
        points[:, 2] += rng.uniform(0, 0.15) * np.sin(points[:, :2] @ wave + rng.uniform(0, 6))
    return points, faces


def opened(rng, number):
    kind = number % 3
    if kind == 0:
        points, faces = height_field(rng, polygon_with_holes(rng, rng.randint(0, 10)), rng.randint(1000, 6000))
    elif kind == 1:                               # a closed surface without some balls: frayed boundaries
        points, faces = lump(rng, rng.randint(16, 26)) if rng.rand() < 0.6 else cad(rng, number)
        centre = points[faces].mean(axis=1)
        for _ in range(rng.randint(1, 8)):
            hole = points[rng.randint(len(points))]
            outside = np.linalg.norm(centre - hole, axis=1) > rng.uniform(0.05, 0.4)
            faces, centre = faces[outside], centre[outside]
        points, faces = largest_part(*compact(points, faces))
    else:                                         # bent strips: pipes, ribbons, helicoids
        u = np.linspace(0, 1, rng.randint(40, 120))[:, None]
        v = np.linspace(-1, 1, rng.randint(8, 30))[None, :]
        turn, width = rng.uniform(1, 9), rng.uniform(0.05, 0.5)
        a = turn * u
        points = np.stack([(1 + width * v * np.cos(a / 2)) * np.cos(a), (1 + width * v * np.cos(a / 2)) * np.sin(a),
                           width * v * np.sin(a / 2) + 0.4 * a], axis=2).reshape(-1, 3)
        i = np.arange(u.size * v.size).reshape(u.size, v.size)
        a, b, c, d = i[:-1, :-1], i[1:, :-1], i[1:, 1:], i[:-1, 1:]
        faces = np.vstack([np.stack(x, axis=2).reshape(-1, 3) for x in ((a, b, c), (a, c, d))])
    topology(points, faces)
    return points, faces


def parts(rng, number):
    """Up to twelve components of several sizes, side by side or one in another."""
    made = []
    for k in range(rng.randint(2, 13)):
        points, faces = lump(rng, rng.randint(9, 16)) if rng.rand() < 0.6 else sized(*tessellation(rng, k), 800)
        if number % 2:
            made.append((points * 0.8 ** k, faces))
        else:
            made.append((points * rng.choice([0.1, 0.5, 1]) + [4 * (k % 4), 4 * (k // 4), 0], faces))
    return join(made)


def needle(rng, number):
    """Boundaries with long narrow teeth, thin wedges, spikes."""
    kind = number % 3
    if kind == 0:
        corners = 2 * rng.randint(8, 40)
        loop = solids.star(rng, corners, 1.0, depth=0.1)
        loop[::2] *= rng.uniform(0.2, 0.6)
        return height_field(rng, [loop], rng.randint(1000, 4000))
    if kind == 1:
        loop = np.array([[0, 0], [2, 0], [rng.uniform(0.1, 1.9), rng.choice([0.01, 0.03, 0.1])]])
        return sized(*solids.extrude([loop], rng.uniform(0.2, 1)), rng.randint(1500, 4000))
    points, faces = lump(rng, rng.randint(14, 22))
    normal, height = vertex_normals(points, faces), rng.uniform(0.2, 1.0)
    for v in rng.permutation(len(points))[:rng.randint(5, 60)]:
        points[v] += height * normal[v]
    return points, faces


CLASSES = [("csg", csg, 40), ("cad", cad, 40), ("noisy", noisy, 40), ("remeshed", remeshed, 40),
           ("slivers", slivers, 40), ("genus", genus, 50), ("open", opened, 30), ("parts", parts, 10),
           ("needle", needle, 10)]
