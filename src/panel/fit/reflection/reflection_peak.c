/* SPDX-License-Identifier: Apache-2.0 */
#include "panel/fit/reflection/reflection_peak.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/mathd.h"
#include "base/units.h"
#include "panel/fit/reflection/peak_window.h"
#include "spectrum/twice.h"

#define WINDOW_FWHMS 6.0 /* rows nearer to the mirror direction than this are looked at */
/* where haze is less than this of the peak, the fitted haze replaces what the subtraction leaves */
#define CORE_SHARE 0.5
#define CORE_FWHMS 1.6      /* and so near to the mirror direction anyway */
#define LEAST_PEAK 0.05     /* times the haze under it: less is no image */
#define WINDOW_STEPS 3.5    /* of the rows: as far a coarse table is looked at */
#define NARROWEST_HAZE 0.05 /* times the instrument's width: a haze's, at least */
#define WIDEST_HAZE 1.0     /* of direction cosines */
#define MODEL_SIGMA 0.01    /* relative: no closer does a real haze follow the model */
#define ENOUGH 0.05         /* relative: as well as a panel should be known */
#define CLOSE_ENOUGH 0.04   /* and so wide its range, since the model errs besides */
#define LEAST_MIRROR 0.002  /* a smaller one need not be known better than this one */

/* The peak of every wavelength out of `value`, its height by a model for the haze. */
static void take_out(const PeakWindow *window, double fwhm, PeakModel model, double *reflectance,
                     float *value) {
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
            bool in_core = spot->angle < CORE_FWHMS * fwhm || haze < CORE_SHARE * peak;
            *at = (float)(in_core ? haze : (double)*at - peak);
        }
    }
}

static float *copy_values(const AngleTable *slice, Arena *arena, AngleTable *haze) {
    size_t count = (size_t)slice->rows * (size_t)slice->channels;
    float *value = ARENA_NEW(arena, float, count);
    memcpy(value, slice->value, sizeof *value * count);
    *haze = *slice;
    haze->value = value;
    return value;
}

/* ---- which mirrors, and which haze under them, rows allow -------------------------------- */

#define CHI_SQUARED 4.0  /* two standard deviations of one number */
#define LEAST_POWER 1.05 /* of the haze */
#define MOST_POWER 4.0
#define POWERS 12 /* of them, that are tried everywhere */
#define WIDTHS 28 /* and widths */
#define POWER_BISECTIONS 8
#define BISECTIONS 12
#define PLACES 9 /* of the haze: quarters of a step, from 0 to two of them */

typedef struct RangeSearch {
    const PeakWindow *window;
    double sigma, step, least; /* least: chi squared of the best */
    double haze[2][PLACES];
    PeakRange *out;
} RangeSearch;

static double chi_squared(const RangeSearch *search, double rest) {
    double rows = rest / search->sigma;
    return rows * rows * search->window->count;
}

static double haze_at(const RangeSearch *search, const PeakModel *model, double b) {
    const PeakWindow *window = search->window;
    double leaving = 1 - reflection_fresnel(cos_d(window->incidence));
    return fmax(0, model->a) * pow_d(1 + b * b / (model->width * model->width), -model->power) +
           window->lambertian * leaving;
}

static void widen(double range[2], double low, double high) {
    range[0] = fmin(range[0], low);
    range[1] = fmax(range[1], high);
}

/* A model that the rows allow, solved; chi: by how much it explains them less well. */
static void take_model(RangeSearch *search, PeakModel *model, double chi) {
    PeakRange *out = search->out;
    double variance[2], room = sqrt(fmax(0, CHI_SQUARED - chi)) * search->sigma;
    peak_window_variances(search->window, model, variance);
    double r = room * sqrt(variance[0]), a = room * sqrt(variance[1]);
    double full = peak_model_fwhm(model);
    widen(out->mirror, model->r - r, model->r + r);
    widen(out->fwhm, full, full);
    for (int k = 0; k < PLACES; k++) {
        double haze = haze_at(search, model, 0.25 * k * search->step);
        double part = model->a > 0 ? fmin(1, a / model->a) : 1;
        double range[2] = {search->haze[0][k], search->haze[1][k]};
        widen(range, haze * (1 - part), haze * (1 + part));
        search->haze[0][k] = range[0], search->haze[1][k] = range[1];
    }
}

/* Tries one width; true: the rows allow it. */
static bool try_width(RangeSearch *search, PeakModel *model, double log_width) {
    model->width = exp_d(log_width);
    double rest = peak_window_solve(search->window, -1, search->window->lambertian, model);
    double chi = chi_squared(search, rest) - search->least;
    if (chi > CHI_SQUARED) return false;
    take_model(search, model, chi);
    return true;
}

