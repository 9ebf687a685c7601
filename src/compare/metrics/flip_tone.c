/* SPDX-License-Identifier: Apache-2.0 */
#include "compare/metrics/flip_tone.h"

#include <math.h>

static const double CURVES[3][6] = {
    [FLIP_ACES] = {0.36 * 2.51, 0.6 * 0.03, 0, 0.36 * 2.43, 0.6 * 0.59, 0.14},
    [FLIP_REINHARD] = {0, 1, 0, 0, 1, 1},
    [FLIP_HABLE] = {0.231683, 0.013791, 0, 0.18, 0.3, 0.018},
};

static double tone_curve(const double p[6], double x) {
    return (p[0] * x * x + p[1] * x + p[2]) / (p[3] * x * x + p[4] * x + p[5]);
}

void flip_tone_map(FlipToneMapper mapper, double rgb[3]) {
    if (mapper == FLIP_REINHARD) {
        double luminance = 0.2126 * rgb[0] + 0.7152 * rgb[1] + 0.0722 * rgb[2];
        for (int c = 0; c < 3; c++) rgb[c] /= 1 + luminance;
    } else {
        for (int c = 0; c < 3; c++) rgb[c] = tone_curve(CURVES[mapper], rgb[c]);
    }
}

double flip_tone_input(FlipToneMapper mapper, double shown) {
    const double *p = CURVES[mapper], t = shown;
    double a = p[0] - t * p[3], b = p[1] - t * p[4], c = p[2] - t * p[5];
    if (a == 0) return -c / b;
    return (-b + sqrt(b * b - 4 * a * c)) / (2 * a);
}
