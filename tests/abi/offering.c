/* A plugin without stages, which offers interfaces: one of them, without a name, is left out. */
#include <qc/plugin.h>
#include <string.h>

static const qc_interface first = {sizeof(qc_interface), 1, "first", "a table"};
static const qc_interface nameless = {sizeof(qc_interface), 2, NULL, NULL};
static const qc_interface second = {sizeof(qc_interface), 3, "second", NULL};
static const qc_interface *const tables[] = {&first, &nameless, &second, NULL};

static const void *extension(const char *id) {
    return strcmp(id, "test.greeter/1") == 0 ? tables : NULL;
}

QC_PLUGIN_EXPORT const qc_plugin qc_plugin_1 = {sizeof(qc_plugin), QC_ABI_MAJOR,
                                                QC_ABI_MINOR,      .id = "org.test.offering",
                                                .version = "1",    .extension = extension};
