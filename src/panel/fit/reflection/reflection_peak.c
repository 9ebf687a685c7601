/* SPDX-License-Identifier: Apache-2.0 */
#include "panel/fit/reflection/reflection_peak.h"

#include <math.h>
#include <string.h>

#include "base/mathd.h"
#include "base/units.h"
#include "panel/fit/reflection/peak_window.h"

#define WINDOW_FWHMS 6.0 /* rows nearer to the mirror direction than this are looked at */
#define LOBE_FWHMS 3.0   /* the same for a lobe, whose haze need not follow the model so far */
#define CORE_SHARE 0.5   /* where haze is less than this of the peak, the fitted haze replaces
                            what the subtraction leaves */
#define CORE_FWHMS 1.6   /* and so near to the mirror direction anyway */
#define LEAST_PEAK 0.05  /* times the haze under it: less is no image */
#define LOBE_REST 0.006  /* relative, rms: a lobe explains the data this well, or it is none */
#define LOBE_HEIGHT 1.0  /* times the haze under it, at least */
#define WINDOW_STEPS 3.5     /* of the rows: as far a coarse table is looked at */
#define NARROWEST_HAZE 0.05  /* times the instrument's width: a haze's, at least */
#define WIDEST_HAZE 1.0      /* of direction cosines */
#define MODEL_SIGMA 0.01     /* relative: no closer does a real haze follow the model */
#define ENOUGH 0.05          /* relative: as well as a panel should be known */
#define CLOSE_ENOUGH 0.04            /* and so wide its range, since the model errs besides */
#define LEAST_MIRROR 0.002   /* a smaller one need not be known better than this one */
#define SEARCH_DEG 6.0   /* a lobe's top is nearer to the mirror direction than this */

/* The peak of every wavelength out of `value`, its height by a model for the haze. */
static void take_out(const PeakWindow *window, double fwhm, PeakModel model,
                     double *reflectance,
                     float *value)
{
    int size = window->slice->channels;
    for (int w = 0; w < size; w++) {
        double lambertian = peak_window_lambertian(window->slice, w);
        peak_window_solve(window, w, lambertian, &model);
        reflectance[w] = fmax(0, model.r);
        for (int i = 0; i < window->count; i++) {
            const PeakRow *spot = &window->row[i];
            float *at = value + (size_t)spot->row * (size_t)size + w;
            double haze = fmax(peak_model_haze(&model, spot) + lambertian * spot->leaving, 0);
            double peak = reflectance[w] * spot->image;
            bool   in_core = spot->angle < CORE_FWHMS * fwhm || haze < CORE_SHARE * peak;
            *at = (float)(in_core ? haze : (double)*at - peak);
        }
    }
}

static float *copy_values(const AngleTable *slice, Arena *arena, AngleTable *haze)
{
    size_t count = (size_t)slice->rows * (size_t)slice->channels;
    float *value = ARENA_NEW(arena, float, count);
    memcpy(value, slice->value, sizeof *value * count);
    *haze = *slice;
    haze->value = value;
    return value;
}

/* ---- the mirror's image ------------------------------------------------------------------ */

/* Keeps the rows of an ellipse: `theta` along the plane of incidence, `across` it. */
static void keep_ellipse(PeakWindow *window, double theta, double across)
{
    int kept = 0;
    for (int i = 0; i < window->count; i++) {
        double x = window->row[i].tilt / theta, away = window->row[i].angle / across;
        double y2 = away * away - x * x * (theta / across) * (theta / across);
        if (x * x + fmax(0, y2) <= 1) window->row[kept++] = window->row[i];
    }
    window->count = kept;
}

/* A window whose haze may be as narrow as a twentieth of the instrument's image. */
static PeakWindow open_window(const PeakTask *task, double reach, Arena *arena)
{
    PeakWindow window = peak_window_collect(task->slice, task->incidence, reach, arena);
    window.width[0] = NARROWEST_HAZE * task->fwhm;
    window.width[1] = fmax(40 * task->fwhm, WIDEST_HAZE);
    window.specular = task->specular;
    peak_window_set_image(&window, task->fwhm);
    return window;
}

static double height_of(const PeakTask *task, double r)
{
    return r * 4 * log_d(2) / (PI * task->fwhm * task->fwhm * cos_d(task->incidence));
}

/* By what a row may miss: its noise, what the model misses, and what no model of a surface
 * holds to. */
static double row_sigma(const PeakTask *task, double rest)
{
    return fmax(MODEL_SIGMA, fmax(task->noise, rest));
}

