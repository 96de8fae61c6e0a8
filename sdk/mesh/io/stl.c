/* STL, ASCII and binary. Both are soups of separate triangles: three new vertices for each face. */
#include "internal.h"

#include <math.h>
#include <string.h>

static uint32_t little_u32(const char *p) {
    const unsigned char *b = (const unsigned char *)p;
    return (uint32_t)b[0] | (uint32_t)b[1] << 8 | (uint32_t)b[2] << 16 | (uint32_t)b[3] << 24;
}

bool qc__is_stl_binary(const char *data, size_t size) {
    return size >= 84 && (size - 84) % 50 == 0 && (size - 84) / 50 == little_u32(data + 80);
}

qc_status qc__read_stl_binary(qc__text *t, qc__soup *s) {
    s->binary = true;
    if (t->end - t->begin < 84)
        return qc__byte_fail(t, t->end,
                             "binary STL needs 84 bytes at least; the file is cut off, "
                             "export it again");
    int64_t n = little_u32(t->begin + 80), there = (t->end - t->begin - 84) / 50;
    if (n > there)
        return qc__byte_fail(t, t->end,
                             "the header promises %lld triangles but the file ends in "
                             "triangle %lld; it is cut off, export it again",
                             (long long)n, (long long)there);
    for (int64_t f = 0; f < n; f++) {
        if (!qc__soup_face(s, f + 1, 0)) return QC_ERR_NOMEM;
        t->p = t->begin + 84 + 50 * f;
        for (int k = 0; k < 3; k++) {
            double xyz[3];
            for (int i = 0; i < 3; i++) {
                uint32_t bits = little_u32(t->p + 12 + 12 * k + 4 * i);
                float value;
                memcpy(&value, &bits, sizeof value);
                xyz[i] = (double)value;
                if (!isfinite(xyz[i]))
                    return qc__byte_fail(t, t->p,
                                         "triangle %lld has a coordinate which is not "
                                         "finite; remove it or export the mesh again",
                                         (long long)f);
            }
            if (!qc__soup_corner(s, s->n_position / 3, -1) || !qc__soup_vertex(s, xyz))
                return QC_ERR_NOMEM;
        }
        if (f % 16384 == 0 && !qc__text_progress(t)) return QC_ERR_CANCELLED;
    }
    return QC_OK;
}

/* The end of a loop: the facet which was open must be a triangle or a polygon. */
static qc_status close_loop(qc__text *t, int64_t corners, int64_t facet) {
    if (corners >= 3) return QC_OK;
    return qc__text_fail(t, t->line,
                         "facet %lld has %lld vertices, at least 3 are needed; the file is "
                         "damaged, export it again",
                         (long long)facet, (long long)corners);
}

qc_status qc__read_stl_ascii(qc__text *t, qc__soup *s) {
    int64_t corners = -1; /* of the open loop, -1 = none is open */
    double xyz[3];
    for (int64_t i = 0;; i++) {
        qc_status status = QC_OK;
        qc__skip_space(t);
        if (t->p == t->end) break;
        if (qc__take_word(t, "vertex")) {
            if (corners < 0)
                return qc__text_fail(t, t->line,
                                     "a vertex outside of 'outer loop'; the file is "
                                     "damaged, export it again");
            status = qc__take_point(t, "vertex", s->n_position / 3, xyz);
            if (status != QC_OK) return status;
            if ((corners == 0 && !qc__soup_face(s, t->line, 0)) ||
                !qc__soup_corner(s, s->n_position / 3, -1) || !qc__soup_vertex(s, xyz))
                return QC_ERR_NOMEM;
            corners++;
        } else if (qc__take_word(t, "outer") || qc__take_word(t, "endloop")) {
            bool begin = corners < 0;
            if (!begin) status = close_loop(t, corners, s->n_face);
            qc__skip_blanks(t);
            corners = begin && qc__take_word(t, "loop") ? 0 : -1;
        } else if (qc__take_word(t, "solid") || qc__take_word(t, "endsolid")) {
            qc__skip_line(t); /* a name may hold any words */
        } else {
            t->p += qc__word_length(t); /* facet, normal and its numbers, endfacet */
        }
        if (status != QC_OK) return status;
        if (i % 16384 == 0 && !qc__text_progress(t)) return QC_ERR_CANCELLED;
    }
    if (corners >= 0)
        return qc__text_fail(t, t->line,
                             "the file ends inside a facet; it is cut off, export it again");
    return QC_OK;
}
