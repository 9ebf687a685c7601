#include "plot/panel/report_tables.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

#include "plot/draw/ticks.h"
#include "text/escape.h"

/* How a number is written. */
typedef enum Style { STYLE_PLAIN, STYLE_BYTES, STYLE_SHARE, STYLE_RATIO } Style;

typedef struct Word {
    const char *key, *name;
    Style       style;
} Word;

static const Word WORDS[] = {
    {"name", "table", STYLE_PLAIN},
    {"source_bytes_text", "source, text", STYLE_BYTES},
    {"source_bytes_float32", "source, float32", STYLE_BYTES},
    {"stored_values", "stored values", STYLE_BYTES},
    {"bytes", "bytes", STYLE_BYTES},
    {"ratio", "ratio to float32", STYLE_RATIO},
    {"ratio_text", "ratio to text", STYLE_RATIO},
    {"max_error", "max. error", STYLE_SHARE},
    {"rms_error", "rms error", STYLE_SHARE},
    {"integral_error", "integral error", STYLE_SHARE},
    {"albedo_error", "albedo error", STYLE_SHARE},
    {"noise", "noise", STYLE_SHARE},
    {"bound", "bound", STYLE_SHARE},
    {"extrapolated_share", "extrapolated", STYLE_SHARE},
    {"cone_deg", "measured cone, degrees", STYLE_PLAIN},
    {"instrument_fwhm_deg", "instrument's width, degrees", STYLE_PLAIN},
    {"size_mm", "size, mm", STYLE_PLAIN},
    {"source_hash_xxh3", "source's hash (XXH3)", STYLE_PLAIN},
};

static Word word_of(const char *key)
{
    for (size_t i = 0; i < sizeof WORDS / sizeof *WORDS; i++)
        if (!strcmp(WORDS[i].key, key)) return WORDS[i];
    size_t length = strlen(key);
    Style  style = length > 6 && !strcmp(key + length - 6, "_error") ? STYLE_SHARE
                                                                     : STYLE_PLAIN;
    return (Word){key, key, style};
}

/* The key with blanks for underscores. */
static void add_name(Text *html, const char *name)
{
    for (const char *c = name; *c; c++) {
        char one[2] = {*c == '_' ? ' ' : *c, 0};
        escape_markup(html, one);
    }
}

/* 1 234 567 with narrow blanks. */
static void add_grouped(Text *html, double value)
{
    char digits[32];
    int  length = snprintf(digits, sizeof digits, "%.0f", value);
    for (int i = 0; i < length; i++) {
        if (i > 0 && (length - i) % 3 == 0 && digits[i - 1] != '-') text_add(html, "&#8239;");
        text_add_bytes(html, digits + i, 1);
    }
}

static void add_number(Text *html, double value, Style style)
{
    char text[32];
    switch (style) {
    case STYLE_BYTES: add_grouped(html, value); break;
    case STYLE_SHARE: text_format(html, "%s&#8239;%%", figure_text(100 * value, text)); break;
    case STYLE_RATIO: text_format(html, "%.*f", value < 10 ? 2 : value < 100 ? 1 : 0, value);
        break;
    default: text_format(html, "%.6g", value);
    }
}

static void add_value(Text *html, const json_t *value, Style style)
{
    size_t  i;
    json_t *item;
    if (json_is_string(value)) escape_markup(html, json_string_value(value));
    else if (json_is_boolean(value)) text_add(html, json_is_true(value) ? "yes" : "no");
    else if (json_is_number(value)) add_number(html, json_number_value(value), style);
    json_array_foreach(value, i, item) {
        if (i > 0) text_add(html, ", ");
        add_value(html, item, style);
    }
}

/* ---- the table of tables ---------------------------------------------------------------- */

