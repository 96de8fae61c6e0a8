"""Surfaces f = 0 of functions on a lattice: marching tetrahedra over Kuhn's six tetrahedra of a cube, whose faces
match those of the next cube, so that the result is a closed manifold wherever f > 0 on the border of the box."""
import itertools

import numpy as np

from mesh import compact, face_normals, neighbour_means


def tetrahedra():
    """The six, as corners of the unit cube, positively oriented."""
    found = []
    for order in itertools.permutations(range(3)):
        corner = [np.zeros(3, dtype=np.int64)]
        for axis in order:
            corner.append(corner[-1] + np.eye(3, dtype=np.int64)[axis])
        if np.linalg.det(np.array(corner[1:]) - corner[0]) < 0:
            corner[2], corner[3] = corner[3], corner[2]
        found.append(np.array(corner))
    return found


def cases():
    """For each set of inside corners of a positive tetrahedron, triangles of edges (inside, outside)."""
    corner = np.array([[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1]], dtype=float)
    table = []
    for mask in range(16):
        inside = [k for k in range(4) if mask >> k & 1]
        outside = [k for k in range(4) if not mask >> k & 1]
        if len(inside) == 2:
            (a, b), (c, d) = inside, outside
            triangles = [[(a, c), (a, d), (b, d)], [(a, c), (b, d), (b, c)]]
        elif len(inside) in (1, 3):
            triangles = [[(i, o) for i in inside for o in outside]]
        else:
            triangles = []
        for k, triangle in enumerate(triangles):
            p = [(corner[i] + corner[o]) / 2 for i, o in triangle]
            out = corner[outside].mean(axis=0) - corner[inside].mean(axis=0)
            if np.dot(np.cross(p[1] - p[0], p[2] - p[0]), out) < 0:
                triangles[k] = triangle[::-1]
        table.append(triangles)
    return table


def polygonise(f, low, high, cells, margin=0.15):
    """The surface f = 0 in the box, at about `cells` cubes along its longest side. Vertices keep `margin` of
    the edge from its ends; 0 leaves the slivers which marching tetrahedra are known for."""
    low, high = np.array(low, dtype=float), np.array(high, dtype=float)
    step = (high - low).max() / cells
    size = np.ceil((high - low) / step).astype(int) + 1
    grid = np.stack(np.meshgrid(*[np.arange(s) for s in size], indexing="ij"), axis=-1).reshape(-1, 3)
    place = low + step * grid
    value = f(place)
    if (value.reshape(size)[[0, -1]] <= 0).any():
        raise ValueError("the surface leaves its box")
    stride = np.array([size[1] * size[2], size[2], 1])
    cube = (grid[(grid < size - 1).all(axis=1)] * stride).sum(axis=1)
    keys, table, n = [], cases(), len(grid)
    for tetrahedron in tetrahedra():
        corner = cube[:, None] + (tetrahedron * stride).sum(axis=1)
        mask = ((value[corner] < 0) << np.arange(4)).sum(axis=1)
        for m in range(1, 15):
            some = corner[mask == m]
            for triangle in table[m]:
                keys.append(np.stack([some[:, i] * n + some[:, o] for i, o in triangle], axis=1))
    edges, faces = np.unique(np.vstack(keys), return_inverse=True)
    inside, outside = edges // n, edges % n
    t = value[inside] / (value[inside] - value[outside])
    t = np.clip(t, max(margin, 1e-3), 1 - max(margin, 1e-3))[:, None]
    return place[inside] * (1 - t) + place[outside] * t, faces.reshape(-1, 3), step


def gradient(f, p, step):
    g = np.empty_like(p)
    for k in range(3):
        d = np.zeros(3)
        d[k] = 1e-4 * step
        g[:, k] = (f(p + d) - f(p - d)) / (2e-4 * step)
    return g


def project(f, p, step, rounds=2):
    """Newton steps along the gradient, none longer than half a cell."""
    for _ in range(rounds):
        g = gradient(f, p, step)
        move = f(p)[:, None] * g / np.maximum((g * g).sum(axis=1, keepdims=True), 1e-12)
        length = np.linalg.norm(move, axis=1, keepdims=True)
        p = p - move * np.minimum(1, 0.5 * step / np.maximum(length, 1e-300))
    return p


def keep_good(points, moved, faces, least=0.05):
    """The moved points, but the former ones at faces which would turn over or lose their shape."""
    normal = face_normals(points, faces)
    free = np.ones(len(points), dtype=bool)
    for _ in range(20):
        now = np.where(free[:, None], moved, points)
        turned = face_normals(now, faces)
        longest = ((now[faces] - now[np.roll(faces, -1, axis=1)]) ** 2).sum(axis=2).max(axis=1)
        bad = (np.einsum("ij,ij->i", normal, turned) <= 0) | (np.linalg.norm(turned, axis=1) < least * longest)
        bad &= free[faces].any(axis=1)
        if not bad.any():
            break
        free[faces[bad].ravel()] = False
    return np.where(free[:, None], moved, points)


def relax(f, points, faces, step, rounds=3):
    """Vertices towards the means of their neighbours, kept on the surface."""
    for _ in range(rounds):
        points = keep_good(points, project(f, (points + neighbour_means(points, faces)) / 2, step), faces)
    return points


def sharpen(f, points, faces, step, rounds=3):
    """Creases which marching tetrahedra cut off: each vertex to the least squares of the tangent planes at
    the faces around it (Ohtake and Belyaev 2002, dual/primal mesh optimization)."""
    for _ in range(rounds):
        centre = project(f, points[faces].mean(axis=1), step, 3)
        normal = gradient(f, centre, step)
        normal /= np.maximum(np.linalg.norm(normal, axis=1, keepdims=True), 1e-12)
        matrix, right = np.zeros((len(points), 3, 3)), np.zeros((len(points), 3))
        for k in range(3):
            v = faces[:, k]
            height = ((centre - points[v]) * normal).sum(axis=1)
            np.add.at(matrix, v, normal[:, :, None] * normal[:, None, :])
            np.add.at(right, v, normal * height[:, None])
        size, axes = np.linalg.eigh(matrix)
        along = np.einsum("vij,vi->vj", axes, right)
        kept = size > 0.1 * size[:, 2:]
        move = np.einsum("vij,vj->vi", axes, np.where(kept, along / np.where(kept, size, 1), 0))
        length = np.linalg.norm(move, axis=1, keepdims=True)
        move *= np.minimum(1, step / np.maximum(length, 1e-300))
        points = keep_good(points, points + move, faces)
    return points


def surface(f, low, high, cells, margin=0.15, rounds=2, sharp=False):
    """A polygonised, relaxed and perhaps sharpened surface."""
    points, faces, step = polygonise(f, low, high, cells, margin)
    points, faces = compact(points, faces)
    if margin > 0:
        points = relax(f, points, faces, step, rounds)
    if sharp:
        points = sharpen(f, points, faces, step)
    return points, faces
