/* Hard features on models: room, exact crosses, open sectors, at every step. */
#include "hard.h"
#include "read_mesh.h"

static void models_keep_their_features(void **state) {
    qc_ctx *ctx = *state;
    const char *names[] = {"fandisk.off", "rocker-arm.obj", "botijo.obj", "cylinder.obj",
                           "planexy.off", "beetle.off",     "cow.off"};
    for (size_t i = 0; i < sizeof names / sizeof *names; i++) {
        char path[64];
        snprintf(path, sizeof path, "meshes/%s", names[i]);
        qc_mesh *mesh = read_mesh(ctx, path);
        qc_features *f = pruned_features(ctx, mesh, 2 * sqrt(mesh->area / 5000));
        check_room(f);
        qc_matching *m = hard_matching(ctx, f), *split = NULL;
        check_matching(ctx, m);
        qc_sizing *sizing = NULL, *fine = NULL;
        assert_int_equal(
            qc_sizing_create(ctx, f->mesh, sqrt(f->mesh->area / 5000), 0, NULL, &sizing), QC_OK);
        assert_int_equal(qc_matching_split(ctx, m, sizing, &mesh, &fine, &split), QC_OK);
        check_matching(ctx, split);
        print_message("%s: %d feature edges, %d corners, %d faces (refined %d), %d singular\n",
                      names[i], (int)f->n_feature_edges, (int)f->n_corners, (int)f->mesh->n_faces,
                      (int)mesh->n_faces, (int)m->n_singular);
        const void *made[] = {mesh, fine, split, sizing, m, f};
        for (size_t j = 0; j < sizeof made / sizeof *made; j++) qc_object_release(made[j]);
    }
}

int main(void) {
    const struct CMUnitTest tests[] = {cmocka_unit_test(models_keep_their_features)};
    const int missing = test_data_missing();
    return missing ? missing : cmocka_run_group_tests(tests, set_up, tear_down);
}
