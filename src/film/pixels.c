/* SPDX-License-Identifier: Apache-2.0 */
#include "film/pixels.h"

#include <math.h>

#include "spectrum/spectral_table.h"

static const struct {
    unsigned users;
    int      size;
} layer_sums[SUMS_COUNT] = {
    [SUMS_DEPTH] = {LAYER_DEPTH, 1},
    [SUMS_POSITION] = {LAYER_POSITION, 3},
    [SUMS_NORMAL] = {LAYER_NORMAL, 3},
    [SUMS_ALBEDO] = {LAYER_ALBEDO, 3},
    [SUMS_UV] = {LAYER_UV, 2},
    [SUMS_EMITTED] = {LAYER_DISPLAY_EMITTED, 3},
    [SUMS_REFLECTED] = {LAYER_DISPLAY_REFLECTED | LAYER_DISPLAY_CONTRAST |
                        LAYER_DISPLAY_SCATTERED | LAYER_DISPLAY_HAZE | LAYER_DISPLAY_HALVES, 3},
    [SUMS_WHITE] = {LAYER_DISPLAY_WHITE | LAYER_DISPLAY_CONTRAST, 3},
    [SUMS_BLACK] = {LAYER_DISPLAY_BLACK | LAYER_DISPLAY_CONTRAST, 3},
    [SUMS_DIRECTION] = {LAYER_DISPLAY_ANGLES, 3},
    [SUMS_FINE] = {LAYER_DISPLAY_FINE, 3},
    [SUMS_MIRROR] = {LAYER_DISPLAY_MIRROR | LAYER_DISPLAY_SCATTERED | LAYER_DISPLAY_HAZE, 3},
    [SUMS_LAMBERTIAN] = {LAYER_NEEDS_LAMBERTIAN, 3},
    [SUMS_ODD] = {LAYER_DISPLAY_HALVES, 4},
    [SUMS_STOKES] = {LAYER_STOKES, 3},
};

unsigned layer_sums_users(LayerSums sums)
{
    return layer_sums[sums].users;
}

int layer_sums_size(LayerSums sums)
{
    return layer_sums[sums].size;
}

/* (sum of squares - (sum)^2 / n) / (n - 1) / n for each of R, G, B. */
void pixel_variance(const PixelSums *sums, double variance[3])
{
    double n = (double)sums->samples, xyz[3];
    for (int i = 0; i < 3; i++) xyz[i] = double_from_fixed(sums->xyz[i], FIXED_BITS);
    for (int i = 0; i < 3; i++) {
        const float *row = rgb_from_xyz_matrix + 3 * i;
        double       sum = (double)row[0] * xyz[0] + (double)row[1] * xyz[1] +
                     (double)row[2] * xyz[2];
        double squares = double_from_fixed(sums->squares[i][0], SQUARE_LOW_BITS) +
                         double_from_fixed(sums->squares[i][1], SQUARE_HIGH_BITS);
        double spread = squares - sum * sum / n;
        variance[i] = n < 2 ? (double)NAN : spread > 0 ? spread / (n - 1) / n : 0;
    }
}

/* odd: samples of sum_odd, of n. */
static bool halves_of(const Fixed sum[3], const Fixed sum_odd[3], double n, double odd,
                      int least, double xyz[3])
{
    double even = n - odd;
    if (odd < least || even < least) return false;
    for (int i = 0; i < 3; i++) {
        double odd_sum = double_from_fixed(sum_odd[i], FIXED_BITS);
        double even_sum = double_from_fixed(sum[i] - sum_odd[i], FIXED_BITS);
        xyz[i] = (odd_sum / odd - even_sum / even) * sqrt(odd * even) / n;
    }
    return true;
}

bool pixel_halves(const PixelSums *sums, int least, double xyz[3])
{
    return halves_of(sums->xyz, sums->odd_xyz, (double)sums->samples, (double)sums->odd_samples,
                     least, xyz);
}

bool pixel_display_halves(const PixelSums *sums, const Fixed reflected[3], const Fixed odd[4],
                          int least, double xyz[3])
{
    return halves_of(reflected, odd, (double)sums->display_hits,
                     double_from_fixed(odd[3], FIXED_BITS), least, xyz);
}

/* From the samples' spread, as if they were independent: the most it can be. */
static double sigma_of_spread(const double variance_rgb[3])
{
    return 0.2126 * sqrt(variance_rgb[0]) + 0.7152 * sqrt(variance_rgb[1]) +
           0.0722 * sqrt(variance_rgb[2]);
}

/* One difference d of two normal means gives sigma only in the mean over pixels, where E|d| =
 * sqrt(2 / pi) sigma_d. */
static double sigma_of_halves(double difference)
{
    return 1.2533141373155003 * fabs(difference);
}

double pixel_sigma_y(const PixelSums *sums)
{
    double variance_rgb[3], halves[3];
    if (pixel_halves(sums, BLOCK_SAMPLES, halves)) return sigma_of_halves(halves[1]);
    pixel_variance(sums, variance_rgb);
    return sigma_of_spread(variance_rgb);
}
