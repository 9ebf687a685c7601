/* SPDX-License-Identifier: Apache-2.0 */
#include "panel/query/panel_reflection.h"
#include "plot/panel/report.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

#include "base/file.h"
#include "base/units.h"
#include "panel/query/panel_info.h"
#include "page/page.h"
#include "plot/draw/ticks.h"
#include "plot/panel/sheet.h"
#include "plot/panel/plot_answer.h"
#include "text/text.h"

#define CHART_WIDTH 420
#define CHART_HEIGHT 344
#define PAGE_BYTES ((size_t)4 << 30) /* of address space, for the text */

/* report.css and report.js beside this file; the build embeds them. */
extern const char PANEL_STYLE[], PANEL_SCRIPT[];

/* ---- values of a figure at the pointer -------------------------------------------------- */

#define READ_ROWS 46    /* every 2 degrees of theta */
#define READ_COLUMNS 60 /* every 6 degrees of phi */

static void add_polar_values(Text *html, const PanelChartMap *map)
{
    const Field *field = &map->field;
    text_format(html, "{\"kind\":\"polar\",\"x\":%.2f,\"y\":%.2f,\"r\":%.2f,\"rim\":%g,"
                "\"rows\":%d,\"columns\":%d,\"unit\":\"", map->disc.x, map->disc.y,
                map->disc.radius, degrees_from_radians(field->theta_rim), READ_ROWS,
                READ_COLUMNS);
    escape_markup(html, map->unit);
    text_add(html, "\",\"v\":[");
    for (int i = 0; i < READ_ROWS; i++)
        for (int j = 0; j < READ_COLUMNS; j++) {
            double column, row;
            field_place(field, field->theta_rim * i / (READ_ROWS - 1),
                        2 * PI * j / READ_COLUMNS, &column, &row);
            double v = field_at(field, column, row);
            if (i + j > 0) text_add(html, ",");
            if (isfinite(v)) text_format(html, "%.4g", v);
            else text_add(html, "null");
        }
    text_add(html, "]}");
}

/* An axis's name without its unit and explanation. */
static const char *short_name(Arena *arena, const char *title)
{
    return arena_string(arena, title, strcspn(title, ",("));
}

static void add_chart_values(Text *html, const PanelChartMap *map, Arena *arena)
{
    text_format(html, "{\"kind\":\"chart\",\"x\":%.2f,\"y\":%.2f,\"w\":%.2f,\"h\":%.2f,"
                "\"low\":[%.9g,%.9g],\"high\":[%.9g,%.9g],\"log\":[%d,%d],\"names\":[\"",
                map->plot.x, map->plot.y, map->plot.w, map->plot.h, map->low[0], map->low[1],
                map->high[0], map->high[1], map->is_log[0], map->is_log[1]);
    escape_markup(html, short_name(arena, map->axis[0]));
    text_add(html, "\",\"");
    escape_markup(html, short_name(arena, map->axis[1]));
    text_add(html, "\"]}");
}

/* chart: the index-th of its list; a caption that the one before has is not repeated. */
static bool add_chart(Text *html, const PanelChart *chart, int index, bool is_dark,
                      Arena *arena, Error *err)
{
    PlotBytes   svg = {0};
    PanelChartMap   map = {0};
    SheetChartFrame frame = {CHART_WIDTH, CHART_HEIGHT, arena_format(arena, "f%d-", index),
                         is_dark};
    if (!sheet_chart_svg(chart, &frame, arena, &svg, &map, err)) return false;
    text_format(html, "<figure class=\"ground%s\" data-map='", is_dark ? " night" : "");
    if (map.kind == PANEL_CHART_POLAR) add_polar_values(html, &map);
    else add_chart_values(html, &map, arena);
    text_add(html, "'>\n");
    page_element(html, "h3", chart->title);
    page_element(html, "p", chart->subtitle);
    text_add_bytes(html, svg.data, svg.size);
    text_add(html, "<div class=\"read\"></div>\n");
    if (index == 0 || strcmp(chart[-1].caption, chart->caption) != 0)
        page_element(html, "figcaption", chart->caption);
    text_add(html, "</figure>\n");
    return true;
}

