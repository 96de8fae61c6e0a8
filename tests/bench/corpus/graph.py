"""Random connected graphs with a given number of independent cycles, on the points of a lattice."""
import numpy as np


def lattice(genus, rng):
    """Sides of a box of points which has enough edges, with some to spare."""
    while True:
        side = rng.randint(2, 6, 3)
        if side.prod() > 4 * genus + 30:
            continue
        if cycles(side) >= 1.2 * genus:
            return side


def cycles(side):
    n = side.prod()
    return sum(n // s * (s - 1) for s in side) - n + 1


def random_graph(genus, rng):
    """Points (integers) and edges; the border of their thickening has this genus."""
    side = lattice(genus, rng)
    points = np.stack(np.meshgrid(*[np.arange(s) for s in side], indexing="ij"), axis=-1).reshape(-1, 3)
    number = {tuple(p): k for k, p in enumerate(points.tolist())}
    edges = [(k, number[tuple(p + step)]) for k, p in enumerate(points) for step in np.eye(3, dtype=int)
             if tuple(p + step) in number]
    edges = [edges[k] for k in rng.permutation(len(edges))]
    parent = list(range(len(points)))

    def root(k):
        while parent[k] != k:
            k = parent[k]
        return k
    tree, rest = [], []
    for a, b in edges:
        if root(a) != root(b):
            parent[root(a)] = root(b)
            tree.append((a, b))
        else:
            rest.append((a, b))
    kept = tree + rest[:genus]
    while True:                                   # leaves add nothing to the genus
        degree = np.bincount(np.array(kept).ravel(), minlength=len(points))
        without = [(a, b) for a, b in kept if degree[a] > 1 and degree[b] > 1]
        if len(without) == len(kept) or not without:
            return points, kept
        kept = without
