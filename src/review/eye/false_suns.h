/* SPDX-License-Identifier: Apache-2.0 */
/* false_suns.h -- where the sun has to stand for a smooth surface to throw it into an eye.
 *
 * Rays from the eye, close together, are followed via mirrors, glass and the fronts of
 * displays until they leave the scene. Where they leave to is where the sun stands when the eye
 * sees its image there: the whole answer for any sun, without a path for each. Light keeps its
 * radiance, so that an image gives the eye the sun's illuminance by the share of the sun's disc
 * that the image covers in the field of view, times what mirror and panes leave.
 *
 * Field        all that lies within FALSE_SUN_FIELD_DEG of straight ahead.
 * Approximate  a mirror narrower than FALSE_SUN_STEP_DEG, as the eye sees it, may be missed; of
 *              glass that mirrors little the illuminance is known within some 10 %.
 * Left out     rough mirrors (satin), and what a display's haze spreads: they have no image.
 * Memory       96 bytes a ray that leaves by a mirror, and 32 a spectrum: 35,000 rays of the
 *              driver of scenes/car_dashboard.gltf, 3.4 and 1.1 MB.
 * Threads      a search starts its own; the same figures for any count.
 */
#pragma once
#include "review/light/setup.h"

#define FALSE_SUN_STEP_DEG 0.1
#define FALSE_SUN_FIELD_DEG 100
#define FALSE_SUN_CELLS (180 * 360) /* by the sun's direction */

/* One ray. */
typedef struct FalseSunRay {
    Vec3 sun;                 /* unit, world: where the sun's point stands */
    Vec3 seen;                /* unit, world: where the eye sees it */
    float share[LIGHT_BANDS]; /* of the radiance, left by mirror and panes */
    float sr;                 /* in the field of view */
    int part_id;              /* the first mirror's */
} FalseSunRay;

/* The rays from an eye in a scene, for any sun in its sky. */
typedef struct FalseSunRays {
    const FalseSunRay *list; /* by cells of the sun's direction */
    const int *first;        /* [cell]; and one more: the end */
    int count;
} FalseSunRays;

/* The setup may be dark: no light of it counts. */
void false_suns_search(const Setup *setup, Vec3 eye, Arena *arena, FalseSunRays *out);

/* A ray under suns of one spectrum. */
typedef struct FalseSun {
    Vec3 sun, seen; /* the ray's */
    float sr;       /* in the field of view, times the share of light left */
    int part_id;
} FalseSun;

typedef struct FalseSuns {
    const FalseSun *list;
    const int *first; /* the rays' */
    int count;
} FalseSuns;

/* `bands`: the sun's (sky_table.h). The rays must outlive the result. */
FalseSuns false_suns_of(const FalseSunRays *rays, const float bands[LIGHT_BANDS], Arena *arena);

/* Called for a ray that leaves to the sun; `share` of it leaves to the disc, below 1 at the
 * rim. */
typedef void FalseSunVisitor(void *user, const FalseSun *image, double share);

/* towards: the sun, unit, world. */
void false_suns_each(const FalseSuns *suns, Vec3 towards, FalseSunVisitor *visit, void *user);

/* All images of one sun. */
typedef struct FalseSunSight {
    double share; /* of the sun's illuminance that comes to the eye, on a plane that faces the
                     image; 0: there is none */
    int part_id;  /* the mirror that throws most, */
    Vec3 seen;    /* and where it stands */
} FalseSunSight;

/* towards: the sun, unit, world. */
FalseSunSight false_suns_at(const FalseSuns *suns, Vec3 towards);

/* ---- searches that are kept -------------------------------------------------------------- */

/* One serves all gazes, moments and sweeps in which the same eye sees the same scene: it takes
 * some 2 million rays; neither the sun nor any other light has a part in it. One thread at a
 * time. */
typedef struct SunSearch SunSearch;

/* For one request; the arena is that of what is kept, until sun_searches_end. */
typedef struct SunSearches {
    Arena arena;
    SunSearch *last;
} SunSearches;

SunSearches sun_searches_start(void);
void sun_searches_end(SunSearches *searches);

/* The setup's scene, lit or dark, as the eye (m, scene) sees it: found before, or now. */
const FalseSunRays *sun_searches_find(SunSearches *searches, const Setup *setup, Vec3 eye);
