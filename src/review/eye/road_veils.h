/* SPDX-License-Identifier: Apache-2.0 */
/* road_veils.h -- the veil over a road at night, by age, and what of it each display makes.
 *
 * From the light that eye_reading.h finds, by the same paths: all that the eye sees, inside and
 * outside, from 0.1 degrees off the gaze on, but for sky and surfaces within 1 degree of it,
 * which are what it looks at (the road). It is weighed by vision/road_glare.h's veil, and
 * besides by the eye's own spread (vision/eye_spread.h).
 *
 * A display's light comes straight or through panes; by mirrors and panes that mirror; or by
 * surfaces that it lights. All of it grows with the display's level, so that the veil is linear
 * in that.
 *
 * Approximate  the upper end of the whole veil holds what lamps may send by mirrors that no
 *              path met; that of one display does not.
 * Units        cd m^-2, years.
 * Memory       the arena's. Threads: road_light_add and road_veils_add_sample are called by
 *              many, for a path or a chunk by one; the rest by one. Fails: never.
 */
#pragma once
#include "review/light/reading.h"
#include "vision/human_eye.h"

typedef enum RoadWay { ROAD_STRAIGHT, ROAD_MIRRORED, ROAD_SCATTERED, ROAD_WAYS } RoadWay;

typedef struct RoadAges {
    const double *list;
    int count;      /* at least 1 */
    double pigment; /* of the eye's own spread */
} RoadAges;

/* A veil and its 95 % interval. */
typedef struct RoadFound {
    double mean, low, high;
    double by_spread; /* the same light by the eye's own spread; of a display NaN */
} RoadFound;

/* How a display's veil comes, for the first age; they add up to it. */
typedef struct RoadShares {
    double way[ROAD_WAYS];
    double mirror;   /* part that mirrors most of it towards the eye, */
    double mirrored; /* and so much; 0: none does, and `mirror` means nothing */
} RoadShares;

typedef struct RoadReading {
    int ages, displays;
    RoadFound *found;     /* [age][display], and behind a row's displays the whole */
    RoadShares *shares;   /* [display] */
    double *without_data; /* of the whole for the first age, the share that came by
                             materials without optical data */
} RoadReading;

/* Empty: all 0. */
RoadReading road_reading_start(int ages, int displays, Arena *arena);

static inline RoadFound road_found(const RoadReading *r, int age, int display) {
    return r->found[age * (r->displays + 1) + display];
}

static inline RoadFound road_found_whole(const RoadReading *r, int age) {
    return road_found(r, age, r->displays);
}

/* ---- while an eye is read ---------------------------------------------------------------- */

typedef struct RoadVeils RoadVeils;

RoadVeils *road_veils_start(const Scene *scene, const RoadAges *ages, Arena *arena);

/* Before anything of it is found; rounds of as many paths, and of samples, each. */
void road_veils_expect(RoadVeils *veils, int paths, int rounds, Arena *arena);

int road_veils_ages(const RoadVeils *veils);
double road_veils_age(const RoadVeils *veils, int age);

/* Light that a path found, Y in cd m^-2. */
void road_light_add(RoadVeils *veils, int path, const PathHistory *history, double y);

/* All of a path: `cd_m2` counts of what it found, whose lux on the pupil's plane are `lx` for
 * each cd m^-2. */
typedef struct RoadPath {
    int path;
    double degrees; /* from the gaze */
    double lx, cd_m2;
    bool is_near; /* what scatters there is looked at */
} RoadPath;

void road_veils_add_path(RoadVeils *veils, const RoadPath *path);

/* A light sample of the pupil's plane; part_id: the emitter's; NO_ID: of another source. */
typedef struct RoadSample {
    double degrees, lx;
    int part_id;
} RoadSample;

/* Light samples come in chunks, each of one thread: its sums, 0 at first. */
double *road_veils_chunk(const RoadVeils *veils, Arena *arena);
void road_veils_add_sample(const RoadVeils *veils, const RoadSample *sample, double *chunk);

/* Each sample's lux times `share`. */
void road_veils_add_chunk(RoadVeils *veils, int round, double share, const double *chunk);

/* Light that is known without paths, as if each piece had come by chance. */
void road_veils_add_known(RoadVeils *veils, double degrees, double lx);

/* What may be there for an age although no path met it. */
void road_veils_set_unmet(RoadVeils *veils, int age, double cd_m2);

/* When all is added. */
void road_veils_read(const RoadVeils *veils, RoadReading *out);
