/* SPDX-License-Identifier: Apache-2.0 */
#include "vision/eye_spread.h"

#include <math.h>

#include "base/mathd.h"

static double fourth_power(double x) {
    return x * x * (x * x);
}

static bool is_angle(double angle_deg) {
    return angle_deg >= 0 && angle_deg <= 90;
}

/* (1 + (t/width)^2) to the power of -3/2 */
static double peak(double t, double width) {
    double x = 1 + t / width * (t / width);
    return 1 / (x * sqrt(x));
}

double eye_spread_aging(double age_years) {
    return fourth_power(age_years / 70);
}

/* The core of the optics (two peaks, narrower than the sun), the lens that scatters more with
 * age, and the light that comes through iris and wall of the eye. */
double eye_spread_at(double angle_deg, HumanEye eye) {
    if (!is_angle(angle_deg)) return NAN;
    double t = angle_deg, p = eye.pigment;
    double age = eye_spread_aging(eye.age_years);
    double x = 1 + t / 0.1 * (t / 0.1);
    double core = 9.2e6 * peak(t, 0.0046) + 1.5e5 * peak(t, 0.045);
    double lens = 400 / x + 3e-8 * t * t;
    double wall = 1300 * peak(t, 0.1) + 0.8 / sqrt(x);
    return (1 - 0.08 * age) * core + (1 + 1.6 * age) * (lens + p * wall) + 2.5e-3 * p;
}
