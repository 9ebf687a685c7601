/* SPDX-License-Identifier: Apache-2.0 */
/* hemisphere_signals.h -- functions on the hemisphere with known values everywhere, as displays
 * and their surfaces have them. */
#pragma once
#include <math.h>

#include "base/units.h"
#include "hemisphere/specular_frame.h"

typedef double (*Signal)(Vec3 direction);

static double polar_deg(Vec3 d)
{
    return degrees_from_radians(atan2(sqrt((double)(d.x * d.x + d.y * d.y)), (double)d.z));
}

/* An IPS-like luminance: a power of the cosine, wider along the horizontal, a slight skew. */
static double emission(Vec3 d)
{
    double across = (double)d.x, up = (double)d.y, z = (double)d.z;
    return 400 * pow(z, 1.6) * (1 + 0.15 * across - 0.2 * up * up) + 40 * z * exp(-6 * up * up);
}

static double angle_between_deg(Vec3 a, Vec3 b)
{
    return degrees_from_radians(
        2 * asin(fmin(1, 0.5 * (double)vec3_length(vec3_sub(a, b)))));
}

/* Light at 30 degrees: a lobe of 6 degrees with wide skirts on a Lambert floor. */
static double haze(Vec3 d)
{
    Vec3   mirror = vec3(0.5f, 0, 0.8660254f);
    double angle = angle_between_deg(d, mirror) / 6;
    return 4 / pow(1 + angle * angle, 1.7) + 0.01;
}

static double haze_in_specular_frame(Vec3 stored)
{
    SpecularFrame frame = specular_frame(30 * PI_F / 180, 2);
    return haze(specular_frame_outer(&frame, stored));
}

/* A peak of half a degree (half width) at the pole, on haze of 1/300 of its height. */
static double narrow_peak(Vec3 d)
{
    double peak = polar_deg(d) / 0.5, wide = polar_deg(d) / 8;
    return 300 * exp(-0.6931 * peak * peak) + 1 / (1 + wide * wide) + 0.01;
}

static double narrow_peak_in_specular_frame(Vec3 stored)
{
    SpecularFrame frame = specular_frame(0, 2);
    return narrow_peak(specular_frame_outer(&frame, stored));
}

typedef struct SignalRow {
    const char *name;
    Signal      value;
    int         octants;
} SignalRow;

static const SignalRow SIGNALS[] = {
    {"emission", emission, 4},
    {"haze", haze, 2},
    {"haze, k=2 frame", haze_in_specular_frame, 2},
    {"narrow peak", narrow_peak, 2},
    {"narrow peak, k=2 frame", narrow_peak_in_specular_frame, 2},
};
