/* Bags: named, typed, shared objects in order of arrival. */
#include "sdk/pipeline/internal.h"
#include <string.h>

typedef struct item {
    char *name;
    const qc_object *object;
} item;

struct qc_bag {
    qc_ctx *ctx;
    item *item;
    int64_t n, capacity;
};

qc_status qc_bag_create(qc_ctx *ctx, qc_bag **out) {
    qc_bag *bag = QC__ZERO(ctx, qc_bag, 1);
    if (!bag) return QC_ERR_NOMEM;
    bag->ctx = ctx;
    *out = bag;
    return QC_OK;
}

static void drop(item dead) {
    qc__free(dead.name);
    qc_object_release(dead.object);
}

void qc_bag_free(qc_bag *bag) {
    if (!bag) return;
    /* Latest first: an object may need those made before it (a library's, a mesh's). */
    while (bag->n > 0) drop(bag->item[--bag->n]);
    qc__free(bag->item);
    qc__free(bag);
}

static int64_t find(const qc_bag *bag, const char *name) {
    for (int64_t i = 0; bag && i < bag->n; i++)
        if (strcmp(bag->item[i].name, name) == 0) return i;
    return -1;
}

static bool reserve(qc_bag *bag, int64_t more) {
    return qc__reserve(bag->ctx, (void **)&bag->item, &bag->capacity, bag->n + more, sizeof(item));
}

/* There is room. An object that replaces another counts as the latest arrival. */
static void append(qc_bag *bag, item new_item) {
    const int64_t old = find(bag, new_item.name);
    if (old >= 0) {
        const item dead = bag->item[old];
        bag->n--;
        memmove(bag->item + old, bag->item + old + 1, (size_t)(bag->n - old) * sizeof(item));
        drop(dead);
    }
    bag->item[bag->n++] = new_item;
}

qc_status qc__bag_take(qc_bag *bag, const char *step, const char *port, const qc_object *object) {
    const size_t before = step ? strlen(step) + 1 : 0, size = before + strlen(port) + 1;
    char *name = reserve(bag, 1) ? QC__NEW(bag->ctx, char, size) : NULL;
    if (!name) {
        qc_object_release(object);
        return QC_ERR_NOMEM;
    }
    if (step) {
        memcpy(name, step, before - 1);
        name[before - 1] = '.';
    }
    memcpy(name + before, port, size - before);
    append(bag, (item){name, object});
    return QC_OK;
}

qc_status qc_bag_put(qc_bag *bag, const char *name, const void *object) {
    const qc_object *o = object;
    if (!name || !*name || !o || !o->type)
        return qc__fail(bag->ctx, QC_ERR_ARGUMENT, -1,
                        "a bag takes a name and an object with a type");
    return qc__bag_take(bag, NULL, name, qc_object_retain(o));
}

qc_status qc__bag_absorb(qc_bag *target, qc_bag *source) {
    if (!reserve(target, source->n)) return QC_ERR_NOMEM;
    for (int64_t i = 0; i < source->n; i++) append(target, source->item[i]);
    source->n = 0;
    return QC_OK;
}

const void *qc_bag_get(const qc_bag *bag, const char *name) {
    const int64_t i = find(bag, name);
    return i < 0 ? NULL : bag->item[i].object;
}

const qc_object *qc__bag_output(const qc_bag *bag, const char *step, const char *port) {
    const size_t before = strlen(step);
    for (int64_t i = 0; bag && i < bag->n; i++) {
        const char *name = bag->item[i].name;
        if (strncmp(name, step, before) == 0 && name[before] == '.' &&
            strcmp(name + before + 1, port) == 0)
            return bag->item[i].object;
    }
    return NULL;
}

const void *qc_bag_latest(const qc_bag *bag, const char *type) {
    for (int64_t i = bag->n; i-- > 0;)
        if (strcmp(bag->item[i].object->type, type) == 0) return bag->item[i].object;
    return NULL;
}

uint32_t qc_bag_count(const qc_bag *bag) {
    return (uint32_t)bag->n;
}

const char *qc_bag_name(const qc_bag *bag, uint32_t i) {
    return i < bag->n ? bag->item[i].name : NULL;
}

const qc_object *qc__bag_object(const qc_bag *bag, uint32_t i) {
    return i < bag->n ? bag->item[i].object : NULL;
}
