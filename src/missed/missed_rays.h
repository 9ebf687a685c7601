/* SPDX-License-Identifier: Apache-2.0 */
/* missed_rays.h -- rays of the lights, followed by smooth surfaces to eyes: the work
 * of missed.h.
 *
 * Memory   from the arena.  Threads: starts its own; the finds are the same for any number, their
 *          order is not.
 */
#pragma once
#include "camera/camera.h"
#include "path/connected.h"

#define MISSED_EVENTS 8 /* smooth boundaries on a way, two a solid */
#define MISSED_COMPACT_SR 1e-3f

#define MISSED_SIDE 16 /* tiles of a camera's picture, across and down */

/* Who might see it: a camera, or the front of a display. */
typedef struct MissedEye {
    const char *name;
    const Camera *camera; /* NULL: the display */
    int display_id;
} MissedEye;

/* Of light of one lamp: by which mirror it goes first, or into which solid. */
typedef struct MissedWay {
    ChainLight from;
    int light_id; /* lamp: of Scene.lights; emitter: of Scene.parts; sun: 0 */
    int part_id;  /* the mirror or solid */
    bool is_solid;
    int then_id; /* the part that most of it comes to next, smooth as well; NO_ID: none */
} MissedWay;

/* An eye and its tiles, MISSED_SIDE^2 of a camera, one of a display, which stand side by side. */
typedef struct EyeTiles {
    const MissedEye *eye;
    int first, count;
    double m2; /* of a display */
} EyeTiles;

/* What one ray brings to a place that an eye sees. */
typedef struct MissedFind {
    MissedWay way;
    int tile;    /* of all eyes' */
    float light; /* of the tile's mean, cd m^-2 or lx */
} MissedFind;

typedef struct MissedFinds {
    MissedFind *list;
    uint32_t count;
} MissedFinds;

/* areas: of areas_measure. */
MissedFinds missed_rays_send(const PathContext *context, const EyeTiles *eyes, int eye_count,
                             const double *areas, Arena *arena);

/* Does the material send light on by a smooth boundary, as a mirror or a solid does? */
bool missed_is_smooth(const Scene *scene, const Material *m);

/* ---- areas ------------------------------------------------------------------------------- */

/* [triangle]: square metres of its part's triangles up to it. */
const double *areas_measure(const Scene *scene, Arena *arena);

static inline double areas_of_part(const Scene *scene, const double *areas, int part_id) {
    const Part *part = &scene->parts[part_id];
    return part->triangle_count ? areas[part->first_triangle + part->triangle_count - 1] : 0;
}

/* The part's point by so many square metres, and by two numbers in its triangle; t is 0. */
Hit areas_point(const Scene *scene, const double *areas, int part_id, double m2, Vec2 at);

/* ---- where a camera's picture shows a place ---------------------------------------------- */

typedef struct EyePlace {
    float x, y;     /* in the picture, [0, 1) from its upper left */
    Ray ray;        /* from the place to the camera, up to there */
    float per_flux; /* mean luminance of the whole picture, cd m^-2, by each lm that falls on the
                       place, times what it scatters to the camera, sr^-1, and the cosine there */
} EyePlace;

/* False: it lies outside the picture. Occlusion is not tested. */
bool eye_place_of(const Camera *camera, Vec3 position, EyePlace *out);
