/* SPDX-License-Identifier: Apache-2.0 */
#include "plot/report/file_report.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

#include "page/page.h"
#include "plot/draw/ticks.h"

/* ---- the panel's own report --------------------------------------------------------------
 *
 * All that it holds is shown: known words get readable names and units, unknown ones stand as
 * they are. */

/* How a number is written. */
typedef enum Style { STYLE_PLAIN, STYLE_BYTES, STYLE_SHARE, STYLE_RATIO } Style;

typedef struct ReportWord {
    const char *key, *name;
    Style       style;
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

static ReportWord word_of(const char *key)
{
    for (size_t i = 0; i < sizeof WORDS / sizeof *WORDS; i++)
        if (!strcmp(WORDS[i].key, key)) return WORDS[i];
    size_t length = strlen(key);
    Style  style = length > 6 && !strcmp(key + length - 6, "_error") ? STYLE_SHARE
                                                                     : STYLE_PLAIN;
    return (ReportWord){key, key, style};
}

/* The name with blanks for underscores. */
static const char *readable(const char *name, Arena *arena)
{
    char *copy = arena_string(arena, name, strlen(name));
    for (char *c = copy; *c; c++)
        if (*c == '_') *c = ' ';
    return copy;
}

#define NARROW_SPACE "\u202f" /* one that no line breaks at */

/* 1 234 567 with narrow blanks. */
static void add_grouped(Text *text, double value)
{
    char digits[32];
    int  length = snprintf(digits, sizeof digits, "%.0f", value);
    for (int i = 0; i < length; i++) {
        bool is_first = i == 0 || digits[i - 1] == '-';
        if (!is_first && (length - i) % 3 == 0) text_add(text, NARROW_SPACE);
        text_add_bytes(text, digits + i, 1);
    }
}

static void add_number(Text *text, double value, Style style)
{
    char number[32];
    switch (style) {
    case STYLE_BYTES: add_grouped(text, value); break;
    case STYLE_SHARE:
        text_format(text, "%s" NARROW_SPACE "%%", figure_text(100 * value, number));
        break;
    case STYLE_RATIO:
        text_format(text, "%.*f", value < 10 ? 2 : value < 100 ? 1 : 0, value);
        break;
    default: text_format(text, "%.6g", value);
    }
}

static void add_value(Text *text, const json_t *value, Style style)
{
    size_t  i;
    json_t *item;
    if (json_is_string(value)) text_add(text, json_string_value(value));
    else if (json_is_boolean(value)) text_add(text, json_is_true(value) ? "yes" : "no");
    else if (json_is_number(value)) add_number(text, json_number_value(value), style);
    json_array_foreach(value, i, item) {
        if (i > 0) text_add(text, ", ");
        add_value(text, item, style);
    }
}

static const char *value_text(const json_t *value, Style style, Arena *arena)
{
    Text text = {.arena = arena};
    add_value(&text, value, style);
    return text.data ? text.data : "";
}

/* ---- the table of tables ---------------------------------------------------------------- */

static void add_row(Text *html, const json_t *keys, const json_t *row, const char *kind,
                    Arena scratch)
{
    const char *key;
    json_t     *unused;
    page_row_begin(html, kind);
    json_object_foreach((json_t *)keys, key, unused) {
        const json_t *value = json_object_get(row, key);
        page_cell(html, json_is_number(value) ? "n" : "",
                  value_text(value, word_of(key).style, &scratch));
    }
    page_row_end(html);
}

static void add_rows(Text *html, const json_t *rows, const json_t *total, Arena scratch)
{
    size_t      i;
    json_t     *row, *value;
    const char *key;
    json_t     *first = json_array_get(rows, 0);
    PageColumn *columns = ARENA_NEW(&scratch, PageColumn, json_object_size(first));
    int         count = 0;
    json_object_foreach(first, key, value) columns[count++] =
        (PageColumn){readable(word_of(key).name, &scratch), json_is_number(value), NULL};
    page_table_begin(html, "", "", columns, count);
    json_array_foreach(rows, i, row) add_row(html, first, row, "", scratch);
    if (total) add_row(html, first, total, "total", scratch);
    page_table_end(html);
}

/* With its totals. */
static void add_tables(Text *html, const json_t *report, Arena scratch)
{
    const json_t *tables = json_object_get(report, "tables");
    if (!json_is_object(json_array_get(tables, 0))) return;
    add_rows(html, tables, json_object_get(report, "total"), scratch);
}

/* ---- everything else -------------------------------------------------------------------- */

static bool is_plain(const json_t *value)
{
    if (json_is_object(value)) return false;
    return !json_is_array(value) || !json_is_object(json_array_get(value, 0));
}

/* Numbers that were not given stand as zeros in the report. */
static bool is_all_zero(const json_t *list)
{
    size_t  i;
    json_t *item;
    json_array_foreach(list, i, item)
        if (!json_is_number(item) || json_number_value(item) != 0) return false;
    return true;
}

static void add_definitions(Text *html, const json_t *object, Arena scratch)
{
    const char *key;
    json_t     *value;
    text_add(html, "<table class=\"list\"><tbody>\n");
    json_object_foreach((json_t *)object, key, value) {
        bool is_empty = (json_is_string(value) && !*json_string_value(value)) ||
                        json_is_null(value) || !strcmp(key, "notes") ||
                        !strcmp(key, "reasons") ||
                        (json_is_array(value) && is_all_zero(value));
        if (!is_plain(value) || is_empty) continue;
        ReportWord word = word_of(key);
        page_row_begin(html, "");
        page_element(html, "th", readable(word.name, &scratch));
        page_cell(html, "", value_text(value, word.style, &scratch));
        page_row_end(html);
    }
    text_add(html, "</tbody></table>\n");
}

/* Everything else but the notes: choices, sizes, provenance. */
static void add_choices(Text *html, const json_t *report, Arena scratch)
{
    const char *key;
    json_t     *value;
    text_add(html, "<div class=\"lists\"><div>\n");
    page_element(html, "h3", "Panel and source");
    add_definitions(html, report, scratch);
    text_add(html, "</div>\n");
    json_object_foreach((json_t *)report, key, value) {
        bool is_table = !strcmp(key, "tables") || !strcmp(key, "total");
        if (is_table || is_plain(value)) continue;
        text_add(html, "<div>");
        page_element(html, "h3", readable(word_of(key).name, &scratch));
        if (json_is_object(value)) add_definitions(html, value, scratch);
        else add_rows(html, value, NULL, scratch);
        text_add(html, "</div>\n");
    }
    text_add(html, "</div>\n");
}

static void add_sentences(Text *html, const char *title, const json_t *notes, Arena scratch)
{
    int          count = (int)json_array_size(notes);
    const char **texts = ARENA_NEW(&scratch, const char *, count);
    if (count == 0) return;
    for (int i = 0; i < count; i++)
        texts[i] = value_text(json_array_get(notes, (size_t)i), STYLE_PLAIN, &scratch);
    page_element(html, "h2", title);
    page_list(html, "notes", texts, count);
}

/* The notes as lists; nothing where there are none. */
static void add_notes(Text *html, const json_t *report, Arena scratch)
{
    const char *verdict = json_string_value(json_object_get(report, "verdict"));
    char        title[64];
    snprintf(title, sizeof title, "Why it is %s", verdict ? verdict : "");
    add_sentences(html, title, json_object_get(report, "reasons"), scratch);
    add_sentences(html, "Notes of the fit", json_object_get(report, "notes"), scratch);
}

void report_of_file(Text *html, const json_t *report, Arena scratch)
{
    page_element(html, "h2", "Sizes and errors, table by table");
    page_element(html, "p class=\"sub\"", "Errors as defined above; trees are shared by "
                 "tables, whose part is an even share.");
    add_tables(html, report, scratch);
    page_element(html, "h2", "Choices and provenance");
    add_choices(html, report, scratch);
    add_notes(html, report, scratch);
}
