/* SPDX-License-Identifier: Apache-2.0 */
#include "plot/report/report.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

#include "base/count.h"
#include "base/file.h"
#include "base/units.h"
#include "page/page.h"
#include "panel/query/panel_info.h"
#include "plot/draw/ticks.h"
#include "plot/panel/grey_inversion.h"
#include "plot/report/colour_tables.h"
#include "plot/report/error_tables.h"
#include "plot/report/file_report.h"
#include "plot/report/level_tables.h"
#include "plot/report/light_tables.h"
#include "plot/report/place_tables.h"
#include "plot/report/report_figures.h"
#include "plot/report/viewing_tables.h"
#include "spectrum/gamut.h"
#include "text/json_text.h"

#define PAGE_BYTES ((size_t)4 << 30) /* of address space, for the text */

/* report.css and report.js beside this file; the build embeds them. */
extern const char PANEL_STYLE[], PANEL_SCRIPT[];

/* ---- what was measured, by whom, when ---------------------------------------------------- */

static const struct { const char *key, *name; } STATED[] = {
    {"panel", "Panel"}, {"instrument", "Instrument"}, {"date", "Date"},
    {"operator", "Operator"}, {"conditions", "Conditions"}, {"source", "Measurement set"},
    {"source_hash_xxh3", "Its hash (XXH3)"}, {"verdict", "Verdict of the fit"}};

static const char *stated(const PlotData *s, int i)
{
    const char *text = json_string_value(json_object_get(s->source.report, STATED[i].key));
    return text && *text ? arena_printable(s->arena, text) : NULL;
}

static void add_fact(Text *html, const char *name, const char *value)
{
    page_row_begin(html, "");
    page_element(html, "th", name);
    page_cell(html, "", value);
    page_row_end(html);
}

static const char *reach_text(const PlotData *s)
{
    const char *emission = s->emits ? arena_format(s->arena, "emission to θ %.4g°",
                                                   degrees_from_radians(s->cone))
                                    : "no emission";
    if (!s->reflects) return arena_format(s->arena, "%s; no reflection", emission);
    return arena_format(s->arena, "%s; reflection to an incidence of %.4g° and a leaving angle "
                        "of %.4g°", emission, degrees_from_radians(s->last_incidence),
                        degrees_from_radians(s->brdf_cone));
}

static void add_facts(Text *html, const PlotData *s)
{
    text_add(html, "<table class=\"list facts\"><tbody>\n");
    for (int i = 0; i < COUNT_OF(STATED); i++) {
        const char *text = stated(s, i);
        add_fact(html, STATED[i].name, text ? text : "not stated");
    }
    add_fact(html, "Measured", reach_text(s));
    add_fact(html, "Panel file", s->file_name);
    text_add(html, "</tbody></table>\n");
}

/* Degrees without the rounding of a cosine in the file. */
static json_t *degrees_json(bool is_there, double radians)
{
    return is_there ? json_real(round(degrees_from_radians(radians) * 1e4) / 1e4) : json_null();
}

static json_t *facts_json(const PlotData *s)
{
    json_t *out = json_object();
    for (int i = 0; i < COUNT_OF(STATED); i++)
        json_object_set_new(out, STATED[i].key, json_text_or_null(stated(s, i)));
    json_object_set_new(out, "file", json_text(s->source.file));
    json_object_set_new(out, "emission_to_theta_deg",
                        degrees_json(s->emits, s->cone));
    json_object_set_new(out, "reflection_to_incidence_deg",
                        degrees_json(s->reflects, s->last_incidence));
    return out;
}

/* ---- the values looked at first --------------------------------------------------------- */

/* A value and its unit, above its name. */
static void add_key(Text *html, double value, const char *unit, const char *name)
{
    char number[32], text[64];
    snprintf(text, sizeof text, "%s %s", figure_text(value, number), unit);
    page_key(html, text, name, false);
}

static void add_white_keys(Text *html, const PlotData *s, Arena *arena)
{
    double uv[2];
    plot_data_normal_uv(s, PATTERN_WHITE, uv);
    ColourTemperature white = colour_temperature(uv);
    page_key(html, arena_format(arena, "%.4f  %.4f", uv[0], uv[1]),
             "u′ v′ of white at the normal", false);
    if (white.is_defined)
        page_key(html, arena_format(arena, "%.0f K", white.kelvin),
                 arena_format(arena, "colour temperature of white, Duv %.4f", white.duv),
                 false);
}

