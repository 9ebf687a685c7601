/* SPDX-License-Identifier: Apache-2.0 */
#include "plot/sky_plot.h"

#include <math.h>
#include <stdint.h>
#include <stdio.h>
#include <string.h>

#include "base/units.h"
#include "plot/draw/ticks.h"

#define PAGE_W 1120.0
#define PAGE_H 620.0
#define MARGIN 40.0
#define DISC_R 200.0
#define PANORAMA_W 560.0

/* One drawing and its scale of colours. */
typedef struct SkyDrawing {
    Canvas *canvas;
    const SkyPlot *plot;
    double low, high; /* cd m^-2 */
    uint32_t colour[AMOUNTS];
} SkyDrawing;

static double position(const SkyDrawing *work, double value) {
    double t = log(fmax(value, 1e-30) / work->low) / log(work->high / work->low);
    return fmin(1, fmax(0, t));
}

/* Three decades or more below the brightest part of the sky, in round numbers. */
static void choose_scale(SkyDrawing *work) {
    const SkyPlot *plot = work->plot;
    double most = 0, least = 1e30;
    for (int i = 0; i < plot->width * plot->height; i++) {
        double v = (double)plot->luminance[i];
        most = fmax(most, v);
        if (v > 0) least = fmin(least, v);
    }
    work->high = round_up(fmax(most, 1e-6));
    work->low = round_down(fmin(fmax(least, work->high * 1e-4), work->high / 10));
    amount_palette(work->colour);
}

/* Bilinear in the panorama; turns from north over east, share from the zenith to the nadir. */
static double luminance_at(const SkyPlot *plot, double turns, double share) {
    double x = (turns - floor(turns)) * plot->width - 0.5, y = share * plot->height - 0.5;
    int i = (int)floor(x), j = (int)fmin(fmax(y, 0), plot->height - 1.001);
    double t = x - i, u = fmin(fmax(y - j, 0), 1);
    int a = (i + plot->width) % plot->width, b = (a + 1) % plot->width;
    const float *top = plot->luminance + (size_t)j * (size_t)plot->width;
    const float *low = top + (j + 1 < plot->height ? plot->width : 0);
    return (1 - u) * ((1 - t) * (double)top[a] + t * (double)top[b]) +
           u * ((1 - t) * (double)low[a] + t * (double)low[b]);
}

typedef double Sample(const SkyDrawing *work, double x, double y);

/* A picture whose colours come from places in [0, 1]^2; NaN: nothing there. */
typedef struct SkyRaster {
    const SkyDrawing *work;
    Sample *sample;
    int w, h;
} SkyRaster;

static uint32_t pixel_at(const void *context, int i, int j) {
    const SkyRaster *raster = context;
    double v = raster->sample(raster->work, (i + 0.5) / raster->w, (j + 0.5) / raster->h);
    return isfinite(v)
               ? raster->work->colour[(int)((AMOUNTS - 1) * position(raster->work, v) + 0.5)]
               : 0;
}

static void paint(const SkyDrawing *work, Box box, Sample *sample) {
    double scale = work->canvas->pixels_per_point;
    SkyRaster raster = {work, sample, (int)(box.w * scale), (int)(box.h * scale)};
    canvas_image(work->canvas, box, &(CanvasRaster){raster.w, raster.h, false, pixel_at, &raster});
}

/* ---- the chart of the dome --------------------------------------------------------------- */

static double disc_sample(const SkyDrawing *work, double x, double y) {
    double dx = 2 * x - 1, dy = 1 - 2 * y, r = sqrt(dx * dx + dy * dy);
    if (r > 1) return NAN;
    return luminance_at(work->plot, atan2(dx, dy) / (2 * PI), 0.5 * r);
}

typedef struct Disc {
    double x, y, r;
} Disc;