/* Full width at half of the haze's height. A haze narrower than the instrument's image no
 * instrument has seen as it is. */
static double haze_width(const PeakModel *model)
{
    return 2 * model->width * sqrt(pow_d(2, 1 / model->power) - 1);
}

/* The range of what a window's rows allow, around its model. */
static void find_range(const PeakTask *task, const PeakWindow *window, const PeakModel *model,
                       PeakMirror *mirror)
{
    PeakWindow open = *window;
    PeakModel  best = *model;
    open.width[0] = NARROWEST_HAZE * task->fwhm;
    open.width[1] = fmax(40 * task->fwhm, WIDEST_HAZE);
    mirror->model = best;
    mirror->lambertian = window->lambertian;
    mirror->rest = peak_window_solve(window, -1, window->lambertian, &best);
    mirror->range = peak_range_find(&open, model, row_sigma(task, mirror->rest),
                                    mirror->spacing.widest);
    mirror->has_haze_open = !mirror->range.has_model || mirror->range.spread > ENOUGH ||
                            haze_width(model) < task->fwhm;
}

/* Within 5 % of it, or of the least mirror that matters? */
static bool is_known(const PeakMirror *mirror)
{
    const double *range = mirror->range.mirror;
    double middle = 0.5 * (range[0] + range[1]);
    return mirror->range.has_model &&
           0.5 * (range[1] - range[0]) <= CLOSE_ENOUGH * fmax(middle, LEAST_MIRROR);
}

static bool stands_out(const PeakTask *task, const PeakModel *model, double lambertian)
{
    return height_of(task, model->r) > LEAST_PEAK * (model->a + lambertian);
}

/* Rows as near as the image's width alone: what fine tables need. True: they determine the
 * mirror, or show that there is none. */
static bool take_near(const PeakTask *task, Arena *arena, PeakMirror *mirror, float *value)
{
    PeakWindow window = peak_window_collect(task->slice, task->incidence,
                                            WINDOW_FWHMS * task->fwhm, arena);
    if (window.count < 12) return false;
    peak_window_set_image(&window, task->fwhm);
    PeakModel model = peak_window_choose_haze(&window, task->fwhm);
    find_range(task, &window, &model, mirror);
    if (!is_known(mirror)) return false;
    bool has_image = stands_out(task, &model, window.lambertian);
    if (!has_image && mirror->range.mirror[0] > ENOUGH * LEAST_MIRROR) return false;
    window.stride = 1;
    if (has_image) take_out(&window, task->fwhm, model, mirror->reflectance, value);
    return true;
}

/* Rows from further away, as far as a coarse grid needs, and a specular measurement. The best
 * that there is comes out of the table even where it is open. */
static bool take_far(const PeakTask *task, Arena *arena, PeakMirror *mirror, float *value)
{
    const PeakSpacing *step = &mirror->spacing;
    double near = WINDOW_FWHMS * task->fwhm, reach = fmax(near, WINDOW_STEPS * step->widest);
    PeakWindow window = open_window(task, reach, arena);
    keep_ellipse(&window, fmax(near, WINDOW_STEPS * step->theta),
                 fmax(near, WINDOW_STEPS * step->across));
    if (window.count < PEAK_RANGE_ROWS) {
        mirror->range = peak_range_find(&window, NULL, MODEL_SIGMA, 0);
        mirror->has_haze_open = true;
        return false;
    }
    PeakModel model = peak_window_choose_haze(&window, task->fwhm);
    find_range(task, &window, &model, mirror);
    window.stride = 1;
    take_out(&window, task->fwhm, model, mirror->reflectance, value);
    for (int w = 0; w < task->slice->channels; w++)
        mirror->reflectance[w] = fmin(mirror->reflectance[w], 1);
    return is_known(mirror);
}

/* By how much the specular measurement differs from what samples give without it. */
static double specular_miss(const PeakTask *task, const PeakMirror *mirror, Arena *arena)
{
    PeakWindow window = open_window(task, 0, arena);
    return peak_window_specular_miss(&window, &mirror->model);
}

void reflection_peak_take_mirror(const PeakTask *task, Arena *arena, PeakMirror *mirror,
                                 AngleTable *haze_table)
{
    PeakTask alone = *task;
    float   *value = copy_values(task->slice, arena, haze_table);
    for (int w = 0; w < task->slice->channels; w++) mirror->reflectance[w] = 0;
    alone.specular = NULL;
    mirror->spacing = peak_spacing_find(task->slice, task->incidence, *arena);
    mirror->source = PEAK_SAMPLES;
    if (take_near(&alone, arena, mirror, value)) {
        if (task->specular) mirror->specular_miss = specular_miss(task, mirror, arena);
        return;
    }
    if (task->specular) {
        bool is_known = take_far(task, arena, mirror, value);
        mirror->source = is_known ? PEAK_SPECULAR : PEAK_OPEN;
        return;
    }
    if (!take_far(&alone, arena, mirror, value)) mirror->source = PEAK_OPEN;
}

