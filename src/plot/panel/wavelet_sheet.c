/* SPDX-License-Identifier: Apache-2.0 */
#include "plot/panel/wavelet_sheet.h"

#include <math.h>

#include "base/file.h"
#include "base/units.h"
#include "plot/draw/chart.h"
#include "plot/draw/polar.h"
#include "plot/draw/ticks.h"

#define MARGIN 30.0
#define HEADING 62.0
#define DISC_W 290.0
#define DISC_H 236.0
#define CHART_W 520.0
#define CHART_H 350.0
#define COLUMNS 5
#define FIELD_SIDE 301

static void draw_heading(Canvas *canvas, const WaveletStudy *study, const char *line)
{
    const char *title = arena_format(canvas->arena, "%s, table %s", path_name(study->file),
                                     study->source->name);
    canvas_text(canvas, MARGIN, MARGIN,
                (Letters){.size = SIZE_HEADING, .ink = canvas->theme.ink, .is_bold = true},
                arena_printable(canvas->arena, title));
    canvas_text(canvas, MARGIN, MARGIN + 25,
                (Letters){.size = SIZE_TEXT, .ink = canvas->theme.soft}, line);
}

/* ---- level by level ---------------------------------------------------------------------- */

static int first_level(const WaveletStudy *study)
{
    return study->level < COLUMNS ? 0 : study->level - COLUMNS + 1;
}

static Field field_of(const WaveletStudy *study, int level, bool is_smooth, Arena *arena)
{
    Field field = field_new(FIELD_SIDE, PI / 2, arena);
    for (int row = 0; row < field.side; row++)
        for (int column = 0; column < field.side; column++)
            field.value[row * field.side + column] = (float)wavelet_study_value(
                study, level, is_smooth, field_direction(&field, row, column));
    return field;
}

static void draw_level(Canvas *canvas, const WaveletStudy *study, int level, bool is_smooth,
                       const FieldRange *range)
{
    double   x = MARGIN + DISC_W * (level - first_level(study));
    double   y = MARGIN + HEADING + (is_smooth ? DISC_H + 24 : 0);
    Field    field = field_of(study, level, is_smooth, canvas->arena);
    bool     is_emission = study->source->channels == 3;
    PolarMap map = {.field = &field, .map = is_emission ? MAP_AMOUNT : MAP_SCATTER,
                    .low = is_emission ? 0 : round_down(fmax(range->low, range->high * 1e-4)),
                    .high = is_emission ? range->high : round_up(range->high),
                    .is_log = !is_emission, .strong = NAN, .is_residual = true,
                    .theta_measured = (double)study->source->theta_max,
                    .unit = is_emission ? "cd/m²" : "sr⁻¹"};
    const WaveletErrors *e = &study->levels[level].errors;
    canvas_text(canvas, x, y, (Letters){.size = SIZE_TITLE, .ink = canvas->theme.ink,
                                        .is_bold = true},
                arena_format(canvas->arena, "level %d, %u triangles%s", level,
                             study->levels[level].triangles,
                             is_smooth ? ", interpolated" : ""));
    canvas_text(canvas, x, y + 15, (Letters){.size = SIZE_SMALL, .ink = canvas->theme.soft},
                arena_format(canvas->arena, "rms error at the samples %.3g %%",
                             100 * (is_smooth ? e->smooth_rms : e->rms)));
    polar_draw(canvas, (Box){x, y + 20, DISC_W - 14, DISC_H - 24}, &map);
}

static void draw_levels(Canvas *canvas, const void *context)
{
    const WaveletStudy *study = context;
    Field      finest = field_of(study, study->level, true, canvas->arena);
    FieldRange range = field_range(&finest, (double)study->source->theta_max);
    draw_heading(canvas, study, arena_format(canvas->arena,
        "means over the triangles of a level, and barycentric interpolation between them: of "
        "%u triangles %u rows are kept", study->levels[study->level].triangles,
        study->kept.rows));
    for (int level = first_level(study); level <= study->level; level++)
        for (int smooth = 0; smooth < 2; smooth++)
            draw_level(canvas, study, level, smooth, &range);
}

bool wavelet_levels_picture(const WaveletStudy *study, Arena *arena, PlotBytes *out, Error *err)
{
    int columns = study->level - first_level(study) + 1;
    PictureSpec spec = {.width = 2 * MARGIN + DISC_W * (columns < 2 ? 2 : columns),
                        .height = 2 * MARGIN + HEADING + 2 * DISC_H + 24,
                        .scale = 1.5, .draw = draw_levels, .context = study};
    return picture_draw(&spec, arena, out, err);
}

/* ---- curves ------------------------------------------------------------------------------ */

typedef struct WaveletCurve {
    const char *name;
    double      y[WAVELET_LEVEL_MAX + 1];
} WaveletCurve;

typedef struct WaveletCurves {
    const char *title;
    AxisSpec    x, y;
    int         count, points;
    double      at[WAVELET_LEVEL_MAX + 1];
    WaveletCurve       curve[4];
} WaveletCurves;

/* Axes around all that is drawn: round numbers of a logarithm, or from 0. */
static void fit_axis(AxisSpec *axis, double low, double high)
{
    axis->low = axis->is_log ? round_down(fmax(low, high * 1e-9)) : 0;
    axis->high = axis->is_log ? round_up(high) : 1.05 * high;
    if (!(axis->high > axis->low)) axis->high = axis->low > 0 ? 10 * axis->low : 1;
    if (axis->is_log && !(axis->low > 0)) axis->low = axis->high / 10;
}

