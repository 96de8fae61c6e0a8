/* The unit cube in every format. */
#ifndef QC_TESTS_MESH_IO_CUBE_H
#define QC_TESTS_MESH_IO_CUBE_H

#include <stdint.h>
#include <stdio.h>
#include <string.h>

static const double CUBE_POINT[8][3] = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0},
                                        {0, 0, 1}, {1, 0, 1}, {1, 1, 1}, {0, 1, 1}};
static const int CUBE_FACE[12][3] = {{0, 2, 1}, {0, 3, 2}, {4, 5, 6}, {4, 6, 7},
                                     {0, 1, 5}, {0, 5, 4}, {1, 2, 6}, {1, 6, 5},
                                     {2, 3, 7}, {2, 7, 6}, {3, 0, 4}, {3, 4, 7}};

enum {
    CUBE_OBJ,
    CUBE_OFF,
    CUBE_PLY_ASCII,
    CUBE_PLY_LITTLE,
    CUBE_PLY_BIG,
    CUBE_STL_ASCII,
    CUBE_STL_BINARY,
    CUBE_FORMATS
};
static const char *const CUBE_NAME[CUBE_FORMATS] = {
    "cube.obj", "cube.off", "ascii.ply", "little.ply", "big.ply", "text.stl", "binary.stl"};

/* A growing text or binary file. */
typedef struct bytes {
    char data[4096];
    size_t n;
} bytes;

static inline void add(bytes *b, const void *p, size_t n) {
    memcpy(b->data + b->n, p, n);
    b->n += n;
}
static inline void add_text(bytes *b, const char *text) {
    add(b, text, strlen(text));
}

/* The bytes of a scalar in the wanted order, whatever the machine's. */
static inline void add_bits(bytes *b, uint64_t bits, int n, int big) {
    for (int i = 0; i < n; i++) b->data[b->n++] = (char)(bits >> 8 * (big ? n - 1 - i : i));
}
static inline void add_float(bytes *b, double x, int big) {
    float f = (float)x;
    uint32_t bits;
    memcpy(&bits, &f, sizeof bits);
    add_bits(b, bits, 4, big);
}
static inline void add_double(bytes *b, double x, int big) {
    uint64_t bits;
    memcpy(&bits, &x, sizeof bits);
    add_bits(b, bits, 8, big);
}

/* With a property of every kind which has to be skipped, before and behind the wanted ones. */
static inline void cube_ply(bytes *b, int format) {
    static const char *const names[] = {"ascii", "binary_little_endian", "binary_big_endian"};
    int big = format == 2;
    add_text(b, "ply\nformat ");
    add_text(b, names[format]);
    add_text(b, " 1.0\ncomment a cube\nobj_info x\nelement junk 2\nproperty list uchar short l\n"
                "property int8 c\nelement vertex 8\nproperty float x\nproperty double y\n"
                "property uchar red\nproperty float32 z\nelement face 12\nproperty int32 tag\n"
                "property list uint8 int vertex_indices\nproperty list int float uv\n"
                "element edge 1\nproperty uint vertex1\nend_header\n");
    char line[128];
    if (format == 0) {
        add_text(b, "3 1 2 3 -1\n0 5\n");
        for (int v = 0; v < 8; v++) {
            snprintf(line, sizeof line, "%g %g 255 %g\n", CUBE_POINT[v][0], CUBE_POINT[v][1],
                     CUBE_POINT[v][2]);
            add_text(b, line);
        }
        for (int f = 0; f < 12; f++) {
            snprintf(line, sizeof line, "7 3 %d %d %d 2 0.5 0.25\n", CUBE_FACE[f][0],
                     CUBE_FACE[f][1], CUBE_FACE[f][2]);
            add_text(b, line);
        }
        add_text(b, "0\n");
        return;
    }
    add_bits(b, 3, 1, big);
    for (int i = 0; i < 3; i++) add_bits(b, 0xfff0u, 2, big);
    add_bits(b, 0xff, 1, big);
    add_bits(b, 0, 1, big);
    add_bits(b, 5, 1, big);
    for (int v = 0; v < 8; v++) {
        add_float(b, CUBE_POINT[v][0], big);
        add_double(b, CUBE_POINT[v][1], big);
        add_bits(b, 255, 1, big);
        add_float(b, CUBE_POINT[v][2], big);
    }
    for (int f = 0; f < 12; f++) {
        add_bits(b, 7, 4, big);
        add_bits(b, 3, 1, big);
        for (int k = 0; k < 3; k++) add_bits(b, (uint64_t)CUBE_FACE[f][k], 4, big);
        add_bits(b, 1, 4, big);
        add_float(b, 0.5, big);
    }
    add_bits(b, 0, 4, big);
}

static inline void cube_stl(bytes *b, int binary) {
    char line[128] = "solid but binary nevertheless";
    if (binary) {
        add(b, line, 80);
        add_bits(b, 12, 4, 0);
    } else
        add_text(b, "solid cube\n");
    for (int f = 0; f < 12; f++) {
        if (binary)
            add(b, "\0\0\0\0\0\0\0\0\0\0\0\0", 12);
        else
            add_text(b, "  facet normal 0 0 0\n    outer loop\n");
        for (int k = 0; k < 3; k++) {
            const double *p = CUBE_POINT[CUBE_FACE[f][k]];
            for (int i = 0; binary && i < 3; i++) add_float(b, p[i], 0);
            snprintf(line, sizeof line, "      vertex %g %g %g\n", p[0], p[1], p[2]);
            if (!binary) add_text(b, line);
        }
        if (binary)
            add(b, "\0\0", 2);
        else
            add_text(b, "    endloop\n  endfacet\n");
    }
    if (!binary) add_text(b, "endsolid cube\n");
}

static inline void cube_text(bytes *b, int off) {
    char line[128];
    add_text(b, off ? "COFF # a cube\n# counts\n8 12 0\n" : "# a cube\nmtllib x.mtl\no cube\n");
    for (int v = 0; v < 8; v++) {
        const double *p = CUBE_POINT[v];
        snprintf(line, sizeof line, off ? "%g %g %g 1 0 0 1\n" : "v  %g\t%g %g 0.5 0.5 0.5\r\n",
                 p[0], p[1], p[2]);
        add_text(b, line);
    }
    for (int f = 0; f < 12; f++) {
        const int *t = CUBE_FACE[f];
        if (off)
            snprintf(line, sizeof line, "3 %d %d %d  0.1 0.2 0.3\n", t[0], t[1], t[2]);
        else if (f % 2)
            snprintf(line, sizeof line, "f %d//1 %d//1 \\\n%d//1\n", t[0] + 1, t[1] + 1, t[2] + 1);
        else
            snprintf(line, sizeof line, "f %d %d %d\n", t[0] - 8, t[1] - 8, t[2] - 8);
        add_text(b, line);
    }
}

static inline void cube_bytes(int format, bytes *b) {
    b->n = 0;
    if (format <= CUBE_OFF)
        cube_text(b, format == CUBE_OFF);
    else if (format <= CUBE_PLY_BIG)
        cube_ply(b, format - CUBE_PLY_ASCII);
    else
        cube_stl(b, format == CUBE_STL_BINARY);
}

#endif
