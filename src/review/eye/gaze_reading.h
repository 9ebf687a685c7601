/* SPDX-License-Identifier: Apache-2.0 */
/* gaze_reading.h -- what lies along an eye's gaze: what it looks at, and what a pane before it
 * mirrors over that, such as the top of the dashboard in the windscreen.
 *
 * Means over the cone of GAZE_CONE_DEG about the gaze, the part of the field that an eye sees
 * sharply. A pane is what lets light through: glass. It mirrors what comes via a
 * reflection at it before the gaze meets anything else than glass; all other light came through
 * it, or there is no pane. Both add up to what a camera would see there, but for the sun's own
 * disc: that one is no background of anything.
 *
 * A pilot shows how many paths both figures take; fresh ones make them (estimate/estimate.h).
 * Their upper ends have, besides, what the brightest lamp could send there that no path met,
 * straight or by mirrors and panes alone.
 *
 * Units        cd m^-2.
 * Memory       scratch only. Threads: starts its own; the same figures for any count.
 */
#pragma once
#include "estimate/estimate.h"
#include "review/eye/eye_reading.h"

/* Paths into the cone about a gaze, in batches, and what they find of its two
 * figures.
 *
 * Light that comes by mirrors and panes alone is found by chance, and its source may be small:
 * cheap paths of its own, that end where something scatters, find it. All other light is left
 * to whole paths. Both kinds add up.
 *
 * Units    cd m^-2; metres, scene.
 * Memory   batches lie in the caller's arena. Threads: starts its own; the same figures for any
 *          count. */

#define GAZE_CONE_DEG EYE_NEAR_DEG /* half its width */

typedef struct GazeAim {
    Vec3 eye;     /* m, scene */
    Vec3 towards; /* any length but 0 */
} GazeAim;

typedef enum GazeFigure { GAZE_THROUGH, GAZE_MIRRORED, GAZE_FIGURES } GazeFigure;

/* A ray behind its last mirror, and the share of its light that the eye sees. */
typedef struct GazeImage {
    Ray ray;
    float share;
} GazeImage;

/* that a batch keeps of a figure: the first ones behind the first mirror, and as many behind
 * others; they stand for all */
#define GAZE_IMAGES 2

/* What a batch of paths found. */
typedef struct GazeBatch {
    const Scene *scene;
    double sum[GAZE_FIGURES];
    BrightSamples bright[GAZE_FIGURES];
    GazeImage image[GAZE_FIGURES][2][GAZE_IMAGES];
    int images[GAZE_FIGURES][2];
    bool *met[GAZE_FIGURES];   /* [part] emitters, by mirrors alone */
    double *panes, *shown;     /* mirrored light by scene part: the pane's, and that of the
                                  part it shows; then one for each set of lights */
    double path[GAZE_FIGURES]; /* of the one at work */
    bool by_mirrors;
} GazeBatch;

typedef struct GazePaths {
    const Setup *setup;
    Vec3 eye;
    Frame frame; /* z: the gaze */
    uint32_t seed;
    bool by_mirrors;            /* which kind */
    int first, end;             /* paths of every batch */
    GazeBatch *batches;         /* [ESTIMATE_BATCHES] */
    double unmet[GAZE_FIGURES]; /* the brightest that a path may have missed, cd m^-2 */
} GazePaths;

typedef struct GazeGoal {
    Vec3 eye;         /* m, scene */
    Vec3 towards;     /* any length but 0 */
    double precision; /* relative standard error of both figures, above 0, */
    int most;         /* unless it takes more paths than that: so many whole ones, a power of
                         two from 2048 on */
} GazeGoal;

/* Where mirrored light comes from: the first surface that the pane shows, or, where it shows
 * none, the source itself. */
typedef struct GazeMirrored {
    int pane_id;     /* scene part; NO_ID: nothing is mirrored */
    int part_id;     /* scene part; NO_ID: the source, */
    LightSet source; /* which is this */
} GazeMirrored;

typedef struct GazeFound {
    double mean, sigma;    /* its standard error */
    MeanInterval interval; /* 95 % */
} GazeFound;

typedef struct GazeReading {
    GazeFound through, mirrored;
    GazeMirrored most; /* most of what is mirrored */
} GazeReading;

GazeReading gaze_read(const Setup *setup, const GazeGoal *goal, Arena scratch);
