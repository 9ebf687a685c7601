/* SPDX-License-Identifier: Apache-2.0 */
#include "panel/fit/reflection/reflection_guide.h"

#include <math.h>

#include "base/mathd.h"
#include "panel/fit/reflection/peak_window.h"

#define GUIDE_MISS 0.02 /* relative: rows that miss less between them need no guide */
#define WINDOW_STEPS 3.0

ReflectionGuide reflection_guide_of(const PeakMirror *peak, double incidence)
{
    const PeakModel *model = &peak->model;
    return (ReflectionGuide){.incidence = incidence, .width = model->width,
        .power = model->power, .a = model->a, .lambertian = fmax(1e-9, peak->lambertian),
        .reach = WINDOW_STEPS * peak->spacing.widest};
}

double reflection_guide_log(const ReflectionGuide *guide, double theta, double phi)
{
    double so = sin_d(theta), si = sin_d(guide->incidence), sp = sin_d(0.5 * phi);
    double b2 = (so - si) * (so - si) + 4 * so * si * sp * sp;
    double haze = guide->a * pow_d(1 + b2 / (guide->width * guide->width), -guide->power);
    return log_d(haze + guide->lambertian);
}

/* A direction between cells; the middle channel is what is compared there. */
typedef struct GuideCheck {
    const DirectionGrid *grid;
    const float         *cells;
    int                  channels;
    ReflectionGuide     *guide;
} GuideCheck;

/* Both ways of reading, from the same cells. */
static void compare_at(const GuideCheck *at, double theta, double phi)
{
    const DirectionGrid *grid = at->grid;
    GridTaps taps;
    double   plain = 0, rest = 0;
    if (peak_window_angle(theta, phi, at->guide->incidence) > at->guide->reach) return;
    direction_grid_taps(grid, (float)theta, (float)phi, &taps);
    for (int i = 0; i < taps.count; i++) {
        int    cell = taps.cell[i];
        double log = (double)at->cells[(size_t)cell * (size_t)at->channels +
                                       (size_t)at->channels / 2];
        plain += (double)taps.weight[i] * log;
        rest += (double)taps.weight[i] *
                (log - reflection_guide_log(at->guide, (double)grid->theta[cell / grid->phis],
                                            (double)grid->phi[cell % grid->phis]));
    }
    double guided = rest + reflection_guide_log(at->guide, theta, phi);
    at->guide->miss = fmax(at->guide->miss, fabs(exp_d(fmin(5, plain - guided)) - 1));
}

void reflection_guide_choose(const DirectionGrid *grid, const float *cells, int channels,
                             ReflectionGuide *guide)
{
    GuideCheck at = {grid, cells, channels, guide};
    for (int i = 0; i + 1 < grid->thetas; i++)
        for (int k = 0; k < grid->phis; k++) {
            double theta = (double)grid->theta[i], phi = (double)grid->phi[k];
            double inner = 0.5 * (theta + (double)grid->theta[i + 1]), turn = phi;
            if (k + 1 < grid->phis) turn = 0.5 * (phi + (double)grid->phi[k + 1]);
            compare_at(&at, inner, phi);
            compare_at(&at, theta, turn);
            compare_at(&at, inner, turn);
        }
    guide->is_used = guide->miss > GUIDE_MISS;
}
