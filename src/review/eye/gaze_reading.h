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
#include "probe/path_kinds.h"
#include "review/eye/eye_reading.h"

#define GAZE_CONE_DEG EYE_NEAR_DEG /* half its width */

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

typedef struct GazeReading {
    Estimate through, mirrored;
    GazeMirrored most; /* most of what is mirrored */
} GazeReading;

GazeReading gaze_read(const Setup *setup, const GazeGoal *goal, Arena scratch);
