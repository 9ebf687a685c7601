/* false_suns.h -- where the sun has to stand for a smooth surface to throw it into an eye.
 *
 * Rays from the eye, close together, are followed by way of mirrors, glass and the fronts of
 * displays until they leave the scene. Where they leave to is where the sun stands when the eye
 * sees its image there: the whole answer for any sun, without a path for each. Light keeps its
 * radiance, so that an image gives the eye the sun's illuminance by the share of the sun's disc
 * that the image covers in the field of view, times what mirror and panes leave.
 *
 * Field        whatever lies within FALSE_SUN_FIELD_DEG of straight ahead.
 * Approximate  a mirror narrower than FALSE_SUN_STEP_DEG, as the eye sees it, may be missed; of
 *              glass that mirrors little the illuminance is known within some 10 %. Mirrors
 *              take colours as those of the sun at FALSE_SUN_ELEVATION_DEG are.
 * Not told     rough mirrors (satin), and what a display's haze spreads: they have no image.
 * Memory       40 bytes a ray that leaves by a mirror: some 20 MB in a car. Threads: starts its
 *              own; the same figures for any count.
 */
#pragma once
#include "review/light/stage.h"

#define FALSE_SUN_STEP_DEG 0.1
#define FALSE_SUN_FIELD_DEG 100
#define FALSE_SUN_ELEVATION_DEG 30

/* One ray. */
typedef struct FalseSun {
    Vec3  sun;     /* unit, world: where the sun's point stands */
    Vec3  seen;    /* unit, world: where the eye sees it */
    float sr;      /* of the field of view, times what is left of the light */
    int   part_id; /* the first mirror's */
} FalseSun;

typedef struct FalseSuns {
    const FalseSun *list;  /* by cells of the sun's direction */
    const int      *first; /* [cell]; and one more: the end */
    int             count;
} FalseSuns;

/* The stage may be dark: no light of it counts. `bands`: of the sun (light_bands.h). */
void false_suns_find(const Stage *stage, Vec3 eye, const float bands[LIGHT_BANDS],
                     Arena *arena, FalseSuns *out);

/* Is told of a ray that leaves to the sun: `share` of it leaves to the disc, its rim's by a
 * part. */
typedef void FalseSunTold(void *user, const FalseSun *image, double share);

/* towards: the sun, unit, world. */
void false_suns_each(const FalseSuns *suns, Vec3 towards, FalseSunTold *told, void *user);

/* All images of one sun. */
typedef struct FalseSunSight {
    double share;   /* of the sun's illuminance that comes to the eye, on a plane that faces the
                       image; 0: there is none */
    int    part_id; /* of the mirror that throws most, */
    Vec3   seen;    /* and where it stands */
} FalseSunSight;

/* towards: the sun, unit, world. */
FalseSunSight false_suns_at(const FalseSuns *suns, Vec3 towards);
