/* SPDX-License-Identifier: Apache-2.0 */
/* intensity_web.h -- luminous intensity over all directions, as a luminaire file gives it.
 *
 * Bilinear between the file's angles. Type C (CIE 121, IES LM-63): gamma from the axis, C
 * around it. In the luminaire's frame gamma = 0 is -Z, C = 0 is +X and C = 90 is +Y:
 * counter-clockwise as seen from behind, along -Z. Types A and B (LM-63) have a vertical angle
 * V and a horizontal angle H; (0, 0) is -Z, V = 90 is +X and H = 90 is -Y, clockwise from
 * behind (as EXT_lights_ies maps them). Their polar axis lies across: in A it is the vertical
 * one, +X, V is the latitude and H the longitude; in B it is the horizontal one, -Y, H is the
 * latitude and V the longitude. Their web is one of type C about that axis: gamma is the
 * latitude plus 90, C the longitude. Beyond the angles that the file has: dark.
 *
 * Units    radians, candela, lumens. Threads: const once built. Memory: the builder's arena.
 */
#pragma once
#include "base/mathf.h"
#include "base/vec.h"

typedef enum WebType { WEB_C, WEB_B, WEB_A } WebType;

typedef struct IntensityWeb {
    WebType type;
    int planes, gammas;
    const float *c;        /* planes + 1, rising; in type C the last is the first one turn on */
    const float *gamma;    /* rising */
    const float *relative; /* (planes + 1) x gammas; the largest is 1 */
    float largest_cd, flux_lm;
    Vec3 brightest; /* unit, the luminaire's frame: where the largest goes to */
} IntensityWeb;

/* A direction of the luminaire's frame in that of the angles, and back. */
static inline Vec3 web_from_luminaire(WebType type, Vec3 d) {
    if (type == WEB_B) return vec3(-d.z, d.x, -d.y);
    if (type == WEB_A) return vec3(-d.z, -d.y, d.x);
    return d;
}

static inline Vec3 luminaire_from_web(WebType type, Vec3 d) {
    if (type == WEB_B) return vec3(d.y, -d.z, -d.x);
    if (type == WEB_A) return vec3(d.z, -d.y, -d.x);
    return d;
}

/* The interval of rising `at` that holds value: 0 to count - 2. */
static inline int intensity_interval(const float *at, int count, float value) {
    int low = 0, high = count - 1;
    while (high - low > 1) {
        int middle = (low + high) / 2;
        if (at[middle] <= value) low = middle;
        else high = middle;
    }
    return low;
}

static inline float intensity_share(const float *at, int i, float value) {
    return clampf((value - at[i]) / (at[i + 1] - at[i]), 0, 1);
}

/* HOT. Relative intensity towards a unit direction of the luminaire's frame. */
static inline float intensity_web_at(const IntensityWeb *web, Vec3 direction) {
    const float turn = 6.28318530717958647692f, slack = 1e-6f;
    Vec3 d = web_from_luminaire(web->type, direction);
    float gamma = acos_f(clampf(-d.z, -1, 1));
    if (gamma < web->gamma[0] - slack || gamma > web->gamma[web->gammas - 1] + slack) return 0;
    float c = d.x == 0 && d.y == 0 ? web->c[0] : atan2_f(d.y, d.x);
    while (c < web->c[0] - slack) c += turn;
    if (c > web->c[web->planes] + slack) return 0;
    int i = intensity_interval(web->c, web->planes + 1, c);
    int k = intensity_interval(web->gamma, web->gammas, gamma);
    float s = intensity_share(web->c, i, c), t = intensity_share(web->gamma, k, gamma);
    const float *row = web->relative + i * web->gammas + k, *next = row + web->gammas;
    return lerpf(lerpf(row[0], row[1], t), lerpf(next[0], next[1], t), s);
}
