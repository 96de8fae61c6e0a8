/* Arrays of integers as text which a browser unpacks at once: differences, zigzag, planes of bytes,
 * deflate, base64. Neighbours in a mesh have near numbers, so that most planes are nearly empty. */
#include "bindings/cli/report.h"
#include <stdlib.h>
#include <string.h>
#include <zlib.h>

int32_t *cli_integers(size_t n) {
    return malloc((n ? n : 1) * sizeof(int32_t));
}

/* Differences wrap as unsigned numbers; the sign goes to the lowest bit. */
static void encode(const int32_t *value, size_t n, size_t stride, unsigned char *out) {
    for (size_t i = 0; i < n; i++) {
        const uint32_t before = i < stride ? 0 : (uint32_t)value[i - stride];
        const uint32_t d = (uint32_t)value[i] - before;
        const uint32_t folded = (d << 1) ^ (d >> 31 ? UINT32_MAX : 0);
        for (size_t k = 0; k < 4; k++) out[k * n + i] = (unsigned char)(folded >> (8 * k));
    }
}

void cli_arrays_add(cli_arrays *arrays, const char *name, int32_t *values, size_t count,
                    int stride) {
    unsigned char *grown = values ? realloc(arrays->bytes, arrays->size + 4 * count + 1) : NULL;
    if (!arrays->list) arrays->list = json_array();
    json_t *entry =
        json_pack("{s:s,s:I,s:i}", "name", name, "count", (json_int_t)count, "stride", stride);
    if (json_array_append_new(arrays->list, entry) != 0 || !grown) arrays->failed = true;
    if (grown) {
        encode(values, count, (size_t)stride, grown + arrays->size);
        arrays->bytes = grown;
        arrays->size += 4 * count;
    }
    free(values);
}

char *cli_base64(const unsigned char *in, size_t n) {
    static const char digit[] = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    char *text = malloc((n + 2) / 3 * 4 + 1), *out = text;
    if (!text) return NULL;
    for (size_t i = 0; i < n; i += 3) {
        const size_t left = n - i;
        const uint32_t b = (uint32_t)in[i] << 16 | (left > 1 ? (uint32_t)in[i + 1] << 8 : 0) |
                           (left > 2 ? in[i + 2] : 0);
        *out++ = digit[b >> 18];
        *out++ = digit[b >> 12 & 63];
        *out++ = left > 1 ? digit[b >> 6 & 63] : '=';
        *out++ = left > 2 ? digit[b & 63] : '=';
    }
    *out = '\0';
    return text;
}

char *cli_arrays_text(const cli_arrays *arrays) {
    uLongf size = compressBound((uLong)arrays->size);
    unsigned char *packed = arrays->failed ? NULL : malloc(size);
    char *text = NULL;
    if (packed && compress2(packed, &size, arrays->bytes ? arrays->bytes : packed,
                            (uLong)arrays->size, 6) == Z_OK)
        text = cli_base64(packed, size);
    free(packed);
    return text;
}

void cli_arrays_free(cli_arrays *arrays) {
    json_decref(arrays->list);
    free(arrays->bytes);
}
