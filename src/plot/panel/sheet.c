/* SPDX-License-Identifier: Apache-2.0 */
#include "plot/panel/sheet.h"

#include <math.h>

#include "base/units.h"
#include "panel/query/panel_info.h"

#define MARGIN 40.0
#define GUTTER 34.0
#define HEADER 66.0
#define FOOTER 30.0

/* ---- where everything goes -------------------------------------------------------------- */

typedef struct Layout {
    int columns, rows;
    bool has_lead; /* the first chart takes two columns and both rows */
    double cell_w, cell_h;
    double width, height; /* of the page, points */
    double scale;         /* pixels per point */
} Layout;

static double sheet_width(int columns, double cell_w) {
    return 2 * MARGIN + columns * cell_w + (columns - 1) * GUTTER;
}

static double sheet_height(int rows, double cell_h) {
    return 2 * MARGIN + HEADER + FOOTER + rows * cell_h + (rows - 1) * GUTTER;
}

/* The size of a cell that letters and lines are made for. */
static void natural_cell(int count, double *w, double *h) {
    *w = count == 1 ? 560 : 376;
    *h = count == 1 ? 460 : 346;
}

static Layout natural_layout(const SheetSpec *spec) {
    int n = spec->list->count;
    Layout l = {.scale = 1};
    l.has_lead = n == 5 && spec->kind == PLOT_LUMINANCE;
    l.columns = l.has_lead ? 4 : n <= 3 ? n : n == 4 ? 2 : n <= 6 ? 3 : 4;
    l.rows = l.has_lead ? 2 : (n + l.columns - 1) / l.columns;
    natural_cell(n, &l.cell_w, &l.cell_h);
    l.width = sheet_width(l.columns, l.cell_w);
    l.height = sheet_height(l.rows, l.cell_h);
    return l;
}

/* As many columns as leave the letters largest; then the cells take what is left over. */
static Layout layout_for_size(const SheetSpec *spec) {
    Layout best = {0};
    double w, h;
    natural_cell(spec->list->count, &w, &h);
    for (int columns = 1; columns <= spec->list->count; columns++) {
        int rows = (spec->list->count + columns - 1) / columns;
        double scale =
            fmin(spec->width / sheet_width(columns, w), spec->height / sheet_height(rows, h));
        if (scale > best.scale) best = (Layout){.columns = columns, .rows = rows, .scale = scale};
    }
    best.width = spec->width / best.scale;
    best.height = spec->height / best.scale;
    best.cell_w = (best.width - sheet_width(best.columns, 0)) / best.columns;
    best.cell_h = (best.height - sheet_height(best.rows, 0)) / best.rows;
    return best;
}

static Layout layout_of(const SheetSpec *spec, double pixels_per_point) {
    if (spec->width > 0) return layout_for_size(spec);
    Layout l = natural_layout(spec);
    l.scale = pixels_per_point;
    return l;
}

/* ---- drawing ---------------------------------------------------------------------------- */

static void draw_heading(Canvas *canvas, const SheetSpec *spec, const Layout *l) {
    const PlotData *s = spec->data;
    const Theme *t = &canvas->theme;
    double width = l->width - 2 * MARGIN;
    const char *source = json_string_value(json_object_get(s->source.report, "source"));
    const char *instrument = json_string_value(json_object_get(s->source.report, "instrument"));
    canvas_text(canvas, MARGIN, MARGIN,
                (Letters){.size = SIZE_HEADING, .ink = t->ink, .is_bold = true},
                canvas_fit_text(canvas, SIZE_HEADING, true, width, s->name));
    const char *line =
        arena_format(canvas->arena, "%s%s%s%s%s", s->file_name, source ? "  ·  fitted from " : "",
                     source ? source : "", instrument && *instrument ? "  ·  " : "",
                     instrument ? instrument : "");
    canvas_text(
        canvas, MARGIN, MARGIN + 27, (Letters){.size = SIZE_TEXT, .ink = t->soft},
        canvas_fit_text(canvas, SIZE_TEXT, false, width, arena_printable(canvas->arena, line)));
    canvas_line(canvas, MARGIN, MARGIN + 46, l->width - MARGIN, MARGIN + 46,
                (Stroke){t->faint, 0.7, DASH_NONE});
}

static bool has_kind(const SheetSpec *spec, PlotKind first, PlotKind last) {
    for (int i = 0; i < spec->list->count; i++)
        if (spec->list->chart[i].kind >= first && spec->list->chart[i].kind <= last) return true;
    return false;
}

