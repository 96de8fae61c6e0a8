/* Planned places never overlap while blocks live, gaps are used again, and many blocks are quick.
 */
#include "sdk/sparse/analyze/area.h"
#include "support.h"

static void live_blocks_never_overlap(void **state) {
    (void)state;
    enum { N = 4000 };
    qc_ctx *ctx = new_ctx(1);
    int64_t *offset = calloc(N, sizeof *offset), *size = calloc(N, sizeof *size), most = 0, sum = 0;
    bool *live = calloc(N, sizeof *live);
    qc__area area;
    assert_int_equal(qc__area_create(ctx, N, offset, &area), QC_OK);
    for (int32_t b = 0; b < N; b++) {
        size[b] = pick(30);
        qc__area_place(&area, b, size[b]);
        for (int32_t c = 0; c < b; c++)
            if (live[c] && size[c] > 0 && size[b] > 0)
                assert_true(offset[b] + size[b] <= offset[c] || offset[c] + size[c] <= offset[b]);
        live[b] = true;
        sum += size[b];
        if (sum > most) most = sum;
        while (sum > 600) { /* as a tree would: some of the older ones end */
            const int32_t c = pick(b + 1);
            if (!live[c]) continue;
            qc__area_release(&area, c);
            live[c] = false;
            sum -= size[c];
        }
    }
    assert_true(area.total >= most && area.total < 2 * most);
    qc__area_free(&area);
    free(offset);
    free(size);
    free(live);
    qc_ctx_free(ctx);
}

/* Quadratic work would take minutes. */
static void a_star_is_planned_in_linear_time(void **state) {
    (void)state;
    enum { N = 1000000 };
    qc_ctx *ctx = new_ctx(1);
    int64_t *offset = calloc(N, sizeof *offset);
    qc__area area;
    assert_int_equal(qc__area_create(ctx, N, offset, &area), QC_OK);
    for (int32_t b = 0; b < N; b++) qc__area_place(&area, b, 1);
    assert_true(area.total == N);
    for (int32_t b = 0; b < N; b += 2) qc__area_release(&area, b); /* gaps too small for 2 */
    for (int32_t b = 0; b < N; b += 2) qc__area_place(&area, b, 2);
    assert_true(area.total == 2 * (int64_t)N);
    qc__area_free(&area);
    free(offset);
    qc_ctx_free(ctx);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(live_blocks_never_overlap),
        cmocka_unit_test(a_star_is_planned_in_linear_time),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
