/* Solving for z = x^4 on a few faces, see region.h. */
#include "region.h"

enum { STEPS = 10 };

qc_status qc__region_create(qc_ctx *ctx, const qc_mesh *mesh, const qc__connection *c,
                            qc__region *out) {
    int32_t F = mesh->n_faces;
    *out = (qc__region){mesh,
                        c,
                        QC__NEW(ctx, int32_t, F),
                        QC__NEW(ctx, int32_t, F),
                        QC__NEW(ctx, int32_t, F),
                        QC__NEW(ctx, int32_t, F),
                        0,
                        0};
    return out->local && out->face && out->patch && out->stack ? QC_OK : QC_ERR_NOMEM;
}

void qc__region_free(qc__region *r) {
    qc__free(r->local);
    qc__free(r->face);
    qc__free(r->patch);
    qc__free(r->stack);
}

/* Adds the faces of the region about vertex p to patch `number`; returns the height of the stack.
 */
static int32_t claim_fan(qc__region *r, int32_t p, int32_t number, int32_t top) {
    int32_t first = r->mesh->vertex_corner[p], c = first;
    do {
        int32_t i = r->local[c / 3];
        if (i >= 0 && r->patch[i] < 0) {
            r->patch[i] = number;
            r->stack[top++] = i;
        }
        c = qc_corner_ccw(r->mesh, c);
    } while (c >= 0 && c != first);
    return top;
}

void qc__region_set(qc__region *r, const uint8_t *inside) {
    r->n = r->n_patches = 0;
    for (int32_t t = 0; t < r->mesh->n_faces; t++) {
        r->local[t] = inside[t] ? r->n : -1;
        if (inside[t]) r->face[r->n++] = t;
    }
    for (int32_t i = 0; i < r->n; i++) r->patch[i] = -1;
    for (int32_t i = 0; i < r->n; i++) {
        if (r->patch[i] >= 0) continue;
        int32_t top = 0;
        r->stack[top++] = i;
        r->patch[i] = r->n_patches;
        while (top > 0) {
            int32_t t = r->face[r->stack[--top]];
            for (int32_t k = 3 * t; k < 3 * t + 3; k++)
                top = claim_fan(r, r->mesh->face_vertex[k], r->n_patches, top);
        }
        r->n_patches++;
    }
}

/* z in the face of h of a section which is `neighbour` in the face across h; plain: z is a
 * function. */
static qc__cplx across(const qc__region *r, bool plain, int32_t h, qc__cplx neighbour) {
    int32_t e = r->mesh->halfedge_edge[h];
    if (plain) return neighbour;
    qc__cplx turn = qc__fourth(qc__c(r->c->rho[e]));
    return (r->mesh->edge_halfedge[2 * e] == h ? conj(turn) : turn) * neighbour;
}

typedef struct local_system {
    bool plain; /* functions instead of sections                                              */
    int64_t *colptr;
    int32_t *row;
    qc_complex *value;
    qc__cplx *pull; /* n: right-hand side, for sections from the z of the kept neighbours       */
} local_system;

static int64_t find_row(local_system *s, int64_t begin, int64_t end, int32_t row) {
    while (begin < end && s->row[begin] < row) begin++;
    return begin;
}

/* Column i: neighbours of lower number, sorted, then the diagonal. */
static int64_t add_column(const qc__region *r, const qc_complex *x, double inertia, local_system *s,
                          int32_t i, int64_t begin) {
    int32_t t = r->face[i];
    int64_t end = begin;
    double diagonal = inertia * r->c->area[t];
    s->pull[i] = 0;
    for (int32_t h = 3 * t; h < 3 * t + 3; h++) {
        int32_t g = r->mesh->twin[h];
        double omega = r->c->omega[r->mesh->halfedge_edge[h]];
        if (g < 0 || g / 3 == t) continue;
        diagonal += omega;
        int32_t j = r->local[g / 3];
        if (j < 0 && x) s->pull[i] += omega * across(r, s->plain, h, qc__fourth(qc__c(x[g / 3])));
        if (j < 0 || j > i) continue;
        qc_complex entry = qc__z(-omega * conj(across(r, s->plain, h, 1)));
        int64_t at = find_row(s, begin, end, j);
        if (at < end && s->row[at] == j) {
            s->value[at].re += entry.re;
            s->value[at].im += entry.im;
            continue;
        }
        for (int64_t k = end++; k > at; k--)
            s->row[k] = s->row[k - 1], s->value[k] = s->value[k - 1];
        s->row[at] = j;
        s->value[at] = entry;
    }
    s->row[end] = i;
    s->value[end] = (qc_complex){diagonal, 0};
    return end + 1;
}