static void add_row(Text *html, const json_t *keys, const json_t *row, const char *kind)
{
    const char *key;
    json_t     *unused;
    text_format(html, "<tr%s>", kind);
    json_object_foreach((json_t *)keys, key, unused) {
        const json_t *value = json_object_get(row, key);
        text_add(html, json_is_number(value) ? "<td class=\"n\">" : "<td>");
        add_value(html, value, word_of(key).style);
        text_add(html, "</td>");
    }
    text_add(html, "</tr>\n");
}

static void add_header(Text *html, const json_t *keys)
{
    const char *key;
    json_t     *value;
    text_add(html, "<thead><tr>");
    json_object_foreach((json_t *)keys, key, value) {
        text_add(html, json_is_number(value) ? "<th class=\"n\">" : "<th>");
        add_name(html, word_of(key).name);
        text_add(html, "</th>");
    }
    text_add(html, "</tr></thead>\n");
}

static void add_rows(Text *html, const json_t *rows, const json_t *total)
{
    size_t        i;
    json_t       *row;
    const json_t *first = json_array_get(rows, 0);
    text_add(html, "<div class=\"wide\"><table>\n");
    add_header(html, first);
    text_add(html, "<tbody>\n");
    json_array_foreach(rows, i, row) add_row(html, first, row, "");
    if (total) add_row(html, first, total, " class=\"total\"");
    text_add(html, "</tbody></table></div>\n");
}

void report_add_tables(Text *html, const json_t *report)
{
    const json_t *tables = json_object_get(report, "tables");
    if (!json_is_object(json_array_get(tables, 0))) return;
    add_rows(html, tables, json_object_get(report, "total"));
}

/* ---- everything else -------------------------------------------------------------------- */

static bool is_plain(const json_t *value)
{
    if (json_is_object(value)) return false;
    return !json_is_array(value) || !json_is_object(json_array_get(value, 0));
}

/* Numbers that were not declared stand as zeros in the report. */
static bool is_all_zero(const json_t *list)
{
    size_t  i;
    json_t *item;
    json_array_foreach(list, i, item)
        if (!json_is_number(item) || json_number_value(item) != 0) return false;
    return true;
}

static void add_definitions(Text *html, const json_t *object)
{
    const char *key;
    json_t     *value;
    text_add(html, "<table class=\"list\"><tbody>\n");
    json_object_foreach((json_t *)object, key, value) {
        bool is_empty = (json_is_string(value) && !*json_string_value(value)) ||
                        json_is_null(value) || !strcmp(key, "notes") ||
                        (json_is_array(value) && is_all_zero(value));
        if (!is_plain(value) || is_empty) continue;
        text_add(html, "<tr><th>");
        add_name(html, word_of(key).name);
        text_add(html, "</th><td>");
        add_value(html, value, word_of(key).style);
        text_add(html, "</td></tr>\n");
    }
    text_add(html, "</tbody></table>\n");
}

void report_add_choices(Text *html, const json_t *report)
{
    const char *key;
    json_t     *value;
    text_add(html, "<div class=\"lists\"><div><h3>Panel and source</h3>\n");
    add_definitions(html, report);
    text_add(html, "</div>\n");
    json_object_foreach((json_t *)report, key, value) {
        bool is_table = !strcmp(key, "tables") || !strcmp(key, "total");
        if (is_table || is_plain(value)) continue;
        text_add(html, "<div><h3>");
        add_name(html, word_of(key).name);
        text_add(html, "</h3>\n");
        if (json_is_object(value)) add_definitions(html, value);
        else add_rows(html, value, NULL);
        text_add(html, "</div>\n");
    }
    text_add(html, "</div>\n");
}

void report_add_notes(Text *html, const json_t *report)
{
    size_t  i;
    json_t *note;
    const json_t *notes = json_object_get(report, "notes");
    if (json_array_size(notes) == 0) return;
    text_add(html, "<h2>Notes of the fit</h2>\n<ul class=\"notes\">\n");
    json_array_foreach(notes, i, note) {
        text_add(html, "<li>");
        add_value(html, note, STYLE_PLAIN);
        text_add(html, "</li>\n");
    }
    text_add(html, "</ul>\n");
}
