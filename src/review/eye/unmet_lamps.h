/* SPDX-License-Identifier: Apache-2.0 */
/* unmet_lamps.h -- how bright a lamp may be that no path met: chance alone finds what an eye sees
 * straight or in mirrors, and a small lamp may be missed.
 *
 * Lamps are emitting parts, displays among them (by their white over the hemisphere), and
 * besides lamps without a surface, which pupils sample in a first mirror alone. The sun is none:
 * false_suns.h looks for its images. Whether something stands before a lamp is not
 * requested.
 *
 * Units    cd m^-2; metres, scene; radians.
 * Memory   lists live in the arena.
 * Threads  pure functions.
 */
#pragma once
#include "review/light/setup.h"

/* A triangle of one: the ball that holds it. */
typedef struct Lamp {
    Vec3 middle;
    double radius, cd_m2;
    bool is_compact; /* (light/compact_emitters.h): pupils sample it in a first mirror */
} Lamp;

/* Brightest first. */
typedef struct UnmetLamps {
    Lamp *list;
    int count;
} UnmetLamps;

/* Those of parts that are not met ([part]). */
UnmetLamps lamps_unmet(const PathContext *context, const bool *met, Arena *arena);

/* The brightest that may be seen along the ray or within half an angle of it; 0: none.
 * no_compact: compact ones do not count. */
double lamps_brightest(const UnmetLamps *lamps, Ray ray, double half, bool no_compact);

/* The most lux, on what faces it at the ray's origin, of a lamp without a surface that lies along
 * the ray or within half an angle of it; by its largest intensity. */
double lamps_point_lx(const Scene *scene, Ray ray, double half);
