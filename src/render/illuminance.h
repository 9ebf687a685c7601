/* SPDX-License-Identifier: Apache-2.0 */
/* illuminance.h -- luxmeters in a scene.
 *
 * Units    places in metres; results in lx.
 * Memory   the lights come from the arena; the ray tracer's memory is gone on return.
 * Threads  starts its own; the same figures for any number, and at each point the same as
 *          without the others.
 */
#pragma once
#include "base/progress.h"
#include "path/path.h"

typedef struct IlluminanceOptions {
    const LitPoint *points; /* a head is at each and faces its ns */
    int count;
    long samples; /* of each; at least 2 */
    int max_bounces;
    uint32_t seed;
    int threads;           /* at least 1 */
    ProgressMode progress; /* of many points */
} IlluminanceOptions;

typedef struct Illuminance {
    double xyz_lx[3];       /* Y is the illuminance */
    double low_lx, high_lx; /* 95 % interval of Y, of independent batches of samples */
} Illuminance;

/* out: one for each point. */
bool illuminance_measure(const Scene *scene, const IlluminanceOptions *options, Arena *arena,
                         Illuminance *out, Error *err);
