/* SPDX-License-Identifier: Apache-2.0 */
#include "vision/privacy.h"

#include <math.h>

#include "base/mathd.h"

#define LN_10 2.302585092994046

double privacy_security(double white, double black, double reflected) {
    if (!(white >= 0 && black >= 0 && reflected >= 0)) return (double)NAN;
    return white > black ? (white + reflected) / (white - black) : (double)INFINITY;
}

double privacy_security_of_contrast(double ratio) {
    if (!(ratio >= 1)) return (double)NAN;
    if (isinf(ratio)) return 1;
    return ratio > 1 ? ratio / (ratio - 1) : (double)INFINITY;
}

double privacy_s(double security) {
    return isfinite(security) ? log10_d(security) : security;
}

double privacy_s_of_contrast(double ratio) {
    return privacy_s(privacy_security_of_contrast(ratio));
}

/* C = 1/(1 - 10^-S), without the loss of 1 - 10^-S near S = 0. */
double privacy_contrast_of_s(double s) {
    if (!(s >= 0)) return (double)NAN;
    if (s == 0) return (double)INFINITY;
    return -1 / expm1_d(-LN_10 * s);
}
