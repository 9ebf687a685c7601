/* SPDX-License-Identifier: Apache-2.0 */
/* missed_rays.h -- rays of the lights, followed by smooth surfaces to eyes. Private to
 * missed_light.c.
 *
 * Memory   from the arena.  Threads: starts its own; the finds and their order are the same for
 *          any number.
 */
#pragma once
#include "missed/missed_eye.h"
#include "path/connected.h"

#define MISSED_EVENTS 8 /* smooth boundaries on a way, two a solid */
#define MISSED_COMPACT_SR 1e-3f

#define MISSED_SIDE 16 /* tiles of a camera's picture, across and down */

/* What one ray brings to a place that an eye sees. */
typedef struct MissedFind {
    ChainLight from;
    int light_id, part_id, then_id;
    bool is_solid;
    int tile;    /* of all eyes': missed_tile */
    float light; /* of the tile's mean, cd m^-2 or lx */
} MissedFind;

typedef struct MissedFinds {
    MissedFind *list;
    uint32_t count;
} MissedFinds;

/* Tiles of an eye, MISSED_SIDE^2 of a camera, one of a display, stand side by side. */
static inline int missed_tiles(const MissedEye *eye) {
    return eye->camera ? MISSED_SIDE * MISSED_SIDE : 1;
}

/* Square metres of a list of triangles, to choose points by area. */
typedef struct AreaList {
    uint32_t *triangle;
    double *until; /* m^2 of it and of those before */
    int count;
} AreaList;

static inline double area_list_m2(const AreaList *list) {
    return list->count ? list->until[list->count - 1] : 0;
}

/* The triangle at so many square metres. */
uint32_t area_list_at(const AreaList *list, double m2);

/* Of all triangles that show a display. */
AreaList area_list_of_display(const Scene *scene, int display_id, Arena *arena);

MissedFinds missed_rays_send(const PathContext *context, const MissedEye *eyes, int eye_count,
                             Arena *arena);

/* Does the material send light on by a smooth boundary, as a mirror or a solid does? */
bool missed_is_smooth(const Scene *scene, const Material *m);
