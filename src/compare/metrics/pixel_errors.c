/* SPDX-License-Identifier: Apache-2.0 */
#include "compare/metrics/pixel_errors.h"

#include <math.h>

#include "base/mathd.h"
#include "compare/metrics/rank.h"
#include "spectrum/photometry.h"

static float pixel_luminance(const Planes *planes, size_t i) {
    const float rgb[3] = {planes->rgb[0][i], planes->rgb[1][i], planes->rgb[2][i]};
    return luminance_from_rgb(rgb);
}

static double shift_of(double reference, double test) {
    return test == reference ? 0 : test / reference - 1;
}

/* (t - r)^2 / (r^2 + e^2), and nothing for equal values of a black picture. */
static double relative_square(double square, double reference, double e) {
    return square == 0 ? 0 : square / (reference * reference + e * e);
}

void pixel_errors_add_means(PixelErrorSums *sums, const Planes *reference, const Planes *test,
                            PixelMask mask, size_t first, size_t end) {
    for (size_t i = first; i < end; i++) {
        if (mask && !mask[i]) continue;
        sums->luminance[0] += (double)pixel_luminance(reference, i);
        sums->luminance[1] += (double)pixel_luminance(test, i);
        sums->members++;
    }
    sums->floor = sums->luminance[0] / sums->members / 100;
}

void pixel_errors_add_differences(PixelErrorSums *sums, const Planes *reference, const Planes *test,
                                  PixelMask mask, size_t first, size_t end) {
    for (size_t i = first; i < end; i++) {
        if (mask && !mask[i]) continue;
        sums->values += 3;
        for (int c = 0; c < 3; c++) {
            double r = (double)reference->rgb[c][i];
            double difference = fabs((double)test->rgb[c][i] - r);
            double square = difference * difference;
            sums->mae += difference;
            sums->mse += square;
            sums->rel_mse += relative_square(square, r, sums->floor);
            if (difference > sums->max_difference) sums->max_difference = difference;
        }
    }
}

static double bright_luminance(const Planes *planes, PixelMask mask, Arena scratch) {
    size_t count = planes_pixel_count(planes);
    float *luminance = ARENA_NEW(&scratch, float, count);
    for (size_t i = 0; i < count; i++) luminance[i] = pixel_luminance(planes, i);
    return (double)rank_value(luminance, count, mask, 0.999);
}

static double psnr_db(double peak, double mse) {
    if (mse == 0) return INFINITY;
    return peak > 0 ? 10 * log10_d(peak * peak / mse) : peak <= 0 ? -INFINITY : NAN;
}

/* 0 / 0 where no pixel counts: NaN as promised. */
PixelErrors pixel_errors_of(const PixelErrorSums *sums, double peak) {
    double mse = sums->mse / sums->values;
    return (PixelErrors){
        .mae = sums->mae / sums->values,
        .mse = mse,
        .rel_mse = sums->rel_mse / sums->values,
        .max_difference = sums->values > 0 ? sums->max_difference : (double)NAN,
        .psnr_db = psnr_db(peak, mse),
        .peak = peak,
        .mean_shift =
            shift_of(sums->luminance[0] / sums->members, sums->luminance[1] / sums->members),
    };
}

PixelErrors pixel_errors_measure(const Planes *reference, const Planes *test, PixelMask mask,
                                 bool is_light, Arena scratch) {
    PixelErrorSums sums = {0};
    size_t count = planes_pixel_count(reference);
    pixel_errors_add_means(&sums, reference, test, mask, 0, count);
    pixel_errors_add_differences(&sums, reference, test, mask, 0, count);
    return pixel_errors_of(&sums, is_light ? bright_luminance(reference, mask, scratch) : 1);
}
