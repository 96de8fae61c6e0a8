/* Deterministic mutations of small files of every format: never a crash, never memory out of
 * proportion, and either a valid mesh or one line of error with status INPUT. */
#include "unit/mesh_io/common.h"
#include "unit/mesh_io/cube.h"
#include "unit/mesh_io/rich.h"

enum { ROUNDS = 1500 };

static uint64_t random_below(uint64_t *s, uint64_t n) {
    *s ^= *s << 13;
    *s ^= *s >> 7;
    *s ^= *s << 17;
    return (*s >> 11) % n;
}

static size_t limit_hit;
static void *resize(void *user, void *p, size_t old_size, size_t new_size) {
    (void)user, (void)old_size;
    if (new_size == 0) {
        free(p);
        return NULL;
    }
    if (new_size > (size_t)1 << 20)
        limit_hit++; /* files here have 4 KB at most                      */
    return realloc(p, new_size);
}

static void mutate(bytes *b, uint64_t *seed) {
    static const char *const words[] = {"-1",
                                        "nan",
                                        "inf",
                                        "4294967295",
                                        "99999999999",
                                        "0",
                                        "\\\n",
                                        "/",
                                        "v ",
                                        "f ",
                                        "\n",
                                        "#",
                                        "1e400",
                                        "-",
                                        "element face 7\n",
                                        "property list char int x\n",
                                        "end_header\n",
                                        "OFF\n",
                                        "solid ",
                                        "endloop",
                                        "outer loop",
                                        "\r",
                                        "2 ",
                                        "l 1 2 "};
    for (uint64_t n = 1 + random_below(seed, 4); n > 0; n--) {
        size_t at = (size_t)random_below(seed, b->n + 1);
        const char *word = words[random_below(seed, sizeof words / sizeof *words)];
        size_t length = strlen(word), cut;
        switch (random_below(seed, 5)) {
        case 0: /* one byte */
            if (at < b->n) b->data[at] = (char)random_below(seed, 256);
            break;
        case 1: /* one bit */
            if (at < b->n) b->data[at] = (char)(b->data[at] ^ (1 << random_below(seed, 8)));
            break;
        case 2: /* insert a word */
            if (b->n + length > sizeof b->data) break;
            memmove(b->data + at + length, b->data + at, b->n - at);
            memcpy(b->data + at, word, length);
            b->n += length;
            break;
        case 3: /* remove some bytes */
            cut = (size_t)random_below(seed, 1 + (b->n - at < 30 ? b->n - at : 30));
            memmove(b->data + at, b->data + at + cut, b->n - at - cut);
            b->n -= cut;
            break;
        default: /* cut off, rarely */
            if (random_below(seed, 4) == 0) b->n = at;
        }
    }
}

static void check_mesh(qc_ctx *ctx, const qc_polygon_mesh *m) {
    assert_int_equal(m->face_offset[0], 0);
    assert_int_equal(m->face_offset[m->n_faces], m->n_corners);
    for (int32_t f = 0; f < m->n_faces; f++)
        assert_true(m->face_offset[f + 1] - m->face_offset[f] >= 3);
    for (int32_t c = 0; c < m->n_corners; c++) {
        assert_in_range(m->face_vertex[c], 0, m->n_vertices - 1);
        if (m->corner_uv) assert_true(m->corner_uv[c] >= -1 && m->corner_uv[c] < m->n_uvs);
    }
    for (int32_t i = 0; i < 2 * m->n_lines; i++) assert_in_range(m->line[i], 0, m->n_vertices - 1);
    qc_mesh *mesh = NULL;
    qc_status status = qc_mesh_repair(ctx, m, &mesh, NULL);
    if (status != QC_OK && status != QC_ERR_INPUT) print_error("%s\n", qc_ctx_error(ctx)->text);
    assert_true(status == QC_OK || status == QC_ERR_INPUT);
    qc_object_release(mesh);
}

static void test_mutations(void **state) {
    (void)state;
    qc_ctx_options options = QC_CTX_OPTIONS_INIT;
    options.resize = resize;
    options.threads = 1;
    qc_ctx *ctx = NULL;
    assert_int_equal(qc_ctx_create(&options, &ctx), QC_OK);
    int good = 0;
    for (int format = 0; format <= CUBE_FORMATS; format++) {
        const bool rich = format == CUBE_FORMATS;
        uint64_t seed = 88172645463325252u + (uint64_t)format;
        for (int round = 0; round < ROUNDS; round++) {
            static bytes b;
            qc_polygon_mesh *m = NULL;
            if (rich)
                memcpy(b.data, RICH_PLY, b.n = sizeof RICH_PLY - 1);
            else
                cube_bytes(format, &b);
            mutate(&b, &seed);
            qc_status status =
                parse_bytes(ctx, b.data, b.n, rich ? "a.ply" : CUBE_NAME[format], &m);
            if (status == QC_OK) {
                good++;
                check_mesh(ctx, m);
                qc_object_release(m);
                continue;
            }
            assert_null(m);
            assert_int_equal(status, QC_ERR_INPUT);
            assert_null(strpbrk(qc_ctx_error(ctx)->text, "\r\n"));
            assert_true(qc_ctx_error(ctx)->where >= 0 &&
                        qc_ctx_error(ctx)->where <= (int64_t)sizeof b.data);
        }
    }
    qc_ctx_free(ctx);
    assert_true(good > ROUNDS / 2);
    assert_int_equal(limit_hit, 0);
}

int main(void) {
    const struct CMUnitTest tests[] = {cmocka_unit_test(test_mutations)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
