/* SPDX-License-Identifier: Apache-2.0 */
#include "panel/query/panel_report.h"

#include <math.h>
#include <stdbool.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>
#define ZLIB_CONST
#include <zlib.h>

#include "panel/query/panel_opened.h"

#define COLUMNS_MAX 64
#define TEXT_MAX 255
#define COMPRESSED 0x2000      /* no count of rows is as large: the beginning of a zlib stream */
#define REPORT_MOST (1u << 24) /* bytes of its text */

extern const char PANEL_WORDS[]; /* panel_words.txt */

typedef struct ReportColumn {
    char kind, key[TEXT_MAX + 1];
} ReportColumn;

/* ---- compression ------------------------------------------------------------------------ */

/* Bytes in the arena; 0: memory is out. */
static size_t packed(const void *bytes, size_t size, Arena *arena, const void **out) {
    z_stream stream = {.next_in = bytes, .avail_in = (uInt)size};
    if (deflateInit(&stream, Z_BEST_COMPRESSION) != Z_OK) return 0;
    bool ok = deflateSetDictionary(&stream, (const Bytef *)PANEL_WORDS,
                                   (uInt)strlen(PANEL_WORDS)) == Z_OK;
    uLong most = deflateBound(&stream, stream.avail_in);
    unsigned char *to = arena_alloc(arena, 1, 8, most);
    stream.next_out = to;
    stream.avail_out = (uInt)most;
    ok = ok && deflate(&stream, Z_FINISH) == Z_STREAM_END;
    deflateEnd(&stream);
    *out = to;
    return ok ? stream.total_out : 0;
}

/* The caller's to free; NULL: damaged, or memory is out. */
static char *unpacked(const void *bytes, size_t size, size_t *out_size) {
    z_stream stream = {.next_in = bytes, .avail_in = (uInt)size};
    size_t most = size < REPORT_MOST / 1032 ? size * 1032 : REPORT_MOST; /* deflate's ratio */
    char *text = malloc(most + 1);
    bool ok = false;
    stream.next_out = (Bytef *)text;
    stream.avail_out = (uInt)most;
    if (text && inflateInit(&stream) == Z_OK) {
        ok = inflate(&stream, Z_FINISH) == Z_NEED_DICT &&
             inflateSetDictionary(&stream, (const Bytef *)PANEL_WORDS, (uInt)strlen(PANEL_WORDS)) ==
                 Z_OK &&
             inflate(&stream, Z_FINISH) == Z_STREAM_END;
        inflateEnd(&stream);
    }
    *out_size = stream.total_out;
    if (ok) return text;
    free(text);
    return NULL;
}

/* ---- packing --------------------------------------------------------------------------- */

static bool is_stored(const char *key) {
    return strcmp(key, "name") && strcmp(key, "ratio") && strcmp(key, "ratio_text");
}

static char kind_of(const char *key, const json_t *value) {
    if (json_is_integer(value)) return 'i';
    return !strcmp(key, "bytes") || !strcmp(key, "stored_values") ? 'f' : 'h';
}

static int find_columns(const json_t *tables, ReportColumn *column) {
    int count = 0;
    size_t i;
    json_t *table, *value;
    json_array_foreach((json_t *)tables, i, table) {
        const char *key;
        json_object_foreach(table, key, value) {
            int at = 0;
            if (!is_stored(key) || !json_is_number(value) || strlen(key) > TEXT_MAX) continue;
            while (at < count && strcmp(column[at].key, key)) at++;
            if (at == COLUMNS_MAX) continue;
            if (at == count) {
                column[count].kind = kind_of(key, value);
                strcpy(column[count++].key, key);
            } else if (!json_is_integer(value) && column[at].kind == 'i') {
                column[at].kind = kind_of(key, value);
            }
        }
    }
    return count;
}

/* The upper half of a float32, away from 0. */
static uint16_t upper_half(float value) {
    uint32_t bits;
    memcpy(&bits, &value, sizeof bits);
    if (isfinite(value) && bits & 0xffffu) bits += 0x10000u;
    return (uint16_t)(bits >> 16);
}

typedef struct TableWriter {
    unsigned char *at;
} TableWriter;

static void put(TableWriter *to, const void *from, size_t bytes) {
    memcpy(to->at, from, bytes);
    to->at += bytes;
}

static void put_text(TableWriter *to, const char *text) {
    uint8_t length = (uint8_t)(strlen(text) > TEXT_MAX ? TEXT_MAX : strlen(text));
    put(to, &length, 1);
    put(to, text, length);
}

