/* SPDX-License-Identifier: Apache-2.0 */
/* judge_road.h -- a gaze's threshold increment held against the profile's own limit.
 *
 * As judge.h: kept when the whole interval of each age keeps it, broken when one's whole
 * interval breaks it, else too close. It cannot be judged where more than UNJUDGED_DATA_SHARE
 * of the veil came via materials without optical data, or from displays whose panels say that
 * they are not usable.
 *
 * Memory   none. Threads: pure but for the gaze that is passed in. Fails: never.
 */
#pragma once
#include "review/profile.h"
#include "review/road_verdict.h"

/* Sets the ages' limits, has_limit, verdict and unjudged. unusable_share: of the veil, for the
 * first age, from displays whose panels are not usable. */
void judge_road(GazeRoad *road, const Profile *profile, double unusable_share);