/* From a width that the rows allow as far as they allow it. */
static void walk(RangeSearch *search, PeakModel model, double limit) {
    double inside = log_d(model.width), outside = log_d(limit);
    if (try_width(search, &model, outside)) return;
    for (int i = 0; i < BISECTIONS; i++) {
        double middle = 0.5 * (inside + outside);
        if (try_width(search, &model, middle)) inside = middle;
        else outside = middle;
    }
}

/* Tries a power with its best width, and from there all widths; true: the rows allow it. */
static bool try_power(RangeSearch *search, PeakModel *model, double power) {
    const PeakWindow *window = search->window;
    model->power = power;
    double chi = chi_squared(search, peak_window_best_width(window, 0, model)) - search->least;
    if (chi > CHI_SQUARED) return false;
    take_model(search, model, chi);
    for (int k = 0; k < 2; k++) walk(search, *model, window->width[k]);
    return true;
}

/* The same for powers: from the best one towards a limit. */
static void walk_powers(RangeSearch *search, double inside, double outside) {
    PeakModel model = {0};
    if (try_power(search, &model, outside)) return;
    for (int i = 0; i < POWER_BISECTIONS; i++) {
        double middle = 0.5 * (inside + outside);
        if (try_power(search, &model, middle)) inside = middle;
        else outside = middle;
    }
}

static double geometric(double low, double high, double share) {
    return exp_d(log_d(low) + share * log_d(high / low));
}

/* All powers and widths on a grid, then from the best power both ways: the haze that explains
 * rows best may be narrow without a mirror or wide with one. */
static void search_all(RangeSearch *search, PeakModel best) {
    PeakModel model[POWERS * WIDTHS];
    double chi[POWERS * WIDTHS];
    const PeakWindow *window = search->window;
    search->least = chi_squared(search, peak_window_best_width(window, 0, &best));
    for (int i = 0; i < POWERS * WIDTHS; i++) {
        model[i].power = geometric(LEAST_POWER, MOST_POWER, (i / WIDTHS) / (POWERS - 1.0));
        model[i].width =
            geometric(window->width[0], window->width[1], (i % WIDTHS) / (WIDTHS - 1.0));
        chi[i] = chi_squared(search, peak_window_solve(window, -1, window->lambertian, &model[i]));
        search->least = fmin(search->least, chi[i]);
    }
    for (int i = 0; i < POWERS * WIDTHS; i++)
        if (chi[i] - search->least <= CHI_SQUARED)
            take_model(search, &model[i], chi[i] - search->least);
    try_power(search, &best, best.power);
    walk_powers(search, best.power, LEAST_POWER);
    walk_powers(search, best.power, MOST_POWER);
}

/* No row can have more of the image than it has. */
static double most_mirror(const PeakWindow *window, double sigma) {
    double most = 1;
    for (int i = 0; i < window->count; i++) {
        const PeakRow *spot = &window->row[i];
        if (spot->image > 0) most = fmin(most, fmax(0, spot->mean) * (1 + 2 * sigma) / spot->image);
    }
    return most;
}

static void finish(const RangeSearch *search, PeakRange *out) {
    for (int k = 0; k < PLACES; k++) {
        double low = search->haze[0][k], high = search->haze[1][k];
        out->spread = fmax(out->spread, high > 0 ? (high - low) / (high + low) : 1);
    }
    out->haze[0] = search->haze[0][0], out->haze[1] = search->haze[1][0];
}

/* All widths and powers of the haze are tried that explain the rows nearly as well as the best
 * ones (chi squared within 4 of theirs: two standard deviations), each with what its own least
 * squares leave open. sigma: by what a row may miss the model, relative. step: of the rows,
 * radians. */
static PeakRange find_peak_range(const PeakWindow *window, const PeakModel *best, double sigma,
                                 double step) {
    PeakRange out = {.mirror = {1e30, -1e30}, .fwhm = {1e30, 0}, .has_model = true};
    RangeSearch search = {window, sigma, step, 1e30, {{0}}, &out};
    double most = most_mirror(window, sigma);
    if (window->count < PEAK_RANGE_ROWS) return (PeakRange){.mirror = {0, most}};
    for (int k = 0; k < PLACES; k++) search.haze[0][k] = 1e30, search.haze[1][k] = 0;
    search_all(&search, *best);
    finish(&search, &out);
    out.mirror[1] = fmax(0, fmin(out.mirror[1], most));
    out.mirror[0] = fmin(fmax(0, out.mirror[0]), out.mirror[1]);
    return out;
}

/* ---- the mirror's image ------------------------------------------------------------------ */

