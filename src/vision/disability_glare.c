/* SPDX-License-Identifier: Apache-2.0 */
#include "vision/disability_glare.h"

#include <math.h>

static double fourth_power(double x)
{
    return x * x * (x * x);
}

static bool within(double angle, double low, double high)
{
    return angle >= low && angle <= high;
}

double disability_glare(double angle_deg, HumanEye eye)
{
    double t = angle_deg, p = eye.pigment;
    if (!within(t, DISABILITY_GLARE_MIN_DEG, DISABILITY_GLARE_MAX_DEG)) return NAN;
    double age = 1 + fourth_power(eye.age_years / 62.5);
    return 10 / (t * t * t) + (5 / (t * t) + 0.1 * p / t) * age + 0.0025 * p;
}

double disability_glare_small_angle(double angle_deg, double age_years)
{
    double t = angle_deg;
    if (!within(t, DISABILITY_GLARE_MIN_DEG, DISABILITY_GLARE_SMALL_MAX_DEG)) return NAN;
    return 10 / (t * t * t) + 5 / (t * t) * (1 + fourth_power(age_years / 62.5));
}

double disability_glare_stiles_holladay(double angle_deg, double age_years)
{
    double t = angle_deg;
    if (!within(t, STILES_HOLLADAY_MIN_DEG, STILES_HOLLADAY_MAX_DEG)) return NAN;
    return 10 * (1 + fourth_power(age_years / 70)) / (t * t);
}
