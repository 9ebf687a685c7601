/* SPDX-License-Identifier: Apache-2.0 */
#include "sky/air/phase_series.h"

#include <math.h>

/* Gauss-Legendre on [0, 1]. */
const double phase_cosine[PHASE_SIDE] = {
    0.01985507175123188, 0.10166676129318663, 0.23723379504183550, 0.40828267875217511,
    0.59171732124782489, 0.76276620495816450, 0.89833323870681337, 0.98014492824876812};
const double phase_weight[PHASE_SIDE] = {
    0.05061426814518813, 0.11119051722668724, 0.15685332293894364, 0.18134189168918099,
    0.18134189168918099, 0.15685332293894364, 0.11119051722668724, 0.05061426814518813};

void phase_legendre(int m, double x, double value[PHASE_MOMENTS]) {
    double sine = sqrt(fmax(0, 1 - x * x)), start = 1;
    for (int k = 1; k <= m; k++) start *= -sine * sqrt((2 * k - 1) / (2.0 * k));
    for (int l = 0; l < PHASE_MOMENTS; l++) value[l] = 0;
    if (m >= PHASE_MOMENTS) return;
    value[m] = start;
    if (m + 1 < PHASE_MOMENTS) value[m + 1] = x * sqrt(2 * m + 1.0) * start;
    for (int l = m + 2; l < PHASE_MOMENTS; l++)
        value[l] =
            ((2 * l - 1) * x * value[l - 1] - sqrt((l - 1.0) * (l - 1) - m * m) * value[l - 2]) /
            sqrt((double)l * l - m * m);
}

float phase_series_mode(AirPart part, const double a[PHASE_MOMENTS], const double b[PHASE_MOMENTS],
                        int m) {
    double sum = 0, moment = 1;
    for (int l = 0; l < PHASE_MOMENTS; l++) {
        double of_molecules = l == 0 ? 1 : l == 2 ? 0.1 : 0;
        if (l >= m)
            sum += (2 * l + 1) * (part == AIR_MOLECULES ? of_molecules : moment) * a[l] * b[l];
        moment *= (double)AIR_ASYMMETRY;
    }
    return (float)sum;
}
