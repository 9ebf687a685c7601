/* SPDX-License-Identifier: Apache-2.0 */
#include "plot/report/file_report.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

#include "page/page.h"
#include "plot/draw/ticks.h"
#include "plot/report/report_table.h"
#include "text/json_text.h"

/* ---- the panel's own report --------------------------------------------------------------
 *
 * All that it holds is shown: known words get readable names and units, unknown ones stand as
 * they are. */

/* How a number is written. */
typedef enum Style { STYLE_PLAIN, STYLE_BYTES, STYLE_SHARE, STYLE_RATIO } Style;

typedef struct ReportWord {
    const char *key, *name;
    Style style;
} ReportWord;

static const ReportWord WORDS[] = {
    {"name", "table", STYLE_PLAIN},
    {"source_bytes_text", "source, text", STYLE_BYTES},
    {"source_bytes_float32", "source, float32", STYLE_BYTES},
    {"stored_values", "stored values", STYLE_BYTES},
    {"bytes", "bytes", STYLE_BYTES},
    {"ratio", "ratio to float32", STYLE_RATIO},
    {"ratio_text", "ratio to text", STYLE_RATIO},
    {"max_error", "max. error", STYLE_SHARE},
    {"outliers", "outliers left out", STYLE_BYTES},
    {"outliers_max_error", "of outliers, max.", STYLE_SHARE},
    {"rms_error", "rms error", STYLE_SHARE},
    {"integral_error", "integral error", STYLE_SHARE},
    {"albedo_error", "albedo error", STYLE_SHARE},
    {"noise", "noise", STYLE_SHARE},
    {"tolerance", "bound required", STYLE_SHARE},
    {"bound", "bound met", STYLE_SHARE},
    {"extrapolated_share", "extrapolated", STYLE_SHARE},
    {"cone_deg", "measured cone, degrees", STYLE_PLAIN},
    {"instrument_fwhm_deg", "instrument's width, degrees", STYLE_PLAIN},
    {"size_mm", "size, mm", STYLE_PLAIN},
    {"source_hash_xxh3", "source's hash (XXH3)", STYLE_PLAIN},
};

static ReportWord word_of(const char *key) {
    for (size_t i = 0; i < sizeof WORDS / sizeof *WORDS; i++)
        if (!strcmp(WORDS[i].key, key)) return WORDS[i];
    size_t length = strlen(key);
    Style style = length > 6 && !strcmp(key + length - 6, "_error") ? STYLE_SHARE : STYLE_PLAIN;
    return (ReportWord){key, key, style};
}

/* The name with blanks for underscores. */
static const char *readable(const char *name, Arena *arena) {
    char *copy = arena_string(arena, name, strlen(name));
    for (char *c = copy; *c; c++)
        if (*c == '_') *c = ' ';
    return copy;
}

#define NARROW_SPACE "\u202f" /* one that no line breaks at */

/* 1 234 567 with narrow blanks. */
static void add_grouped(Text *text, double value) {
    char digits[32];
    int length = snprintf(digits, sizeof digits, "%.0f", value);
    for (int i = 0; i < length; i++) {
        bool is_first = i == 0 || digits[i - 1] == '-';
        if (!is_first && (length - i) % 3 == 0) text_add(text, NARROW_SPACE);
        text_add_bytes(text, digits + i, 1);
    }
}

static void add_number(Text *text, double value, Style style) {
    char number[32];
    switch (style) {
    case STYLE_BYTES: add_grouped(text, value); break;
    case STYLE_SHARE:
        text_format(text, "%s" NARROW_SPACE "%%", figure_text(100 * value, number));
        break;
    case STYLE_RATIO: text_format(text, "%.*f", value < 10 ? 2 : value < 100 ? 1 : 0, value); break;
    default: text_format(text, "%.6g", value);
    }
}

