/* SPDX-License-Identifier: Apache-2.0 */
#include "review/light/glasses.h"

#include "base/mathd.h"
#include "base/units.h"

#define STRATA 16 /* of SPECTRUM_LANES wavelengths each */

double glasses_luminous(const Curve *transmittance) {
    double passed = 0, all = 0;
    for (int i = 0; i < STRATA; i++) {
        Wavelengths w;
        wavelengths_sample(((float)i + 0.5f) / STRATA, &w);
        Spectrum light = w.d65 * w.xyz[1];
        all += (double)spectrum_mean(light);
        passed += (double)spectrum_mean(light * curve_lookup(transmittance, &w));
    }
    return passed / all;
}

static const Curve *colour_of(const Curve *transmittance, double luminous, Arena *arena) {
    Curve *colour = ARENA_NEW(arena, Curve, 1);
    for (int i = 0; i < CURVE_COUNT; i++)
        colour->value[i] = (float)((double)transmittance->value[i] / luminous);
    return colour;
}

static const PolarisedEye *polariser_of(const ReviewGlasses *glasses, Vec3 towards, Arena *arena) {
    PolarisedEye *eye = ARENA_NEW(arena, PolarisedEye, 1);
    Vec3 forward = vec3_normalize(towards);
    Vec3 right = vec3_cross(forward, vec3(0, 1, 0));
    double angle = radians_from_degrees(glasses->axis_deg);
    if (!(vec3_dot(right, right) > 1e-6f)) right = frame_from_z(forward).x;
    *eye = (PolarisedEye){.right = vec3_normalize(right),
                          .forward = forward,
                          .has_glasses = true,
                          .axis = {(float)sin_d(angle), (float)cos_d(angle)},
                          .lets = (float)(2 * glasses->extinction / (glasses->extinction + 1)),
                          .blocks = (float)(2 / (glasses->extinction + 1))};
    return eye;
}

Glasses glasses_worn(const ReviewCondition *condition, Vec3 towards, Arena *arena) {
    const ReviewGlasses *given = condition->glasses;
    Glasses out = {.transmittance = 1};
    if (!given) return out;
    out.words = given->words;
    out.transmittance = given->curve ? glasses_luminous(given->curve) : given->transmittance;
    if (given->curve) out.colour = colour_of(given->curve, out.transmittance, arena);
    if (given->is_polarising) out.polariser = polariser_of(given, towards, arena);
    return out;
}
