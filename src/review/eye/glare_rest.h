/* SPDX-License-Identifier: Apache-2.0 */
/* glare_rest.h -- how bright that is which paths find by chance only, direction by direction:
 * means over cells that are as small as their noise allows.
 *
 * A cell's mean counts where noise cannot make a source of it: where its standard error is
 * small beside the threshold, or the mean is many times its error. Cells of which neither is
 * true are thrown together with their neighbours, until one is. So no single path ever stands
 * for a direction, and all light is kept.
 *
 * Frame    cells about the line of sight: rings of equal steps of the angle's logarithm.
 * Units    cd m^-2, sr. Threads: const once built.
 */
#pragma once
#include "base/arena.h"
#include "base/vec.h"

/* Where the head is and how it is turned; unit vectors, world. */
typedef struct GlareHead {
    Vec3 eye; /* m */
    Vec3 right, up, gaze;
} GlareHead;

/* Of an equidistant picture about the gaze: x to the right, y up, radians. */
Vec3 glare_head_direction(const GlareHead *head, double x, double y);

#define GLARE_REST_FROM_DEG 0.1
#define GLARE_REST_TO_DEG 90.0

typedef struct GlareRest {
    GlareHead head;
    int       side; /* rings, and cells a ring */
    float    *mean; /* [ring][cell] */
} GlareRest;

/* What paths found, each in a direction (unit, world) that stands for a solid angle. */
typedef struct GlarePaths {
    const Vec3   *towards;
    const double *sr, *cd_m2;
    int           count;
} GlarePaths;

GlareRest glare_rest_build(const GlareHead *head, const GlarePaths *paths,
                           double threshold_cd_m2, Arena *arena);

/* d: unit, world, in front. */
double glare_rest_at(const GlareRest *rest, Vec3 d);
