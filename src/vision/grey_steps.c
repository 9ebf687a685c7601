/* SPDX-License-Identifier: Apache-2.0 */
#include "vision/grey_steps.h"

#include <math.h>

#include "base/count.h"
#include "base/mathd.h"

/* PS3.14, Table 7-1's formula: the coefficients of powers of ln j, above and below the line. */
static const double ABOVE[] = {-1.3011877, 8.0242636e-2, 1.3646699e-1, -2.5468404e-2, 1.3635334e-3};
static const double BELOW[] = {
    1, -2.5840191e-2, -1.0320229e-1, 2.8745620e-2, -3.1978977e-3, 1.2992634e-4};
/* The coefficients of powers of log10 L. */
static const double INVERSE[] = {71.498068,  94.593053,   41.912053,  9.8247004,   0.28175407,
                                 -1.1878455, -0.18014349, 0.14710899, -0.017046845};

static double polynomial(const double *coefficients, int count, double x) {
    double sum = 0;
    for (int i = count - 1; i >= 0; i--) sum = sum * x + coefficients[i];
    return sum;
}

double grey_steps_luminance(double step) {
    if (!(step >= GREY_STEPS_MIN && step <= GREY_STEPS_MAX)) return NAN;
    double x = log_d(step);
    return pow_d(10, polynomial(ABOVE, COUNT_OF(ABOVE), x) / polynomial(BELOW, COUNT_OF(BELOW), x));
}

double grey_steps_of(double luminance_cd_m2) {
    double l = luminance_cd_m2;
    if (!(l >= GREY_STEPS_MIN_CD_M2 && l <= GREY_STEPS_MAX_CD_M2)) return NAN;
    return polynomial(INVERSE, COUNT_OF(INVERSE), log10_d(l));
}

double grey_steps_between(double one_cd_m2, double other_cd_m2) {
    return fabs(grey_steps_of(one_cd_m2) - grey_steps_of(other_cd_m2));
}

double contrast_sensitivity(double cycles_per_degree, double luminance_cd_m2, double size_deg) {
    double u = cycles_per_degree, l = luminance_cd_m2, x = size_deg;
    if (!(u > 0 && l > 0 && x > 0)) return NAN;
    double optics = exp_d(-0.0016 * u * u * pow_d(1 + 100 / l, 0.08));
    double area = 1 + 144 / (x * x) + 0.64 * u * u;
    double noise = 63 / pow_d(l, 0.83) - 1 / expm1_d(-0.02 * u * u);
    return 5200 * optics / sqrt(area * noise);
}
