/* SPDX-License-Identifier: Apache-2.0 */
#include "vision/position_index.h"

#include <math.h>

#include "base/mathd.h"
#include "base/units.h"

static double limited(double index)
{
    return index < POSITION_INDEX_MAX ? index : POSITION_INDEX_MAX;
}

double position_index_above(double tau_deg, double sigma_deg)
{
    double t = tau_deg, s = sigma_deg;
    double linear = (35.2 - 0.31889 * t - 1.22 * exp_d(-2 * t / 9)) * 1e-3;
    double square = (21 + 0.26667 * t - 0.002963 * t * t) * 1e-5;
    return limited(exp_d(linear * s + square * s * s));
}

double position_index_below(double sigma_deg)
{
    double ratio = sigma_deg < 90 ? tan_d(radians_from_degrees(sigma_deg)) : 3;
    if (ratio > 3) ratio = 3;
    return 1 + (ratio < 0.6 ? 0.8 : 1.2) * ratio;
}

double position_index(double right, double up, double forward)
{
    double beside = hypot_d(right, up);
    if (!(forward > 0)) return POSITION_INDEX_MAX;
    double sigma = degrees_from_radians(atan2_d(beside, forward));
    if (up < 0) return position_index_below(sigma);
    return position_index_above(degrees_from_radians(atan2_d(fabs(right), up)), sigma);
}
