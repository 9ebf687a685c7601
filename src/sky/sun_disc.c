/* SPDX-License-Identifier: Apache-2.0 */
#include "sky/sun_disc.h"

#include <math.h>

#include "base/mathd.h"
#include "base/mathf.h"
#include "base/units.h"

#define BANDS 11
#define FIRST_NM 320.0
#define STEP_NM 40.0

static const double limb[BANDS][6] = {
    {0.087657, 0.767174, 0.658123, -1.02953, 0.703297, -0.186735},
    {0.122953, 1.01278, 0.238687, -1.12208, 1.17087, -0.424947},
    {0.123511, 1.08444, -0.405598, 0.370629, -0.240567, 0.0674778},
    {0.158489, 1.23346, -0.875754, 0.857812, -0.484919, 0.110895},
    {0.198587, 1.30507, -1.25998, 1.49727, -1.04047, 0.299516},
    {0.23695, 1.29927, -1.28034, 1.3776, -0.85054, 0.21706},
    {0.26892, 1.34319, -1.58427, 1.91271, -1.3135, 0.37295},
    {0.299804, 1.36718, -1.80884, 2.29294, -1.60595, 0.454874},
    {0.33551, 1.30791, -1.79382, 2.44646, -1.89082, 0.594769},
    {0.364007, 1.27316, -1.73824, 2.28535, -1.70203, 0.517758},
    {0.389704, 1.2448, -1.69708, 2.14061, -1.51803, 0.440004}};

double sun_angular_radius(double distance_au) {
    return asin_d(SUN_RADIUS_KM / (ASTRONOMICAL_UNIT_KM * distance_au));
}

double disc_share_above(double above) {
    if (above >= 1) return 1;
    if (above <= -1) return 0;
    return 0.5 + (above * sqrt(1 - above * above) + asin_d(above)) / PI;
}

void sun_limb(double nm, double coefficient[6]) {
    double at = fmax(0, fmin((nm - FIRST_NM) / STEP_NM, BANDS - 1.000001)), mean = 0;
    int i = (int)at;
    for (int k = 0; k < 6; k++) {
        coefficient[k] = limb[i][k] + (at - i) * (limb[i + 1][k] - limb[i][k]);
        mean += 2 * coefficient[k] / (k + 2);
    }
    for (int k = 0; k < 6; k++) coefficient[k] /= mean;
}

void sun_limb_curves(Curve limb_curve[SUN_LIMB_TERMS]) {
    for (int i = 0; i < CURVE_COUNT; i++) {
        double c[SUN_LIMB_TERMS];
        sun_limb(CURVE_FIRST_NM + i, c);
        for (int k = 0; k < SUN_LIMB_TERMS; k++) limb_curve[k].value[i] = (float)c[k];
    }
}

Spectrum sun_limb_shade(const Curve limb_curve[SUN_LIMB_TERMS], float share,
                        const Wavelengths *wavelengths) {
    float mu = safe_sqrtf(1 - share * share);
    Spectrum value = spectrum_all(0);
    for (int k = SUN_LIMB_TERMS - 1; k >= 0; k--)
        value = value * spectrum_all(mu) + curve_lookup(&limb_curve[k], wavelengths);
    return spectrum_max(value, spectrum_all(0));
}
