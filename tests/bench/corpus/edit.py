"""Flips, splits and collapses. A mesh is a dict from directed edges to the third vertex of their face, so that
every step is a few look-ups; the order of the dict is that of the changes, hence the same for the same seed."""
import numpy as np


class Editor:
    def __init__(self, points, faces):
        self.point = [tuple(p) for p in points.tolist()]
        self.apex = {}
        for a, b, c in faces.tolist():
            self.add(a, b, c)

    def add(self, a, b, c):
        self.apex[a, b], self.apex[b, c], self.apex[c, a] = c, a, b

    def remove(self, a, b, c):
        del self.apex[a, b], self.apex[b, c], self.apex[c, a]

    def result(self):
        used, faces = {}, []
        for (a, b), c in self.apex.items():
            if a < b and a < c:
                faces.append([used.setdefault(v, len(used)) for v in (a, b, c)])
        return np.array([self.point[v] for v in used]), np.array(faces)

    def count(self):
        return len(self.apex) // 3

    def edges(self):
        return [(a, b) for a, b in self.apex if a < b or (b, a) not in self.apex]

    def length(self, a, b):
        return sum((x - y) ** 2 for x, y in zip(self.point[a], self.point[b])) ** 0.5

    def normal(self, a, b, c):
        (ax, ay, az), p, q = self.point[a], self.point[b], self.point[c]
        ux, uy, uz, vx, vy, vz = p[0] - ax, p[1] - ay, p[2] - az, q[0] - ax, q[1] - ay, q[2] - az
        return uy * vz - uz * vy, uz * vx - ux * vz, ux * vy - uy * vx

    def quality(self, a, b, c):
        """Twice the area over the squared longest edge; at most 0.87."""
        n = self.normal(a, b, c)
        longest = max(self.length(a, b), self.length(b, c), self.length(c, a))
        return (n[0] ** 2 + n[1] ** 2 + n[2] ** 2) ** 0.5 / max(longest ** 2, 1e-300)

    def cosine(self, f, g):
        """Between the normals of two faces."""
        m, n = self.normal(*f), self.normal(*g)
        size = (sum(x * x for x in m) * sum(x * x for x in n)) ** 0.5
        return sum(x * y for x, y in zip(m, n)) / max(size, 1e-300)

    def flip(self, a, b, flat=-2.0):
        """Only where the faces enclose an angle of cosine at least `flat`, before and after."""
        c, d = self.apex.get((a, b)), self.apex.get((b, a))
        if c is None or d is None or c == d or (c, d) in self.apex or (d, c) in self.apex:
            return False
        if flat > -1 and (self.cosine((a, b, c), (b, a, d)) < flat or self.cosine((a, d, c), (d, b, c)) < flat or
                          self.cosine((a, b, c), (a, d, c)) < flat):
            return False
        self.remove(a, b, c)
        self.remove(b, a, d)
        self.add(a, d, c)
        self.add(d, b, c)
        return True

    def split(self, a, b, t=0.5):
        """A new vertex at a + t (b - a)."""
        v = len(self.point)
        self.point.append(tuple((1 - t) * x + t * y for x, y in zip(self.point[a], self.point[b])))
        for s, e in ((a, b), (b, a)):
            c = self.apex.get((s, e))
            if c is not None:
                self.remove(s, e, c)
                self.add(s, v, c)
                self.add(v, e, c)
        return v

    def split_face(self, a, b, c, weights):
        v = len(self.point)
        self.point.append(tuple(sum(w * x for w, x in zip(weights, column))
                                for column in zip(self.point[a], self.point[b], self.point[c])))
        self.remove(a, b, c)
        for s, e in ((a, b), (b, c), (c, a)):
            self.add(s, e, v)
        return v

    def ring(self, a, some):
        """Vertices around a, from an edge (a, some) on; None at the boundary."""
        ring, b = [], some
        while True:
            ring.append(b)
            b = self.apex.get((a, b))
            if b is None or len(ring) > 1000:
                return None
            if b == some:
                return ring

    def collapse(self, a, b, flat=0.2, least=0.0, longest=1e300):
        """a moves to b. Not at the boundary, where the link condition fails, where normals would turn by
        more than arccos(flat), or where faces worse than `least` or edges above `longest` would be made."""
        ring, other = self.ring(a, b), self.ring(b, a) if (b, a) in self.apex else None
        if ring is None or other is None or len(ring) < 4 or len(set(ring) & set(other)) != 2:
            return False
        if min(len(self.ring(v, a) or range(9)) for v in (self.apex[a, b], self.apex[b, a])) < 4:
            return False
        old = [(a, ring[k - 1], ring[k]) for k in range(len(ring))]
        new = [(b, x, y) for _, x, y in old if b not in (x, y)]
        for _, x, y in old:
            if b not in (x, y) and (self.cosine((a, x, y), (b, x, y)) < flat or self.quality(b, x, y) < least):
                return False
        if max(self.length(b, v) for v in ring if v != b) > longest:
            return False
        for f in old:
            self.remove(*f)
        for f in new:
            self.add(*f)
        return True


def refined(points, faces, length, flat=0.999):
    """Longest edges first halved until none is longer; then flat pairs of faces flipped for better shape."""
    e = Editor(points, faces)
    while True:
        long_ones = [(e.length(a, b), a, b) for a, b in e.edges()]
        long_ones = sorted((x for x in long_ones if x[0] > length), reverse=True)
        if not long_ones:
            break
        for size, a, b in long_ones:
            if size > 0.7 * long_ones[0][0] and (a, b) in e.apex:
                e.split(a, b)
    improve(e, flat)
    return e.result()


def improve(e, flat, rounds=4):
    for _ in range(rounds):
        for a, b in e.edges():
            c, d = e.apex.get((a, b)), e.apex.get((b, a))
            if c is None or d is None:
                continue
            before = min(e.quality(a, b, c), e.quality(b, a, d))
            if min(e.quality(a, d, c), e.quality(d, b, c)) > before:
                e.flip(a, b, flat)


def decimated(points, faces, count, least=0.1):
    """Short edges collapsed until `count` faces are left, where the shape allows."""
    e = Editor(points, faces)
    length = 0.0
    for _ in range(12):
        shortest = sorted((e.length(a, b), a, b) for a, b in e.edges())
        length = max(length, shortest[len(shortest) // 4][0])
        for size, a, b in shortest:
            if e.count() <= count or size > length:
                break
            if (a, b) in e.apex and (b, a) in e.apex:
                e.collapse(a, b, 0.7, least, 4 * length)
        if e.count() <= count:
            break
        length *= 1.2
    improve(e, 0.7)
    return e.result()
