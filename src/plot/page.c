#include "plot/page.h"

#include <cairo-svg.h>
#include <math.h>
#include <string.h>

#include "base/file.h"
#include "base/units.h"
#include "plot/text.h"

#define MARGIN 40.0
#define GUTTER 34.0
#define HEADER 66.0
#define FOOTER 30.0

/* ---- where everything goes -------------------------------------------------------------- */

typedef struct Layout {
    int    columns, rows;
    bool   has_lead;      /* the first figure takes two columns and both rows */
    double cell_w, cell_h;
    double width, height; /* of the page, points */
    double scale;         /* pixels per point */
} Layout;

static double page_width(int columns, double cell_w)
{
    return 2 * MARGIN + columns * cell_w + (columns - 1) * GUTTER;
}

static double page_height(int rows, double cell_h)
{
    return 2 * MARGIN + HEADER + FOOTER + rows * cell_h + (rows - 1) * GUTTER;
}

/* The size of a cell that letters and lines are made for. */
static void natural_cell(int count, double *w, double *h)
{
    *w = count == 1 ? 560 : 376;
    *h = count == 1 ? 460 : 346;
}

static Layout natural_layout(const PageSpec *spec)
{
    int    n = spec->list->count;
    Layout l = {.scale = 1};
    l.has_lead = n == 5 && spec->kind == PLOT_LUMINANCE;
    l.columns = l.has_lead ? 4 : n <= 3 ? n : n == 4 ? 2 : n <= 6 ? 3 : 4;
    l.rows = l.has_lead ? 2 : (n + l.columns - 1) / l.columns;
    natural_cell(n, &l.cell_w, &l.cell_h);
    l.width = page_width(l.columns, l.cell_w);
    l.height = page_height(l.rows, l.cell_h);
    return l;
}

/* As many columns as leave the letters largest; then the cells take what is left over. */
static Layout layout_for_size(const PageSpec *spec)
{
    Layout best = {0};
    double w, h;
    natural_cell(spec->list->count, &w, &h);
    for (int columns = 1; columns <= spec->list->count; columns++) {
        int    rows = (spec->list->count + columns - 1) / columns;
        double scale = fmin(spec->width / page_width(columns, w),
                            spec->height / page_height(rows, h));
        if (scale > best.scale)
            best = (Layout){.columns = columns, .rows = rows, .scale = scale};
    }
    best.width = spec->width / best.scale;
    best.height = spec->height / best.scale;
    best.cell_w = (best.width - page_width(best.columns, 0)) / best.columns;
    best.cell_h = (best.height - page_height(best.rows, 0)) / best.rows;
    return best;
}

static Layout layout_of(const PageSpec *spec, double pixels_per_point)
{
    if (spec->width > 0) return layout_for_size(spec);
    Layout l = natural_layout(spec);
    l.scale = pixels_per_point;
    return l;
}

/* ---- drawing ---------------------------------------------------------------------------- */

static void draw_heading(Canvas *canvas, const PageSpec *spec, const Layout *l)
{
    const Subject *s = spec->subject;
    const Theme   *t = &canvas->theme;
    double         width = l->width - 2 * MARGIN;
    const char *source = json_string_value(json_object_get(s->source.report, "source"));
    const char *instrument = json_string_value(json_object_get(s->source.report, "instrument"));
    canvas_text(canvas, MARGIN, MARGIN,
                (Letters){.size = SIZE_HEADING, .ink = t->ink, .is_bold = true},
                canvas_fit_text(canvas, SIZE_HEADING, true, width, s->name));
    const char *line = arena_format(canvas->arena, "%s%s%s%s%s", s->file_name,
                                    source ? "  ·  fitted from " : "", source ? source : "",
                                    instrument && *instrument ? "  ·  " : "",
                                    instrument ? instrument : "");
    canvas_text(canvas, MARGIN, MARGIN + 27, (Letters){.size = SIZE_TEXT, .ink = t->soft},
                canvas_fit_text(canvas, SIZE_TEXT, false, width,
                                text_clean(line, canvas->arena)));
    canvas_line(canvas, MARGIN, MARGIN + 46, l->width - MARGIN, MARGIN + 46,
                (Stroke){t->faint, 0.7, DASH_NONE});
}

