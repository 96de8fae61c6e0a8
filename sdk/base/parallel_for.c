/* A fork-join loop over fixed chunks. Workers sleep between loops; chunks are handed out by one
 * atomic counter, so which thread runs a chunk varies but the chunks themselves never do. The
 * caller waits only for workers which joined: one that wakes up late finds the loop closed. */
#include "sdk/base/context_private.h"
#include <pthread.h>

struct qc__pool {
    pthread_mutex_t lock;
    pthread_cond_t work, done;
    uint32_t n_workers, joined;
    uint64_t generation;
    bool quit, busy, open; /* open: workers may still join the present loop */

    qc__body *body;
    void *arg;
    int64_t n, chunk;
    atomic_int_fast64_t next;
    pthread_t *thread;
    struct worker {
        qc__pool *pool;
        uint32_t index;
    } * worker;
};

static void run_chunks(qc__pool *pool, uint32_t worker) {
    for (;;) {
        const int64_t begin = (int64_t)atomic_fetch_add(&pool->next, pool->chunk);
        if (begin >= pool->n) return;
        const int64_t end = begin + pool->chunk < pool->n ? begin + pool->chunk : pool->n;
        pool->body(pool->arg, begin, end, worker);
    }
}

static void *worker_main(void *arg) {
    struct worker *self = arg;
    qc__pool *pool = self->pool;
    uint64_t seen = 0;
    pthread_mutex_lock(&pool->lock);
    for (;;) {
        while (!pool->quit && (!pool->open || pool->generation == seen))
            pthread_cond_wait(&pool->work, &pool->lock);
        if (pool->quit) break;
        seen = pool->generation;
        pool->joined++;
        pthread_mutex_unlock(&pool->lock);
        run_chunks(pool, self->index);
        pthread_mutex_lock(&pool->lock);
        if (--pool->joined == 0) pthread_cond_signal(&pool->done);
    }
    pthread_mutex_unlock(&pool->lock);
    return NULL;
}

void qc__pool_free(qc__pool *pool) {
    if (!pool) return;
    pthread_mutex_lock(&pool->lock);
    pool->quit = true;
    pthread_cond_broadcast(&pool->work);
    pthread_mutex_unlock(&pool->lock);
    for (uint32_t i = 0; i < pool->n_workers; i++) pthread_join(pool->thread[i], NULL);
    pthread_mutex_destroy(&pool->lock);
    pthread_cond_destroy(&pool->work);
    pthread_cond_destroy(&pool->done);
    qc__free(pool->thread);
    qc__free(pool->worker);
    qc__free(pool);
}

/* NULL when threads or memory cannot be had: the loop then runs on the calling thread. */
static qc__pool *pool_create(qc_ctx *ctx) {
    qc__pool *pool = QC__ZERO(ctx, qc__pool, 1);
    if (!pool) return NULL;
    pool->thread = QC__NEW(ctx, pthread_t, ctx->threads);
    pool->worker = QC__NEW(ctx, struct worker, ctx->threads);
    if (!pool->thread || !pool->worker) {
        qc__free(pool->thread);
        qc__free(pool->worker);
        qc__free(pool);
        return NULL;
    }
    pthread_mutex_init(&pool->lock, NULL);
    pthread_cond_init(&pool->work, NULL);
    pthread_cond_init(&pool->done, NULL);
    for (uint32_t i = 0; i + 1 < ctx->threads; i++) {
        pool->worker[i] = (struct worker){pool, i + 1};
        if (pthread_create(&pool->thread[i], NULL, worker_main, &pool->worker[i]) != 0) break;
        pool->n_workers++;
    }
    return pool;
}

static void run_serially(int64_t n, int64_t chunk, qc__body *body, void *arg) {
    for (int64_t begin = 0; begin < n; begin += chunk)
        body(arg, begin, begin + chunk < n ? begin + chunk : n, 0);
}

void qc__parallel_for(qc_ctx *ctx, int64_t n, int64_t chunk, qc__body *body, void *arg) {
    if (chunk < 1) chunk = 1;
    if (ctx->threads > 1 && n > chunk && !ctx->pool) {
        ctx->pool = pool_create(ctx);
        if (!ctx->pool) qc__clear_error(ctx);
    }
    qc__pool *pool = ctx->pool;
    if (!pool || pool->n_workers == 0 || n <= chunk) {
        run_serially(n, chunk, body, arg);
        return;
    }
    pthread_mutex_lock(&pool->lock);
    if (pool->busy) { /* nested */
        pthread_mutex_unlock(&pool->lock);
        run_serially(n, chunk, body, arg);
        return;
    }
    pool->busy = true;
    pool->body = body;
    pool->arg = arg;
    pool->n = n;
    pool->chunk = chunk;
    atomic_store(&pool->next, 0);
    pool->open = true;
    pool->generation++;
    pthread_cond_broadcast(&pool->work);
    pthread_mutex_unlock(&pool->lock);

    run_chunks(pool, 0);

    pthread_mutex_lock(&pool->lock);
    pool->open = false;
    while (pool->joined != 0) pthread_cond_wait(&pool->done, &pool->lock);
    pool->busy = false;
    pthread_mutex_unlock(&pool->lock);
}