static const char *extrapolation_text(Canvas *canvas, const SheetSpec *spec) {
    const PlotData *s = spec->data;
    double cone = degrees_from_radians(s->cone), last = degrees_from_radians(s->last_incidence);
    bool is_fit = has_kind(spec, PLOT_FIT, PLOT_FIT);
    bool emission =
        s->emits && cone < 89.95 && (is_fit || has_kind(spec, PLOT_LUMINANCE, PLOT_SECTIONS));
    bool reflection = s->reflects && (is_fit || has_kind(spec, PLOT_BRDF, PLOT_MIRROR));
    if (emission && reflection)
        return arena_format(canvas->arena,
                            "not measured, extrapolated: emission beyond θ "
                            "%.4g°, reflection beyond θ %.4g° or an incidence of %.4g°",
                            cone, degrees_from_radians(s->brdf_cone), last);
    if (emission)
        return arena_format(canvas->arena, "not measured, extrapolated: beyond θ %.4g°", cone);
    if (reflection && panel_info_has_hulls(s->source.panel))
        return arena_format(canvas->arena,
                            "not measured, extrapolated (pale lines too): "
                            "outside of an incidence's samples, θ %.4g° at most, or beyond an "
                            "incidence of %.4g°",
                            degrees_from_radians(s->brdf_cone), last);
    return reflection ? arena_format(canvas->arena,
                                     "not measured, extrapolated: beyond θ "
                                     "%.4g° or an incidence of %.4g°",
                                     degrees_from_radians(s->brdf_cone), last)
                      : NULL;
}

static void draw_legend(Canvas *canvas, const SheetSpec *spec, const Layout *l) {
    double y = l->height - MARGIN - 6;
    const char *text = extrapolation_text(canvas, spec);
    Letters letters = {.size = SIZE_TICK, .ink = canvas->theme.soft, .down = 0.5};
    if (text) {
        Box swatch = {MARGIN, y - 6, 22, 12};
        cairo_rectangle(canvas->cr, swatch.x, swatch.y, swatch.w, swatch.h);
        canvas_fill(canvas, canvas->theme.grid);
        canvas_hatch(canvas, swatch);
        canvas_text(canvas, MARGIN + 29, y, letters, text);
    }
    letters.across = 1;
    double used = text ? canvas_text_width(canvas, SIZE_TICK, false, text) + 29 + GUTTER : 0;
    const char *sign = "θ from the normal, φ counter-clockwise from the viewer's right  ·  "
                       "Parhelion " PARHELION_VERSION;
    if (used + canvas_text_width(canvas, SIZE_TICK, false, sign) > l->width - 2 * MARGIN)
        sign = "Parhelion " PARHELION_VERSION;
    canvas_text(canvas, l->width - MARGIN, y, letters, sign);
}

static Box chart_box(const Layout *l, int index) {
    Box box = {MARGIN, MARGIN + HEADER, l->cell_w, l->cell_h};
    if (l->has_lead && index == 0) {
        box.w = 2 * l->cell_w + GUTTER;
        box.h = 2 * l->cell_h + GUTTER;
        return box;
    }
    int column = l->has_lead ? 2 + (index - 1) % 2 : index % l->columns;
    int row = l->has_lead ? (index - 1) / 2 : index / l->columns;
    box.x += column * (l->cell_w + GUTTER);
    box.y += row * (l->cell_h + GUTTER);
    return box;
}

/* A page with its layout, while it is drawn. */
typedef struct Sheet {
    const SheetSpec *spec;
    Layout layout;
} Sheet;

static void draw_sheet(Canvas *canvas, const void *context) {
    const Sheet *sheet = context;
    draw_heading(canvas, sheet->spec, &sheet->layout);
    for (int i = 0; i < sheet->spec->list->count; i++)
        panel_chart_draw(canvas, chart_box(&sheet->layout, i), &sheet->spec->list->chart[i]);
    draw_legend(canvas, sheet->spec, &sheet->layout);
}

bool sheet_picture(const SheetSpec *spec, Arena *arena, PlotBytes *out, Error *err) {
    Sheet sheet = {spec, layout_of(spec, spec->is_svg ? 1 : 2)};
    PictureSpec picture = {.width = sheet.layout.width,
                           .height = sheet.layout.height,
                           .scale = sheet.layout.scale,
                           .is_svg = spec->is_svg,
                           .is_dark = spec->is_dark,
                           .draw = draw_sheet,
                           .context = &sheet};
    return picture_draw(&picture, arena, out, err);
}

/* One chart, and where its read-out map goes. */
typedef struct Single {
    const ChartRows *rows;
    const SheetChartFrame *frame;
    ChartMap *map;
} Single;

static void draw_single(Canvas *canvas, const void *context) {
    const Single *one = context;
    Box inside = {4, 4, one->frame->width - 8, one->frame->height - 8};
    *one->map = chart_rows_draw(canvas, inside, one->rows);
}

bool sheet_chart_svg(const ChartRows *rows, const SheetChartFrame *frame, Arena *arena,
                     PlotBytes *out, ChartMap *map, Error *err) {
    Single one = {rows, frame, map};
    PictureSpec picture = {.width = frame->width,
                           .height = frame->height,
                           .scale = 1,
                           .is_svg = true,
                           .is_dark = frame->is_dark,
                           .inline_prefix = frame->prefix,
                           .draw = draw_single,
                           .context = &one};
    return picture_draw(&picture, arena, out, err);
}