static void add_value(Text *text, const json_t *value, Style style) {
    size_t i;
    json_t *item;
    if (json_is_string(value)) text_add(text, json_string_value(value));
    else if (json_is_boolean(value)) text_add(text, json_is_true(value) ? "yes" : "no");
    else if (json_is_number(value)) add_number(text, json_number_value(value), style);
    json_array_foreach(value, i, item) {
        if (i > 0) text_add(text, ", ");
        add_value(text, item, style);
    }
}

static const char *value_text(const json_t *value, Style style, Arena *arena) {
    Text text = {.arena = arena};
    add_value(&text, value, style);
    return text.data ? text.data : "";
}

/* ---- the table of tables ---------------------------------------------------------------- */

static void add_row(json_t *rows, const json_t *keys, const json_t *row, bool is_total,
                    Arena scratch) {
    const char *key;
    json_t *unused, *cells = report_add_row(rows, is_total);
    json_object_foreach((json_t *)keys, key, unused) {
        const json_t *value = json_object_get(row, key);
        report_add_cell(cells, value_text(value, word_of(key).style, &scratch),
                        json_is_number(value));
    }
}

/* Of objects of the same keys, with their total. */
static json_t *table_values(const json_t *list, const json_t *total, Arena scratch) {
    size_t i;
    json_t *row, *value, *to = json_object(), *columns = json_array(), *rows = json_array();
    const char *key;
    json_t *first = json_array_get(list, 0);
    json_object_foreach(first, key, value)
        report_add_column(columns, readable(word_of(key).name, &scratch), json_is_number(value));
    json_array_foreach(list, i, row) add_row(rows, first, row, false, scratch);
    if (total) add_row(rows, first, total, true, scratch);
    report_set_columns(to, "", columns, rows);
    return to;
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

static void set_facts(json_t *to, const json_t *object, Arena scratch) {
    const char *key;
    json_t *value, *facts = json_array();
    json_object_foreach((json_t *)object, key, value) {
        if (!is_shown(key, value)) continue;
        json_t *fact = page_add(facts);
        page_set(fact, "name", readable(word_of(key).name, &scratch));
        page_set(fact, "value", value_text(value, word_of(key).style, &scratch));
    }
    json_object_set_new(to, "facts", facts);
    page_set_flag(to, "has_facts", true);
}

/* Everything else but the notes: choices, sizes, provenance. */
static json_t *lists_values(const json_t *report, Arena scratch) {
    const char *key;
    json_t *value, *lists = json_array();
    set_facts(add_list(lists, "Panel and source"), report, scratch);
    json_object_foreach((json_t *)report, key, value) {
        if (!strcmp(key, "tables") || !strcmp(key, "total") || is_plain(value)) continue;
        json_t *to = add_list(lists, readable(word_of(key).name, &scratch));
        if (json_is_object(value)) set_facts(to, value, scratch);
        else json_object_set_new(to, "columns_of", table_values(value, NULL, scratch));
    }
    return lists;
}

static void set_sentences(json_t *to, const char *name, const char *flag, const json_t *list,
                          Arena scratch) {
    json_t *texts = json_array();
    for (size_t i = 0; i < json_array_size(list); i++)
        json_array_append_new(
            texts, json_text(value_text(json_array_get(list, i), STYLE_PLAIN, &scratch)));
    page_set_flag(to, flag, json_array_size(texts) > 0);
    json_object_set_new(to, name, texts);
}

void report_of_file(json_t *to, const json_t *report, Arena scratch) {
    const json_t *tables = json_object_get(report, "tables");
    bool has_sizes = json_is_object(json_array_get(tables, 0));
    json_object_set_new(to, "sizes",
                        has_sizes ? table_values(tables, json_object_get(report, "total"), scratch)
                                  : json_null());
    json_object_set_new(to, "lists", lists_values(report, scratch));
    set_sentences(to, "reasons", "has_reasons", json_object_get(report, "reasons"), scratch);
    set_sentences(to, "notes", "has_notes", json_object_get(report, "notes"), scratch);
}