/* ---- a lobe ------------------------------------------------------------------------------ */

static double row_angle(const AngleTable *slice, int row, double incidence)
{
    return peak_window_angle((double)slice->theta[row], (double)slice->phi[row], incidence);
}

/* Full width at half of the largest value near the mirror direction; 0: the largest value is
 * not there. By the outermost row above half of it, or the grid's step if that is wider. */
static double guess_width(const AngleTable *slice, double incidence)
{
    double top = 0, reach = radians_from_degrees(SEARCH_DEG), half = 0, nearest = 1;
    for (int i = 0; i < slice->rows; i++) {
        double angle = row_angle(slice, i, incidence);
        if (angle < reach) top = fmax(top, peak_window_row_mean(slice, i));
        if (angle > 1e-6) nearest = fmin(nearest, angle);
    }
    for (int i = 0; i < slice->rows; i++) {
        double angle = row_angle(slice, i, incidence);
        if (angle < reach && peak_window_row_mean(slice, i) > 0.5 * top)
            half = fmax(half, angle);
    }
    return half > 0.8 * reach ? 0 : 2 * fmax(half, nearest);
}

/* The residual at a width, with the haze that suits it best. */
static double rest_of_width(PeakWindow *window, double fwhm, double haze, PeakModel *model)
{
    peak_window_set_image(window, fwhm);
    *model = peak_window_choose_haze(window, haze);
    return peak_window_solve(window, -1, window->lambertian, model);
}

/* The width that leaves the least, by golden section over its logarithm. haze: begins there. */
static double choose_width(PeakWindow *window, const double range[2], double haze,
                           PeakModel *model)
{
    double low = log_d(range[0]), high = log_d(range[1]);
    double a = high - 0.618034 * (high - low), b = low + 0.618034 * (high - low);
    double left = rest_of_width(window, exp_d(a), haze, model);
    double right = rest_of_width(window, exp_d(b), haze, model);
    for (int i = 0; i < 12; i++) {
        if (left < right) {
            high = b, b = a, right = left;
            a = high - 0.618034 * (high - low);
            left = rest_of_width(window, exp_d(a), haze, model);
        } else {
            low = a, a = b, left = right;
            b = low + 0.618034 * (high - low);
            right = rest_of_width(window, exp_d(b), haze, model);
        }
    }
    rest_of_width(window, exp_d(0.5 * (low + high)), haze, model);
    return exp_d(0.5 * (low + high));
}

/* rms of what the model leaves where the peak is the larger part, relative. */
static double core_rest(const PeakWindow *window, const PeakModel *model)
{
    double squares = 0, count = 0;
    for (int i = 0; i < window->count; i++) {
        const PeakRow *spot = &window->row[i];
        double haze = peak_model_haze(model, spot) + window->lambertian * spot->leaving;
        double peak = model->r * spot->image;
        if (peak < haze) continue;
        double rest = (spot->mean - haze - peak) / (haze + peak);
        squares += rest * rest;
        count++;
    }
    return count > 2 ? sqrt(squares / count) : 1;
}

bool reflection_peak_take_lobe(const AngleTable *slice, double incidence, double noise,
                               Arena *arena,
                               ReflectionLobe *lobe, AngleTable *haze_table)
{
    double guess = guess_width(slice, incidence);
    *haze_table = *slice;
    if (!(guess > 0)) return false;
    PeakWindow window = peak_window_collect(slice, incidence, LOBE_FWHMS * guess, arena);
    if (window.count < 16) return false;
    PeakModel model;
    double fwhm = choose_width(&window, (double[2]){0.5 * guess, 2 * guess}, 2 * guess, &model);
    double rest = peak_window_solve(&window, -1, window.lambertian, &model);
    double most = LOBE_REST + 2 * noise;
    double peak = 4 * log_d(2) / (PI * fwhm * fwhm * cos_d(incidence));
    if (!(model.r * peak > LOBE_HEIGHT * (model.a + window.lambertian)) || rest > most ||
        core_rest(&window, &model) > most)
        return false;
    window.stride = 1;
    lobe->fwhm = fwhm;
    take_out(&window, 0, model, lobe->reflectance, copy_values(slice, arena, haze_table));
    return true;
}