static void disc_rings(const SkyDrawing *work, const Disc *disc) {
    Canvas *canvas = work->canvas;
    Stroke thin = {ink_alpha(ink_hex(0xffffff), 0.45), 0.6, DASH_NONE};
    for (int elevation = 30; elevation < 90; elevation += 30) {
        double r = disc->r * (1 - elevation / 90.0);
        char text[16];
        canvas_circle(canvas, disc->x, disc->y, r);
        canvas_stroke(canvas, thin);
        snprintf(text, sizeof text, "%d°", elevation);
        canvas_text(canvas, disc->x + 3, disc->y - r,
                    (Letters){.size = SIZE_SMALL,
                              .ink = ink_hex(0xffffff),
                              .down = 1.1,
                              .halo = ink_alpha(ink_hex(0x14181c), 0.6)},
                    text);
    }
    for (int i = 0; i < 4; i++) {
        double a = i * PI / 4;
        canvas_line(canvas, disc->x - disc->r * sin(a), disc->y + disc->r * cos(a),
                    disc->x + disc->r * sin(a), disc->y - disc->r * cos(a), thin);
    }
    canvas_circle(canvas, disc->x, disc->y, disc->r);
    canvas_stroke(canvas, (Stroke){INK_TEXT, 1, DASH_NONE});
}

static void disc_compass(const SkyDrawing *work, const Disc *disc) {
    static const char *const names[8] = {"N", "NE", "E", "SE", "S", "SW", "W", "NW"};
    for (int i = 0; i < 8; i++) {
        double a = i * PI / 4;
        canvas_text(work->canvas, disc->x + (disc->r + 13) * sin(a),
                    disc->y - (disc->r + 13) * cos(a),
                    (Letters){.size = i % 2 ? SIZE_TICK : SIZE_TEXT,
                              .ink = INK_TEXT,
                              .across = 0.5,
                              .down = 0.5,
                              .is_bold = i % 2 == 0},
                    names[i]);
    }
}

/* The vehicle's way: an arrow at the rim. */
static void disc_heading(const SkyDrawing *work, const Disc *disc) {
    Canvas *canvas = work->canvas;
    double a = work->plot->heading, x[3], y[3], r[3] = {disc->r - 2, disc->r - 18, disc->r - 18};
    double turn[3] = {0, 0.04, -0.04};
    for (int i = 0; i < 3; i++) {
        x[i] = disc->x + r[i] * sin(a + turn[i]);
        y[i] = disc->y - r[i] * cos(a + turn[i]);
    }
    cairo_move_to(canvas->cr, x[0], y[0]);
    cairo_line_to(canvas->cr, x[1], y[1]);
    cairo_line_to(canvas->cr, x[2], y[2]);
    cairo_close_path(canvas->cr);
    canvas_fill(canvas, ink_hex(0xffffff));
    canvas_text(canvas, disc->x + (disc->r - 26) * sin(a), disc->y - (disc->r - 26) * cos(a),
                (Letters){.size = SIZE_SMALL,
                          .ink = ink_hex(0xffffff),
                          .across = 0.5,
                          .down = 0.5,
                          .halo = ink_alpha(ink_hex(0x14181c), 0.6)},
                "ahead");
}

/* ---- the sun and its way ----------------------------------------------------------------- */

typedef void Place(const void *view, double azimuth, double elevation, double *x, double *y);

static void place_disc(const void *view, double azimuth, double elevation, double *x, double *y) {
    const Disc *disc = view;
    double r = disc->r * (1 - elevation / (PI / 2));
    *x = disc->x + r * sin(azimuth);
    *y = disc->y - r * cos(azimuth);
}

static void place_panorama(const void *view, double azimuth, double elevation, double *x,
                           double *y) {
    const Box *box = view;
    double turns = azimuth / (2 * PI);
    *x = box->x + (turns - floor(turns)) * box->w;
    *y = box->y + (0.5 - elevation / PI) * box->h;
}

static void draw_disc(Canvas *canvas, double x, double y, Ink ink) {
    canvas_circle(canvas, x, y, 5);
    canvas_fill(canvas, ink);
    canvas_circle(canvas, x, y, 5);
    canvas_stroke(canvas, (Stroke){ink_hex(0x14181c), 1, DASH_NONE});
}

