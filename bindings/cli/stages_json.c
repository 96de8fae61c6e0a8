/* The registered stages as JSON: the same tables the pipeline runs from. */
#include "bindings/cli/cli.h"
#include <jansson.h>

static const char *const type_names[] = {"", "bool", "int", "real", "enum", "text"};

static json_t *port_json(const qc_port *port) {
    return json_pack("{s:s,s:s,s:b,s:s}", "name", port->name, "type", port->type, "optional",
                     (port->flags & QC_PORT_OPTIONAL) != 0, "doc", port->doc);
}

static json_t *default_json(const qc_param *p) {
    switch (p->type) {
    case QC_BOOL:
        return json_boolean(p->def != 0);
    case QC_INT:
        return json_integer((json_int_t)p->def);
    case QC_REAL:
        return json_real(p->def);
    case QC_ENUM:
        return json_string(p->choices[(int)p->def]);
    default:
        return json_null();
    }
}

static json_t *param_json(const qc_param *p) {
    json_t *json = json_pack("{s:s,s:s,s:o,s:s,s:s}", "name", p->name, "type", type_names[p->type],
                             "default", default_json(p), "unit", p->unit, "doc", p->doc);
    if (p->type == QC_INT || p->type == QC_REAL) {
        json_object_set_new(json, "min", json_real(p->min));
        json_object_set_new(json, "max", json_real(p->max));
    }
    if (p->type == QC_TEXT && p->choices)
        json_object_set_new(json, "interface", json_string(p->choices[0]));
    if (p->type == QC_ENUM) {
        json_t *choices = json_array();
        for (int i = 0; p->choices[i]; i++)
            json_array_append_new(choices, json_string(p->choices[i]));
        json_object_set_new(json, "choices", choices);
    }
    return json;
}

static json_t *stage_json(const qc_stage *stage) {
    json_t *in = json_array(), *out = json_array(), *params = json_array();
    for (uint32_t i = 0; i < stage->n_in; i++)
        json_array_append_new(in, port_json(qc_stage_in(stage, i)));
    for (uint32_t i = 0; i < stage->n_out; i++)
        json_array_append_new(out, port_json(qc_stage_out(stage, i)));
    for (uint32_t i = 0; i < stage->n_params; i++)
        json_array_append_new(params, param_json(qc_stage_param(stage, i)));
    return json_pack("{s:s,s:s,s:s,s:s,s:s,s:o,s:o,s:o}", "id", stage->id, "version",
                     stage->version, "brief", stage->brief, "doc", stage->doc, "cite", stage->cite,
                     "in", in, "out", out, "params", params);
}

char *cli_stages_json(qc_registry *registry, const qc_stage *one) {
    json_t *list = json_array();
    for (uint32_t i = 0; !one && i < qc_registry_count(registry); i++)
        json_array_append_new(list, stage_json(qc_registry_stage(registry, i)));
    if (one) json_array_append_new(list, stage_json(one));
    json_t *root = json_pack("{s:s,s:o}", "quadcover", qc_version(), "stages", list);
    char *text = json_dumps(root, JSON_INDENT(2) | JSON_REAL_PRECISION(12));
    json_decref(root);
    return text;
}
