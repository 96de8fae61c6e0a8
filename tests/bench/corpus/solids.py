"""Solids with exact creases, as a CAD system makes them: extruded polygons with holes, turned profiles, unions of
boxes. Faces are few and long; `edit.refined` gives them the wanted size."""
import numpy as np

from mesh import compact


def cross(a, b, c):
    return (b[..., 0] - a[..., 0]) * (c[..., 1] - a[..., 1]) - (b[..., 1] - a[..., 1]) * (c[..., 0] - a[..., 0])


def star(rng, corners, radius, centre=(0.0, 0.0), depth=0.5):
    """A polygon, counter-clockwise, which the centre sees as a whole."""
    angle = 2 * np.pi * (np.arange(corners) + 0.6 * rng.random_sample(corners)) / corners
    r = radius * (1 - depth * rng.random_sample(corners))
    return np.stack([centre[0] + r * np.cos(angle), centre[1] + r * np.sin(angle)], axis=1)


def crosses(p, a, b, start, end):
    """Whether segments a b cross segments start end, ends which are the same vertex apart."""
    s, e = p[start], p[end]
    apart = (start != a) & (start != b) & (end != a) & (end != b)
    return (apart & (cross(p[a], p[b], s) * cross(p[a], p[b], e) <= 0) &
            (cross(s, e, p[a]) * cross(s, e, p[b]) <= 0)).any()


def triangulate(loops):
    """Triangles of the polygon loops[0] with the holes loops[1:], all counter-clockwise: each hole is joined
    by a bridge to the nearest vertex which it sees, and ears are cut off."""
    p = np.vstack(loops)
    first = np.cumsum([0] + [len(loop) for loop in loops])
    rings = [list(range(first[k], first[k + 1])) for k in range(len(loops))]
    start = np.concatenate([np.array(r) for r in rings])
    end = np.concatenate([np.roll(r, -1) for r in rings])
    ring, rest = rings[0], [r[::-1] for r in rings[1:]]
    while rest:
        pairs = sorted((float(((p[a] - p[b]) ** 2).sum()), i, k, j) for i, a in enumerate(ring)
                       for k, hole in enumerate(rest) for j, b in enumerate(hole))
        _, i, k, j = next(x for x in pairs if not crosses(p, ring[x[1]], rest[x[2]][x[3]], start, end))
        hole = rest.pop(k)
        start, end = np.append(start, ring[i]), np.append(end, hole[j])
        ring = ring[:i + 1] + hole[j:] + hole[:j + 1] + ring[i:]
    triangles = []
    while len(ring) > 3:
        index = np.array(ring)
        a, b, c = np.roll(index, 1), index, np.roll(index, -1)
        area = cross(p[a], p[b], p[c])
        size = ((p[a] - p[c]) ** 2).sum(axis=1)
        for i in np.lexsort((np.arange(len(ring)), size)):
            if area[i] <= 1e-12 * size[i]:
                continue
            q = p[[v for v in set(ring) if v not in (a[i], b[i], c[i])]]
            corner = p[a[i]], p[b[i]], p[c[i]]
            if not ((cross(corner[0], corner[1], q) >= 0) & (cross(corner[1], corner[2], q) >= 0) &
                    (cross(corner[2], corner[0], q) >= 0)).any():
                break
        else:
            raise ValueError("no ear")
        triangles.append([a[i], b[i], c[i]])
        del ring[i]
    return p, np.array(triangles + [ring])


def extrude(loops, height, twist=0.0, taper=1.0, layers=1):
    """The polygon with holes as bottom and top, walls between."""
    p, flat = triangulate(loops)
    n, rows = len(p), []
    for k in range(layers + 1):
        t = k / layers
        c, s, r = np.cos(twist * t), np.sin(twist * t), 1 + (taper - 1) * t
        rows.append(np.stack([r * (c * p[:, 0] - s * p[:, 1]), r * (s * p[:, 0] + c * p[:, 1]),
                              np.full(n, height * t)], axis=1))
    faces, first = [flat[:, ::-1], flat + layers * n], 0
    for number, loop in enumerate(loops):
        a = first + np.arange(len(loop))
        b = first + np.roll(np.arange(len(loop)), -1)
        if number:
            a, b = b, a
        for k in range(layers):
            faces += [np.stack([a, b, b + n], axis=1) + k * n, np.stack([a, b + n, a + n], axis=1) + k * n]
        first += len(loop)
    return np.vstack(rows), np.vstack(faces)


def turned(profile, segments):
    """A closed profile of points (r, z), counter-clockwise, around the axis; its points at r = 0 become poles."""
    n = len(profile)
    angle = 2 * np.pi * np.arange(segments) / segments
    r, z = profile[:, :1], profile[:, 1:]
    points = np.stack([r * np.cos(angle), r * np.sin(angle), z + 0 * angle], axis=2).reshape(-1, 3)
    number = np.arange(n * segments).reshape(n, segments)
    number[profile[:, 0] == 0] = number[profile[:, 0] == 0, :1]
    a, b = number, np.roll(number, -1, axis=1)
    c, d = np.roll(b, -1, axis=0), np.roll(a, -1, axis=0)
    faces = np.vstack([np.stack(x, axis=2).reshape(-1, 3) for x in ((a, b, c), (a, c, d))])
    return compact(points, faces[(faces != np.roll(faces, 1, axis=1)).all(axis=1)])


def boxes(solid, axes):
    """The border of the filled cells of a grid whose planes stand at the given coordinates."""
    filled = np.pad(solid, 1)
    size = np.array(solid.shape) + 1
    faces = []
    for axis in range(3):
        u, v = (axis + 1) % 3, (axis + 2) % 3
        for side in (0, 1):
            here = filled & ~np.roll(filled, -1 if side else 1, axis=axis)
            cell = np.argwhere(here) - 1
            corner = [cell.copy() for _ in range(4)]
            for k, (du, dv) in enumerate(((0, 0), (1, 0), (1, 1), (0, 1))):
                corner[k][:, axis] += side
                corner[k][:, u] += du
                corner[k][:, v] += dv
            number = [(x * [size[1] * size[2], size[2], 1]).sum(axis=1) for x in corner]
            a, b, c, d = number if side else number[::-1]
            faces += [np.stack([a, b, c], axis=1), np.stack([a, c, d], axis=1)]
    grid = np.stack(np.meshgrid(*axes, indexing="ij"), axis=-1).reshape(-1, 3)
    return compact(grid, np.vstack(faces))