static void draw_sun(const SkyDrawing *work, Place *place, const void *view, double widest) {
    Canvas *canvas = work->canvas;
    const SkyPlot *plot = work->plot;
    Ink white = ink_hex(0xffffff), dark = ink_hex(0x14181c);
    double x, y, before = 0;
    bool is_drawing = false;
    for (int i = 0; i < plot->path_count; i++) {
        const SkyPlotSun *at = &plot->path[i];
        if (at->elevation < plot->horizon) {
            is_drawing = false;
            continue;
        }
        place(view, at->azimuth, at->elevation, &x, &y);
        if (is_drawing && fabs(x - before) < widest) cairo_line_to(canvas->cr, x, y);
        else cairo_move_to(canvas->cr, x, y);
        is_drawing = true;
        before = x;
    }
    canvas_stroke(canvas, (Stroke){ink_alpha(white, 0.9), 1.2, DASH_SHORT});
    for (int i = 0; i < plot->path_count; i++) {
        const SkyPlotSun *at = &plot->path[i];
        if (!at->label || at->elevation < plot->horizon) continue;
        place(view, at->azimuth, at->elevation, &x, &y);
        canvas_circle(canvas, x, y, 1.8);
        canvas_fill(canvas, white);
        canvas_text(canvas, x, y - 4,
                    (Letters){.size = SIZE_SMALL,
                              .ink = white,
                              .across = 0.5,
                              .down = 1,
                              .halo = ink_alpha(dark, 0.6)},
                    at->label);
    }
    if (plot->has_sun) {
        place(view, plot->sun.azimuth, plot->sun.elevation, &x, &y);
        draw_disc(canvas, x, y, ink_hex(0xfff2c0));
    }
    if (plot->has_moon) {
        place(view, plot->moon.azimuth, plot->moon.elevation, &x, &y);
        draw_disc(canvas, x, y, ink_hex(0xdfe4ea));
    }
}

/* ---- the panorama ------------------------------------------------------------------------ */

static double panorama_sample(const SkyDrawing *work, double x, double y) {
    return luminance_at(work->plot, x, y);
}

static void draw_panorama(const SkyDrawing *work, Box box) {
    static const char *const names[5] = {"N", "E", "S", "W", "N"};
    Canvas *canvas = work->canvas;
    Stroke thin = {ink_alpha(ink_hex(0xffffff), 0.45), 0.6, DASH_NONE};
    double x, y;
    paint(work, box, panorama_sample);
    place_panorama(&box, 0, work->plot->horizon, &x, &y);
    canvas_line(canvas, box.x, y, box.x + box.w, y, (Stroke){ink_hex(0xffffff), 0.9, DASH_LONG});
    for (int i = 0; i < 5; i++) {
        double at = box.x + box.w * i / 4;
        canvas_line(canvas, at, box.y, at, box.y + box.h, thin);
        canvas_text(canvas, at, box.y + box.h + 5,
                    (Letters){.size = SIZE_TICK, .ink = INK_TEXT, .across = 0.5, .is_bold = true},
                    names[i]);
    }
    for (int e = -60; e <= 60; e += 30) {
        char text[16];
        double at = box.y + box.h * (0.5 - e / 180.0);
        canvas_line(canvas, box.x, at, box.x + box.w, at, thin);
        snprintf(text, sizeof text, "%d°", e);
        canvas_text(canvas, box.x - 5, at,
                    (Letters){.size = SIZE_TICK, .ink = INK_SOFT, .across = 1, .down = 0.5}, text);
    }
    draw_sun(work, place_panorama, &box, box.w / 2);
}

/* ---- the scale and the figures ----------------------------------------------------------- */

static double bar_sample(const SkyDrawing *work, double x, double y) {
    (void)y;
    return work->low * pow(work->high / work->low, x);
}