static bool has_kind(const PageSpec *spec, PlotKind first, PlotKind last)
{
    for (int i = 0; i < spec->list->count; i++)
        if (spec->list->figure[i].kind >= first && spec->list->figure[i].kind <= last)
            return true;
    return false;
}

static const char *extrapolation_text(Canvas *canvas, const PageSpec *spec)
{
    const Subject *s = spec->subject;
    double cone = degrees_from_radians(s->cone), last = degrees_from_radians(s->last_incidence);
    bool   is_fit = has_kind(spec, PLOT_FIT, PLOT_FIT);
    bool   emission = s->emits && cone < 89.95 &&
                      (is_fit || has_kind(spec, PLOT_LUMINANCE, PLOT_COLOUR_SHIFT) ||
                       has_kind(spec, PLOT_SECTIONS, PLOT_SECTIONS));
    bool   reflection = s->reflects && (is_fit || has_kind(spec, PLOT_BRDF, PLOT_MIRROR));
    if (emission && reflection)
        return arena_format(canvas->arena, "not measured, extrapolated: emission beyond θ "
                            "%.4g°, reflection beyond θ %.4g° or an incidence of %.4g°", cone,
                            degrees_from_radians(s->brdf_cone), last);
    if (emission)
        return arena_format(canvas->arena, "not measured, extrapolated: beyond θ %.4g°", cone);
    return reflection ? arena_format(canvas->arena, "not measured, extrapolated: beyond θ "
                                     "%.4g° or an incidence of %.4g°",
                                     degrees_from_radians(s->brdf_cone), last) : NULL;
}