/* ---- the figures under their headings --------------------------------------------------- */

static const struct { PlotKind first, last; const char *title; } CHAPTERS[] = {
    {PLOT_LUMINANCE, PLOT_COLOUR_SHIFT, "Luminance, contrast and colour over the hemisphere"},
    {PLOT_SECTIONS, PLOT_SECTIONS, "Sections"},
    {PLOT_GREY_LEVELS, PLOT_GREY_LEVELS, "Grey levels"},
    {PLOT_CHROMATICITY, PLOT_SPECTRA, "Colour"},
    {PLOT_BRDF, PLOT_MIRROR, "Reflection"},
    {PLOT_FIT, PLOT_FIT, "Measured against fitted"}};

static bool is_in_chapter(const PanelChart *chart, int chapter)
{
    if (chart->kind == PLOT_GREY_LEVELS) return chapter == 2;
    return chart->kind >= CHAPTERS[chapter].first && chart->kind <= CHAPTERS[chapter].last;
}

static bool add_chapters(Text *html, const PanelChartList *list, bool is_dark, Arena *arena,
                         Error *err)
{
    for (int chapter = 0; chapter < (int)(sizeof CHAPTERS / sizeof *CHAPTERS); chapter++) {
        bool is_open = false;
        for (int i = 0; i < list->count; i++) {
            if (!is_in_chapter(&list->chart[i], chapter)) continue;
            if (!is_open) {
                page_element(html, "h2", CHAPTERS[chapter].title);
                text_add(html, "<div class=\"figures\">\n");
            }
            is_open = true;
            if (!add_chart(html, &list->chart[i], i, is_dark, arena, err)) return false;
        }
        if (is_open) text_add(html, "</div>\n");
    }
    return true;
}

/* ---- the values looked at first --------------------------------------------------------- */

/* A value and its unit, above its name. */
static void add_key(Text *html, double value, const char *unit, const char *name)
{
    char number[32], text[64];
    snprintf(text, sizeof text, "%s %s", figure_text(value, number), unit);
    page_key(html, text, name, false);
}

static void add_shift_keys(Text *html, const PlotData *s, Arena *arena)
{
    char   text[64];
    double uv[2];
    plot_data_normal_uv(s, PATTERN_WHITE, uv);
    snprintf(text, sizeof text, "%.4f  %.4f", uv[0], uv[1]);
    page_key(html, text, "u′ v′ of white at the normal", false);
    Field  field = plot_data_shift(s, PATTERN_WHITE, arena);
    double limit = fmin(s->cone, radians_from_degrees(60));
    page_key(html, figure_text(field_range(&field, limit).high, text),
             arena_format(arena, "largest Δu′v′ of white within θ %.3g°",
                          degrees_from_radians(limit)), false);
}

static void add_emission_keys(Text *html, const PlotData *s, Arena *arena)
{
    double white = (double)s->normal[PATTERN_WHITE][1];
    double black = (double)s->normal[PATTERN_BLACK][1];
    add_key(html, white, "cd/m²", "white at the normal");
    if (s->has_black) {
        add_key(html, black, "cd/m²", "black at the normal");
        add_key(html, white / black, ": 1", "contrast ratio at the normal, dark room");
    }
    add_shift_keys(html, s, arena);
}

static double largest_error(const json_t *report, bool is_reflection)
{
    size_t  i;
    json_t *table;
    double  most = 0;
    json_array_foreach(json_object_get(report, "tables"), i, table) {
        const char *name = json_string_value(json_object_get(table, "name"));
        if (name && !strncmp(name, "brdf", 4) == is_reflection)
            most = fmax(most, json_number_value(json_object_get(table, "max_error")));
    }
    return most;
}

static void add_file_keys(Text *html, const PlotData *s)
{
    const json_t *total = json_object_get(s->source.report, "total");
    double bytes = json_number_value(json_object_get(total, "bytes"));
    double source = json_number_value(json_object_get(total, "source_bytes_float32"));
    if (bytes > 0 && source > 0)
        add_key(html, 100 * bytes / source, "%", "file size over the source's float32 values");
    for (int part = 0; part < 2; part++) {
        double error = largest_error(s->source.report, part == 1);
        if (error > 0)
            add_key(html, 100 * error, "%", part ? "largest error of a reflection sample"
                                                 : "largest error of an emission sample");
    }
}

