/* SPDX-License-Identifier: Apache-2.0 */
#include "vision/visibility.h"

#include <math.h>

#include "base/mathd.h"

#define NEARLY_ALWAYS 2.6
#define BRIGHT_CD_M2 0.6 /* the ends of the formula's pieces */
#define DIM_CD_M2 0.00418
#define DARKER_CD_M2 0.1
#define JUMP_YEARS 1.0

static double square(double x) {
    return x * x;
}

/* How a target's light adds up over a small area (Ricco), and how far a large one must stand
 * out (Weber): sqrt(phi) and sqrt(L). */
typedef struct Adapted {
    double small, large;
} Adapted;

static Adapted adapted_at(double cd_m2) {
    double lg = log10_d(cd_m2);
    if (cd_m2 >= BRIGHT_CD_M2)
        return (Adapted){log10_d(4.1925 * pow_d(cd_m2, 0.1556)) + 0.1684 * pow_d(cd_m2, 0.5867),
                         0.05946 * pow_d(cd_m2, 0.466)};
    if (cd_m2 <= DIM_CD_M2)
        return (Adapted){pow_d(10, 0.028 + 0.173 * lg),
                         pow_d(10, -0.891 + 0.5275 * lg + 0.0227 * lg * lg)};
    return (Adapted){pow_d(10, -0.072 + 0.3372 * lg + 0.0866 * lg * lg),
                     pow_d(10, -1.256 + 0.319 * lg)};
}

/* Of a lighter target, for somebody of AF 1 who looks at leisure. */
static double plain_threshold(double size_arcmin, double cd_m2) {
    Adapted at = adapted_at(cd_m2);
    return NEARLY_ALWAYS * square(at.small / size_arcmin + at.large);
}

static bool is_positive(double size_arcmin, double cd_m2) {
    return size_arcmin > 0 && cd_m2 > 0 && isfinite(size_arcmin) && isfinite(cd_m2);
}

double visibility_age_factor(double age_years) {
    if (!(age_years >= VISIBILITY_AGE_MIN && age_years <= VISIBILITY_AGE_MAX)) return NAN;
    return age_years < VISIBILITY_AGE_JUMP ? square(age_years - 19) / 2160 + 0.99
                                           : square(age_years - 56.6) / 116.3 + 1.43;
}

double visibility_polarity_factor(double size_arcmin, double adapted_cd_m2) {
    if (!is_positive(size_arcmin, adapted_cd_m2)) return NAN;
    if (adapted_cd_m2 <= VISIBILITY_DARKER_MIN) return 1;
    double slope = adapted_cd_m2 >= DARKER_CD_M2 ? 0.125 : 0.075;
    double inner = pow_d(10, -(slope * square(log10_d(adapted_cd_m2) + 1) + 0.0245));
    double beta = 0.6 * pow_d(adapted_cd_m2, -0.1488);
    return 1 - pow_d(10, -inner) * pow_d(size_arcmin, -beta) /
                   (2.4 * plain_threshold(size_arcmin, adapted_cd_m2));
}

double visibility_glance_factor(double size_arcmin, double adapted_cd_m2, double glance_s) {
    if (!is_positive(size_arcmin, adapted_cd_m2) || !(glance_s > 0)) return NAN;
    if (glance_s >= VISIBILITY_GLANCE_LONG) return 1;
    double x = log10_d(size_arcmin) + 0.523, y = log10_d(adapted_cd_m2) + 6;
    double by_size = 0.36 - 0.0972 * x * x / (x * x - 2.513 * x + 2.7895);
    double by_light = 0.355 - 0.1217 * y * y / (y * y - 10.4 * y + 52.28);
    return (hypot_d(by_size, by_light) / 2.1 + glance_s) / glance_s;
}

double visibility_threshold(const VisibilityTarget *target) {
    const VisibilityTarget *t = target;
    if (!is_positive(t->size_arcmin, t->adapted_cd_m2)) return NAN;
    double threshold = plain_threshold(t->size_arcmin, t->adapted_cd_m2);
    if (t->is_darker) threshold *= visibility_polarity_factor(t->size_arcmin, t->adapted_cd_m2);
    threshold *= visibility_glance_factor(t->size_arcmin, t->adapted_cd_m2, t->glance_s);
    return threshold * visibility_age_factor(t->age_years);
}

double visibility_level(const VisibilityTarget *target, double difference_cd_m2) {
    return fabs(difference_cd_m2) / visibility_threshold(target);
}

unsigned visibility_doubts(const VisibilityTarget *target) {
    const VisibilityTarget *t = target;
    bool is_aged = t->age_years >= VISIBILITY_AGE_MIN && t->age_years <= VISIBILITY_AGE_MAX;
    bool is_at_jump = fabs(t->age_years - VISIBILITY_AGE_JUMP) <= JUMP_YEARS;
    bool is_large = t->size_arcmin > VISIBILITY_SIZE_LARGE;
    bool is_among_people =
        t->adapted_cd_m2 >= VISIBILITY_PEOPLE_MIN && t->adapted_cd_m2 <= VISIBILITY_PEOPLE_MAX;
    bool has_polarity = !t->is_darker || t->adapted_cd_m2 > VISIBILITY_DARKER_MIN;
    const bool DOUBTS[VISIBILITY_DOUBTS] = {[VISIBILITY_DOUBT_AGE] = !is_aged,
                                            [VISIBILITY_DOUBT_JUMP] = is_at_jump,
                                            [VISIBILITY_DOUBT_GLANCE] =
                                                is_large && t->glance_s < VISIBILITY_GLANCE_LONG,
                                            [VISIBILITY_DOUBT_DARKER] = !has_polarity,
                                            [VISIBILITY_DOUBT_LUMINANCE] = !is_among_people};
    unsigned bits = 0;
    for (int i = 0; i < VISIBILITY_DOUBTS; i++) bits |= (unsigned)DOUBTS[i] << i;
    return bits;
}
