/* Memory and cancellation of the host: the library allocates through one callback and asks another
 * one whether to go on. Cancelled in the middle, it has given everything back. */
#include <qc/qc.h>
#include <stdatomic.h>
#include <stdio.h>
#include <stdlib.h>

typedef struct host {
    atomic_size_t bytes; /* in use; resize is called from any thread */
    int calls;
} host;

static void *resize(void *user, void *p, size_t old_size, size_t new_size) {
    host *h = user;
    void *q = NULL;
    if (new_size == 0)
        free(p);
    else if (!(q = realloc(p, new_size)))
        return NULL; /* p is untouched; the call under way answers QC_ERR_NOMEM */
    atomic_fetch_add(&h->bytes, new_size - old_size);
    return q;
}

/* Called by the calling thread only, several times a second; false = stop. */
static bool progress(void *user, const char *stage, double fraction) {
    host *h = user;
    (void)stage;
    (void)fraction;
    return ++h->calls < 3;
}

int main(void) {
    static host h;
    qc_ctx_options options = QC_CTX_OPTIONS_INIT;
    options.resize = resize;
    options.progress = progress;
    options.user = &h;
    qc_ctx *ctx = NULL;
    qc_mesh *mesh = NULL;
    if (qc_ctx_create(&options, &ctx) != QC_OK) return 1;
    qc_shape_options shape = QC_SHAPE_OPTIONS_INIT;
    shape.resolution = 200000;
    qc_status status = qc_shape_create(ctx, "sphere", &shape, &mesh);
    const size_t before = atomic_load(&h.bytes);
    uint8_t *cut = mesh ? calloc((size_t)mesh->n_edges, 1) : NULL;
    if (status == QC_OK && cut) status = qc_mesh_cut_graph(ctx, mesh, NULL, NULL, cut);
    printf("%s, %zu bytes left behind by the call\n", qc_status_name(status),
           atomic_load(&h.bytes) - before);
    free(cut);
    qc_object_release(mesh);
    qc_ctx_free(ctx);
    printf("%zu bytes left behind at the end\n", atomic_load(&h.bytes));
    return 0;
}
