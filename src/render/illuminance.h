/* SPDX-License-Identifier: Apache-2.0 */
/* illuminance.h -- a luxmeter in a scene.
 *
 * Units    places in metres (world); results in lx.
 * Memory   the lights come from the arena; the ray tracer's memory is gone on return.
 * Threads  starts its own; the same figures for any number.
 */
#pragma once
#include "path/path.h"

typedef struct IlluminanceOptions {
    LitPoint point;            /* the head is there and faces point.ns */
    long     samples;          /* at least 2 */
    int      max_bounces;
    uint32_t seed;
    int      threads;          /* at least 1 */
} IlluminanceOptions;

typedef struct Illuminance {
    double xyz_lx[3];  /* Y is the illuminance */
    double low_lx, high_lx; /* 95 % interval of Y, of independent batches of samples */
} Illuminance;

bool illuminance_measure(const Scene *scene, const IlluminanceOptions *options, Arena *arena,
                         Illuminance *out, Error *err);