static double haze_percent(const PlotData *s)
{
    float cosine = (float)cos(radians_from_degrees(10));
    return 100 * (double)panel_haze_albedo(s->source.panel, cosine);
}

static void add_keys(Text *html, const PlotData *s, Arena *arena)
{
    page_keys_begin(html);
    if (s->emits) add_emission_keys(html, s, arena);
    if (s->has_mirror)
        add_key(html, 100 * plot_data_mirror(s, 0, 0), "%", "mirror reflectance at the normal");
    if (s->reflects)
        add_key(html, haze_percent(s), "%",
                "diffuse reflectance (haze and lambertian part), light at 10°");
    add_file_keys(html, s);
    page_keys_end(html);
}

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

static void add_head(Text *html, const PlotData *s, bool is_dark)
{
    const char *note = json_string_value(json_object_get(s->source.report, "note"));
    page_begin(html, &(PageHead){s->name, PANEL_STYLE, is_dark, 0});
    page_element(html, "h1", s->name);
    text_add(html, "<p class=\"sub\">");
    escape_markup(html, s->file_name);
    text_add(html, note && *note ? " · " : "");
    escape_markup(html, note);
    text_add(html, "</p>\n");
}

static void add_legend(Text *html, const PlotData *s)
{
    text_add(html, "<p class=\"sub legend\">Angles: θ from the normal, φ "
             "counter-clockwise from the viewer's right.");
    if (s->emits && s->cone < PI / 2 - 1e-3)
        text_format(html, " Emission was measured up to θ %.4g°; hatched regions beyond it are "
                    "extrapolated.", degrees_from_radians(s->cone));
    if (s->reflects)
        text_format(html, " Reflection was measured up to an incidence of %.4g° and a leaving "
                    "angle of %.4g°.", degrees_from_radians(s->last_incidence),
                    degrees_from_radians(s->brdf_cone));
    if (s->reflects && panel_info_has_hulls(s->source.panel))
        text_add(html, " At some incidences its samples do not surround all of these: what "
                 "they leave out is hatched, and pale in lines.");
    text_add(html, "</p>\n");
}

static bool add_page(Text *html, const PlotData *s, const PanelChartList *list, bool is_dark,
                     Arena *arena, Error *err)
{
    add_head(html, s, is_dark);
    add_keys(html, s, arena);
    add_legend(html, s);
    if (!add_chapters(html, list, is_dark, arena, err)) return false;
    plot_answer_table(html, s);
    page_element(html, "h2", "Sizes and errors");
    page_element(html, "p class=\"sub\"", "Errors are relative to the measured values; trees "
                 "are shared by tables, whose part is an even share.");
    add_tables(html, s->source.report, *arena);
    page_element(html, "h2", "Choices and provenance");
    add_choices(html, s->source.report, *arena);
    add_notes(html, s->source.report, *arena);
    page_end(html, "panel plot --report", (const char *const[]){PANEL_SCRIPT, NULL});
    return true;
}

bool plot_write_report(const PlotInput *input, const PlotOptions *options, const char *path,
                       Arena *arena, int *figures, Error *err)
{
    json_t     *report = NULL;
    const char *ending = path_ending(path);
    if (strcmp(ending, ".html") && strcmp(ending, ".htm"))
        return error_set(err, ERROR_USAGE, "--report is '%s', wanted a name that ends in .html",
                         path);
    PlotOptions all = *options;
    all.kind = PLOT_ALL;
    PlotData *data = plot_ask(input, &all, arena, &report, err);
    if (!data) return false;
    PanelChartList *list = plot_charts(data, PLOT_ALL, arena);
    Arena       own = arena_reserve(PAGE_BYTES);
    Text        html = {.arena = &own};
    bool ok = add_page(&html, data, list, options->is_dark, arena, err) &&
              text_write(&html, path, err);
    if (ok) *figures = list->count;
    arena_release(&own);
    json_decref(report);
    return ok;
}