/* Breadth first over each patch from its first face. */
static void transport(const qc__region *r, const qc_complex *x, qc__cplx *z) {
    for (int32_t i = 0; i < r->n; i++) z[i] = 0;
    for (int32_t i = 0; i < r->n; i++) {
        if (cabs(z[i]) > 0) continue;
        int32_t head = 0, tail = 0;
        r->stack[tail++] = i;
        z[i] = qc__fourth(qc__c(x[r->face[i]]));
        while (head < tail) {
            int32_t a = r->stack[head++];
            for (int32_t h = 3 * r->face[a]; h < 3 * r->face[a] + 3; h++) {
                int32_t g = r->mesh->twin[h], b = g < 0 ? -1 : r->local[g / 3];
                if (b < 0 || cabs(z[b]) > 0) continue;
                z[b] = qc__unit(across(r, false, g, z[a]));
                r->stack[tail++] = b;
            }
        }
    }
}

static qc_status step_flow(qc_ctx *ctx, const qc__region *r, const local_system *s,
                           const qc_factor *factor, double inertia, qc__cplx *z) {
    for (int32_t i = 0; i < r->n; i++) z[i] = s->pull[i] + inertia * r->c->area[r->face[i]] * z[i];
    qc_status status = qc_solve(ctx, factor, 1, (qc_complex *)z);
    for (int32_t i = 0; !status && i < r->n; i++) z[i] = qc__unit(z[i]);
    return status;
}

static qc_status factorise(qc_ctx *ctx, const qc__region *r, local_system *s, const qc_complex *x,
                           double inertia, qc_factor **factor) {
    qc_symbolic *symbolic = NULL;
    int64_t k = 0;
    for (int32_t i = 0; i < r->n; i++) {
        s->colptr[i] = k;
        k = add_column(r, x, inertia, s, i, k);
    }
    s->colptr[r->n] = k;
    qc_hermitian A = {r->n, s->colptr, s->row, s->value};
    qc_status status = qc_analyze(ctx, &A, NULL, &symbolic);
    if (!status) status = qc_factorize(ctx, symbolic, &A, factor);
    qc_symbolic_free(symbolic);
    return status;
}

static qc_status allocate(qc_ctx *ctx, size_t n, local_system *s) {
    s->colptr = QC__NEW(ctx, int64_t, n + 1);
    s->row = QC__NEW(ctx, int32_t, 4 * n);
    s->value = QC__NEW(ctx, qc_complex, 4 * n);
    s->pull = QC__NEW(ctx, qc__cplx, n);
    return s->colptr && s->row && s->value && s->pull ? QC_OK : QC_ERR_NOMEM;
}

static void release(local_system *s, qc_factor *factor) {
    qc__free(s->colptr);
    qc__free(s->row);
    qc__free(s->value);
    qc__free(s->pull);
    qc_factor_free(factor);
}

static double total_area(const qc__region *r) {
    double area = 0;
    for (int32_t i = 0; i < r->n; i++) area += r->c->area[r->face[i]];
    return area;
}

/* Part of the unit of the diagonal which keeps patches without a kept neighbour from being
 * singular. */
#define SHIFT 1e-6

qc_status qc__region_solve(qc_ctx *ctx, const qc__region *r, const qc_complex *x, bool transported,
                           double length, qc__cplx *z) {
    local_system s = {.plain = false};
    qc_factor *factor = NULL;
    double inertia = transported ? 2 / (length * length) : SHIFT / total_area(r);
    qc_status status = allocate(ctx, (size_t)r->n, &s);
    if (!status) status = factorise(ctx, r, &s, x, inertia, &factor);
    if (!status && transported) {
        transport(r, x, z);
    } else if (!status) {
        for (int32_t i = 0; i < r->n; i++) z[i] = qc__fourth(qc__c(x[r->face[i]]));
    }
    for (int step = 0; !status && step < (transported ? STEPS : 1); step++)
        status = step_flow(ctx, r, &s, factor, inertia, z);
    release(&s, factor);
    return status;
}

qc_status qc__region_rotate(qc_ctx *ctx, const qc__region *r, const double *theta,
                            qc__cplx *alpha) {
    local_system s = {.plain = true};
    qc_factor *factor = NULL;
    qc_status status = allocate(ctx, (size_t)r->n, &s);
    if (!status) status = factorise(ctx, r, &s, NULL, SHIFT / total_area(r), &factor);
    for (int32_t i = 0; !status && i < r->n; i++) {
        alpha[i] = 0;
        for (int32_t h = 3 * r->face[i]; h < 3 * r->face[i] + 3; h++) {
            int32_t e = r->mesh->halfedge_edge[h];
            double b = r->c->omega[e] * theta[e];
            if (r->mesh->twin[h] >= 0) alpha[i] += r->mesh->edge_halfedge[2 * e] == h ? b : -b;
        }
    }
    if (!status) status = qc_solve(ctx, factor, 1, (qc_complex *)alpha);
    release(&s, factor);
    return status;
}
