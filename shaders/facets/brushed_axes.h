/* SPDX-License-Identifier: Apache-2.0 */
/* brushed_axes.h -- how directions above a brushed boundary stand in tables.
 *
 * For alphas much below 1 only ratios matter: of the two, and of the cosine to the alpha along
 * the direction's own azimuth (Heitz 2014: G depends on nothing else), `own` below. So the axes
 * are the fourth roots of the greater alpha and of the ratio of both; the root of own from the
 * lesser (0) to the greater (1), `turn`; and facet_axis.
 *
 * alpha: of x and y, each in [SMOOTH_ALPHA, 1]. w: a unit direction with z > 0. Threads: pure
 * functions.
 */
#pragma once
#include "base/mathf.h"
#include "base/vec.h"

#define FACET_LEAST 0.17782794f /* the fourth root of SMOOTH_ALPHA, where alphas begin */

/* Four neighbours of an axis' nodes. */
typedef struct FacetKnot {
    int   first;
    float share[4];
} FacetKnot;

/* Lagrange's cubic at `share` of the axis, of at least four nodes. */
static inline FacetKnot facet_knot(float share, int count)
{
    float place = clampf(share, 0, 1) * (float)(count - 1);
    int   first = (int)place - 1;
    if (first < 0) first = 0;
    if (first > count - 4) first = count - 4;
    float a = place - (float)first, b = a - 1, c = a - 2, d = a - 3;
    return (FacetKnot){first, {b * c * d * (-1.0f / 6), a * c * d * 0.5f, a * b * d * -0.5f,
                               a * b * c * (1.0f / 6)}};
}

static inline float facet_own(Vec3 w, Vec2 alpha)
{
    float x = alpha.x * w.x, y = alpha.y * w.y, side2 = w.x * w.x + w.y * w.y;
    return side2 > 1e-12f ? sqrtf((x * x + y * y) / side2) : fmaxf(alpha.x, alpha.y);
}

static inline float facet_turn(float own, Vec2 alpha)
{
    float high = fmaxf(alpha.x, alpha.y), low = fminf(alpha.x, alpha.y);
    return high > low ? safe_sqrtf((own - low) / (high - low)) : 0;
}

/* Where a cosine stands on the table's axis, 0 to 1. Half of the axis is for cosines about the
 * own alpha. */
static inline float facet_axis(float cosine, float own)
{
    return 0.5f * cosine * (1 + (1 + own) / (cosine + own));
}

/* The inverse of facet_axis, which rises; for what is made before the first ray. */
static inline float facet_axis_cosine(float x, float own)
{
    float low = 1e-5f, high = 1;
    if (x >= 1) return 1;
    for (int step = 0; step < 40; step++) {
        float middle = 0.5f * (low + high);
        if (facet_axis(middle, own) < x) low = middle;
        else high = middle;
    }
    return low;
}

/* A direction of that cosine and of that alpha along its azimuth; alpha.x is the greater. */
static inline Vec3 facet_direction(float cosine, float own, Vec2 alpha)
{
    float range = alpha.x * alpha.x - alpha.y * alpha.y;
    float c2 = range > 0 ? clampf((own * own - alpha.y * alpha.y) / range, 0, 1) : 1;
    float sine = safe_sqrtf(1 - cosine * cosine);
    return vec3(sine * sqrtf(c2), sine * sqrtf(1 - c2), cosine);
}
