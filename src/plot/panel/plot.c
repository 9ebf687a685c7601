/* SPDX-License-Identifier: Apache-2.0 */
#include "plot/panel/plot.h"

#include <string.h>

#include "base/file.h"
#include "base/file_write.h"

PlotCharts plot_charts(const PlotData *data, PlotKind kind) {
    PlotCharts charts = {0};
    if (data->emits) emission_charts(&charts, data, kind);
    if (data->reflects) reflection_charts(&charts, data, kind);
    if (data->emits) place_charts(&charts, data, kind);
    return charts;
}

/* Why there is no chart of that kind. */
static bool fails_empty(const PlotData *s, PlotKind kind, Error *err) {
    size_t at = 0;
    for (int k = 0; k < (int)kind; k++) at += strcspn(PLOT_KINDS + at, "|") + 1;
    const char *name = arena_string(s->arena, PLOT_KINDS + at, strcspn(PLOT_KINDS + at, "|"));
    bool is_reflection = kind == PLOT_BRDF || kind == PLOT_REFLECTANCE;
    if (kind == PLOT_FIT && !s->measured)
        return error_set(err, ERROR_USAGE,
                         "--kind fit wants --measured MANIFEST.json, the set "
                         "that the panel was fitted from");
    if (is_reflection ? !s->reflects : !s->emits)
        return error_at(err, ERROR_INPUT, s->file, "",
                        "has no %s data, which is required for --kind %s; fit a set with a "
                        "'%s' entry",
                        is_reflection ? "reflection" : "emission", name,
                        is_reflection ? "reflection" : "emission");
    return error_at(err, ERROR_INPUT, s->file, "", "has nothing to draw for --kind %s: %s", name,
                    kind == PLOT_UNIFORMITY ? "it is the same everywhere, as its set had neither "
                                              "'spots' nor 'uniformity'"
                    : kind == PLOT_CONTRAST ? "its black emits nothing, or was measured with "
                                              "white alone"
                    : kind == PLOT_GREY_LEVELS ? "one level was measured"
                                               : "the set has no emission");
}

/* ---- a sheet ----------------------------------------------------------------------------- */

#define MARGIN 40.0
#define GUTTER 34.0
#define HEADER 66.0
#define FOOTER 30.0

typedef struct Sheet {
    const PlotData *data;
    const PlotCharts *charts;
    int columns;
    double cell_w, cell_h, width, height; /* points */
} Sheet;

static Sheet sheet_of(const PlotData *data, const PlotCharts *charts) {
    int n = charts->count;
    Sheet sheet = {data, charts, n <= 3 ? n : n == 4 ? 2 : n <= 6 ? 3 : 4, 376, 346, 0, 0};
    if (n == 1) sheet.cell_w = 560, sheet.cell_h = 460;
    int rows = (n + sheet.columns - 1) / sheet.columns;
    sheet.width = 2 * MARGIN + sheet.columns * (sheet.cell_w + GUTTER) - GUTTER;
    sheet.height = 2 * MARGIN + HEADER + FOOTER + rows * (sheet.cell_h + GUTTER) - GUTTER;
    return sheet;
}

static void draw_heading(Canvas *canvas, const Sheet *sheet) {
    const PlotData *s = sheet->data;
    double width = sheet->width - 2 * MARGIN;
    const char *source = json_string_value(json_object_get(s->report, "source"));
    const char *instrument = json_string_value(json_object_get(s->report, "instrument"));
    canvas_text(canvas, MARGIN, MARGIN,
                (Letters){.size = SIZE_HEADING, .ink = INK_TEXT, .is_bold = true},
                canvas_fit_text(canvas, SIZE_HEADING, true, width, s->name));
    const char *line =
        arena_format(canvas->arena, "%s%s%s%s%s", s->file_name, source ? "  ·  fitted from " : "",
                     source ? source : "", instrument && *instrument ? "  ·  " : "",
                     instrument ? instrument : "");
    canvas_text(
        canvas, MARGIN, MARGIN + 27, (Letters){.size = SIZE_TEXT, .ink = INK_SOFT},
        canvas_fit_text(canvas, SIZE_TEXT, false, width, arena_printable(canvas->arena, line)));
    canvas_line(canvas, MARGIN, MARGIN + 46, sheet->width - MARGIN, MARGIN + 46,
                (Stroke){INK_FAINT, 0.7, DASH_NONE});
}

static void draw_sheet(Canvas *canvas, const void *context) {
    const Sheet *sheet = context;
    draw_heading(canvas, sheet);
    for (int i = 0; i < sheet->charts->count; i++) {
        const Chart *chart = sheet->charts->chart[i];
        double x = MARGIN + i % sheet->columns * (sheet->cell_w + GUTTER);
        double y = MARGIN + HEADER + i / sheet->columns * (sheet->cell_h + GUTTER);
        canvas_text(canvas, x, y, (Letters){.size = SIZE_TITLE, .ink = INK_TEXT, .is_bold = true},
                    canvas_fit_text(canvas, SIZE_TITLE, true, sheet->cell_w, chart->title));
        canvas_text(canvas, x, y + 17, (Letters){.size = SIZE_TICK, .ink = INK_SOFT},
                    canvas_fit_text(canvas, SIZE_TICK, false, sheet->cell_w, chart->subtitle));
        chart_draw(canvas, (Box){x, y + 34, sheet->cell_w, sheet->cell_h - 34}, chart);
    }
    double y = sheet->height - MARGIN - 6;
    canvas_text(canvas, MARGIN, y, (Letters){.size = SIZE_TICK, .ink = INK_SOFT, .down = 0.5},
                "hatched: not measured, extrapolated");
    canvas_text(canvas, sheet->width - MARGIN, y,
                (Letters){.size = SIZE_TICK, .ink = INK_SOFT, .across = 1, .down = 0.5},
                "Parhelion " PARHELION_VERSION);
}

bool plot_write(const PlotInput *input, PlotKind kind, const char *path, Arena *arena, int *charts,
                Error *err) {
    bool is_svg = !strcmp(path_ending(path), ".svg");
    if (!is_svg && strcmp(path_ending(path), ".png"))
        return error_set(err, ERROR_USAGE,
                         "-o is '%s', required: a name that ends in .svg or "
                         ".png",
                         path);
    PlotData *data = plot_data_new(input, arena, err);
    if (!data) return false;
    PlotCharts list = plot_charts(data, kind);
    PlotBytes bytes = {0};
    bool ok = list.count > 0 || fails_empty(data, kind, err);
    if (ok) {
        Sheet sheet = sheet_of(data, &list);
        ok = picture_draw(&(PictureSpec){sheet.width, sheet.height, is_svg ? 1 : 2, is_svg,
                                         draw_sheet, &sheet},
                          arena, &bytes, err) &&
             file_write(path, bytes.data, bytes.size, err);
    }
    if (ok) *charts = list.count;
    plot_data_free(data);
    return ok;
}

/* A chart alone, and its room. */
typedef struct Single {
    const Chart *chart;
    Box box;
} Single;

static void draw_single(Canvas *canvas, const void *context) {
    const Single *one = context;
    chart_draw(canvas, one->box, one->chart);
}

bool plot_chart_svg(const Chart *chart, double width, double height, Arena *arena, PlotBytes *out,
                    Error *err) {
    Single one = {chart, {4, 4, width - 8, height - 8}};
    return picture_draw(&(PictureSpec){width, height, 1, true, draw_single, &one}, arena, out, err);
}