static void put_number(TableWriter *to, char kind, const json_t *value) {
    float number = json_is_number(value) ? (float)json_number_value(value) : NAN;
    uint32_t whole = json_is_number(value) ? (uint32_t)json_number_value(value) : UINT32_MAX;
    uint16_t half = upper_half(number);
    if (kind == 'i') put(to, &whole, sizeof whole);
    else if (kind == 'f') put(to, &number, sizeof number);
    else put(to, &half, sizeof half);
}

static const char *name_of(const json_t *table) {
    const char *name = json_string_value(json_object_get(table, "name"));
    return name ? name : "";
}

static size_t plain_tables(const json_t *tables, Arena *arena, const void **bytes) {
    ReportColumn column[COLUMNS_MAX];
    size_t i, size = 3, rows = json_array_size(tables);
    json_t *table;
    uint8_t columns = (uint8_t)find_columns(tables, column);
    for (int c = 0; c < columns; c++) size += 2 + strlen(column[c].key);
    json_array_foreach((json_t *)tables, i, table) size +=
        1 + strlen(name_of(table)) + 4 * (size_t)columns;
    unsigned char *out = ARENA_NEW(arena, unsigned char, size);
    TableWriter to = {out};
    uint16_t count = (uint16_t)rows;
    put(&to, &count, sizeof count);
    put(&to, &columns, 1);
    for (int c = 0; c < columns; c++) {
        put(&to, &column[c].kind, 1);
        put_text(&to, column[c].key);
    }
    json_array_foreach((json_t *)tables, i, table) put_text(&to, name_of(table));
    json_array_foreach((json_t *)tables, i, table) for (int c = 0; c < columns; c++)
        put_number(&to, column[c].kind, json_object_get(table, column[c].key));
    *bytes = out;
    return (size_t)(to.at - out);
}

size_t panel_report_pack_tables(const json_t *tables, bool is_compressed, Arena *arena,
                                const void **bytes) {
    size_t size = plain_tables(tables, arena, bytes);
    return is_compressed ? packed(*bytes, size, arena, bytes) : size;
}

/* ---- opening --------------------------------------------------------------------------- */

typedef struct Reader {
    const unsigned char *at, *end;
} Reader;

static bool get(Reader *from, void *to, size_t bytes) {
    if ((size_t)(from->end - from->at) < bytes) return false;
    memcpy(to, from->at, bytes);
    from->at += bytes;
    return true;
}

static bool get_text(Reader *from, char text[TEXT_MAX + 1]) {
    uint8_t length;
    if (!get(from, &length, 1) || !get(from, text, length)) return false;
    text[length] = 0;
    return true;
}

static bool get_number(Reader *from, const ReportColumn *column, json_t *table) {
    uint32_t bits = 0;
    uint16_t half = 0;
    float number;
    if (column->kind == 'h') {
        if (!get(from, &half, sizeof half)) return false;
        bits = (uint32_t)half << 16;
    } else if (!get(from, &bits, sizeof bits)) {
        return false;
    }
    if (column->kind == 'i') {
        if (bits != UINT32_MAX)
            json_object_set_new(table, column->key, json_integer((json_int_t)bits));
        return true;
    }
    memcpy(&number, &bits, sizeof number);
    if (isfinite(number)) json_object_set_new(table, column->key, json_real((double)number));
    return true;
}

/* Source bytes over the panel's. */
static void add_ratio(json_t *table, const char *source, const char *key) {
    double stored = json_number_value(json_object_get(table, "bytes"));
    double bytes = json_number_value(json_object_get(table, source));
    if (json_object_get(table, source))
        json_object_set_new(table, key, json_real(stored > 0 ? bytes / stored : 0));
}

static bool get_columns(Reader *from, ReportColumn *column, int columns) {
    for (int c = 0; c < columns; c++)
        if (!get(from, &column[c].kind, 1) || !strchr("ifh", column[c].kind) || !column[c].kind ||
            !get_text(from, column[c].key))
            return false;
    return true;
}

static bool get_rows(Reader *from, const ReportColumn *column, int columns, int rows, json_t *out) {
    char text[TEXT_MAX + 1];
    for (int i = 0; i < rows; i++) {
        if (!get_text(from, text)) return false;
        json_t *name = json_string(text);
        if (!name) return false; /* no UTF-8 */
        json_t *table = json_object();
        json_object_set_new(table, "name", name);
        json_array_append_new(out, table);
    }
    for (int i = 0; i < rows; i++) {
        json_t *table = json_array_get(out, (size_t)i);
        for (int c = 0; c < columns; c++)
            if (!get_number(from, &column[c], table)) return false;
        add_ratio(table, "source_bytes_float32", "ratio");
        add_ratio(table, "source_bytes_text", "ratio_text");
    }
    return true;
}