/* Keeps the rows of an ellipse: `theta` along the plane of incidence, `across` it. */
static void keep_ellipse(PeakWindow *window, double theta, double across) {
    int kept = 0;
    for (int i = 0; i < window->count; i++) {
        double x = window->row[i].tilt / theta, away = window->row[i].angle / across;
        double y2 = away * away - x * x * (theta / across) * (theta / across);
        if (x * x + fmax(0, y2) <= 1) window->row[kept++] = window->row[i];
    }
    window->count = kept;
}

/* A window whose haze may be as narrow as a twentieth of the instrument's image. */
static PeakWindow open_window(const PeakTask *task, double reach, Arena *arena) {
    PeakWindow window = peak_window_collect(task->slice, task->incidence, reach, arena);
    window.width[0] = NARROWEST_HAZE * task->fwhm;
    window.width[1] = fmax(40 * task->fwhm, WIDEST_HAZE);
    window.specular = task->specular;
    peak_window_set_image(&window, task->fwhm);
    return window;
}

static double height_of(const PeakTask *task, double r) {
    return r * 4 * log_d(2) / (PI * task->fwhm * task->fwhm * cos_d(task->incidence));
}

/* By what a row may miss: its noise, what the model misses, and what no model of a surface
 * holds to. */
static double row_sigma(const PeakTask *task, double rest) {
    return fmax(MODEL_SIGMA, fmax(task->noise, rest));
}

/* The range of what a window's rows allow, around its model. */
static void find_range(const PeakTask *task, const PeakWindow *window, const PeakModel *model,
                       PeakMirror *mirror) {
    PeakWindow open = *window;
    PeakModel best = *model;
    open.width[0] = NARROWEST_HAZE * task->fwhm;
    open.width[1] = fmax(40 * task->fwhm, WIDEST_HAZE);
    mirror->model = best;
    mirror->lambertian = window->lambertian;
    mirror->rest = peak_window_solve(window, -1, window->lambertian, &best);
    mirror->range =
        find_peak_range(&open, model, row_sigma(task, mirror->rest), mirror->spacing.widest);
    /* a haze narrower than the instrument's image no instrument has seen as it is */
    mirror->has_haze_open = !mirror->range.has_model || mirror->range.spread > ENOUGH ||
                            peak_model_fwhm(model) < task->fwhm;
}

/* Within 5 % of it, or of the least mirror that matters? */
static bool is_known(const PeakMirror *mirror) {
    const double *range = mirror->range.mirror;
    double middle = 0.5 * (range[0] + range[1]);
    return mirror->range.has_model &&
           0.5 * (range[1] - range[0]) <= CLOSE_ENOUGH * fmax(middle, LEAST_MIRROR);
}

static bool stands_out(const PeakTask *task, const PeakModel *model, double lambertian) {
    return height_of(task, model->r) > LEAST_PEAK * (model->a + lambertian);
}

/* Rows as near as the image's width alone: what fine tables need. True: they determine the
 * mirror, or show that there is none. */
