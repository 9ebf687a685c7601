/* SPDX-License-Identifier: Apache-2.0 */
/* unfollowed.h -- how much light of small lamps there may be by ways that no connection makes.
 * HOT.
 *
 * A lamp without a surface that shines by two mirrors, by a mirror and a plate, or through a
 * wedge is found by no path, a compact emitter there, or behind a plate, by one of many
 * thousands. A reading's path that left such boundaries takes every such lamp for a disc 11
 * degrees wide, seen from the last of them, that sends as much light: blurred so, paths find it,
 * and in the mean about what there is. Some times that is counted as what may be missing
 * (path_state.h). Frames have src/missed instead.
 *
 * Approximate  where a caustic is narrower than the disc, more may come than is counted; of the
 *              brightest place of one the mean about it counts.
 */
#pragma once
#include "path/path_state.h"

/* Has the path left boundaries behind which lamps, or emitters alone, are not followed? */
static inline bool unfollowed_emitters(const PathState *path) {
    return path->smooth + path->by_plates >= 2 || (path->smooth >= 0 && path->by_plates);
}

static inline bool unfollowed_lamps(const PathState *path) {
    return path->smooth + path->by_plates >= 2;
}

/* Counts what the path would see of them up to `until` m from the last boundary. */
void unfollowed_add(PathState *path, float until);

/* An emitter was met, and added so much. */
void unfollowed_found(PathState *path, int part_id, Spectrum radiance);
