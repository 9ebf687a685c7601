/* SPDX-License-Identifier: Apache-2.0 */
/* sunlit_way.h -- from a lit point x by a surface y to the sun, chosen from the sun's side; and
 * how often that is worth while. HOT.
 *
 * With the density m of a ray, m^-2 across the sun's middle direction, x chooses the direction
 * to y, where that ray ends, with the density
 *
 *     m |n_y . sun| / (middle . sun) |x - y|^2 / |n_y . (x - y)|.
 *
 * Threads  pure functions of what is const by then.
 */
#pragma once
#include "sunlit/sunlit_land.h"
#include "sunlit/sunlit_map.h"

typedef struct SunlitWay {
    LightSample sun; /* as y samples it */
    LightSample y;   /* as a light of x: a point of a triangle; its pdf is that above */
} SunlitWay;

/* u in [0, 1)^6: three for the ray, three for the sun. False: it chooses none, or its ray ends
 * nowhere inside. Nothing is known of occlusion from x. */
bool sunlit_way_choose(const SunlitTools *tools, const SunlitMap *map, const LitPoint *from,
                       const float u[6], SunlitWay *way);

/* Density of directions at x, sr^-1, by that of rays; y_sun, y_x: cosines at y; 0: y is seen
 * edge on. */
static inline float sunlit_way_at_x(float density, float y_sun, float y_x, float distance2) {
    return y_x > 1e-6f ? density * y_sun * distance2 / y_x : 0;
}

/* Before the first path: illuminance, lx, about, by one such path to a white point; and the
 * direction that it came from, with its density, sr^-1. */
typedef struct SunlitTry {
    Vec3 wi;
    float pdf;
    double lx;
} SunlitTry;

/* How often the map is worth a sample. A chance direction finds the light f with the variance
 * integral f^2 / p; with a sample of the map, of density m, in a share q of the vertices it is
 * about integral f^2 / (p + q m). Of several q the one is taken for which variance times time
 * is least. */
#define SUNLIT_PROBS 5
typedef struct SunlitFinds {
    double variance[SUNLIT_PROBS]; /* sums, lx^2, for each q */
} SunlitFinds;

/* own: density with which chance chooses the direction of a find, sr^-1. */
void sunlit_finds_add(SunlitFinds *finds, const SunlitTry *found, float own);

/* The best q; points: that were tried; rest: lx^2, the variance of all other light there. */
float sunlit_finds_prob(const SunlitFinds *finds, double points, double rest);

/* u in [0, 1)^6. False: it finds none. */
bool sunlit_try(const SunlitTools *tools, const SunlitMap *map, LitPoint point, const float u[6],
                SunlitTry *out);
