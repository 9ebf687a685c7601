#include "plot/panel/plot.h"

#include <string.h>

#include "base/file.h"
#include "base/file_write.h"
#include "panel/fit/fit.h"
#include "panel/query/panel_report.h"
#include "plot/panel/page.h"

const char *plot_kind_name(PlotKind kind)
{
    static const char *const NAMES[] = {"all", "luminance", "contrast", "colour-shift",
        "grey-levels", "sections", "chromaticity", "spectra", "brdf", "brdf-spectrum",
        "brdf-map", "mirror", "fit"};
    return NAMES[kind];
}

static bool is_among(PlotKind kind, PlotKind first, PlotKind last)
{
    return kind == PLOT_ALL || (kind >= first && kind <= last);
}

FigureList *plot_figures(const Subject *subject, PlotKind kind, Arena *arena)
{
    FigureList *list = ARENA_NEW(arena, FigureList, 1);
    if (subject->source.wants_maps) figures_add_emission(list, subject);
    if (is_among(kind, PLOT_GREY_LEVELS, PLOT_SECTIONS)) figures_add_curves(list, subject);
    if (is_among(kind, PLOT_CHROMATICITY, PLOT_SPECTRA)) figures_add_colour(list, subject);
    if (is_among(kind, PLOT_BRDF, PLOT_MIRROR)) figures_add_reflection(list, subject);
    if (is_among(kind, PLOT_FIT, PLOT_FIT)) figures_add_fit(list, subject);
    return list;
}

/* The sheet has four columns: spare figures come in, in their order, where the last row would
 * have holes. */
#define SHEET_COLUMNS 4

static void fill_sheet(FigureList *list)
{
    int always = 0;
    for (int i = 0; i < list->count; i++) always += list->figure[i].role == SHEET_ALWAYS;
    int holes = (SHEET_COLUMNS - always % SHEET_COLUMNS) % SHEET_COLUMNS;
    for (int i = list->count - 1; i >= 0; i--) {
        Figure *f = &list->figure[i];
        if (f->role != SHEET_SPARE) continue;
        f->role = holes > 0 ? SHEET_ALWAYS : SHEET_NEVER;
        holes--;
    }
}

static void keep_kind(FigureList *list, PlotKind kind)
{
    int kept = 0;
    if (kind == PLOT_ALL) fill_sheet(list);
    for (int i = 0; i < list->count; i++) {
        const Figure *f = &list->figure[i];
        if (kind == PLOT_ALL ? f->role == SHEET_ALWAYS : f->kind == kind)
            list->figure[kept++] = list->figure[i];
    }
    list->count = kept;
}

/* Why there is no figure of that kind. */
static bool say_nothing_to_draw(const Subject *s, PlotKind kind, Error *err)
{
    const char *file = s->source.file, *name = plot_kind_name(kind);
    if (kind == PLOT_FIT && !s->source.measured)
        return error_set(err, ERROR_USAGE, "--kind fit wants --measured MANIFEST.json, the set "
                         "that the panel was fitted from");
    if (kind >= PLOT_BRDF && kind <= PLOT_MIRROR && !s->reflects)
        return error_at(err, ERROR_INPUT, file, "", "has no reflection data, wanted for --kind "
                        "%s; fit a set with a 'reflection' entry", name);
    if (kind < PLOT_BRDF && !s->emits)
        return error_at(err, ERROR_INPUT, file, "", "has no emission data, wanted for --kind "
                        "%s; the panel only reflects", name);
    if (kind == PLOT_CONTRAST)
        return error_at(err, ERROR_INPUT, file, "", "its black emits nothing, so there is no "
                        "contrast ratio to draw");
    if (kind == PLOT_MIRROR)
        return error_at(err, ERROR_INPUT, file, "", "has no mirror part to draw");
    return error_at(err, ERROR_INPUT, file, "", "has nothing to draw for --kind %s", name);
}

Subject *plot_subject(const PlotInput *input, const PlotOptions *options, Arena *arena,
                      json_t **report, Error *err)
{
    if (!panel_report(input->panel, report, err)) {
        error_in_file(err, input->file);
        return NULL;
    }
    return subject_new(&(SubjectSource){input->panel, input->file, *report, input->measured,
                                        options->incidence_phi,
                                        is_among(options->kind, PLOT_LUMINANCE,
                                                 PLOT_COLOUR_SHIFT), options->threads}, arena);
}

bool plot_write(const PlotInput *input, const PlotOptions *options, const char *path,
                Arena *arena, int *figures, Error *err)
{
    json_t     *report = NULL;
    PlotBytes   bytes = {0};
    const char *ending = path_ending(path);
    bool        is_svg = !strcmp(ending, ".svg");
    if (!is_svg && strcmp(ending, ".png"))
        return error_set(err, ERROR_USAGE, "-o is '%s', wanted a name that ends in .svg or "
                         ".png", path);
    Subject *subject = plot_subject(input, options, arena, &report, err);
    if (!subject) return false;
    FigureList *list = plot_figures(subject, options->kind, arena);
    keep_kind(list, options->kind);
    PageSpec spec = {list, subject, options->kind, options->width, options->height,
                     options->is_dark};
    bool ok = (list->count > 0 || say_nothing_to_draw(subject, options->kind, err)) &&
              (is_svg ? page_svg(&spec, arena, &bytes, err)
                      : page_png(&spec, arena, &bytes, err)) &&
              file_write(path, bytes.data, bytes.size, err);
    if (ok) *figures = list->count;
    json_decref(report);
    return ok;
}