static bool take_near(const PeakTask *task, Arena *arena, PeakMirror *mirror, float *value) {
    PeakWindow window =
        peak_window_collect(task->slice, task->incidence, WINDOW_FWHMS * task->fwhm, arena);
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
static bool take_far(const PeakTask *task, Arena *arena, PeakMirror *mirror, float *value) {
    const PeakSpacing *step = &mirror->spacing;
    double near = WINDOW_FWHMS * task->fwhm, reach = fmax(near, WINDOW_STEPS * step->widest);
    PeakWindow window = open_window(task, reach, arena);
    keep_ellipse(&window, fmax(near, WINDOW_STEPS * step->theta),
                 fmax(near, WINDOW_STEPS * step->across));
    if (window.count < PEAK_RANGE_ROWS) {
        mirror->range = find_peak_range(&window, NULL, MODEL_SIGMA, 0);
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
static double specular_miss(const PeakTask *task, const PeakMirror *mirror, Arena *arena) {
    PeakWindow window = open_window(task, 0, arena);
    return peak_window_specular_miss(&window, &mirror->model);
}

void reflection_peak_take_mirror(const PeakTask *task, Arena *arena, PeakMirror *mirror,
                                 AngleTable *haze_table) {
    PeakTask alone = *task;
    float *value = copy_values(task->slice, arena, haze_table);
    for (int w = 0; w < task->slice->channels; w++) mirror->reflectance[w] = 0;
    alone.specular = NULL;
    mirror->spacing = peak_window_spacing(task->slice, task->incidence, *arena);
    mirror->source = PEAK_SAMPLES;
    if (take_near(&alone, arena, mirror, value)) {
        if (task->specular) mirror->specular_miss = specular_miss(task, mirror, arena);
        return;
    }
    if (task->specular) {
        bool is_known = take_far(task, arena, mirror, value);
        mirror->source = is_known ? PEAK_SPECULAR : PEAK_OPEN;
        if (mirror->range.has_model) mirror->specular_miss = specular_miss(task, mirror, arena);
        return;
    }
    if (!take_far(&alone, arena, mirror, value)) mirror->source = PEAK_OPEN;
}

/* ---- a mirror that the samples do not hold ----------------------------------------------- */

#define WIDEST_IMAGE_DEG 2.0 /* of instruments that do not declare their width */
#define WIDTH_TIMES 1.5      /* the image over a declared width, at most */
#define APART_TIMES 1.5      /* the mirror over the most that the samples have room for */
#define UNSEEN 0.05          /* of a sample: so much of the image goes unseen */
#define NEAR_DEG 15.0        /* samples farther off are not asked */

typedef struct PeakSample {
    double angle, value;
} PeakSample;

static int by_angle(const void *a, const void *b) {
    double p = ((const PeakSample *)a)->angle, q = ((const PeakSample *)b)->angle;
    return (p > q) - (p < q);
}

/* The samples around the mirror direction, from it outwards, each raised to the largest beyond
 * it: no peak lies higher. */
static int collect_samples(const AngleTable *slice, double incidence, PeakSample *out) {
    double reach = radians_from_degrees(NEAR_DEG), most = 0;
    int count = 0;
    for (int i = 0; i < slice->rows; i++) {
        double angle = peak_window_angle((double)slice->theta[i], (double)slice->phi[i], incidence);
        if (angle < reach) out[count++] = (PeakSample){angle, peak_window_row_mean(slice, i)};
    }
    qsort(out, (size_t)count, sizeof *out, by_angle);
    for (int i = count; i-- > 0;) out[i].value = most = fmax(most, out[i].value);
    return count;
}

/* Within the aperture, at most. */
static double light_within(const PeakSample *sample, int count, double radius, double cosine) {
    double sum = 0, inner = 0;
    for (int i = 0; i < count && inner < radius; i++) {
        double outer = i + 1 < count ? fmin(radius, sample[i + 1].angle) : radius;
        sum += sample[i].value * PI * (outer * outer - inner * inner) * cosine;
        inner = fmax(inner, outer);
    }
    return sum;
}

bool reflection_peak_is_apart(const PeakTask *task, Arena scratch) {
    PeakSample *sample = ARENA_NEW(&scratch, PeakSample, task->slice->rows);
    int count = collect_samples(task->slice, task->incidence, sample), half = 0;
    double cosine = cos_d(task->incidence), room = INFINITY;
    double widest =
        task->fwhm > 0 ? WIDTH_TIMES * task->fwhm : radians_from_degrees(WIDEST_IMAGE_DEG);
    if (!count) return true;
    while (half + 1 < count && sample[half].value > 0.5 * sample[0].value) half++;
    double sigma = fmin(fmax(2 * sample[half].angle, task->fwhm), widest) / sqrt(8 * log_d(2));
    double mirror =
        task->specular->mean - light_within(sample, count, 0.5 * task->specular->aperture, cosine);
    bool is_unseen = !(task->fwhm > 0);
    for (int i = 0; i < count; i++) {
        double x = sample[i].angle / sigma;
        double image = exp_d(-0.5 * x * x) / (2 * PI * sigma * sigma * cosine);
        if (image > 0) room = fmin(room, sample[i].value / image);
        is_unseen &= task->specular->mean * image <= UNSEEN * sample[i].value;
    }
    return is_unseen || mirror > APART_TIMES * room;
}

/* No row has a part of the image, so that the specular equation alone sets the mirror. */
void reflection_peak_take_apart(const PeakTask *task, Arena *arena, PeakMirror *mirror,
                                AngleTable *haze_table) {
    float *value = copy_values(task->slice, arena, haze_table);
    mirror->spacing = peak_window_spacing(task->slice, task->incidence, *arena);
    mirror->source = PEAK_APART;
    double least = radians_from_degrees(WIDEST_IMAGE_DEG);
    double reach =
        fmax(2 * least, fmax(task->specular->aperture, WINDOW_STEPS * mirror->spacing.widest));
    PeakWindow window = peak_window_collect(task->slice, task->incidence, reach, arena);
    window.width[0] = fmax(NARROWEST_HAZE * least, 0.5 * mirror->spacing.widest);
    window.width[1] = fmax(40 * least, WIDEST_HAZE);
    window.specular = task->specular;
    PeakModel model = {.width = 1, .power = LEAST_POWER};
    if (window.count >= PEAK_RANGE_ROWS) model = peak_window_choose_haze(&window, least);
    peak_window_solve(&window, -1, window.lambertian, &model);
    mirror->specular_miss =
        model.r < 0 ? twice_share(task->specular->mean - model.r, task->specular->mean) : 0;
    window.stride = 1;
    take_out(&window, 0, model, mirror->reflectance, value);
}
