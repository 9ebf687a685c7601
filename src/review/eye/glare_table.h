/* SPDX-License-Identifier: Apache-2.0 */
/* glare_table.h -- the sources that an eye sees, and all else, as sums over groups of samples:
 * from them the figures of glare, with their intervals.
 *
 * Every figure is a function of sums. Samples are dealt out to GLARE_GROUPS groups that differ
 * in nothing but chance; leaving out one group after the other shows how sure the figure is
 * (J. W. Tukey's jackknife; Miller, Biometrika 61 (1974) 1-15).
 *
 * Units    cd m^-2, sr, lx.
 * Memory   the list grows in the arena.
 */
#pragma once
#include "base/arena.h"
#include "base/confidence.h"
#include "base/vec.h"
#include "vision/discomfort.h"

#define GLARE_DEAL 4
#define GLARE_GROUPS (GLARE_DEAL * GLARE_DEAL)

/* Of a raster's cells every square of 4 by 4 has one in each group. */
static inline int glare_group_at(int x, int y)
{
    return y % GLARE_DEAL * GLARE_DEAL + x % GLARE_DEAL;
}

/* One source. */
typedef struct GlareTally {
    GlareSum group[GLARE_GROUPS]; /* they add up to it */
    double   area_m2;             /* GlareSource's */
} GlareTally;

typedef struct GlareTable {
    GlareTally *list;
    int         count;
    double      background_lx[GLARE_GROUPS]; /* they add up to it */
} GlareTable;

/* A new source; the pointer holds until the next one. */
GlareTally *glare_table_add(GlareTable *table, Arena *arena);

/* What an eye is disturbed by. NaN in intervals: the figure is NaN, or might be. */
typedef struct GlareReading {
    GlareFigures figures;
    MeanInterval ugr, dgp, dgi;   /* 95 % */
    double       threshold_cd_m2; /* by which it was read */
    double       source_lx;       /* on the pupil's plane, of all sources */
    int          source_count;
    double       smallest_sr, largest_sr; /* of a source; NaN: none */
} GlareReading;

GlareReading glare_table_read(const GlareTable *table, const GlareSettings *settings,
                              double threshold_cd_m2, Arena scratch);

/* How bright that is which paths find by chance only, direction by direction:
 * means over cells that are as small as their noise allows.
 *
 * A cell's mean counts where noise cannot make a source of it: where its standard error is
 * small beside the threshold, or the mean is many times its error. Cells of which neither is
 * true are thrown together with their neighbours, until one is. So no single path ever stands
 * for a direction, and all light is kept.
 *
 * Frame    cells about the line of sight: rings of equal steps of the angle's logarithm.
 * Units    cd m^-2, sr. Threads: const once built. */

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