static void draw_legend(Canvas *canvas, const PageSpec *spec, const Layout *l)
{
    double      y = l->height - MARGIN - 6;
    const char *text = extrapolation_text(canvas, spec);
    Letters     letters = {.size = SIZE_TICK, .ink = canvas->theme.soft, .down = 0.5};
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

static Box figure_box(const Layout *l, int index)
{
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

static void draw_page(cairo_t *cr, const PageSpec *spec, const Layout *l, Arena *arena)
{
    Theme     theme = spec->is_dark ? theme_dark() : theme_light();
    Canvas    canvas = {cr, theme, fmax(l->scale, 1), arena};
    FigureMap unused;
    cairo_rectangle(cr, 0, 0, l->width, l->height);
    canvas_fill(&canvas, canvas.theme.paper);
    draw_heading(&canvas, spec, l);
    for (int i = 0; i < spec->list->count; i++) {
        figure_draw(&canvas, figure_box(l, i), &spec->list->figure[i], &unused);
    }
    draw_legend(&canvas, spec, l);
}

/* ---- bytes ------------------------------------------------------------------------------ */

typedef struct Sink {
    Arena    *arena;
    PlotBytes bytes;
    size_t    capacity;
} Sink;

static cairo_status_t sink_write(void *closure, const unsigned char *data, unsigned length)
{
    Sink *sink = closure;
    if (sink->bytes.size + length + 1 > sink->capacity) {
        size_t         capacity = 2 * (sink->bytes.size + length) + 65536;
        unsigned char *bigger = ARENA_NEW(sink->arena, unsigned char, capacity);
        if (sink->bytes.size > 0) memcpy(bigger, sink->bytes.data, sink->bytes.size);
        sink->bytes.data = bigger;
        sink->capacity = capacity;
    }
    memcpy(sink->bytes.data + sink->bytes.size, data, length);
    sink->bytes.size += length;
    sink->bytes.data[sink->bytes.size] = 0;
    return CAIRO_STATUS_SUCCESS;
}

static bool check(cairo_status_t status, Error *err)
{
    if (status == CAIRO_STATUS_SUCCESS) return true;
    return error_set(err, ERROR_LIBRARY, "cairo cannot draw the picture: %s",
                     cairo_status_to_string(status));
}

/* Ends the drawing: what went wrong on the way is kept by cairo until now. */
static bool finish(cairo_t *cr, cairo_surface_t *surface, Error *err)
{
    cairo_status_t status = cairo_status(cr);
    cairo_destroy(cr);
    cairo_surface_finish(surface);
    if (status == CAIRO_STATUS_SUCCESS) status = cairo_surface_status(surface);
    cairo_surface_destroy(surface);
    return check(status, err);
}

static cairo_surface_t *svg_surface(Sink *sink, double width, double height)
{
    cairo_surface_t *surface = cairo_svg_surface_create_for_stream(sink_write, sink, width,
                                                                   height);
    cairo_svg_surface_set_document_unit(surface, CAIRO_SVG_UNIT_PX);
    return surface;
}

bool page_svg(const PageSpec *spec, Arena *arena, PlotBytes *out, Error *err)
{
    Layout l = layout_of(spec, 1);
    /* The sink grows while figures allocate: it has an arena of its own. */
    Arena  own = arena_reserve((size_t)4 << 30);
    Sink   sink = {.arena = &own};
    const char *title = arena_format(arena, "%s, %s", spec->subject->name,
                                     spec->kind == PLOT_ALL ? "panel plot"
                                                            : plot_kind_name(spec->kind));
    cairo_surface_t *surface = svg_surface(&sink, l.width * l.scale, l.height * l.scale);
    cairo_t         *cr = cairo_create(surface);
    cairo_scale(cr, l.scale, l.scale);
    if (l.scale < 1.6) l.scale = 1.6; /* rasters inside are finer than the page's unit */
    Layout drawn = l;
    draw_page(cr, spec, &drawn, arena);
    bool ok = finish(cr, surface, err);
    if (ok) *out = svg_with_title(svg_with_ids(sink.bytes, "p", false, arena), title, arena);
    arena_release(&own);
    return ok;
}

bool page_png(const PageSpec *spec, Arena *arena, PlotBytes *out, Error *err)
{
    Layout l = layout_of(spec, 2);
    Sink   sink = {.arena = arena};
    cairo_surface_t *surface = cairo_image_surface_create(
        CAIRO_FORMAT_RGB24, (int)(l.width * l.scale + 0.5), (int)(l.height * l.scale + 0.5));
    cairo_t *cr = cairo_create(surface);
    cairo_scale(cr, l.scale, l.scale);
    draw_page(cr, spec, &l, arena);
    cairo_status_t status = cairo_status(cr);
    if (status == CAIRO_STATUS_SUCCESS)
        status = cairo_surface_write_to_png_stream(surface, sink_write, &sink);
    if (!finish(cr, surface, err) || !check(status, err)) return false;
    *out = sink.bytes;
    return true;
}

bool page_figure_svg(const Figure *figure, const FigureFrame *frame, Arena *arena,
                     PlotBytes *out, FigureMap *map, Error *err)
{
    Arena own = arena_reserve((size_t)4 << 30);
    Sink  sink = {.arena = &own};
    cairo_surface_t *surface = svg_surface(&sink, frame->width, frame->height);
    cairo_t         *cr = cairo_create(surface);
    Canvas           canvas = {cr, frame->is_dark ? theme_dark() : theme_light(), 1.6, arena};
    figure->draw(&canvas, (Box){4, 4, frame->width - 8, frame->height - 8}, figure, map);
    bool ok = finish(cr, surface, err);
    if (ok) *out = svg_with_ids(sink.bytes, frame->prefix, true, arena);
    arena_release(&own);
    return ok;
}
