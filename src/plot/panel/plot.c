/* SPDX-License-Identifier: Apache-2.0 */
#include "plot/panel/plot.h"

#include <string.h>

#include "base/count.h"
#include "base/file.h"
#include "base/file_write.h"
#include "panel/query/panel_report.h"
#include "plot/panel/sheet.h"

static bool is_among(PlotKind kind, PlotKind first, PlotKind last) {
    return kind == PLOT_ALL || (kind >= first && kind <= last);
}

PanelChartList *plot_charts(const PlotData *data, PlotKind kind, Arena *arena) {
    static const PanelCharts *const all[] = {&emission_charts, &curve_charts,      &angle_charts,
                                             &colour_charts,   &reflection_charts, &fit_charts,
                                             &place_charts,    &halo_charts};
    PanelChartList *list = ARENA_NEW(arena, PanelChartList, 1);
    list->data = data;
    for (int i = 0; i < COUNT_OF(all); i++)
        if (is_among(kind, all[i]->first, all[i]->last)) all[i]->add(list, data);
    return list;
}

/* The sheet has four columns: spare charts come in, in their order, where the last row would
 * have holes. */
#define SHEET_COLUMNS 4

static void fill_sheet(PanelChartList *list) {
    int always = 0;
    for (int i = 0; i < list->count; i++) always += list->chart[i].role == SHEET_ALWAYS;
    int holes = (SHEET_COLUMNS - always % SHEET_COLUMNS) % SHEET_COLUMNS;
    for (int i = list->count - 1; i >= 0; i--) {
        PanelChart *f = &list->chart[i];
        if (f->role != SHEET_SPARE) continue;
        f->role = holes > 0 ? SHEET_ALWAYS : SHEET_NEVER;
        holes--;
    }
}

static void keep_kind(PanelChartList *list, PlotKind kind) {
    int kept = 0;
    if (kind == PLOT_ALL) fill_sheet(list);
    for (int i = 0; i < list->count; i++) {
        const PanelChart *f = &list->chart[i];
        if (kind == PLOT_ALL ? f->role == SHEET_ALWAYS : f->kind == kind)
            list->chart[kept++] = list->chart[i];
    }
    list->count = kept;
}

/* Why there is no chart of that kind. */
static bool fails_empty(const PlotData *s, PlotKind kind, Error *err) {
    const char *file = s->source.file, *name = plot_kind_name(kind);
    if (kind == PLOT_FIT && !s->source.measured)
        return error_set(err, ERROR_USAGE,
                         "--kind fit wants --measured MANIFEST.json, the set "
                         "that the panel was fitted from");
    if (kind >= PLOT_BRDF && kind <= PLOT_MIRROR && !s->reflects)
        return error_at(err, ERROR_INPUT, file, "",
                        "has no reflection data, which is "
                        "required for --kind %s; fit a set with a 'reflection' entry",
                        name);
    if (kind < PLOT_BRDF && !s->emits)
        return error_at(err, ERROR_INPUT, file, "",
                        "has no emission data, which is "
                        "required for --kind %s; the panel only reflects",
                        name);
    if (kind == PLOT_UNIFORMITY)
        return error_at(err, ERROR_INPUT, file, "",
                        "is the same everywhere: its set had "
                        "neither 'spots' nor 'uniformity'");
    if (kind == PLOT_HALO)
        return error_at(err, ERROR_INPUT, file, "",
                        "has one backlight that is always full: "
                        "its set had no 'local_dimming'");
    if (kind == PLOT_CONTRAST)
        return error_at(err, ERROR_INPUT, file, "",
                        "its black emits nothing, so there is no "
                        "contrast ratio to draw in the dark; --ambient LUX draws one in the "
                        "light");
    if (kind == PLOT_GREY_INVERSION)
        return error_at(err, ERROR_INPUT, file, "",
                        "has no grey inversion to draw: of its "
                        "measured levels none is brighter than a higher one by 1 %% or more");
    if (kind == PLOT_MIRROR)
        return error_at(err, ERROR_INPUT, file, "", "has no mirror part to draw");
    return error_at(err, ERROR_INPUT, file, "", "has nothing to draw for --kind %s", name);
}

/* Contrast in the light needs both: what the panel shines and what it reflects. */
static bool can_be_lit(const PlotData *s, Error *err) {
    if (!s->source.ambient.count || (s->emits && s->reflects)) return true;
    return error_at(err, ERROR_INPUT, s->source.file, "",
                    "has no %s data, which is "
                    "required for --ambient; fit a set with a '%s' entry",
                    s->emits ? "reflection" : "emission", s->emits ? "reflection" : "emission");
}

PlotData *plot_query(const PlotInput *input, const PlotOptions *options, Arena *arena,
                     json_t **report, Error *err) {
    if (!panel_report(input->panel, report, err)) {
        error_in_file(err, input->file);
        return NULL;
    }
    PlotData *data = plot_data_new(
        &(PlotSource){.panel = input->panel,
                      .file = input->file,
                      .reading = input->reading,
                      .report = *report,
                      .measured = input->measured,
                      .incidence_phi = options->incidence_phi,
                      .wants_maps = is_among(options->kind, PLOT_LUMINANCE, PLOT_COLOUR_SHIFT),
                      .threads = options->threads,
                      .contours = options->contours,
                      .ambient = options->ambient,
                      .wants_reflectance = options->wants_reflectance},
        arena);
    if (can_be_lit(data, err)) return data;
    json_decref(*report);
    return NULL;
}

bool plot_write(const PlotInput *input, const PlotOptions *options, const char *path, Arena *arena,
                int *charts, Error *err) {
    json_t *report = NULL;
    PlotBytes bytes = {0};
    const char *ending = path_ending(path);
    bool is_svg = !strcmp(ending, ".svg");
    if (!is_svg && strcmp(ending, ".png"))
        return error_set(err, ERROR_USAGE,
                         "-o is '%s', required: a name that ends in .svg or "
                         ".png",
                         path);
    PlotData *data = plot_query(input, options, arena, &report, err);
    if (!data) return false;
    PanelChartList *list = plot_charts(data, options->kind, arena);
    keep_kind(list, options->kind);
    SheetSpec spec = {list,  data, options->kind, options->width, options->height, options->is_dark,
                      is_svg};
    bool ok = (list->count > 0 || fails_empty(data, options->kind, err)) &&
              sheet_picture(&spec, arena, &bytes, err) &&
              file_write(path, bytes.data, bytes.size, err);
    if (ok) *charts = list->count;
    json_decref(report);
    return ok;
}
