/* SPDX-License-Identifier: Apache-2.0 */
/* road.h -- a gaze at a road that is lit by night: what the light that its eye sees makes of
 * the threshold increment, and the levels of displays that keep a limit of it.
 *
 * The veil is linear in each display's level, so that what a level makes of it needs no path.
 *
 * Units    road_verdict.h's.
 * Memory   texts and lists lie in the arena. Threads: one at a time. Fails: never.
 */
#pragma once
#include "review/eye/road_veils.h"
#include "review/light/setup.h"
#include "review/profile.h"
#include "review/road_verdict.h"

/* Is the road evaluated in that setup, and why not? */
RoadLeftOut road_left_out(const Setup *setup, const ReviewRoad *road);

/* The ages of the request's road, of its observer where it names none. */
RoadAges road_ages(const ReviewRequest *request, const ReviewRoad *road, Arena *arena);

/* A road that is left out: what is stated of it. */
GazeRoad *road_stated(const ReviewRoad *road, RoadLeftOut left_out, Arena *arena);

/* From what was read, judged by the profile. */
GazeRoad *road_of(const Setup *setup, const ReviewRoad *road, const RoadReading *reading,
                  const Profile *profile, Arena *arena);

/* Of an evaluated road with a limit: the table of levels, from the cases of its condition. */
void road_dim(const ReviewRoad *road, const Profile *profile, const ReviewCase *cases,
              int case_count, GazeFinding *gaze, Arena *arena);
