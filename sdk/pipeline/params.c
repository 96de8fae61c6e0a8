/* Parameters: defaults from the table into a params struct, text <-> value with range checks. */
#include "sdk/pipeline/internal.h"
#include <errno.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

static void store(const qc_param *p, void *params, double value) {
    char *member = (char *)params + p->offset;
    const bool b = value != 0;
    const int64_t i = p->type == QC_INT ? (int64_t)value : 0;
    const int32_t e = p->type == QC_ENUM ? (int32_t)value : 0;
    switch (p->type) {
    case QC_BOOL:
        memcpy(member, &b, sizeof b);
        break;
    case QC_INT:
        memcpy(member, &i, sizeof i);
        break;
    case QC_REAL:
        memcpy(member, &value, sizeof value);
        break;
    case QC_ENUM:
        memcpy(member, &e, sizeof e);
        break;
    default:
        break; /* QC_TEXT: NULL from the zeroed block */
    }
}

void *qc__params_create(qc_ctx *ctx, const qc_stage *stage) {
    void *params = qc__calloc(ctx, 1, (size_t)stage->params_size + 1);
    for (uint32_t i = 0; params && i < stage->n_params; i++)
        store(&stage->params[i], params, stage->params[i].def);
    return params;
}

int32_t qc__params_find(qc_ctx *ctx, const qc_stage *stage, const char *step, const char *name) {
    for (uint32_t i = 0; i < stage->n_params; i++)
        if (strcmp(stage->params[i].name, name) == 0) return (int32_t)i;
    qc__fail(ctx, QC_ERR_NOT_FOUND, -1, "unknown parameter '%.100s' of stage '%s'%s", name, step,
             qc__closest_hint(ctx, name, stage->params, stage->n_params, sizeof(qc_param)).text);
    return -1;
}

static bool in_range(const qc_param *p, double value) {
    return value >= p->min && value <= p->max;
}

static qc_status refuse_range(qc_ctx *ctx, const qc_param *p, const char *step, const char *text) {
    char lo[64], hi[64];
    qc__print_double(lo, sizeof lo, p->min);
    qc__print_double(hi, sizeof hi, p->max);
    return qc__fail(ctx, QC_ERR_ARGUMENT, -1,
                    "parameter '%s' of stage '%s' is %s, not in [%s, %s]%s%s", p->name, step, text,
                    lo, hi, *p->unit ? " " : "", p->unit);
}

static qc_status refuse_text(qc_ctx *ctx, const qc_param *p, const char *step, const char *text,
                             const char *wanted) {
    return qc__fail(ctx, QC_ERR_ARGUMENT, -1, "parameter '%s' of stage '%s' is '%.100s', not %s",
                    p->name, step, text, wanted);
}

static qc_status set_bool(qc_ctx *ctx, const qc_param *p, const char *step, void *params,
                          const char *text) {
    static const char *const words[] = {"false", "true", "0", "1", "no", "yes", "off", "on"};
    for (size_t i = 0; i < sizeof words / sizeof *words; i++)
        if (strcmp(text, words[i]) == 0) {
            store(p, params, i % 2 ? 1.0 : 0.0);
            return QC_OK;
        }
    return refuse_text(ctx, p, step, text, "true or false");
}

/* "12", and "1e6" or "2.0" as long as the value is whole. */
static qc_status set_int(qc_ctx *ctx, const qc_param *p, const char *step, void *params,
                         const char *text) {
    char *end;
    errno = 0;
    long long value = strtoll(text, &end, 10);
    if (end == text || *end != '\0' || errno != 0) {
        const double real = qc__parse_double(text, &end);
        if (end == text || *end != '\0' || real != floor(real))
            return refuse_text(ctx, p, step, text, "a whole number");
        if (!(fabs(real) <= 0x1p53)) return refuse_range(ctx, p, step, text);
        value = (long long)real;
    }
    if (!in_range(p, (double)value)) return refuse_range(ctx, p, step, text);
    const int64_t member = value;
    memcpy((char *)params + p->offset, &member, sizeof member);
    return QC_OK;
}

static qc_status set_real(qc_ctx *ctx, const qc_param *p, const char *step, void *params,
                          const char *text) {
    char *end;
    const double value = qc__parse_double(text, &end);
    if (end == text || *end != '\0' || isnan(value))
        return refuse_text(ctx, p, step, text, "a number");
    if (!in_range(p, value)) return refuse_range(ctx, p, step, text);
    store(p, params, value);
    return QC_OK;
}

static qc_status set_enum(qc_ctx *ctx, const qc_param *p, const char *step, void *params,
                          const char *text) {
    char list[256] = "one of";
    size_t n = 0, used = strlen(list);
    for (; p->choices[n]; n++) {
        if (strcmp(p->choices[n], text) == 0) {
            store(p, params, (double)n);
            return QC_OK;
        }
        const int more = snprintf(list + used, sizeof list - used, " %s", p->choices[n]);
        used = used + (size_t)more < sizeof list ? used + (size_t)more : sizeof list - 1;
    }
    const char *closest = qc_closest_name(text, p->choices, n);
    if (closest) snprintf(list + used, sizeof list - used, " (closest: '%s')", closest);
    return refuse_text(ctx, p, step, text, list);
}

qc_status qc__param_set(qc_ctx *ctx, const qc_param *param, const char *step, void *params,
                        const char *text) {
    const char *member = *text ? text : NULL;
    switch (param->type) {
    case QC_BOOL:
        return set_bool(ctx, param, step, params, text);
    case QC_INT:
        return set_int(ctx, param, step, params, text);
    case QC_REAL:
        return set_real(ctx, param, step, params, text);
    case QC_ENUM:
        return set_enum(ctx, param, step, params, text);
    default:
        memcpy((char *)params + param->offset, &member, sizeof member);
        return QC_OK;
    }
}

const char *qc__param_print(const qc_param *param, const void *params, char *number) {
    const char *member = (const char *)params + param->offset, *text;
    bool b;
    int64_t i;
    int32_t e;
    double r;
    switch (param->type) {
    case QC_BOOL:
        memcpy(&b, member, sizeof b);
        return b ? "true" : "false";
    case QC_INT:
        memcpy(&i, member, sizeof i);
        snprintf(number, 64, "%lld", (long long)i);
        return number;
    case QC_REAL:
        memcpy(&r, member, sizeof r);
        qc__print_double(number, 64, r);
        return number;
    case QC_ENUM:
        memcpy(&e, member, sizeof e);
        return param->choices[e];
    default:
        memcpy(&text, member, sizeof text);
        return text;
    }
}

qc_status qc__params_check(qc_ctx *ctx, const qc_stage *stage, const char *step,
                           const void *params) {
    for (uint32_t k = 0; k < stage->n_params; k++) {
        const qc_param *p = &stage->params[k];
        const char *member = (const char *)params + p->offset;
        double value = p->def;
        int64_t i;
        int32_t e;
        if (p->type == QC_INT) memcpy(&i, member, sizeof i), value = (double)i;
        if (p->type == QC_REAL) memcpy(&value, member, sizeof value);
        if (p->type == QC_ENUM) memcpy(&e, member, sizeof e), value = e;
        if (p->type == QC_TEXT || in_range(p, value)) continue;
        char text[64];
        qc__print_double(text, sizeof text, value);
        return refuse_range(ctx, p, step, text);
    }
    return QC_OK;
}
