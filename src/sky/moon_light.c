/* SPDX-License-Identifier: Apache-2.0 */
#include "sky/moon_light.h"

#include <math.h>

#include "base/mathd.h"
#include "base/mathf.h"
#include "base/units.h"

#define MEAN_KM 384400.0
#define SUN_V (-26.74)
#define V_NM 551.0
#define REDNESS 1.16
#define PHASE_MAX (175 * PI / 180)
#define MEAN_STEPS 400

double moon_angular_radius(double distance_km) {
    return asin_d(MOON_RADIUS_KM / distance_km);
}

void moon_over_sun(const MoonDistances *at, Curve *out) {
    double a = at->phase_angle_deg, nearer = MEAN_KM / at->observer_km;
    double magnitude = -12.73 + 0.026 * a + 4e-9 * a * a * a * a;
    double ratio =
        pow_d(10, 0.4 * (SUN_V - magnitude)) * nearer * nearer / (at->sun_au * at->sun_au);
    for (int i = 0; i < CURVE_COUNT; i++)
        out->value[i] = (float)(ratio * pow_d((CURVE_FIRST_NM + i) / V_NM, REDNESS));
}

static float shade(float sine, float cosine, float x, float distance2) {
    float mu = safe_sqrtf(1 - distance2), mu0 = x * sine + mu * cosine;
    return mu0 > 0 ? mu0 / (mu0 + mu) : 0;
}

/* The mean from columns between the terminator, x = -cos a sqrt(1 - y^2), and the lit limb. */
MoonDisc moon_disc(double phase_angle) {
    double phase = fmin(phase_angle, PHASE_MAX), sum = 0;
    MoonDisc disc = {(float)sin_d(phase), (float)cos_d(phase), 1};
    for (int j = 0; j < MEAN_STEPS; j++) {
        double y = (j + 0.5) / MEAN_STEPS, half = sqrt(1 - y * y), row = 0;
        double from = -half * cos_d(phase), width = half - from;
        for (int i = 0; i < MEAN_STEPS; i++) {
            double x = from + width * (i + 0.5) / MEAN_STEPS;
            row += (double)shade(disc.sine, disc.cosine, (float)x, (float)(x * x + y * y));
        }
        sum += row * width / MEAN_STEPS;
    }
    disc.scale = (float)(PI * MEAN_STEPS / (2 * sum));
    return disc;
}

float moon_disc_shade(const MoonDisc *disc, float x, float distance2) {
    return disc->scale * shade(disc->sine, disc->cosine, x, distance2);
}
