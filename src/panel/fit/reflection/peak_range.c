/* SPDX-License-Identifier: Apache-2.0 */
#include "panel/fit/reflection/peak_range.h"

#include <math.h>

#include "base/mathd.h"
#include "base/units.h"
#include "panel/fit/reflection/reflection_fresnel.h"

#define CHI_SQUARED 4.0   /* two standard deviations of one number */
#define LEAST_POWER 1.05   /* of the haze */
#define MOST_POWER 4.0
#define POWERS 12          /* of them, that are asked everywhere */
#define WIDTHS 28          /* and widths */
#define POWER_BISECTIONS 8
#define BISECTIONS 12
#define PLACES 9          /* of the haze: quarters of a step, from 0 to two of them */

typedef struct RangeSearch {
    const PeakWindow *window;
    double     sigma, step, least; /* least: chi squared of the best */
    double     haze[2][PLACES];
    PeakRange *out;
} RangeSearch;

static double chi_squared(const RangeSearch *search, double rest)
{
    double rows = rest / search->sigma;
    return rows * rows * search->window->count;
}

static double haze_at(const RangeSearch *search, const PeakModel *model, double b)
{
    const PeakWindow *window = search->window;
    double leaving = 1 - reflection_fresnel(cos_d(window->incidence));
    return fmax(0, model->a) * pow_d(1 + b * b / (model->width * model->width), -model->power) +
           window->lambertian * leaving;
}

static void widen(double range[2], double low, double high)
{
    range[0] = fmin(range[0], low);
    range[1] = fmax(range[1], high);
}

/* A model that the rows allow, solved; chi: by how much it explains them less well. */
static void take_model(RangeSearch *search, PeakModel *model, double chi)
{
    PeakRange *out = search->out;
    double     variance[2], room = sqrt(fmax(0, CHI_SQUARED - chi)) * search->sigma;
    peak_window_variances(search->window, model, variance);
    double r = room * sqrt(variance[0]), a = room * sqrt(variance[1]);
    double full = 2 * model->width * sqrt(pow_d(2, 1 / model->power) - 1);
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

/* Asks one width; true: the rows allow it. */
static bool ask_width(RangeSearch *search, PeakModel *model, double log_width)
{
    model->width = exp_d(log_width);
    double rest = peak_window_solve(search->window, -1, search->window->lambertian, model);
    double chi = chi_squared(search, rest) - search->least;
    if (chi > CHI_SQUARED) return false;
    take_model(search, model, chi);
    return true;
}

/* From a width that the rows allow as far as they allow it. */
static void walk(RangeSearch *search, PeakModel model, double limit)
{
    double inside = log_d(model.width), outside = log_d(limit);
    if (ask_width(search, &model, outside)) return;
    for (int i = 0; i < BISECTIONS; i++) {
        double middle = 0.5 * (inside + outside);
        if (ask_width(search, &model, middle)) inside = middle;
        else outside = middle;
    }
}

/* Asks a power with its best width, and from there all widths; true: the rows allow it. */
static bool ask_power(RangeSearch *search, PeakModel *model, double power)
{
    const PeakWindow *window = search->window;
    model->power = power;
    double chi = chi_squared(search, peak_window_best_width(window, 0, model)) - search->least;
    if (chi > CHI_SQUARED) return false;
    take_model(search, model, chi);
    for (int k = 0; k < 2; k++) walk(search, *model, window->width[k]);
    return true;
}

/* The same for powers: from the best one towards a limit. */
static void walk_powers(RangeSearch *search, double inside, double outside)
{
    PeakModel model = {0};
    if (ask_power(search, &model, outside)) return;
    for (int i = 0; i < POWER_BISECTIONS; i++) {
        double middle = 0.5 * (inside + outside);
        if (ask_power(search, &model, middle)) inside = middle;
        else outside = middle;
    }
}

static double geometric(double low, double high, double share)
{
    return exp_d(log_d(low) + share * log_d(high / low));
}

/* All powers and widths on a grid, then from the best power both ways: the haze that explains
 * rows best may be narrow without a mirror or wide with one. */
static void search_all(RangeSearch *search, PeakModel best)
{
    PeakModel model[POWERS * WIDTHS];
    double    chi[POWERS * WIDTHS];
    const PeakWindow *window = search->window;
    search->least = chi_squared(search, peak_window_best_width(window, 0, &best));
    for (int i = 0; i < POWERS * WIDTHS; i++) {
        model[i].power = geometric(LEAST_POWER, MOST_POWER, (i / WIDTHS) / (POWERS - 1.0));
        model[i].width = geometric(window->width[0], window->width[1],
                                   (i % WIDTHS) / (WIDTHS - 1.0));
        chi[i] = chi_squared(search, peak_window_solve(window, -1, window->lambertian,
                                                       &model[i]));
        search->least = fmin(search->least, chi[i]);
    }
    for (int i = 0; i < POWERS * WIDTHS; i++)
        if (chi[i] - search->least <= CHI_SQUARED)
            take_model(search, &model[i], chi[i] - search->least);
    ask_power(search, &best, best.power);
    walk_powers(search, best.power, LEAST_POWER);
    walk_powers(search, best.power, MOST_POWER);
}

/* No row can have more of the image than it has. */
static double most_mirror(const PeakWindow *window, double sigma)
{
    double most = 1;
    for (int i = 0; i < window->count; i++) {
        const PeakRow *spot = &window->row[i];
        if (spot->image > 0)
            most = fmin(most, fmax(0, spot->mean) * (1 + 2 * sigma) / spot->image);
    }
    return most;
}

static void finish(const RangeSearch *search, PeakRange *out)
{
    for (int k = 0; k < PLACES; k++) {
        double low = search->haze[0][k], high = search->haze[1][k];
        out->spread = fmax(out->spread, high > 0 ? (high - low) / (high + low) : 1);
    }
    out->haze[0] = search->haze[0][0], out->haze[1] = search->haze[1][0];
}

PeakRange peak_range_find(const PeakWindow *window, const PeakModel *best, double sigma,
                          double step)
{
    PeakRange out = {.mirror = {1e30, -1e30}, .fwhm = {1e30, 0}, .has_model = true};
    RangeSearch    search = {window, sigma, step, 1e30, {{0}}, &out};
    double    most = most_mirror(window, sigma);
    if (window->count < PEAK_RANGE_ROWS) return (PeakRange){.mirror = {0, most}};
    for (int k = 0; k < PLACES; k++) search.haze[0][k] = 1e30, search.haze[1][k] = 0;
    search_all(&search, *best);
    finish(&search, &out);
    out.mirror[1] = fmax(0, fmin(out.mirror[1], most));
    out.mirror[0] = fmin(fmax(0, out.mirror[0]), out.mirror[1]);
    return out;
}
