#include "compare/metrics/pixel_errors.h"

#include <math.h>

#include "base/mathd.h"
#include "compare/metrics/rank.h"
#include "spectrum/photometry.h"

static float pixel_luminance(const Planes *planes, size_t i)
{
    const float rgb[3] = {planes->rgb[0][i], planes->rgb[1][i], planes->rgb[2][i]};
    return luminance_from_rgb(rgb);
}

static double mean_luminance(const Planes *planes, PixelMask mask)
{
    double sum = 0, members = 0;
    for (size_t i = 0; i < planes_pixel_count(planes); i++) {
        if (mask && !mask[i]) continue;
        sum += (double)pixel_luminance(planes, i);
        members++;
    }
    return sum / members; /* 0 / 0: no pixel, NaN as promised */
}

static double shift_of(double reference, double test)
{
    return test == reference ? 0 : test / reference - 1;
}

/* (t - r)^2 / (r^2 + e^2), and nothing for equal values of a black picture. */
static double relative_square(double square, double reference, double e)
{
    return square == 0 ? 0 : square / (reference * reference + e * e);
}

static void add_differences(const Planes *reference, const Planes *test, PixelMask mask,
                            double e, PixelErrors *out)
{
    double members = 0;
    for (size_t i = 0; i < planes_pixel_count(reference); i++) {
        if (mask && !mask[i]) continue;
        members += 3;
        for (int c = 0; c < 3; c++) {
            double r = (double)reference->rgb[c][i];
            double difference = fabs((double)test->rgb[c][i] - r);
            double square = difference * difference;
            out->mae += difference;
            out->mse += square;
            out->rel_mse += relative_square(square, r, e);
            if (difference > out->max_difference) out->max_difference = difference;
        }
    }
    out->mae /= members;
    out->mse /= members;
    out->rel_mse /= members;
    if (members == 0) out->max_difference = NAN;
}

static double bright_luminance(const Planes *planes, PixelMask mask, Arena scratch)
{
    size_t count = planes_pixel_count(planes);
    float *luminance = ARENA_NEW(&scratch, float, count);
    for (size_t i = 0; i < count; i++) luminance[i] = pixel_luminance(planes, i);
    return (double)rank_value(luminance, count, mask, 0.999);
}

static double psnr_db(double peak, double mse)
{
    if (mse == 0) return INFINITY;
    return peak > 0 ? 10 * log10_d(peak * peak / mse) : peak <= 0 ? -INFINITY : NAN;
}

PixelErrors pixel_errors_measure(const Planes *reference, const Planes *test, PixelMask mask,
                                 bool is_light, Arena scratch)
{
    double      mean = mean_luminance(reference, mask);
    PixelErrors errors = {
        .peak = is_light ? bright_luminance(reference, mask, scratch) : 1,
        .mean_shift = shift_of(mean, mean_luminance(test, mask)),
    };
    add_differences(reference, test, mask, mean / 100, &errors);
    errors.psnr_db = psnr_db(errors.peak, errors.mse);
    return errors;
}
