/* Stage tables of any compatible header, checked and copied into this header's layout. */
#include "sdk/pipeline/internal.h"
#include <math.h>
#include <stdalign.h>
#include <string.h>

/* The members a table must have; everything after them may be missing (older) or follow (newer). */
enum {
    STAGE_MINIMUM = sizeof(qc_stage), /* run is the last member of the first release */
    PORT_MINIMUM = offsetof(qc_port, doc),
    PARAM_MINIMUM = offsetof(qc_param, unit),
    STRIDE_MAXIMUM = 1 << 12
};

const char *qc__short_id(const char *id) {
    return strncmp(id, "qc.", 3) == 0 ? id + 3 : id;
}

bool qc__is_name(const char *text, const char *extra) {
    if (!text) return false;
    size_t n = 0;
    for (; text[n]; n++) {
        const char c = text[n];
        const bool plain =
            (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9');
        if (n == 63 || (!plain && !strchr(extra, c))) return false;
    }
    return n > 0;
}

char *qc__copy_text(qc_ctx *ctx, const char *text) {
    const size_t size = strlen(text) + 1;
    char *copy = QC__NEW(ctx, char, size);
    if (copy) memcpy(copy, text, size);
    return copy;
}

qc__hint qc__closest_hint(qc_ctx *ctx, const char *wanted, const void *names, int64_t n,
                          size_t stride) {
    qc__hint hint = {""};
    const char **list = QC__NEW(ctx, const char *, n);
    for (int64_t i = 0; list && i < n; i++)
        memcpy(&list[i], (const char *)names + (size_t)i * stride, sizeof *list);
    const char *closest = list ? qc_closest_name(wanted, list, (size_t)n) : NULL;
    if (closest) snprintf(hint.text, sizeof hint.text, " (closest: '%s')", closest);
    qc__free(list);
    return hint;
}

/* n structs of `from` bytes each -> n structs of `to` bytes, missing members zero. */
static void *copy_array(qc_ctx *ctx, qc__arena *arena, const void *array, uint32_t n, size_t from,
                        size_t to) {
    char *copy = qc__arena_alloc(arena, (size_t)n * to + 1);
    if (!copy) {
        qc__nomem(ctx);
        return NULL;
    }
    memset(copy, 0, (size_t)n * to + 1);
    for (uint32_t i = 0; i < n; i++)
        memcpy(copy + i * to, (const char *)array + i * from, from < to ? from : to);
    return copy;
}

static void never_null(const char **text) {
    if (!*text) *text = "";
}

static qc_status check_ports(qc_ctx *ctx, const char *id, qc_port *port, uint32_t n) {
    for (uint32_t i = 0; i < n; i++) {
        if (!qc__is_name(port[i].name, "_-") || !port[i].type || !*port[i].type)
            return qc__fail(ctx, QC_ERR_ARGUMENT, i,
                            "stage '%s': port %u needs a name (letters, digits, _ -) and a type",
                            id, i);
        for (uint32_t j = 0; j < i; j++)
            if (strcmp(port[i].name, port[j].name) == 0)
                return qc__fail(ctx, QC_ERR_ARGUMENT, i, "stage '%s': port '%s' appears twice", id,
                                port[i].name);
        never_null(&port[i].doc);
    }
    return QC_OK;
}

static size_t size_of_type(int32_t type) {
    static const size_t size[] = {
        0, sizeof(bool), sizeof(int64_t), sizeof(double), sizeof(int32_t), sizeof(const char *)};
    return type >= QC_BOOL && type <= QC_TEXT ? size[type] : 0;
}

static size_t alignment_of_type(int32_t type) {
    static const size_t alignment[] = {1,
                                       alignof(bool),
                                       alignof(int64_t),
                                       alignof(double),
                                       alignof(int32_t),
                                       alignof(const char *)};
    return alignment[type];
}

/* What is wrong with a parameter's numbers; NULL = nothing. Sets the range of bools and enums. */
static const char *wrong_range(qc_param *p) {
    if (p->type == QC_TEXT) return NULL;
    if (p->type == QC_BOOL) p->min = 0, p->max = 1;
    if (p->type == QC_ENUM) {
        uint32_t n = 0;
        while (p->choices && p->choices[n]) n++;
        if (n == 0) return "has no choices";
        p->min = 0, p->max = n - 1;
    }
    if (!(p->min <= p->max)) return "has an empty range";
    if (!(p->def >= p->min && p->def <= p->max)) return "has a default outside its range";
    if (p->type != QC_REAL && p->def != floor(p->def)) return "has a fractional default";
    if (p->type == QC_INT && fabs(p->def) > 0x1p53) return "has a default beyond 2^53";
    return NULL;
}

static qc_status check_params(qc_ctx *ctx, const qc_stage *stage, qc_param *param) {
    for (uint32_t i = 0; i < stage->n_params; i++) {
        qc_param *p = &param[i];
        const size_t size = size_of_type(p->type);
        const char *wrong = NULL;
        if (!qc__is_name(p->name, "_-"))
            wrong = "needs a name (letters, digits, _ -)";
        else if (size == 0)
            wrong = "has an unknown type";
        else if (p->offset % alignment_of_type(p->type) != 0 || p->offset > stage->params_size ||
                 stage->params_size - p->offset < size)
            wrong = "lies outside the params struct or is misaligned";
        else
            wrong = wrong_range(p);
        for (uint32_t j = 0; j < i && !wrong; j++)
            if (strcmp(p->name, param[j].name) == 0) wrong = "appears twice";
        if (wrong)
            return qc__fail(ctx, QC_ERR_ARGUMENT, i, "stage '%s': parameter %u ('%s') %s",
                            stage->id, i, p->name ? p->name : "", wrong);
        never_null(&p->unit);
        never_null(&p->doc);
    }
    return QC_OK;
}

static bool stride_fits(uint32_t size, uint32_t minimum, uint32_t n) {
    return n == 0 || (size >= minimum && size <= STRIDE_MAXIMUM && size % alignof(void *) == 0);
}

/* The head of a table, enough to copy its arrays safely. */
static qc_status check_head(qc_ctx *ctx, const qc_stage *s) {
    if (!qc__is_name(s->id, "._-"))
        return qc__fail(ctx, QC_ERR_ARGUMENT, -1,
                        "a stage needs an id of letters, digits and . _ - (at most 63)");
    if (!stride_fits(s->port_size, PORT_MINIMUM, s->n_in + s->n_out) ||
        !stride_fits(s->param_size, PARAM_MINIMUM, s->n_params))
        return qc__fail(ctx, QC_ERR_ABI, -1,
                        "stage '%s': port_size %u or param_size %u does not fit this library",
                        s->id, s->port_size, s->param_size);
    const char *wrong = NULL;
    if (s->n_in > 1000 || s->n_out > 1000 || s->n_params > 1000 || s->params_size > 1 << 20)
        wrong = "has implausible counts";
    else if ((s->n_in && !s->in) || (s->n_out && !s->out) || (s->n_params && !s->params))
        wrong = "has a NULL array of ports or parameters";
    else if (!s->run)
        wrong = "has no run function";
    return wrong ? qc__fail(ctx, QC_ERR_ARGUMENT, -1, "stage '%s' %s", s->id, wrong) : QC_OK;
}

qc_status qc__table_import(qc_ctx *ctx, qc__arena *arena, const qc_stage *table,
                           const qc_stage **out) {
    if (!table) return qc__fail(ctx, QC_ERR_ARGUMENT, -1, "no stage given");
    if (table->struct_size < STAGE_MINIMUM)
        return qc__fail(ctx, QC_ERR_ABI, -1, "a stage table of %u bytes is too short (%u needed)",
                        table->struct_size, (unsigned)STAGE_MINIMUM);
    qc_stage *s = qc__arena_alloc(arena, sizeof *s);
    if (!s) return qc__nomem(ctx);
    memcpy(s, table, sizeof *s);
    qc_status status = check_head(ctx, s);
    if (status != QC_OK) return status;

    qc_port *in = copy_array(ctx, arena, s->in, s->n_in, s->port_size, sizeof *in);
    qc_port *outputs = copy_array(ctx, arena, s->out, s->n_out, s->port_size, sizeof *outputs);
    qc_param *params =
        copy_array(ctx, arena, s->params, s->n_params, s->param_size, sizeof *params);
    if (!in || !outputs || !params) return QC_ERR_NOMEM;
    if ((status = check_ports(ctx, s->id, in, s->n_in)) != QC_OK ||
        (status = check_ports(ctx, s->id, outputs, s->n_out)) != QC_OK ||
        (status = check_params(ctx, s, params)) != QC_OK)
        return status;

    s->struct_size = sizeof *s;
    s->port_size = sizeof *in;
    s->param_size = sizeof *params;
    s->in = in;
    s->out = outputs;
    s->params = params;
    never_null(&s->version);
    never_null(&s->brief);
    never_null(&s->doc);
    never_null(&s->cite);
    *out = s;
    return QC_OK;
}

static const void *element(const void *array, uint32_t i, uint32_t n, uint32_t stride) {
    return i < n ? (const char *)array + (size_t)i * stride : NULL;
}

const qc_port *qc_stage_in(const qc_stage *stage, uint32_t i) {
    return element(stage->in, i, stage->n_in, stage->port_size);
}

const qc_port *qc_stage_out(const qc_stage *stage, uint32_t i) {
    return element(stage->out, i, stage->n_out, stage->port_size);
}

const qc_param *qc_stage_param(const qc_stage *stage, uint32_t i) {
    return element(stage->params, i, stage->n_params, stage->param_size);
}
