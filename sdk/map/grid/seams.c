/* Transitions of an integer-seamless map (docs/theory/exact-grid.md): across an edge from the lower
 * face s to t, f_t = i^r f_s + tau with r in 0..3 and integer tau. */
#include <complex.h>
#include <math.h>

#include "sdk/map/grid/internal.h"

static double complex value(const qc__grid_build *b, int32_t c) {
    return b->uv[2 * (int64_t)c] + I * b->uv[2 * (int64_t)c + 1];
}

static double complex quarter_turns(double complex z, int r) {
    switch (r & 3) {
    case 1:
        return -cimag(z) + I * creal(z);
    case 2:
        return -z;
    case 3:
        return cimag(z) - I * creal(z);
    default:
        return z;
    }
}

static double max_norm(double complex z) {
    return fmax(fabs(creal(z)), fabs(cimag(z)));
}

/* Residual of f_t = i^r f_s + tau at both ends of the edge, tau rounded from their mean. */
static double residual(const double complex s[2], const double complex t[2], int r,
                       double complex *tau) {
    const double complex d0 = t[0] - quarter_turns(s[0], r), d1 = t[1] - quarter_turns(s[1], r);
    const double complex mean = 0.5 * (d0 + d1);
    *tau = round(creal(mean)) + I * round(cimag(mean));
    return fmax(max_norm(d0 - *tau), max_norm(d1 - *tau));
}

static qc_status seam_error(const qc__grid_build *b, int32_t e, double amount, bool ambiguous) {
    const qc_mesh *m = b->mesh;
    const int32_t h = m->edge_halfedge[2 * (int64_t)e], k = m->edge_halfedge[2 * (int64_t)e + 1];
    const int32_t v = m->edge_vertex[2 * (int64_t)e], w = m->edge_vertex[2 * (int64_t)e + 1];
    if (ambiguous)
        return qc__fail(b->ctx, QC_ERR_FAILED, e,
                        "edge %d (vertices %d, %d; faces %d, %d) is too short in the parameter "
                        "domain to tell the rotation across it; remove degenerate faces or try a "
                        "finer density",
                        (int)e, (int)v, (int)w, (int)(h / 3), (int)(k / 3));
    return qc__fail(
        b->ctx, QC_ERR_FAILED, e,
        "seam at edge %d (vertices %d, %d; faces %d, %d) is off by %.3g parameter units; "
        "the map must be integer-seamless to %.3g",
        (int)e, (int)v, (int)w, (int)(h / 3), (int)(k / 3), amount, b->tolerance);
}

static qc_status seam(qc__grid_build *b, int32_t e) {
    const int32_t h = b->mesh->edge_halfedge[2 * (int64_t)e];
    const int32_t k = b->mesh->edge_halfedge[2 * (int64_t)e + 1];
    if (k < 0) return QC_OK;
    const double complex s[2] = {value(b, qc_next(h)), value(b, qc_prev(h))};
    const double complex t[2] = {value(b, qc_prev(k)), value(b, qc_next(k))};
    double best = INFINITY, second = INFINITY;
    const int known = b->known_rotation ? b->known_rotation[e] & 3 : -1;
    for (int r = 0; r < 4; r++) {
        if (known >= 0 && r != known) continue;
        double complex tau;
        const double error = residual(s, t, r, &tau);
        if (error >= best) {
            second = fmin(second, error);
            continue;
        }
        second = best;
        best = error;
        b->rotation[e] = (int8_t)r;
        b->translation[2 * (int64_t)e] = (int32_t)creal(tau);
        b->translation[2 * (int64_t)e + 1] = (int32_t)cimag(tau);
    }
    if (best > b->tolerance) return seam_error(b, e, best, false);
    /* Noise of the doubles themselves; a second rotation which fits as well cannot be excluded. */
    const double noise = 1e-13 * (1 + max_norm(s[0]) + max_norm(t[0]));
    if (second <= 2 * best + noise) return seam_error(b, e, best, true);
    return QC_OK;
}

qc_status qc__grid_seams(qc__grid_build *b) {
    const int32_t n = b->mesh->n_edges;
    for (int32_t e = 0; e < n; e++) {
        if (e % 8192 == 0 && !qc__progress(b->ctx, 0.4 * e / n)) return QC_ERR_CANCELLED;
        const qc_status status = seam(b, e);
        if (status != QC_OK) return status;
    }
    return QC_OK;
}
