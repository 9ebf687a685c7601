/* SPDX-License-Identifier: Apache-2.0 */
#include "panel/query/panel_report.h"

#include <stdlib.h>
#include <string.h>
#define ZLIB_CONST
#include <zlib.h>

#include "panel/query/panel_opened.h"

#define DIGITS 5
#define REPORT_MOST (1u << 24) /* bytes of its text */
#define DEFLATE_MOST 1032      /* bytes of text for one */

static const char *const derived[] = {"ratio", "ratio_text"};
static const char *const source[] = {"source_bytes_float32", "source_bytes_text"};

/* ---- packing --------------------------------------------------------------------------- */

static json_t *without_derived(const json_t *table) {
    json_t *out = json_copy((json_t *)table);
    for (int k = 0; k < 2; k++) json_object_del(out, derived[k]);
    return out;
}

size_t panel_report_pack(const json_t *report, Arena *arena, const void **bytes) {
    json_t *stored = json_copy((json_t *)report), *tables = json_array(), *table;
    json_t *total = without_derived(json_object_get(report, "total"));
    size_t i, size = 0;
    json_object_del(total, "bytes");
    json_array_foreach(json_object_get(report, "tables"), i, table)
        json_array_append_new(tables, without_derived(table));
    json_object_set_new(stored, "total", total);
    json_object_set_new(stored, "tables", tables);
    char *text = json_dumps(stored, JSON_COMPACT | JSON_REAL_PRECISION(DIGITS));
    json_decref(stored);
    if (!text) return 0;
    uLongf packed = compressBound((uLong)strlen(text));
    unsigned char *to = arena_alloc(arena, 1, 8, packed);
    if (compress2(to, &packed, (const Bytef *)text, (uLong)strlen(text), Z_BEST_COMPRESSION) ==
        Z_OK)
        size = packed;
    free(text);
    *bytes = to;
    return size;
}

/* ---- opening --------------------------------------------------------------------------- */

void panel_report_add_sizes(json_t *report, size_t file_bytes) {
    json_t *tables = json_object_get(report, "tables"), *total = json_object_get(report, "total");
    json_object_set_new(total, "bytes", json_real((double)file_bytes));
    for (size_t i = 0; i <= json_array_size(tables); i++) {
        json_t *table = i < json_array_size(tables) ? json_array_get(tables, i) : total;
        double stored = json_number_value(json_object_get(table, "bytes"));
        for (int k = 0; k < 2; k++) {
            double bytes = json_number_value(json_object_get(table, source[k]));
            json_object_set_new(table, derived[k], json_real(stored > 0 ? bytes / stored : 0));
        }
    }
}

/* NULL: damaged, or memory is out. */
static json_t *unpacked(const void *bytes, size_t size) {
    uLongf most = size < REPORT_MOST / DEFLATE_MOST ? size * DEFLATE_MOST : REPORT_MOST;
    char *text = malloc(most + 1);
    json_t *out = NULL;
    if (text && uncompress((Bytef *)text, &most, bytes, (uLong)size) == Z_OK)
        out = json_loadb(text, most, 0, NULL);
    free(text);
    return out;
}

bool panel_report(const Panel *panel, json_t **report, Error *err) {
    *report = unpacked(panel->meta, panel->meta_size);
    if (!json_is_object(*report) || !json_is_array(json_object_get(*report, "tables")) ||
        !json_is_object(json_object_get(*report, "total"))) {
        json_decref(*report);
        *report = NULL;
        return error_set(err, ERROR_INPUT, "the panel's report is damaged");
    }
    panel_report_add_sizes(*report, panel->own_size);
    json_object_set_new(*report, "file_bytes", json_integer((json_int_t)panel->size));
    return true;
}