static json_t *open_plain_tables(const void *bytes, size_t size) {
    Reader from = {bytes, (const unsigned char *)bytes + size};
    uint16_t rows;
    uint8_t columns;
    ReportColumn column[COLUMNS_MAX];
    json_t *out = json_array();
    if (get(&from, &rows, sizeof rows) && get(&from, &columns, 1) && columns <= COLUMNS_MAX &&
        get_columns(&from, column, columns) && get_rows(&from, column, columns, rows, out))
        return out;
    json_decref(out);
    return NULL;
}

json_t *panel_report_open_tables(const void *bytes, size_t size) {
    uint16_t rows;
    size_t plain_size;
    if (size < sizeof rows) return NULL;
    memcpy(&rows, bytes, sizeof rows);
    if (rows < COMPRESSED) return open_plain_tables(bytes, size);
    void *plain = unpacked(bytes, size, &plain_size);
    json_t *out = plain ? open_plain_tables(plain, plain_size) : NULL;
    free(plain);
    return out;
}

/* ---- the whole report -------------------------------------------------------------------- */

/* Usual values, which a file omits; panel_report adds them again. */
static json_t *unsaid(void) {
    return json_pack("{s:s, s:s, s:s, s:s, s:s, s:[f,f], s:[f,f]}", "instrument", "", "date", "",
                     "operator", "", "conditions", "", "note", "", "pixels", 0.0, 0.0, "size_mm",
                     0.0, 0.0);
}

static void leave_unsaid(json_t *meta) {
    const char *key;
    json_t *value, *usual = unsaid();
    json_object_foreach(usual, key, value) if (json_equal(json_object_get(meta, key), value))
        json_object_del(meta, key);
    json_decref(usual);
}

/* [{a: 1, b: 2}, {a: 3, b: 4}] as {a: [1, 3], b: [2, 4]}: names stand once. */
static json_t *columns_of(const json_t *rows) {
    json_t *out = json_object(), *row, *value;
    const char *key;
    size_t i;
    json_array_foreach((json_t *)rows, i, row) json_object_foreach(row, key, value) {
        if (!json_object_get(out, key)) json_object_set_new(out, key, json_array());
        json_array_append(json_object_get(out, key), value);
    }
    return out;
}

static json_t *rows_of(const json_t *columns) {
    json_t *out = json_array(), *column, *value;
    const char *key;
    size_t i;
    json_object_foreach((json_t *)columns, key, column) json_array_foreach(column, i, value) {
        if (i >= json_array_size(out)) json_array_append_new(out, json_object());
        json_object_set(json_array_get(out, i), key, value);
    }
    return out;
}

/* Puts a changed "mirror" into the report's reflection, if there is one. */
static void change_mirror(json_t *report, json_t *(*change)(const json_t *)) {
    json_t *reflection = json_copy(json_object_get(report, "reflection"));
    json_t *mirror = json_object_get(reflection, "mirror");
    if (mirror) json_object_set_new(reflection, "mirror", change(mirror));
    if (mirror) json_object_set(report, "reflection", reflection);
    json_decref(reflection);
}

size_t panel_report_pack(json_t *report, Arena *arena, const void **bytes) {
    leave_unsaid(report);
    change_mirror(report, columns_of);
    char *text = json_dumps(report, JSON_COMPACT | JSON_REAL_PRECISION(4));
    size_t size = text ? packed(text, strlen(text), arena, bytes) : 0;
    free(text);
    return size;
}

/* Older files hold the text as it is. */
static json_t *read_report(const Panel *panel) {
    size_t size;
    if (panel->meta_size && panel->meta[0] == '{')
        return json_loadb(panel->meta, panel->meta_size, 0, NULL);
    char *text = unpacked(panel->meta, panel->meta_size, &size);
    json_t *out = text ? json_loadb(text, size, 0, NULL) : NULL;
    free(text);
    return out;
}

bool panel_report(const Panel *panel, json_t **report, Error *err) {
    json_t *figures = json_array();
    if (panel->figures) {
        json_decref(figures);
        figures = panel_report_open_tables(panel->figures, panel->figures_size);
    }
    *report = read_report(panel);
    if (!json_is_object(*report) || !figures) {
        error_set(err, ERROR_INPUT, "the panel's report is damaged: %s",
                  figures ? "no JSON" : "its figures");
        json_decref(*report);
        json_decref(figures);
        return false;
    }
    json_t *usual = unsaid();
    json_object_update_missing(*report, usual);
    if (json_is_object(json_object_get(json_object_get(*report, "reflection"), "mirror")))
        change_mirror(*report, rows_of);
    json_decref(usual);
    size_t rows = json_array_size(figures);
    if (rows) {
        json_object_set(*report, "total", json_array_get(figures, rows - 1));
        json_array_remove(figures, rows - 1);
    }
    json_object_set_new(*report, "tables", figures);
    json_object_set_new(*report, "file_bytes", json_integer((json_int_t)panel->size));
    return true;
}