static void add_inversion_key(Text *html, const PlotData *s, Arena *arena)
{
    GreyLevels levels = grey_levels(s);
    if (!levels.count) return;
    GreyInversion most = grey_inversion_most(s, &levels);
    if (most.share > 0)
        page_key(html, arena_format(arena, "%.3g %%", 100 * most.share),
                 arena_format(arena, "largest grey inversion, at θ %.3g°, φ %.3g°: level %.4g "
                              "is brighter than %.4g", degrees_from_radians(most.theta),
                              degrees_from_radians(most.phi), most.low, most.high), true);
    else page_key(html, "none", "grey inversion of 1 % or more", false);
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
    add_white_keys(html, s, arena);
    add_inversion_key(html, s, arena);
}

static void add_keys(Text *html, const PlotData *s, Arena *arena)
{
    page_keys_begin(html);
    if (s->emits) add_emission_keys(html, s, arena);
    if (s->has_mirror)
        add_key(html, 100 * plot_data_mirror(s, 0, 0), "%", "mirror reflectance at the normal");
    if (s->reflects)
        add_key(html, 100 * plot_data_albedo(s, radians_from_degrees(8)), "%",
                "diffuse reflectance (haze and lambertian part), light at 8°");
    page_keys_end(html);
}

/* ---- the page ---------------------------------------------------------------------------- */

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

static void add_head(Text *html, const PlotData *s, bool is_dark)
{
    const char *note = json_string_value(json_object_get(s->source.report, "note"));
    page_begin(html, &(PageHead){s->name, PANEL_STYLE, is_dark, 0});
    page_element(html, "h1", s->name);
    if (note && *note) page_element(html, "p class=\"sub\"", note);
    add_facts(html, s);
}

static bool add_page(Text *html, const PlotData *s, const Report *report, bool is_dark,
                     Error *err)
{
    Arena          *arena = s->arena;
    PanelChartList *list = plot_charts(s, PLOT_ALL, arena);
    add_head(html, s, is_dark);
    add_keys(html, s, arena);
    add_legend(html, s);
    report_show(report, html);
    text_add(html, "<p class=\"sign\"><span>Place, date</span><span>Signature</span></p>\n");
    if (!report_figures(html, list, is_dark, arena, err)) return false;
    report_of_file(html, s->source.report, *arena);
    page_end(html, "panel report", (const char *const[]){PANEL_SCRIPT, NULL});
    return true;
}

static Report *make_tables(const PlotData *data, Arena *arena)
{
    Report *report = ARENA_NEW(arena, Report, 1);
    report->arena = arena;
    report_viewing(report, data);
    report_colour(report, data);
    report_levels(report, data);
    report_reflection(report, data);
    report_ambient(report, data);
    report_places(report, data);
    report_errors(report, data);
    return report;
}

static bool write_page(const PlotData *data, const Report *report, const PlotOptions *options,
                       const char *path, Error *err)
{
    Arena own = arena_reserve(PAGE_BYTES);
    Text  html = {.arena = &own};
    bool  ok = add_page(&html, data, report, options->is_dark, err) &&
              text_write(&html, path, err);
    arena_release(&own);
    return ok;
}

bool panel_report_write(const PlotInput *input, const PlotOptions *options,
                        const ReportOutput *output, Arena *arena, json_t **answer, Error *err)
{
    json_t     *source = NULL;
    PlotOptions all = *options;
    all.kind = PLOT_ALL;
    all.wants_reflectance = true;
    PlotData *data = plot_ask(input, &all, arena, &source, err);
    if (!data) return false;
    const Report *report = make_tables(data, arena);
    json_t       *document = facts_json(data);
    json_object_set_new(document, "tables", report_json(report));
    bool ok = (!output->tables ||
               report_write_csv(report, document, output->tables, input->file, err)) &&
              (!output->page || write_page(data, report, options, output->page, err));
    if (ok) *answer = document;
    else json_decref(document);
    json_decref(source);
    return ok;
}
