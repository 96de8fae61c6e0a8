/* Repair step 6: turns faces so that neighbours agree. Each component keeps the orientation of the
 * majority of its faces; a closed one which was mixed is turned outward as a whole. */
#include "sdk/mesh/repair/internal.h"

typedef struct component {
    int32_t n, turned;
    bool closed;
    double volume; /* six times the signed volume, with the faces as turned */
} component;

static bool same_direction(const qc__repair *r, int32_t h, int32_t g) {
    return r->triangle[qc_next(h)] == r->triangle[qc_next(g)];
}

/* Six times the volume of the tetrahedron over a face from `origin`. */
static double face_volume(const qc__repair *r, int32_t face, const double origin[3]) {
    double e[3][3];
    for (int k = 0; k < 3; k++)
        for (int i = 0; i < 3; i++)
            e[k][i] = qc__repair_point(r, r->triangle[3 * face + k])[i] - origin[i];
    double volume = 0;
    for (int i = 0; i < 3; i++)
        volume += e[0][i] *
                  (e[1][(i + 1) % 3] * e[2][(i + 2) % 3] - e[1][(i + 2) % 3] * e[2][(i + 1) % 3]);
    return volume;
}

/* Visits the component of `seed`; turn[f] is -1 before the visit, then 1 for faces which disagree
 * with the seed. queue gets the faces. */
static qc_status visit(qc__repair *r, int32_t seed, int8_t *turn, int32_t *queue, component *out) {
    const double *origin = qc__repair_point(r, r->triangle[3 * seed]);
    component c = {1, 0, true, 0};
    char name[QC__FACE_NAME];
    queue[0] = seed;
    turn[seed] = 0;
    for (int32_t i = 0; i < c.n; i++) {
        int32_t f = queue[i];
        c.turned += turn[f];
        c.volume += (turn[f] ? -1 : 1) * face_volume(r, f, origin);
        for (int32_t h = 3 * f; h < 3 * f + 3; h++) {
            int32_t g = r->twin[h];
            if (g < 0) c.closed = false;
            if (g < 0) continue;
            int8_t wanted = (int8_t)(turn[f] ^ (int8_t)same_direction(r, h, g));
            if (turn[g / 3] < 0) {
                turn[g / 3] = wanted;
                queue[c.n++] = g / 3;
            } else if (turn[g / 3] != wanted)
                return qc__fail(
                    r->ctx, QC_ERR_INPUT, r->source_face[g / 3],
                    "the surface is one-sided (like a Moebius strip) at %s; cut it open "
                    "along a loop through that face",
                    qc__repair_face_name(r, g / 3, name));
        }
    }
    *out = c;
    return QC_OK;
}

/* Whether the visited component has to be turned as a whole. */
static bool invert(const component *c) {
    bool majority = 2 * (int64_t)c->turned > c->n;
    if (c->turned == 0 || c->turned == c->n) return majority;
    if (c->closed && c->volume != 0) return c->volume < 0;
    return majority;
}

static int32_t moved(const int8_t *turn, int32_t h) {
    return !turn[h / 3] || h % 3 == 0 ? h : h % 3 == 1 ? h + 1 : h - 1;
}

static qc_status apply(qc__repair *r, const int8_t *turn) {
    int32_t *twin = QC__NEW(r->ctx, int32_t, 3 * (size_t)r->n_faces);
    if (!twin) return QC_ERR_NOMEM;
    for (int32_t h = 0; h < 3 * r->n_faces; h++)
        twin[moved(turn, h)] = r->twin[h] < 0 ? -1 : moved(turn, r->twin[h]);
    qc__free(r->twin);
    r->twin = twin;
    for (int32_t f = 0; f < r->n_faces; f++) {
        if (!turn[f]) continue;
        int32_t *t = r->triangle + 3 * (size_t)f, b = t[1];
        t[1] = t[2];
        t[2] = b;
        qc__repair_note(r, QC_REPAIR_ORIENTED, r->source_face[f]);
    }
    return QC_OK;
}

qc_status qc__repair_orient(qc__repair *r) {
    int8_t *turn = QC__NEW(r->ctx, int8_t, r->n_faces);
    int32_t *queue = QC__NEW(r->ctx, int32_t, r->n_faces);
    qc_status status = turn && queue ? QC_OK : QC_ERR_NOMEM;
    for (int32_t f = 0; status == QC_OK && f < r->n_faces; f++) turn[f] = -1;
    for (int32_t f = 0; status == QC_OK && f < r->n_faces; f++) {
        component c = {0};
        if (turn[f] >= 0) continue;
        status = visit(r, f, turn, queue, &c);
        if (status == QC_OK && invert(&c))
            for (int32_t i = 0; i < c.n; i++) turn[queue[i]] ^= 1;
    }
    if (status == QC_OK) status = apply(r, turn);
    qc__free(turn);
    qc__free(queue);
    return status;
}
