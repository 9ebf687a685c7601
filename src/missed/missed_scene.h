/* SPDX-License-Identifier: Apache-2.0 */
/* missed_scene.h -- which light is missed in a scene as it is loaded, by whoever may look: its
 * cameras (without one, that which frames it) and its displays.
 *
 * Memory   from the arena; the ray tracer's is gone on return.  Threads: starts its own.
 */
#pragma once
#include "base/progress.h"
#include "missed/missed_light.h"

typedef struct MissedRun {
    int threads;
    ProgressMode progress; /* of the ray tracer's structure */
} MissedRun;

/* Nothing is missed where neither sun nor lamps shine. */
bool missed_in_scene(const Scene *scene, const MissedRun *run, Arena *arena, MissedLight *out,
                     Error *err);
