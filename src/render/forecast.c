#include "render/forecast.h"

#include <math.h>
#include <stdbool.h>

#include "render/render.h"

#define GROWTH_DECAY 0.6
#define GROWTH_MAX 0.5
#define HALVES_FROM 32 /* samples from which the error is told by halves (film.h), and smaller */

static bool is_of_halves(uint32_t samples)
{
    return samples >= HALVES_FROM;
}

/* Readings a doubling apart tell the growth; where the way of reading changed in between, the
 * growth before goes on. */
static void watch(Forecast *forecast, uint32_t done, double wanted)
{
    if (forecast->samples && done < 2 * (uint64_t)forecast->samples) return;
    double doublings = forecast->samples ? log2((double)done / (double)forecast->samples) : 0;
    if (forecast->samples && is_of_halves(done) == is_of_halves(forecast->samples))
        forecast->growth =
            fmin(fmax(pow(wanted / forecast->wanted, 1 / doublings) - 1, 0), GROWTH_MAX);
    else
        forecast->growth *= pow(GROWTH_DECAY, doublings);
    forecast->samples = done;
    forecast->wanted = wanted;
}

/* The sum of what all doublings to come will add, as a factor. */
static double growth_to_come(const Forecast *forecast, uint32_t done, double wanted)
{
    double doublings = fmax(log2(wanted / (double)done), 0);
    double sum = GROWTH_DECAY * (1 - pow(GROWTH_DECAY, doublings)) / (1 - GROWTH_DECAY);
    return exp(forecast->growth * sum);
}

/* Passes grow to a size that they keep: a few are counted, the rest is divided. */
static uint32_t end_of_pass(uint32_t done, double wanted, uint32_t most, size_t pixels)
{
    uint64_t end = done;
    for (int i = 0; i < 8 && (double)end < wanted; i++)
        end += render_pass_samples((uint32_t)end, pixels);
    if ((double)end < wanted) {
        double step = render_pass_samples((uint32_t)end, pixels);
        end += (uint64_t)(ceil((wanted - (double)end) / step) * step);
    }
    return end < most ? (uint32_t)end : most;
}

uint32_t forecast_samples(Forecast *forecast, uint32_t done, double error_ratio, uint32_t most,
                          size_t pixels)
{
    double wanted = (double)done * error_ratio * error_ratio;
    if (!isfinite(wanted) || !(wanted > 0)) return most;
    watch(forecast, done, wanted);
    wanted *= growth_to_come(forecast, done, wanted);
    return end_of_pass(done, fmin(fmax(wanted, RENDER_LEAST_SAMPLES), most), most, pixels);
}
