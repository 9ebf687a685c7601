/* SPDX-License-Identifier: Apache-2.0 */
#include "vision/road_glare.h"

#include <math.h>

#include "base/mathd.h"

#define SCOTOPIC_WEIGHT (683.0 / 1699) /* the photopic over the scotopic maximum efficacy */
#define NIGHT_CD_M2 0.005
#define DAY_CD_M2 5.0
#define ROUNDS 200
#define UNCHANGED 1e-14

static double fourth_power(double x) {
    return x * x * (x * x);
}

double road_veil_at(double angle_deg, double age_years) {
    double t = angle_deg;
    if (!(t >= ROAD_VEIL_FROM_DEG && t <= 90 && age_years >= 0)) return NAN;
    if (t > ROAD_VEIL_NEAR_DEG) return 9.86 / (t * t) * (1 + fourth_power(age_years / 66.4));
    return 10 / (t * t * t) + 5 / (t * t) * (1 + fourth_power(age_years / 62.5));
}

/* Per cent of one cd m^-2. */
static double increment_of_one(double road) {
    if (!(road >= ROAD_LUMINANCE_MIN) || isinf(road)) return NAN;
    return road <= ROAD_LUMINANCE_MID ? 65 / pow_d(road, 0.8) : 95 / pow_d(road, 1.05);
}

double road_threshold_increment(double veil_cd_m2, double road_cd_m2) {
    return veil_cd_m2 >= 0 ? veil_cd_m2 * increment_of_one(road_cd_m2) : (double)NAN;
}

double road_veil_of_increment(double increment_pct, double road_cd_m2) {
    return increment_pct >= 0 ? increment_pct / increment_of_one(road_cd_m2) : (double)NAN;
}

/* The weight of day vision under a mesopic luminance. */
static double day_share(double mesopic) {
    if (mesopic <= NIGHT_CD_M2) return 0;
    if (mesopic >= DAY_CD_M2) return 1;
    return fmin(fmax(0.7670 + 0.3334 * log10_d(mesopic), 0), 1);
}

/* The share's slope by itself is below 0.3 wherever S/P is below 4, so that each round lessens
 * what is wrong by as much; the mean of two rounds keeps it from swinging beyond. */
double road_mesopic_luminance(double photopic_cd_m2, double s_p) {
    double p = photopic_cd_m2, s = p * s_p, m = 0.5, found = NAN;
    if (!(p > 0 && s_p > 0 && isfinite(s))) return NAN;
    for (int i = 0; i < ROUNDS; i++) {
        found = (m * p + (1 - m) * s * SCOTOPIC_WEIGHT) / (m + (1 - m) * SCOTOPIC_WEIGHT);
        double next = 0.5 * (m + day_share(found));
        if (fabs(next - m) < UNCHANGED) break;
        m = next;
    }
    return found;
}
