/* Shape operators by the normal cycle of Cohen-Steiner and Morvan, "Restricted Delaunay
 * triangulations and normal cycle" (2003): the tensor 1/|B| sum_e beta(e) |e n B| e e^T over a ball
 * B about each vertex; a face averages its three vertices. The principal directions of T are
 * swapped against the shape operator's, so it enters as J T J^T.
 *
 * The part of the surface in B is found breadth first from the vertex, so the cost is the number of
 * faces in the balls; at most FACE_LIMIT faces are visited, which bounds it: the ball is then
 * effectively smaller, but an average over so many faces is free of noise anyway. */
#include "internal.h"

enum { FACE_LIMIT = 200, CHUNK = 256 };

/* All that a visit needs, side by side: the visits jump about in memory. */
typedef struct patch {
    double corner[3][3], beta[3], area;
    int32_t next[3]; /* face across halfedge k, -1 = boundary */
} patch;

typedef struct cycle_job {
    const qc_mesh *mesh;
    double radius;
    patch *patch;     /* n_faces                                                     */
    double *tensor;   /* 6 n_vertices: xx, xy, xz, yy, yz, zz                        */
    int64_t first;    /* vertex of index 0 of the parallel loop                      */
    int32_t *visited; /* n_faces per worker: last centre which reached the face, + 1  */
    int32_t *queue;   /* FACE_LIMIT per worker                                       */
} cycle_job;

/* Share of segment a, a + d inside the ball of the given radius about 0: roots of |a + u d|^2 =
 * r^2. */
static double share_inside(const double a[3], const double d[3], double r) {
    double dd = qc__dot3(d, d), ad = qc__dot3(a, d), disc = ad * ad - dd * (qc__dot3(a, a) - r * r);
    if (!(disc > 0) || !(dd > 0)) return 0;
    double root = sqrt(disc), lo = (-ad - root) / dd, hi = (-ad + root) / dd;
    lo = lo < 0 ? 0 : lo;
    hi = hi > 1 ? 1 : hi;
    return hi > lo ? hi - lo : 0;
}

typedef struct ball {
    const double *centre;
    double radius, area, *tensor;
} ball;

/* Adds halfedge k of a visited face, half of its edge's tensor (its twin adds the rest); its share
 * inside. */
static double add_halfedge(const patch *face, int k, ball *B, double *length) {
    const double *p = face->corner[k == 2 ? 0 : k + 1], *q = face->corner[k == 0 ? 2 : k - 1];
    double a[3], e[3];
    qc__sub(p, B->centre, a);
    qc__sub(q, p, e);
    double share = share_inside(a, e, B->radius);
    *length = sqrt(qc__dot3(e, e));
    if (share > 0 && face->beta[k] != 0) {
        double w = face->beta[k] * share / (2 * *length);
        for (int i = 0, m = 0; i < 3; i++)
            for (int n = i; n < 3; n++) B->tensor[m++] += w * e[i] * e[n];
    }
    return share;
}

/* The fan of the centre starts the search; a fan beyond the limit loses its last faces. */
static void gather(const cycle_job *j, int32_t centre, int32_t *visited, int32_t *queue, ball *B) {
    int32_t head = 0, tail = 0, first = j->mesh->vertex_corner[centre], c = first;
    do {
        visited[c / 3] = centre + 1;
        queue[tail++] = c / 3;
        c = qc_corner_ccw(j->mesh, c);
    } while (c >= 0 && c != first && tail < FACE_LIMIT);
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

/* Large enough for the edges at the vertex: their mean length at least. */
static double ball_radius(const cycle_job *j, int32_t p) {
    const double *centre = j->mesh->position + 3 * (size_t)p;
    double sum = 0, n = 0;
    int32_t first = j->mesh->vertex_corner[p], c = first;
    do {
        double d[3];
        qc__sub(j->mesh->position + 3 * (size_t)j->mesh->face_vertex[qc_next(c)], centre, d);
        sum += sqrt(qc__dot3(d, d));
        n++;
        c = qc_corner_ccw(j->mesh, c);
    } while (c >= 0 && c != first);
    return fmax(j->radius, sum / n);
}

static void cycle_vertices(void *arg, int64_t begin, int64_t end, uint32_t worker) {
    const cycle_job *j = arg;
    int32_t *visited = j->visited + (size_t)worker * (size_t)j->mesh->n_faces;
    int32_t *queue = j->queue + (size_t)worker * FACE_LIMIT;
    for (int64_t i = begin; i < end; i++) {
        int32_t p = (int32_t)(j->first + i);
        double *tensor = j->tensor + 6 * (size_t)p;
        ball B = {j->mesh->position + 3 * (size_t)p, ball_radius(j, p), 0, tensor};
        gather(j, p, visited, queue, &B);
        for (int k = 0; k < 6; k++) tensor[k] = B.area > 0 ? tensor[k] / B.area : 0;
    }
}

/* J T J^T in the frame of each face, T the mean of its vertices. */
static void restrict_to_faces(const qc_mesh *mesh, const double *tensor, const double *real_axis,
                              const double *imaginary_axis, double *shape) {
    for (size_t t = 0; t < (size_t)mesh->n_faces; t++) {
        const double *u = real_axis + 3 * t, *v = imaginary_axis + 3 * t;
        double T[6] = {0, 0, 0, 0, 0, 0}, Tu[3], Tv[3];
        for (size_t k = 0; k < 3; k++)
            for (size_t i = 0; i < 6; i++)
                T[i] += tensor[6 * (size_t)mesh->face_vertex[3 * t + k] + i] / 3;
        const double row[3][3] = {{T[0], T[1], T[2]}, {T[1], T[3], T[4]}, {T[2], T[4], T[5]}};
        for (int i = 0; i < 3; i++) Tu[i] = qc__dot3(row[i], u), Tv[i] = qc__dot3(row[i], v);
        shape[3 * t] = qc__dot3(v, Tv);
        shape[3 * t + 1] = -qc__dot3(u, Tv);
        shape[3 * t + 2] = qc__dot3(u, Tu);
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
    cycle_job job = {mesh, radius, NULL, NULL, 0, NULL, NULL};
    int64_t V = mesh->n_vertices;
    job.tensor = QC__ZERO(ctx, double, 6 * V);
    job.patch = QC__NEW(ctx, patch, F);
    job.visited = QC__ZERO(ctx, int32_t, workers * F);
    job.queue = QC__NEW(ctx, int32_t, workers * FACE_LIMIT);
    qc_status status = job.patch && job.tensor && job.visited && job.queue ? QC_OK : QC_ERR_NOMEM;
    if (!status) status = qc__poll(ctx);
    if (!status) fill_patches(mesh, beta, area, job.patch);
    if (!status) status = qc__poll(ctx);
    /* Slices keep the time between two progress calls short. */
    int64_t slice = CHUNK * 4 * (int64_t)workers;
    for (job.first = 0; !status && job.first < V; job.first += slice) {
        int64_t n = V - job.first < slice ? V - job.first : slice;
        qc__parallel_for(ctx, n, CHUNK, cycle_vertices, &job);
        if (!qc__progress(ctx, (double)(job.first + n) / (double)V)) status = QC_ERR_CANCELLED;
    }
    if (!status) restrict_to_faces(mesh, job.tensor, real_axis, imaginary_axis, shape);
    qc__free(job.tensor);
    qc__free(job.patch);
    qc__free(job.visited);
    qc__free(job.queue);
    return status;
}
