/* SPDX-License-Identifier: Apache-2.0 */
#include "vision/eye_spread.h"

#include <math.h>

#include "base/mathd.h"
#include "base/units.h"

static double fourth_power(double x)
{
    return x * x * (x * x);
}

static bool is_angle(double angle_deg)
{
    return angle_deg >= 0 && angle_deg <= 90;
}

/* (1 + (t/width)^2) to the power of -3/2 */
static double peak(double t, double width)
{
    double x = 1 + t / width * (t / width);
    return 1 / (x * sqrt(x));
}

/* The core of the optics (two peaks, narrower than the sun), the lens that scatters more with
 * age, and the light that comes through iris and wall of the eye. */
double eye_spread_at(double angle_deg, HumanEye eye)
{
    if (!is_angle(angle_deg)) return NAN;
    double t = angle_deg, p = eye.pigment;
    double age = fourth_power(eye.age_years / 70);
    double x = 1 + t / 0.1 * (t / 0.1);
    double core = 9.2e6 * peak(t, 0.0046) + 1.5e5 * peak(t, 0.045);
    double lens = 400 / x + 3e-8 * t * t;
    double wall = 1300 * peak(t, 0.1) + 0.8 / sqrt(x);
    return (1 - 0.08 * age) * core + (1 + 1.6 * age) * (lens + p * wall) + 2.5e-3 * p;
}

double eye_spread_spencer(double angle_deg)
{
    if (!is_angle(angle_deg)) return NAN;
    double t = angle_deg, far = t + 0.02;
    double f0 = 2.61e6 * exp_d(-(t / 0.02) * (t / 0.02));
    double f1 = 20.91 / (far * far * far);
    double f2 = 72.37 / (far * far);
    return 0.384 * f0 + 0.478 * f1 + 0.138 * f2;
}

/* ---- equations of the veil alone --------------------------------------------------------- */

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
