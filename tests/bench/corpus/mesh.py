"""Triangle meshes as arrays: points n x 3, faces m x 3, counter-clockwise from outside."""
import numpy as np


def compact(points, faces):
    """Without vertices no face uses, in the order of the others."""
    used = np.unique(faces)
    number = np.full(len(points), -1, dtype=np.int64)
    number[used] = np.arange(len(used))
    return points[used], number[faces]


def join(meshes):
    """One mesh of several, vertices and faces in their order."""
    start = np.cumsum([0] + [len(p) for p, _ in meshes])
    return np.vstack([p for p, _ in meshes]), np.vstack([f + s for (_, f), s in zip(meshes, start)])


def labels(n, pairs):
    """The smallest element of the class of each of n elements, the pairs (k x 2) being equivalent."""
    label = np.arange(n)
    while True:
        least = np.minimum(label[pairs[:, 0]], label[pairs[:, 1]])
        before = label.copy()
        np.minimum.at(label, pairs[:, 0], least)
        np.minimum.at(label, pairs[:, 1], least)
        label = label[label]
        if (label == before).all():
            return label


def topology(points, faces):
    """Euler characteristic, components and boundary loops; ValueError unless the mesh is an oriented
    manifold without free vertices. Used beside the counts of the library, which it does not share."""
    n, m = len(points), len(faces)
    tail, head = faces.ravel(), np.roll(faces, -1, axis=1).ravel()
    key, back = tail * n + head, head * n + tail
    if (tail == head).any() or len(np.unique(key)) < len(key):
        raise ValueError("a directed edge occurs twice")
    if len(np.unique(faces)) < n:
        raise ValueError("a vertex without faces")
    order = np.argsort(key)
    place = np.minimum(np.searchsorted(key[order], back), len(key) - 1)
    twin = np.where(key[order][place] == back, order[place], -1)
    inner = np.flatnonzero(twin >= 0)
    # Corners h and next(twin(h)) lie at the same vertex: one class of corners a vertex.
    following = 3 * (twin[inner] // 3) + (twin[inner] + 1) % 3
    corners = labels(3 * m, np.stack([inner, following], axis=1))
    if len(np.unique(corners)) != n:
        raise ValueError("a vertex with several fans")
    edges = (len(key) + np.count_nonzero(twin < 0)) // 2
    parts = len(np.unique(labels(n, np.stack([tail, head], axis=1))))
    rim = np.flatnonzero(twin < 0)
    loops = len(np.unique(labels(n, np.stack([tail[rim], head[rim]], axis=1))[tail[rim]]))
    return {"faces": int(m), "euler": int(n - edges + m), "components": int(parts), "boundaries": int(loops)}


def face_normals(points, faces):
    """Cross products of the edges: twice the area long."""
    a, b, c = (points[faces[:, k]] for k in range(3))
    return np.cross(b - a, c - a)


def vertex_normals(points, faces):
    normal = np.zeros_like(points)
    across = face_normals(points, faces)
    for k in range(3):
        np.add.at(normal, faces[:, k], across)
    return normal / np.maximum(np.linalg.norm(normal, axis=1, keepdims=True), 1e-300)


def mean_edge(points, faces):
    return float(np.linalg.norm(points[faces] - points[np.roll(faces, -1, axis=1)], axis=2).mean())


def neighbour_means(points, faces):
    """Means of the neighbours of each vertex."""
    total, count = np.zeros_like(points), np.zeros(len(points))
    for k in range(3):
        for other in (1, 2):
            np.add.at(total, faces[:, k], points[faces[:, (k + other) % 3]])
            np.add.at(count, faces[:, k], 1)
    return total / count[:, None]


def write_obj(path, points, faces):
    lines = ["v %.9g %.9g %.9g" % tuple(p) for p in points.tolist()]
    lines += ["f %d %d %d" % tuple(f) for f in (faces + 1).tolist()]
    with open(path, "w") as out:
        out.write("\n".join(lines) + "\n")
