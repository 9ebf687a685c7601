/* SPDX-License-Identifier: Apache-2.0 */
#include "measure/pixel_noise.h"

#include <math.h>

#include "base/confidence.h"
#include "spectrum/photometry.h"

double pixel_noise_luminance(const double variance[3]) {
    float sigma[3], xyz[3];
    for (int c = 0; c < 3; c++) sigma[c] = sqrtf((float)variance[c]);
    xyz_from_rgb(sigma, xyz);
    return (double)xyz[1] * (double)xyz[1];
}

void pixel_noise_add(PixelNoise *noise, const double rgb[3], double luminance) {
    noise->luminance += luminance;
    noise->fourths += luminance * luminance;
    for (int c = 0; c < 3; c++) noise->rgb[c] += rgb[c];
    noise->pixels++;
}

bool pixel_noise_of_halves(const PixelNoise *halves, long pixels, double least, PixelNoise *out) {
    double freedom =
        halves->fourths > 0 ? 3 * halves->luminance * halves->luminance / halves->fourths : 0;
    if (halves->pixels != pixels || freedom < least) return false;
    double factor = student_quantile(freedom) / SIGMAS_95;
    *out = *halves;
    out->luminance *= factor * factor;
    for (int c = 0; c < 3; c++) out->rgb[c] *= factor * factor;
    return true;
}

void rim_noise_add(RimNoise *rim, double spread, const double rgb[3]) {
    float in[3] = {(float)rgb[0], (float)rgb[1], (float)rgb[2]};
    const double values[4] = {rgb[0], rgb[1], rgb[2], (double)luminance_from_rgb(in)};
    if (!(spread > 0)) return;
    rim->spread += spread;
    for (int k = 0; k < 4; k++) {
        rim->means[k] += spread * values[k];
        rim->squares[k] += spread * values[k] * values[k];
    }
}

void rim_noise_put(const RimNoise *rim, const double rgb[3], PixelNoise *to) {
    float in[3] = {(float)rgb[0], (float)rgb[1], (float)rgb[2]};
    double variance[4];
    const double mean[4] = {rgb[0], rgb[1], rgb[2], (double)luminance_from_rgb(in)};
    for (int k = 0; k < 4; k++)
        variance[k] = fmax(
            rim->squares[k] - 2 * mean[k] * rim->means[k] + mean[k] * mean[k] * rim->spread, 0);
    for (int c = 0; c < 3; c++) to->rgb[c] += variance[c];
    to->luminance += variance[3];
}