static void draw_scale(const SkyDrawing *work, Box box) {
    Canvas *canvas = work->canvas;
    Ticks ticks = ticks_log(work->low, work->high, 9);
    paint(work, box, bar_sample);
    for (int i = 0; i < ticks.count; i++) {
        double x = box.x + box.w * position(work, ticks.value[i]);
        char text[32];
        canvas_line(canvas, x, box.y + box.h, x, box.y + box.h + (ticks.is_labelled[i] ? 4 : 2),
                    (Stroke){INK_SOFT, 0.7, DASH_NONE});
        if (ticks.is_labelled[i])
            canvas_text(canvas, x, box.y + box.h + 6,
                        (Letters){.size = SIZE_TICK, .ink = INK_TEXT, .across = 0.5},
                        tick_text(ticks.value[i], 0, text));
    }
    canvas_text(canvas, box.x + box.w, box.y - 4,
                (Letters){.size = SIZE_TICK, .across = 1, .ink = INK_SOFT, .down = 1},
                "luminance, cd/m² (without the sun's disc)");
}

static void draw_lines(const SkyDrawing *work, double x, double y) {
    Canvas *canvas = work->canvas;
    for (int i = 0; i < work->plot->line_count; i++) {
        const TableLine *line = &work->plot->line[i];
        double column = i % 2 ? x + PANORAMA_W / 2 : x, down = y + 17 * (i / 2);
        canvas_text(canvas, column, down, (Letters){.size = SIZE_TEXT, .ink = INK_SOFT},
                    line->words);
        canvas_text(canvas, column + 138, down,
                    (Letters){.size = SIZE_TEXT, .ink = INK_TEXT, .is_bold = true}, line->value);
    }
}

static void draw_sheet(Canvas *canvas, const void *context) {
    SkyDrawing work = {.canvas = canvas, .plot = context};
    Disc disc = {MARGIN + DISC_R + 22, MARGIN + 94 + DISC_R, DISC_R};
    Box panorama = {PAGE_W - MARGIN - PANORAMA_W, MARGIN + 72, PANORAMA_W, PANORAMA_W / 2};
    choose_scale(&work);
    canvas_text(canvas, MARGIN, MARGIN,
                (Letters){.size = SIZE_HEADING, .ink = INK_TEXT, .is_bold = true},
                work.plot->title);
    canvas_text(canvas, MARGIN, MARGIN + 27, (Letters){.size = SIZE_TEXT, .ink = INK_SOFT},
                work.plot->subtitle);
    canvas_line(canvas, MARGIN, MARGIN + 46, PAGE_W - MARGIN, MARGIN + 46,
                (Stroke){INK_FAINT, 0.7, DASH_NONE});
    paint(&work, (Box){disc.x - disc.r, disc.y - disc.r, 2 * disc.r, 2 * disc.r}, disc_sample);
    disc_rings(&work, &disc);
    disc_compass(&work, &disc);
    draw_sun(&work, place_disc, &disc, 1e9);
    if (work.plot->has_heading) disc_heading(&work, &disc);
    draw_panorama(&work, panorama);
    draw_scale(&work, (Box){panorama.x, panorama.y + panorama.h + 46, panorama.w, 12});
    draw_lines(&work, panorama.x, panorama.y + panorama.h + 94);
    canvas_text(canvas, MARGIN, PAGE_H - MARGIN + 8,
                (Letters){.size = SIZE_TICK, .ink = INK_SOFT, .down = 0.5},
                "plan of the sky: zenith in the middle, north on "
                "top, east right");
    canvas_text(canvas, PAGE_W - MARGIN, PAGE_H - MARGIN + 8,
                (Letters){.size = SIZE_TICK, .ink = INK_SOFT, .across = 1, .down = 0.5},
                "Parhelion " PARHELION_VERSION);
}

bool sky_plot_draw(const SkyPlot *plot, bool is_svg, int width, Arena *arena, PlotBytes *out,
                   Error *err) {
    double scale = width > 0 ? width / PAGE_W : is_svg ? 1 : 2;
    PictureSpec spec = {.width = PAGE_W,
                        .height = PAGE_H,
                        .scale = scale,
                        .is_svg = is_svg,
                        .draw = draw_sheet,
                        .context = plot};
    return picture_draw(&spec, arena, out, err);
}
