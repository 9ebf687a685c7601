/* intensity_web.h -- luminous intensity over all directions, as a luminaire file tells it.
 *
 * Bilinear between the file's angles (CIE 121 and IES LM-63, type C): gamma from the axis, C
 * around it. In the luminaire's frame gamma = 0 is -Z, C = 0 is +X and C = 90 is +Y:
 * counter-clockwise as seen from behind, along -Z. Beyond the file's last gamma, and before its
 * first: dark.
 *
 * Units    radians, candela, lumens. Threads: const once built. Memory: the builder's arena.
 */
#pragma once
#include "base/mathf.h"
#include "base/vec.h"

typedef struct IntensityWeb {
    int          planes, gammas;
    const float *c;        /* planes + 1, rising; the last is the first one turn on */
    const float *gamma;    /* rising */
    const float *relative; /* (planes + 1) x gammas; the largest is 1 */
    float        largest_cd, flux_lm;
    Vec3         brightest; /* unit: where the largest goes to */
} IntensityWeb;

/* The interval of rising `at` that holds value: 0 to count - 2. */
static inline int intensity_interval(const float *at, int count, float value)
{
    int low = 0, high = count - 1;
    while (high - low > 1) {
        int middle = (low + high) / 2;
        if (at[middle] <= value) low = middle;
        else high = middle;
    }
    return low;
}

static inline float intensity_share(const float *at, int i, float value)
{
    return clampf((value - at[i]) / (at[i + 1] - at[i]), 0, 1);
}

/* HOT. Relative intensity towards a unit direction of the luminaire's frame. */
static inline float intensity_web_at(const IntensityWeb *web, Vec3 d)
{
    const float turn = 6.28318530717958647692f, slack = 1e-6f;
    float gamma = acos_f(clampf(-d.z, -1, 1));
    if (gamma < web->gamma[0] - slack || gamma > web->gamma[web->gammas - 1] + slack) return 0;
    float c = d.x == 0 && d.y == 0 ? web->c[0] : atan2_f(d.y, d.x);
    while (c < web->c[0]) c += turn;
    while (c > web->c[web->planes]) c -= turn;
    int   i = intensity_interval(web->c, web->planes + 1, c);
    int   k = intensity_interval(web->gamma, web->gammas, gamma);
    float s = intensity_share(web->c, i, c), t = intensity_share(web->gamma, k, gamma);
    const float *row = web->relative + i * web->gammas + k, *next = row + web->gammas;
    return lerpf(lerpf(row[0], row[1], t), lerpf(next[0], next[1], t), s);
}
