/* Sorting, heap and union-find against their definitions. */
#include "sdk/mesh/internal.h"
#include "unit/mesh/fixtures.h"

enum { N = 5000 };

static void test_keys(void **state) {
    static uint64_t key[N];
    static int32_t index[N];
    static double x[N];
    for (int i = 0; i < N; i++) {
        x[i] = i % 17 == 0 ? 3.25 : ldexp((i * 7919) % 1009, i % 40 - 20);
        key[i] = qc__sort_key(x[i]);
        index[i] = i;
    }
    assert_int_equal(qc__sort_keys(*state, N, key, index), QC_OK);
    for (int i = 1; i < N; i++) {
        assert_true(x[index[i - 1]] <= x[index[i]]);
        assert_true(x[index[i - 1]] < x[index[i]] || index[i - 1] < index[i]); /* stable */
    }
    assert_true(qc__sort_key(-0.0) == qc__sort_key(0.0));
    assert_int_equal(qc__sort_keys(*state, 0, key, index), QC_OK);
}

static void test_pairs(void **state) {
    static int32_t a[N], b[N], order[N];
    for (int i = 0; i < N; i++) {
        a[i] = i * 31 % 97;
        b[i] = i * 57 % 89;
    }
    assert_int_equal(qc__sort_pairs(*state, 100, N, a, b, order), QC_OK);
    for (int i = 1; i < N; i++) {
        int32_t p = order[i - 1], q = order[i];
        assert_true(a[p] < a[q] || (a[p] == a[q] && (b[p] < b[q] || (b[p] == b[q] && p < q))));
    }
}

static void test_heap(void **state) {
    static double key[N];
    qc__heap heap;
    assert_int_equal(qc__heap_create(*state, N, key, &heap), QC_OK);
    for (int i = 0; i < N; i++) {
        key[i] = 10 + i * 7919 % 1009;
        qc__heap_push(&heap, i);
    }
    for (int i = 0; i < N; i += 3) {
        key[i] -= 9.5;
        qc__heap_push(&heap, i);
    }
    int32_t last = qc__heap_pop(&heap);
    for (int i = 1; i < N; i++) {
        int32_t next = qc__heap_pop(&heap);
        assert_true(key[last] < key[next] || (key[last] == key[next] && last < next));
        last = next;
    }
    assert_int_equal(heap.n, 0);
    qc__heap_free(&heap);
}

static void test_sets(void **state) {
    (void)state;
    static int32_t parent[N];
    qc__sets_init(parent, N);
    for (int i = N - 1; i >= 7; i--) assert_true(qc__sets_unite(parent, i, i - 7));
    assert_false(qc__sets_unite(parent, 8, 4999 - (4999 - 1) % 7));
    for (int i = 0; i < N; i++) assert_int_equal(qc__sets_find(parent, i), i % 7);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_keys),
        cmocka_unit_test(test_pairs),
        cmocka_unit_test(test_heap),
        cmocka_unit_test(test_sets),
    };
    return cmocka_run_group_tests(tests, set_up, tear_down);
}
