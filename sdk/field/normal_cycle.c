/* Shape operators by the normal cycle of Cohen-Steiner and Morvan, "Restricted Delaunay triangulations and
 * normal cycle" (2003): the tensor 1/|B| sum_e beta(e) |e n B| e e^T over a ball B about the face's centre.
 * Its principal directions are swapped against the shape operator's, so it enters as J T J^T.
 *
 * The part of the surface in B is found breadth first from the face, so the cost is the number of faces in
 * the balls; at most FACE_LIMIT faces are visited, which bounds it: the ball is then effectively smaller, but
 * an average over so many faces is free of noise anyway. */
#include "internal.h"

enum { FACE_LIMIT = 300, CHUNK = 512 };

/* All that a visit needs, side by side: the visits jump about in memory. */
typedef struct patch {
    double corner[3][3], beta[3], area;
    int32_t next[3]; /* face across halfedge k, -1 = boundary */
} patch;

typedef struct cycle_job {
    const qc_mesh *mesh;
    double radius;
    const double *real_axis, *imaginary_axis;
    patch *patch; /* n_faces */
    double *shape;
    int64_t first;    /* face of index 0 of the parallel loop                        */
    int32_t *visited; /* n_faces per worker: last centre which reached the face, + 1  */
    int32_t *queue;   /* FACE_LIMIT per worker                                       */
} cycle_job;

/* Share of segment a, a + d inside the ball of the given radius about 0: roots of |a + u d|^2 = r^2. */
static double share_inside(const double a[3], const double d[3], double r) {
    double dd = qc__dot(d, d), ad = qc__dot(a, d), disc = ad * ad - dd * (qc__dot(a, a) - r * r);
    if (!(disc > 0) || !(dd > 0)) return 0;
    double root = sqrt(disc), lo = (-ad - root) / dd, hi = (-ad + root) / dd;
    lo = lo < 0 ? 0 : lo;
    hi = hi > 1 ? 1 : hi;
    return hi > lo ? hi - lo : 0;
}

typedef struct ball {
    double centre[3], radius, area, a, b, d; /* T in the frame of the centre face: a, b, d */
    const double *u, *v;
} ball;

/* Adds halfedge k of a visited face, half of its edge's tensor (its twin adds the rest); its share inside. */
static double add_halfedge(const patch *face, int k, ball *B, double *length) {
    const double *p = face->corner[k == 2 ? 0 : k + 1], *q = face->corner[k == 0 ? 2 : k - 1];
    double a[3], e[3];
    qc__sub(p, B->centre, a);
    qc__sub(q, p, e);
    double share = share_inside(a, e, B->radius);
    *length = sqrt(qc__dot(e, e));
    if (share > 0 && face->beta[k] != 0) {
        double w = face->beta[k] * share / (2 * *length);
        double eu = qc__dot(e, B->u), ev = qc__dot(e, B->v);
        B->a += w * eu * eu;
        B->b += w * eu * ev;
        B->d += w * ev * ev;
    }
    return share;
}

static void gather(const cycle_job *j, int32_t centre, int32_t *visited, int32_t *queue, ball *B) {
    int32_t head = 0, tail = 0;
    queue[tail++] = centre;
    visited[centre] = centre + 1;
    while (head < tail) {
        const patch *face = j->patch + queue[head++];
        double inside = 0, total = 0;
        for (int k = 0; k < 3; k++) {
            double length, share = add_halfedge(face, k, B, &length);
            int32_t next = face->next[k];
            inside += share * length;
            total += length;
            if (next < 0 || !(share > 0) || visited[next] == centre + 1 || tail >= FACE_LIMIT)
                continue;
            visited[next] = centre + 1;
            queue[tail++] = next;
        }
        if (total > 0) B->area += face->area * inside / total;
    }
}

/* About the centroid; large enough to hold the edges of face t itself. */
static ball centred_ball(const cycle_job *j, size_t t) {
    ball B = {{0, 0, 0}, j->radius, 0, 0, 0, 0, j->real_axis + 3 * t, j->imaginary_axis + 3 * t};
    const patch *face = j->patch + t;
    for (size_t k = 0; k < 3; k++)
        for (size_t c = 0; c < 3; c++) B.centre[c] += face->corner[k][c] / 3;
    for (size_t k = 0; k < 3; k++) {
        double d[3];
        qc__sub(face->corner[k], B.centre, d);
        B.radius = fmax(B.radius, 1.5 * sqrt(qc__dot(d, d)));
    }
    return B;
}

static void cycle_faces(void *arg, int64_t begin, int64_t end, uint32_t worker) {
    const cycle_job *j = arg;
    int32_t *visited = j->visited + (size_t)worker * (size_t)j->mesh->n_faces;
    int32_t *queue = j->queue + (size_t)worker * FACE_LIMIT;
    for (int64_t i = begin; i < end; i++) {
        size_t t = (size_t)(j->first + i);
        ball B = centred_ball(j, t);
        gather(j, (int32_t)t, visited, queue, &B);
        double scale = B.area > 0 ? 1 / B.area : 0;
        j->shape[3 * t] = scale * B.d; /* J T J^T */
        j->shape[3 * t + 1] = -scale * B.b;
        j->shape[3 * t + 2] = scale * B.a;
    }
}

static void fill_patches(const qc_mesh *mesh, const double *beta, const double *area, patch *out) {
    for (size_t t = 0; t < (size_t)mesh->n_faces; t++) {
        out[t].area = area[t];
        for (size_t k = 0; k < 3; k++) {
            size_t h = 3 * t + k;
            const double *p = mesh->position + 3 * (size_t)mesh->face_vertex[h];
            for (size_t c = 0; c < 3; c++) out[t].corner[k][c] = p[c];
            out[t].beta[k] = beta[mesh->halfedge_edge[h]];
            out[t].next[k] = mesh->twin[h] < 0 ? -1 : mesh->twin[h] / 3;
        }
    }
}

qc_status qc__curvature_normal_cycle(qc_ctx *ctx, const qc_mesh *mesh, double radius,
                                     const double *beta, const double *area,
                                     const double *real_axis, const double *imaginary_axis,
                                     double *shape) {
    size_t workers = qc_ctx_threads(ctx), F = (size_t)mesh->n_faces;
    cycle_job job = {mesh, radius, real_axis, imaginary_axis, NULL, shape, 0, NULL, NULL};
    job.patch = QC__NEW(ctx, patch, F);
    job.visited = QC__ZERO(ctx, int32_t, workers * F);
    job.queue = QC__NEW(ctx, int32_t, workers * FACE_LIMIT);
    qc_status status = job.patch && job.visited && job.queue ? QC_OK : QC_ERR_NOMEM;
    if (!status) fill_patches(mesh, beta, area, job.patch);
    /* Slices keep the time between two progress calls short. */
    int64_t slice = CHUNK * 4 * (int64_t)workers;
    for (job.first = 0; !status && job.first < mesh->n_faces; job.first += slice) {
        int64_t n = mesh->n_faces - job.first < slice ? mesh->n_faces - job.first : slice;
        qc__parallel_for(ctx, n, CHUNK, cycle_faces, &job);
        if (!qc__progress(ctx, (double)(job.first + n) / mesh->n_faces)) status = QC_ERR_CANCELLED;
    }
    qc__free(job.patch);
    qc__free(job.visited);
    qc__free(job.queue);
    return status;
}
