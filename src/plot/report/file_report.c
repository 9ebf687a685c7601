/* SPDX-License-Identifier: Apache-2.0 */
#include "plot/report/file_report.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

#include "page/page.h"
#include "plot/draw/ticks.h"
#include "text/json_text.h"

/* ---- the panel's own report --------------------------------------------------------------
 *
 * All that it holds is shown: known words get readable names and units, unknown ones stand as
 * they are. */

static const Column WORDS[] = {
    COLUMN_TEXT("name", "table"),
    COLUMN_FIXED("source_bytes_text", "text", "bytes", 0),
    {.key = "source_bytes_float32"},
    COLUMN_FIXED("stored_values", "values", NULL, 0),
    COLUMN_FIXED("bytes", "bytes", NULL, 0),
    COLUMN_DIGITS("ratio", "ratio", NULL, 4),
    {.key = "ratio_text"},
    COLUMN_SHARE("max_error", "largest error"),
    COLUMN_FIXED("outliers", "outliers left out", NULL, 0),
    COLUMN_SHARE("outliers_max_error", "of outliers, largest"),
    COLUMN_SHARE("rms_error", "rms error"),
    COLUMN_SHARE("integral_error", "integral error"),
    COLUMN_SHARE("albedo_error", "albedo error"),
    COLUMN_SHARE("noise", "noise"),
    COLUMN_SHARE("tolerance", "bound required"),
    COLUMN_SHARE("bound", "bound met"),
    COLUMN_SHARE("extrapolated_share", "extrapolated"),
    COLUMN_DIGITS("cone_deg", "measured cone", "degrees", 6),
    COLUMN_DIGITS("instrument_fwhm_deg", "instrument's width", "degrees", 6),
    COLUMN_DIGITS("size_mm", "size", "mm", 6),
    COLUMN_TEXT("source_hash_xxh3", "source's hash (XXH3)"),
};

Table *panel_file_table(const json_t *report, Arena *arena) {
    const json_t *total = json_object_get(report, "total");
    Table *table =
        table_of_objects(WORDS, COUNT_OF(WORDS), json_object_get(report, "tables"), arena);
    if (!table || !total) return table;
    table->total_row = table->row_count;
    table_add_object(table, total);
    return table;
}

/* ---- everything else -------------------------------------------------------------------- */

static bool is_plain(const json_t *value) {
    if (json_is_object(value)) return false;
    return !json_is_array(value) || !json_is_object(json_array_get(value, 0));
}

/* Numbers that were not given stand as zeros in the report. */
static bool is_all_zero(const json_t *list) {
    size_t i;
    json_t *item;
    json_array_foreach(list, i, item) if (!json_is_number(item) ||
                                          json_number_value(item) != 0) return false;
    return true;
}

static bool is_shown(const char *key, const json_t *value) {
    bool is_empty = (json_is_string(value) && !*json_string_value(value)) || json_is_null(value) ||
                    !strcmp(key, "notes") || !strcmp(key, "reasons") ||
                    (json_is_array(value) && is_all_zero(value));
    return is_plain(value) && !is_empty;
}

static json_t *add_list(json_t *lists, const char *title) {
    json_t *to = page_add(lists);
    page_set(to, "title", title);
    page_set(to, "columns_of", NULL);
    page_set_flag(to, "has_facts", false);
    return to;
}

/* One row of the object's members, each a fact. */
static void set_facts(json_t *to, const json_t *object, Arena *arena) {
    json_t *facts = json_array(), *one = json_array();
    json_array_append(one, (json_t *)object);
    const Table *table = table_of_objects(WORDS, COUNT_OF(WORDS), one, arena);
    for (int c = 0; table && c < table->kind->column_count; c++) {
        const Column *column = &table->kind->columns[c];
        const char *words = table_cell_text(table, 0, c);
        if (!is_shown(column->key, json_object_get(object, column->key)) || !words) continue;
        json_t *fact = page_add(facts);
        page_set(fact, "name", column->words ? column->words : column->key);
        page_set(fact, "value",
                 column->unit ? arena_format(arena, "%s %s", words, column->unit) : words);
    }
    json_decref(one);
    json_object_set_new(to, "facts", facts);
    page_set_flag(to, "has_facts", true);
}

/* Everything else but the notes: choices, sizes, provenance. */
static json_t *lists_values(const json_t *report, Arena *arena) {
    const char *key;
    json_t *value, *lists = json_array();
    set_facts(add_list(lists, "Panel and source"), report, arena);
    json_object_foreach((json_t *)report, key, value) {
        if (!strcmp(key, "tables") || !strcmp(key, "total") || is_plain(value)) continue;
        json_t *to = add_list(lists, key);
        if (json_is_object(value)) set_facts(to, value, arena);
        else
            json_object_set_new(to, "columns_of",
                                table_page(table_of_objects(WORDS, COUNT_OF(WORDS), value, arena)));
    }
    return lists;
}

static void set_sentences(json_t *to, const char *name, const char *flag, const json_t *list) {
    page_set_flag(to, flag, json_array_size(list) > 0);
    json_object_set_new(to, name, list ? json_deep_copy(list) : json_array());
}

void report_of_file(json_t *to, const json_t *report, Arena *arena) {
    const Table *sizes = panel_file_table(report, arena);
    json_object_set_new(to, "sizes", sizes ? table_page(sizes) : json_null());
    json_object_set_new(to, "lists", lists_values(report, arena));
    set_sentences(to, "reasons", "has_reasons", json_object_get(report, "reasons"));
    set_sentences(to, "notes", "has_notes", json_object_get(report, "notes"));
}