static void draw_curves(Canvas *canvas, Box box, WaveletCurves *of)
{
    static const Dash dashes[4] = {DASH_NONE, DASH_LONG, DASH_SHORT, DASH_DOT};
    double low = INFINITY, high = 0;
    for (int k = 0; k < of->count; k++)
        for (int i = 0; i < of->points; i++) {
            if (of->curve[k].y[i] > 0) low = fmin(low, of->curve[k].y[i]);
            high = fmax(high, of->curve[k].y[i]);
        }
    fit_axis(&of->y, low, high);
    fit_axis(&of->x, of->at[0], of->at[of->points - 1]);
    canvas_text(canvas, box.x, box.y, (Letters){.size = SIZE_TITLE, .ink = canvas->theme.ink,
                                                .is_bold = true}, of->title);
    Chart chart = chart_open(canvas, (Box){box.x, box.y + 12, box.w, box.h - 12}, of->x, of->y,
                             110);
    for (int k = 0; k < of->count; k++) {
        Ink ink = k == 0 ? canvas->theme.ink : k == 1 ? canvas->theme.accent
                                                      : canvas->theme.primary[k == 2 ? 2 : 1];
        chart_curve(&chart, of->at, of->curve[k].y, of->points, (Stroke){ink, 1.5, dashes[k]});
        for (int i = 0; i < of->points; i++)
            chart_dot(&chart, of->at[i], of->curve[k].y[i], 2, ink);
        chart_name_curve(&chart, of->at, of->curve[k].y, of->points, ink, of->curve[k].name);
    }
    chart_close(&chart);
}

static WaveletCurves level_curves(const WaveletStudy *study)
{
    WaveletCurves of = {.title = "Error of each level at the samples",
                 .x = {.is_log = true, .title = "Triangles"},
                 .y = {.is_log = true, .title = "Rms error, %"}, .count = 2,
                 .points = study->level + 1,
                 .curve = {{.name = "means"}, {.name = "interpolated"}}};
    for (int i = 0; i <= study->level; i++) {
        of.at[i] = study->levels[i].triangles;
        of.curve[0].y[i] = 100 * study->levels[i].errors.rms;
        of.curve[1].y[i] = 100 * study->levels[i].errors.smooth_rms;
    }
    return of;
}

static WaveletCurves size_curves(const WaveletStudy *study)
{
    WaveletCurves of = {.title = study->noise > 0 ? "Error beside the size, also from the truth"
                                                  : "Error beside the size",
                 .x = {.is_log = true, .title = "Kept of the source's numbers, %"},
                 .y = {.is_log = true, .title = "Rms error, %"},
                 .count = study->noise > 0 ? 4 : 3, .points = study->size_count,
                 .curve = {{.name = "leaves"}, {.name = "samples"}, {.name = "interpolated"},
                           {.name = "truth"}}};
    for (int i = 0; i < study->size_count; i++) {
        const WaveletSize *size = &study->sizes[i];
        double error[4] = {size->leaf_rms, size->errors.rms, size->errors.smooth_rms,
                           size->truth_rms};
        of.at[i] = 100 * size->share;
        for (int k = 0; k < 4; k++) of.curve[k].y[i] = 100 * error[k];
    }
    return of;
}

static WaveletCurves spectrum_curves(const WaveletStudy *study)
{
    WaveletCurves of = {.title = "The spectrum by a wavelet",
                 .x = {.is_log = true, .title = "Kept of the spectrum's numbers, %"},
                 .y = {.is_log = true, .title = "Rms error, %"}, .count = 3,
                 .points = WAVELET_SPECTRUM_SIZES,
                 .curve = {{.name = "Haar"}, {.name = "CDF 5/3"}, {.name = "CDF 9/7"}}};
    for (int i = 0; i < of.points; i++) {
        of.at[i] = 100 * study->spectrum.share[i];
        for (int k = 0; k < 3; k++) of.curve[k].y[i] = 100 * study->spectrum.rms[k][i];
    }
    return of;
}

static WaveletCurves time_curves(const WaveletStudy *study)
{
    WaveletCurves of = {.title = "Time of a query",
                 .x = {.is_log = true, .title = "Triangles"},
                 .y = {.title = "Nanoseconds"}, .count = 2, .points = WAVELET_TIMED_LEVEL + 1,
                 .curve = {{.name = "mean"}, {.name = "interpolated"}}};
    for (int i = 0; i <= WAVELET_TIMED_LEVEL; i++) {
        of.at[i] = geodesic_count(i);
        of.curve[0].y[i] = study->query_ns[i];
        of.curve[1].y[i] = study->smooth_ns[i];
    }
    return of;
}

static void draw_all_curves(Canvas *canvas, const void *context)
{
    const WaveletStudy *study = context;
    WaveletCurves all[4] = {level_curves(study), size_curves(study), time_curves(study),
                     spectrum_curves(study)};
    draw_heading(canvas, study, "errors are relative to the rms of the table's values");
    for (int i = 0; i < (study->spectrum.count ? 4 : 3); i++)
        draw_curves(canvas, (Box){MARGIN + i % 2 * (CHART_W + 20),
                                  MARGIN + HEADING + i / 2 * (CHART_H + 20), CHART_W, CHART_H},
                    &all[i]);
}

bool wavelet_curves_picture(const WaveletStudy *study, Arena *arena, PlotBytes *out, Error *err)
{
    PictureSpec spec = {.width = 2 * MARGIN + 2 * CHART_W + 20,
                        .height = 2 * MARGIN + HEADING + 2 * CHART_H + 20,
                        .scale = 1.5, .draw = draw_all_curves, .context = study};
    return picture_draw(&spec, arena, out, err);
}
