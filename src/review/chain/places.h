/* SPDX-License-Identifier: Apache-2.0 */
/* places.h -- where the light of chains comes by, about an eye and a display: off what could be
 * of another material, off the seat behind the eye, past where a hood would stand.
 *
 * Which thing is a seat, and which is not, goes by its place, for models name them in any
 * language: what lies behind the eye and not above it, and what lies in its lap. The figures of
 * a seated person are rough, and on the safe side: what might be a seat or somebody in it is no
 * trim.
 *
 * Units    cd m^-2; metres, world.
 * Memory   the arena's. Threads: sums belong to one. Fails: never.
 */
#pragma once
#include "kernel/probe.h"
#include "scene/scene.h"

#define PLACE_HOODS 3 /* depths that are compared */

/* A display's box in axes of its own: right and up of who faces it, and its mean normal. */
typedef struct PlaceFace {
    Vec3  right, up, normal;
    float low[3], high[3]; /* along those axes */
    bool  is_upright;      /* else no edge is the upper one: no hood */
} PlaceFace;

typedef struct ChainPlaces {
    const Scene *scene;
    const bool  *is_occupant; /* [part] who was put into the seats */
    Vec3         eye;
    Vec3         ahead;      /* unit, level: where who sits there faces */
    PlaceFace    face;
    float        hood_m[PLACE_HOODS]; /* how far each reaches out (scene/load/hood.h) */
} ChainPlaces;

/* The light of some paths. */
typedef struct PlaceSums {
    double *by_trim;        /* [part] that meets it where it could be of another material */
    double *by_seat;        /* [part] that comes to the display straight off the seat's back */
    double  hooded[PLACE_HOODS]; /* that each hood would keep off */
} PlaceSums;

PlaceFace place_face(const Scene *scene, const int *part_ids, int part_count);

PlaceSums place_sums(const Scene *scene, Arena *arena);

/* Of a path whose first surface is a display. alike: parts that count as one. */
void place_add(const ChainPlaces *places, const int *alike, const PathHistory *history,
               double y, PlaceSums *to);

void place_merge(const PlaceSums *from, int part_count, double scale, PlaceSums *to);

/* Whether a hood of that depth would stand between two points; infinitely far: `towards` is a
 * unit direction. */
bool place_is_hooded(const PlaceFace *face, float depth_m, Vec3 from, Vec3 towards,
                     float distance);
