/* SPDX-License-Identifier: Apache-2.0 */
/* road_steps.h -- roads of a sweep or route in its steps in twilight, hour by hour.
 *
 * A step is evaluated as a moment is, by all paths, under the sky that the sweep has there
 * (sweep_environment), with the displays' levels under that light, over a road that its lamps
 * light as the request states and the sky besides, by its lux on level ground. Steps count from
 * where the sky lights the road no more than its lamps do: before, the increment is the sky's,
 * and no figure of lamps or displays. Where there are more than the request has evaluated they
 * are chosen evenly by the sun's height, the highest and the lowest among them, and each stands
 * for those about it. Below 12 degrees a road is as after dark.
 *
 * Memory   the arena's. Threads: starts its own; the same figures for any count. Readings are
 *          kept in the setup's journal.
 */
#pragma once
#include "review/light/setup.h"
#include "review/run/job.h"

typedef struct RoadStepsArgs {
    const ReviewRun *run;
    Setup           *setup;  /* of the condition; its light becomes another */
} RoadStepsArgs;

/* How many steps in twilight are evaluated of `count`: their places among them, from 0, rising,
 * go to chosen[most]. */
int road_steps_choose(int count, int most, int *chosen);

/* found: of the condition's roads after dark (setup_gazes with roads_only). Each whose road has
 * twilight_steps gets its steps, and becomes that of the worst of them where one is worse. */
bool road_steps_find(const RoadStepsArgs *args, GazeFinding *found, int count, Arena *arena,
                     Error *err);
