/* A small picture of a result for the summary: flat shaded faces, a depth buffer, PNG with sixteen
 * shades on nothing. */
#include "bindings/cli/batch.h"
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <zlib.h>

enum { WIDTH = 112, HEIGHT = 84, SAMPLES = 2, W = WIDTH * SAMPLES, H = HEIGHT * SAMPLES };
enum { SHADES = 15, ROW = WIDTH / 2 + 1 }; /* shade 0 is transparent; two pixels a byte */

typedef struct picture {
    float depth[W * H];
    unsigned char shade[W * H];
} picture;

/* x to the right, y up, z towards the eye: a turn about the upright axis, then a tilt. */
static void turn(const double *p, double *out) {
    static const double ca = 0.8192, sa = 0.5736, cb = 0.9063, sb = 0.4226; /* 35, 25 degrees */
    const double depth = ca * p[2] - sa * p[0];
    out[0] = ca * p[0] + sa * p[2];
    out[1] = cb * p[1] - sb * depth;
    out[2] = sb * p[1] + cb * depth;
}

/* All points in units of samples, centred; NULL: out of memory. */
static double *project(const qc_polygon_mesh *mesh) {
    const size_t n = (size_t)mesh->n_vertices;
    double *point = malloc((3 * n + 1) * sizeof *point);
    double low[2] = {INFINITY, INFINITY}, high[2] = {-INFINITY, -INFINITY};
    for (size_t v = 0; point && v < n; v++) {
        turn(mesh->position + 3 * v, point + 3 * v);
        for (int i = 0; i < 2; i++) {
            low[i] = fmin(low[i], point[3 * v + (size_t)i]);
            high[i] = fmax(high[i], point[3 * v + (size_t)i]);
        }
    }
    const double scale = fmin((W - 4) / (high[0] - low[0]), (H - 4) / (high[1] - low[1]));
    for (size_t v = 0; point && v < n; v++) {
        double *p = point + 3 * v;
        p[0] = W / 2.0 + scale * (p[0] - (low[0] + high[0]) / 2);
        p[1] = H / 2.0 - scale * (p[1] - (low[1] + high[1]) / 2);
        p[2] *= scale;
    }
    return point;
}

/* 1 .. SHADES by the angle to a light beside the eye; both sides are lit. */
static unsigned char shade_of(const double *a, const double *b, const double *c) {
    const double u[3] = {b[0] - a[0], a[1] - b[1], b[2] - a[2]};
    const double v[3] = {c[0] - a[0], a[1] - c[1], c[2] - a[2]};
    const double n[3] = {u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2],
                         u[0] * v[1] - u[1] * v[0]};
    const double length = sqrt(n[0] * n[0] + n[1] * n[1] + n[2] * n[2]);
    const double side = n[2] < 0 ? -1 : 1;
    const double light = length > 0 ? side * (-0.4 * n[0] + 0.5 * n[1] + 0.77 * n[2]) / length : 0;
    return (unsigned char)(1 + lround((SHADES - 1) * fmin(1, 0.15 + 0.85 * fmax(0, light))));
}

static double cross(const double *a, const double *b, double x, double y) {
    return (b[0] - a[0]) * (y - a[1]) - (b[1] - a[1]) * (x - a[0]);
}

static int clamp(double x, int most) {
    return x < 0 ? 0 : x > most ? most : (int)x;
}

static void draw(picture *p, const double *a, const double *b, const double *c) {
    const double area = cross(a, b, c[0], c[1]);
    if (!isfinite(area) || area == 0) return;
    const unsigned char shade = shade_of(a, b, c);
    const int left = clamp(fmin(fmin(a[0], b[0]), c[0]), W - 1),
              right = clamp(fmax(fmax(a[0], b[0]), c[0]), W - 1),
              top = clamp(fmin(fmin(a[1], b[1]), c[1]), H - 1),
              bottom = clamp(fmax(fmax(a[1], b[1]), c[1]), H - 1);
    for (int y = top; y <= bottom; y++)
        for (int x = left; x <= right; x++) {
            const double sx = x + 0.5, sy = y + 0.5;
            const double wa = cross(b, c, sx, sy) / area, wb = cross(c, a, sx, sy) / area,
                         wc = 1 - wa - wb;
            const float z = (float)(wa * a[2] + wb * b[2] + wc * c[2]);
            if (wa < 0 || wb < 0 || wc < 0 || z <= p->depth[y * W + x]) continue;
            p->depth[y * W + x] = z;
            p->shade[y * W + x] = shade;
        }
}

