#!/usr/bin/env python3
"""render.py quads.obj out.png [--with triangles.obj] [--width N] [--turn DEG] [--tilt DEG]

Renders polygon meshes as a PNG: software rasteriser with z-buffer, supersampling, one shade a face and
dark edges. With --with, that mesh is the left panel. Standard library only."""
import argparse
import math
import struct
import zlib

SUPER = 3  # samples a pixel and direction
LIGHTS = (((-0.45, 0.75, 0.6), 0.80), ((0.8, 0.1, 0.5), 0.22), ((0.0, -1.0, 0.3), 0.10))
TRIANGLES, QUADS = ((190, 196, 205), (96, 104, 116)), ((236, 178, 92), (74, 44, 12))
BACKGROUND = (255, 255, 255)


def read_obj(path):
    points, faces = [], []
    for line in open(path):
        word = line.split()
        if word[:1] == ["v"]:
            points.append(tuple(map(float, word[1:4])))
        elif word[:1] == ["f"]:
            faces.append([int(w.split("/")[0]) - 1 for w in word[1:]])
    return points, faces


def rotation(turn, tilt):
    a, b = math.radians(turn), math.radians(tilt)
    ca, sa, cb, sb = math.cos(a), math.sin(a), math.cos(b), math.sin(b)
    return lambda p: (ca * p[0] + sa * p[1],
                      cb * (ca * p[1] - sa * p[0]) + sb * p[2],
                      cb * p[2] - sb * (ca * p[1] - sa * p[0]))


def shade(normal, depth, colour):
    length = math.sqrt(sum(x * x for x in normal)) or 1.0
    n = [x / length * (1 if normal[2] >= 0 else -1) for x in normal]
    light = 0.34
    for direction, strength in LIGHTS:
        size = math.sqrt(sum(x * x for x in direction))
        light += strength * max(0.0, sum(x * y for x, y in zip(n, direction)) / size)
    light *= 0.72 + 0.28 * depth  # far parts are darker
    return tuple(min(255, int(255 * (c / 255 * max(light, 0.0)) ** 0.85)) for c in colour)


def raster(image, size, mesh, colours, view, fit, box, line):
    """Triangle fans with the distance to the nearest polygon side, which draws the edges."""
    points, faces = mesh
    (cx, cy, scale), (near, far) = fit
    left, width, height = box
    at = [view(p) for p in points]
    screen = [(left + width / 2 + scale * (x - cx), height / 2 - scale * (y - cy), z)
              for x, y, z in at]
    pixels, depths = image
    for face in faces:
        p = [screen[v] for v in face]
        a, b, c = at[face[0]], at[face[1]], at[face[2]]
        d = at[face[3]] if len(face) > 3 else at[face[0]]
        u, w = [c[i] - a[i] for i in range(3)], [d[i] - b[i] for i in range(3)]
        normal = (u[1] * w[2] - u[2] * w[1], u[2] * w[0] - u[0] * w[2], u[0] * w[1] - u[1] * w[0])
        middle = sum(q[2] for q in p) / len(p)
        fill = shade(normal, (middle - far) / (near - far), colours[0])
        edge = tuple(int(0.75 * e + 0.25 * f) for e, f in zip(colours[1], fill))
        sides = []
        for i, q in enumerate(p):
            r = p[(i + 1) % len(p)]
            length = math.hypot(r[0] - q[0], r[1] - q[1]) or 1.0
            sides.append((q[0], q[1], (r[1] - q[1]) / length, (q[0] - r[0]) / length))
        for i in range(1, len(p) - 1):
            fan(pixels, depths, size, (p[0], p[i], p[i + 1]), sides, fill, edge, line)


def fan(pixels, depths, size, corner, sides, fill, edge, line):
    (x0, y0, z0), (x1, y1, z1), (x2, y2, z2) = corner
    area = (x1 - x0) * (y2 - y0) - (x2 - x0) * (y1 - y0)
    if abs(area) < 1e-12:
        return
    for y in range(max(0, math.ceil(min(y0, y1, y2))), min(size[1] - 1, int(max(y0, y1, y2))) + 1):
        for x in range(max(0, math.ceil(min(x0, x1, x2))), min(size[0] - 1, int(max(x0, x1, x2))) + 1):
            b1 = ((x - x0) * (y2 - y0) - (x2 - x0) * (y - y0)) / area
            b2 = ((x1 - x0) * (y - y0) - (x - x0) * (y1 - y0)) / area
            if b1 < 0 or b2 < 0 or b1 + b2 > 1:
                continue
            z, at = z0 + b1 * (z1 - z0) + b2 * (z2 - z0), y * size[0] + x
            if z > depths[at]:
                depths[at] = z
                near = min(abs((x - qx) * nx + (y - qy) * ny) for qx, qy, nx, ny in sides)
                pixels[at] = edge if near < line else fill


def write_png(path, width, height, rows):
    def chunk(kind, data):
        return struct.pack(">I", len(data)) + kind + data + struct.pack(">I", zlib.crc32(kind + data))
    with open(path, "wb") as file:
        file.write(b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", struct.pack(">2I5B", width, height, 8, 2, 0, 0, 0)) +
                   chunk(b"IDAT", zlib.compress(b"".join(b"\0" + row for row in rows), 9)) + chunk(b"IEND", b""))


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("quads")
    parser.add_argument("png")
    parser.add_argument("--with", dest="triangles")
    parser.add_argument("--width", type=int, default=1280)
    parser.add_argument("--turn", type=float, default=15)
    parser.add_argument("--tilt", type=float, default=-28)
    a = parser.parse_args()
    meshes = [(read_obj(a.triangles), TRIANGLES)] if a.triangles else []
    meshes.append((read_obj(a.quads), QUADS))
    view = rotation(a.turn, a.tilt)
    seen = [view(p) for p in meshes[-1][0][0]]
    low, high = [[f(p[i] for p in seen) for i in range(3)] for f in (min, max)]
    panel = a.width * SUPER // len(meshes)
    scale = 0.94 * panel / (high[0] - low[0])
    height = int(scale * (high[1] - low[1]) + 0.06 * panel) // SUPER * SUPER
    size = (panel * len(meshes), height)
    image = [BACKGROUND] * (size[0] * height), [-1e300] * (size[0] * height)
    fit = ((low[0] + high[0]) / 2, (low[1] + high[1]) / 2, scale), (high[2], low[2])
    for i, (mesh, colours) in enumerate(meshes):
        line = 0.45 * SUPER if len(mesh[1][0]) > 3 else 0.28 * SUPER
        raster(image, size, mesh, colours, view, fit, (i * panel, panel, height), line)
    pixels, rows = image[0], []
    for y in range(0, height - SUPER + 1, SUPER):
        row = bytearray()
        for x in range(0, size[0] - SUPER + 1, SUPER):
            block = [pixels[(y + j) * size[0] + x + i] for j in range(SUPER) for i in range(SUPER)]
            row += bytes(sum(p[k] for p in block) // (SUPER * SUPER) for k in range(3))
        rows.append(bytes(row))
    write_png(a.png, len(rows[0]) // 3, len(rows), rows)


main()
