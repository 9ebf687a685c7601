/* SPDX-License-Identifier: Apache-2.0 */
/* pane_image_reading.h -- how bright the image of a display in a pane is, and against what it
 * is seen.
 *
 * Means over the image's solid angle, by paths as a frame's from anywhere in it: both faces of
 * the pane, its coatings, its ghost, the display's content, level and emission at that angle
 * are in them. The rays carry how light is polarised, as frames with --polarised do: an LCD's
 * light is, and glass mirrors one direction of it many times as much as the other. The eye is
 * a naked one.
 *
 *   image    the display's own light via a reflection at that pane, by mirrors and panes alone
 *   through  what comes past all panes: what lies behind the glass
 *   against  all but the image: `through`, and all else that panes mirror there
 *
 * A pilot shows how many paths they take; fresh ones make them (estimate/estimate.h).
 *
 * Units    cd m^-2.
 * Memory   scratch only. Threads: starts its own; the same figures for any count.
 */
#pragma once
#include "review/eye/gaze_reading.h"
#include "review/eye/pane_images.h"

typedef struct PaneImageGoal {
    Vec3 eye;               /* m, scene */
    const PaneImage *image; /* with cells */
    double precision;       /* relative standard error of the image and of `against`, */
    int most;               /* unless it takes more paths: a power of two from 2048 on */
    uint32_t seed;          /* other paths than those of 0 */
} PaneImageGoal;

typedef struct PaneImageReading {
    Estimate image, through, against;
    double ghost_share; /* of the image's light: by the pane's far face, which shows
                           another place of the display than its near one there */
    double ghost_rad;   /* how far beside it stands, as the eye sees it: mean over that
                           light; NaN: there is none */
} PaneImageReading;

PaneImageReading pane_image_read(const Setup *setup, const PaneImageGoal *goal, Arena scratch);
