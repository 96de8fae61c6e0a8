"""Functions whose zero sets bound solids, negative inside, and random choices of them."""
import numpy as np


def rotation(rng):
    q, r = np.linalg.qr(rng.standard_normal((3, 3)))
    q = q * np.sign(np.diag(r))
    return q if np.linalg.det(q) > 0 else -q


def ball(centre, radius):
    return lambda p: np.linalg.norm(p - centre, axis=1) - radius


def box(centre, half, turn):
    def f(p):
        d = np.abs((p - centre) @ turn) - half
        return np.linalg.norm(np.maximum(d, 0), axis=1) + np.minimum(d.max(axis=1), 0)
    return f


def cylinder(centre, radius, half, turn):
    def f(p):
        q = (p - centre) @ turn
        d = np.stack([np.hypot(q[:, 0], q[:, 1]) - radius, np.abs(q[:, 2]) - half], axis=1)
        return np.linalg.norm(np.maximum(d, 0), axis=1) + np.minimum(d.max(axis=1), 0)
    return f


def segment(a, b, radius):
    """All within the radius of a segment."""
    d = b - a

    def f(p):
        t = np.clip(((p - a) @ d) / max(float(d @ d), 1e-30), 0, 1)
        return np.linalg.norm(p - a - t[:, None] * d, axis=1) - radius
    return f


def ring(radius, tube):
    return lambda p: np.hypot(np.hypot(p[:, 0], p[:, 1]) - radius, p[:, 2]) - tube


def union(*fs):
    return lambda p: np.min([f(p) for f in fs], axis=0)


def difference(f, g):
    return lambda p: np.maximum(f(p), -g(p))


def intersection(f, g):
    return lambda p: np.maximum(f(p), g(p))


def melted(fs, width):
    """Smooth union."""
    return lambda p: -width * np.log(np.exp(-np.array([f(p) for f in fs]) / width).sum(axis=0))


def primitive(rng, spread):
    centre, turn = spread * rng.uniform(-1, 1, 3), rotation(rng) if rng.rand() < 0.5 else np.eye(3)
    kind = rng.randint(3)
    if kind == 0:
        return ball(centre, rng.uniform(0.3, 0.6))
    if kind == 1:
        return box(centre, rng.uniform(0.2, 0.7, 3), turn)
    return cylinder(centre, rng.uniform(0.15, 0.45), rng.uniform(0.4, 1.2), turn)


def solid(rng, steps):
    """Unions and differences of random primitives, the first one large; inside a ball of radius 1.6."""
    f = box(np.zeros(3), rng.uniform(0.5, 0.9, 3), np.eye(3)) if rng.rand() < 0.7 else ball(np.zeros(3), 0.8)
    for _ in range(steps):
        f = (union if rng.rand() < 0.4 else difference)(f, primitive(rng, 0.8))
    return intersection(f, ball(np.zeros(3), 1.6))


def blob(rng, count):
    """A smooth connected lump: each ball next to one before."""
    centre, radius = [np.zeros(3)], [0.5]
    while len(centre) < count:
        k, way, r = rng.randint(len(centre)), rng.standard_normal(3), rng.uniform(0.2, 0.5)
        centre.append(centre[k] + way / np.linalg.norm(way) * (radius[k] + 0.5 * r))
        radius.append(r)
    reach = max(np.linalg.norm(c) + r for c, r in zip(centre, radius))
    return melted([ball(c / reach, r / reach) for c, r in zip(centre, radius)], 0.05 * rng.uniform(0.5, 2))


def knotted(rng):
    """A tube round a torus knot or a wavy ring."""
    p, q = ((2, 3), (2, 5), (3, 2), (1, 4), (1, 7))[rng.randint(5)]
    t = 2 * np.pi * np.arange(60) / 60
    r = 0.75 + 0.3 * np.cos(q * t)
    line = np.stack([r * np.cos(p * t), r * np.sin(p * t), 0.3 * np.sin(q * t)], axis=1)
    tubes = [segment(a, b, 0.09 + 0.05 * rng.rand()) for a, b in zip(line, np.roll(line, -1, axis=0))]
    return union(*tubes)
