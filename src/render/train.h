/* SPDX-License-Identifier: Apache-2.0 */
/* train.h -- trains a guide on the scene before the first sample that counts.
 *
 * It is trained on paths of a coarse raster over the whole frame, not the crop; always the same
 * ones, so that the guide depends on scene, camera and the frame's size alone, and of a preview
 * on its samples.
 *
 * Memory   the guide comes from the arena.
 */
#pragma once
#include "camera/camera.h"
#include "guide/guide_file.h"
#include "kernel/kernel.h"

typedef struct TrainOptions {
    const Kernel *kernel;
    int threads;
    bool stops_at_once; /* where a stop is requested (signals.h): the guide is NULL */
    double paths;       /* that are to be guided: few are worth little training; 0: many */
} TrainOptions;

/* The facts of this light that a guide from a file must match. */
GuideScene train_guide_scene(const PathContext *context);

/* context: without a guide. */
const LightGuide *train_guide(const PathContext *context, const Camera *camera,
                              const TrainOptions *options, Arena *arena, PathStatistics *cost);
