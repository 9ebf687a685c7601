/* SPDX-License-Identifier: Apache-2.0 */
/* gaze_paths.h -- paths into the cone about a gaze, in batches, and what they find of its two
 * figures.
 *
 * Light that comes by mirrors and panes alone is found by chance, and its source may be small:
 * cheap paths of its own, that end where something scatters, find it. All other light is left
 * to whole paths. Both kinds add up.
 *
 * Units    cd m^-2; metres, scene.
 * Memory   batches lie in the caller's arena. Threads: starts its own; the same figures for any
 *          count.
 */
#pragma once
#include "estimate/estimate.h"
#include "review/eye/eye_reading.h"

#define GAZE_CONE_DEG EYE_NEAR_DEG /* half its width */

typedef struct GazeAim {
    Vec3 eye;     /* m, scene */
    Vec3 towards; /* any length but 0 */
} GazeAim;

typedef enum GazeFigure { GAZE_THROUGH, GAZE_MIRRORED, GAZE_FIGURES } GazeFigure;

/* A ray behind its last mirror, and the share of its light that the eye sees. */
typedef struct GazeImage {
    Ray   ray;
    float share;
} GazeImage;

#define GAZE_IMAGES 2 /* that a batch keeps of a figure: the first ones behind the first
                         mirror, and as many behind others; they stand for all */

/* What a batch of paths found. */
typedef struct GazeBatch {
    const Scene  *scene;
    double        sum[GAZE_FIGURES];
    BrightSamples bright[GAZE_FIGURES];
    GazeImage     image[GAZE_FIGURES][2][GAZE_IMAGES];
    int           images[GAZE_FIGURES][2];
    bool         *met[GAZE_FIGURES];   /* [part] emitters, by mirrors alone */
    double       *panes, *shown; /* mirrored light by scene part: the pane's, and that of the
                                    part it shows; then one for each set of lights */
    double        path[GAZE_FIGURES];  /* of the one at work */
    bool          by_mirrors;
} GazeBatch;

typedef struct GazePaths {
    const Setup *setup;
    Vec3      eye;
    Frame     frame;      /* z: the gaze */
    uint32_t  seed;
    bool      by_mirrors; /* which kind */
    int       first, end; /* paths of every batch */
    GazeBatch *batches;   /* [ESTIMATE_BATCHES] */
    double     unmet[GAZE_FIGURES]; /* the brightest that a path may have missed, cd m^-2 */
} GazePaths;

GazePaths gaze_paths_start(const Setup *setup, const GazeAim *gaze, bool by_mirrors,
                           uint32_t seed, Arena *arena);

/* Goes on to so many paths in all, a multiple of 32. */
void gaze_paths_read(GazePaths *paths, long count, Arena scratch);

/* With what lamps may have sent by mirrors that were not met. */
EstimateSums gaze_paths_sums(const GazePaths *paths, GazeFigure figure);

/* Adds where mirrored light came from, each path by `weight`: [part], [part and sets]. */
void gaze_paths_places(const GazePaths *paths, double weight, double *panes, double *shown);
