/* SPDX-License-Identifier: Apache-2.0 */
/* sunlit_map.h -- the sun's rays that end inside: from where else they come than from chance.
 *
 * A ray of the sun is a point (s, t) of the plane across the direction of its middle, for one
 * direction of its disc. The map is a square of that plane, cut into a tree of quarters; a leaf
 * is a square whose rays end on surfaces that light the displays and cameras about. From a
 * lit point a quarter is chosen by the light that it may send there: its power over the squared
 * distance, times the cosines at both ends, bounded by its sphere and its cone of normals
 * (A. Conty Estevez and C. Kulla, "Importance Sampling of Many Lights with Adaptive Tree
 * Splitting", HPG 2018). The place in a leaf is uniform.
 *
 * Where the map has nothing, its density is 0 and the light is left to chance: it decides
 * noise, never a mean.
 *
 * Units    metres, scene; densities in m^-2 of the plane.
 * Threads  const once built (sunlit_build.h).
 */
#pragma once
#include <stdbool.h>
#include <stdint.h>

#include "base/units.h"
#include "base/vec.h"
#include "light/lit_point.h"

/* of quarters: 2^9 pixels along the square's side; where few are lit they are cut further */
#define SUNLIT_LEVELS 9
#define SUNLIT_SIDE (1 << SUNLIT_LEVELS)

/* Four quarters side by side: the surfaces on which their rays end. Number k is the one of
 * i and j low (0), i high (1), j high (2) or both (3). */
typedef struct SunlitQuarters {
    float centre[3][4];       /* x, y, z of the spheres about them, m */
    float square[4];          /* of the spheres' radii, m^2 */
    float axis[3][4];         /* unit: the mean of their normals, to the sun's side */
    float cosine[4], sine[4]; /* of the cone about it that holds them; -1: light leaves to
                                 all sides */
    float power[4];           /* relative; 0: there is nothing */
    uint32_t child[4];        /* number of the four that a quarter is cut into; 0: a leaf */
} SunlitQuarters;

typedef struct SunlitMap {
    const SunlitQuarters *nodes; /* the first are the square's; NULL: no ray of the sun ends
                                    inside */
    Frame frame;                 /* z: unit, to the sun's middle; x, y: of s and t */
    Vec3 corner;                 /* m: (s, t) = (0, 0), in the plane across the region */
    float side;                  /* m, of the square */
    float above, below;          /* m, from the plane along z: where the region ends */
    float unseen_lm; /* of a beam as wide as a pixel, which may come in unseen where no ray
                        ended inside; 0 where some did, and without a sun or a region */
} SunlitMap;

/* The most, cd m^-2, that a white surface has of the unseen beam, which ends on a pale one a
 * metre before it: two Lambert's, of reflectance SUNLIT_PALE and 1, that face each other. */
#define SUNLIT_PALE 0.8f
static inline float sunlit_map_unseen(const SunlitMap *map) {
    return map->unseen_lm * SUNLIT_PALE * INV_PI_F * INV_PI_F;
}

/* A ray of the sun, chosen from a lit point. */
typedef struct SunlitRay {
    float s, t;    /* m */
    float density; /* m^-2 */
} SunlitRay;

/* u in [0, 1)^3. False: nothing of the map lights the point. HOT. */
bool sunlit_map_choose(const SunlitMap *map, const LitPoint *from, const float u[3],
                       SunlitRay *ray);

/* Density with which sunlit_map_choose chooses the ray that comes from `towards` (unit, of the
 * disc) and passes the place `at`; 0 outside the region. HOT. */
float sunlit_map_density(const SunlitMap *map, const LitPoint *from, Vec3 at, Vec3 towards);

/* Where the ray enters the region, coming from `towards`; *length: m, until it leaves it. */
Vec3 sunlit_map_entry(const SunlitMap *map, const SunlitRay *ray, Vec3 towards, float *length);