static bool draw_all(picture *p, const qc_polygon_mesh *mesh) {
    double *point = project(mesh);
    for (int i = 0; i < W * H; i++) p->depth[i] = -INFINITY;
    for (int32_t f = 0; point && f < mesh->n_faces; f++) {
        const int32_t *v = mesh->face_vertex + mesh->face_offset[f];
        const int32_t n = mesh->face_offset[f + 1] - mesh->face_offset[f];
        for (int32_t i = 1; i + 1 < n; i++)
            draw(p, point + 3 * (size_t)v[0], point + 3 * (size_t)v[i],
                 point + 3 * (size_t)v[i + 1]);
    }
    free(point);
    return point != NULL;
}

/* The mean of the samples of a pixel; nothing when most are. */
static unsigned pixel(const picture *p, int x, int y) {
    unsigned sum = 0, n = 0;
    for (int i = 0; i < SAMPLES * SAMPLES; i++) {
        const int sx = SAMPLES * x + i % SAMPLES, sy = SAMPLES * y + i / SAMPLES;
        sum += p->shade[sy * W + sx];
        n += p->shade[sy * W + sx] > 0;
    }
    return 2 * n < SAMPLES * SAMPLES ? 0 : (sum + n / 2) / n;
}

static void put_number(FILE *out, uLong n) {
    for (int shift = 24; shift >= 0; shift -= 8) fputc((int)(n >> shift & 255), out);
}

static void put_chunk(FILE *out, const char *type, const unsigned char *data, uLong n) {
    put_number(out, n);
    fwrite(type, 1, 4, out);
    if (n > 0) fwrite(data, 1, n, out);
    uLong crc = crc32(0, (const unsigned char *)type, 4);
    put_number(out, n > 0 ? crc32(crc, data, (uInt)n) : crc);
}

static void put_png(FILE *out, const picture *p) {
    static const unsigned char signature[] = {137, 'P', 'N', 'G', 13, 10, 26, 10}, none[] = {0};
    static const unsigned char header[] = {0, 0, 0, WIDTH, 0, 0, 0, HEIGHT, 4, 3, 0, 0, 0};
    unsigned char palette[3 * (SHADES + 1)] = {0}, rows[ROW * HEIGHT] = {0},
                                        packed[ROW * HEIGHT + 1024];
    uLongf size = sizeof packed;
    for (int i = 1; i <= SHADES; i++) {
        const int colour[] = {247, 189, 97};
        for (int c = 0; c < 3; c++)
            palette[3 * i + c] = (unsigned char)(colour[c] * (i + 3) / (SHADES + 3));
    }
    for (int y = 0; y < HEIGHT; y++)
        for (int x = 0; x < WIDTH; x++)
            rows[y * ROW + 1 + x / 2] |= (unsigned char)(pixel(p, x, y) << (x % 2 ? 0 : 4));
    if (compress2(packed, &size, rows, sizeof rows, 9) != Z_OK) return;
    fwrite(signature, 1, sizeof signature, out);
    put_chunk(out, "IHDR", header, sizeof header);
    put_chunk(out, "PLTE", palette, sizeof palette);
    put_chunk(out, "tRNS", none, sizeof none);
    put_chunk(out, "IDAT", packed, size);
    put_chunk(out, "IEND", NULL, 0);
}

char *batch_picture_path(const char *folder, const char *name) {
    return batch_format("%s/picture/%s.png", folder, name);
}

static void write_picture(const char *folder, const char *name, const qc_polygon_mesh *mesh) {
    picture *p = calloc(1, sizeof *p);
    char *parent = batch_format("%s/picture", folder), *path = batch_picture_path(folder, name);
    char *bytes = NULL;
    size_t size = 0;
    FILE *out = p && parent && path && draw_all(p, mesh) ? open_memstream(&bytes, &size) : NULL;
    if (out) put_png(out, p);
    if (out && fclose(out) == 0) {
        mkdir(parent, 0777);
        cli_write_bytes(path, bytes, size);
    }
    free(bytes);
    free(path);
    free(parent);
    free(p);
}

void batch_draw(const json_t *task) {
    const char *folder = batch_text(task, "folder"), *name = batch_text(task, "name");
    const char *quads = json_string_value(json_array_get(json_object_get(task, "outputs"), 0));
    qc_ctx_options options = QC_CTX_OPTIONS_INIT;
    qc_polygon_mesh *mesh = NULL;
    qc_ctx *ctx = NULL;
    options.threads = 1;
    if (qc_ctx_create(&options, &ctx) == QC_OK && qc_polygon_mesh_read(ctx, quads, &mesh) == QC_OK)
        write_picture(folder, name, mesh);
    qc_object_release(mesh);
    qc_ctx_free(ctx);
}
