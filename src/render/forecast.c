/* SPDX-License-Identifier: Apache-2.0 */
#include "render/forecast.h"

#include <math.h>
#include <stdbool.h>

#include "base/mathd.h"

#define GROWTH_DECAY 0.6
#define GROWTH_MAX 0.5
#define HALVES_FROM 32 /* samples from which halves give the error (film.h): less of it */

static bool is_of_halves(uint32_t samples) {
    return samples >= HALVES_FROM;
}

/* Readings a doubling apart give the growth; where the method of reading changed in between,
 * the growth before decays on. */
static void watch(Forecast *forecast, uint32_t done, double wanted) {
    if (forecast->samples && done < 2 * (uint64_t)forecast->samples) return;
    double before = forecast->samples, doublings = before > 0 ? log2_d(done / before) : 0;
    if (forecast->samples && is_of_halves(done) == is_of_halves(forecast->samples))
        forecast->growth =
            fmin(fmax(pow_d(wanted / forecast->wanted, 1 / doublings) - 1, 0), GROWTH_MAX);
    else forecast->growth *= pow_d(GROWTH_DECAY, doublings);
    forecast->samples = done;
    forecast->wanted = wanted;
}

/* The factor by which all doublings to come will raise the count. */
static double growth_to_come(const Forecast *forecast, uint32_t done, double wanted) {
    double doublings = fmax(log2_d(wanted / (double)done), 0);
    double sum = GROWTH_DECAY * (1 - pow_d(GROWTH_DECAY, doublings)) / (1 - GROWTH_DECAY);
    return exp_d(forecast->growth * sum);
}

double forecast_samples(Forecast *forecast, uint32_t done, double error_ratio) {
    double wanted = (double)done * error_ratio * error_ratio;
    if (!isfinite(wanted)) return INFINITY;
    if (!(wanted > 0)) return 0;
    watch(forecast, done, wanted);
    return wanted * growth_to_come(forecast, done, wanted);
}
