/* SPDX-License-Identifier: Apache-2.0 */
#include "vision/contrast_sensitivity.h"

#include <math.h>

#include "base/mathd.h"

double contrast_sensitivity(double cycles_per_degree, double luminance_cd_m2, double size_deg)
{
    double u = cycles_per_degree, l = luminance_cd_m2, x = size_deg;
    if (!(u > 0 && l > 0 && x > 0)) return NAN;
    double optics = exp_d(-0.0016 * u * u * pow_d(1 + 100 / l, 0.08));
    double area = 1 + 144 / (x * x) + 0.64 * u * u;
    double noise = 63 / pow_d(l, 0.83) - 1 / expm1_d(-0.02 * u * u);
    return 5200 * optics / sqrt(area * noise);
}
