/* SPDX-License-Identifier: Apache-2.0 */
/* pane_fixture.h -- displays in glass as a review tells them: one is seen, the other is not. */
#pragma once
#include <math.h>

#include "review/judge.h"
#include "review/pane_verdict.h"

/* Seen; 1 +- 0.1 against 4 +- 0.4 cd/m2. */
static inline PaneFinding fixture_pane(const char *display) {
    static const double OUTLINE[] = {-12, 8, -6, 8.5, -6, 11};
    PaneFinding f = {.condition = "night",
                     .eye = "driver",
                     .display = display,
                     .pane = "windscreen (glass)",
                     .shown_share = 0.75,
                     .covered_share = 0.25,
                     .covered_by = "hood (leather)",
                     .right_deg = -8,
                     .up_deg = 9,
                     .width_deg = 6,
                     .height_deg = 3,
                     .outline_deg = OUTLINE,
                     .outline_count = 6,
                     .image = 1,
                     .image_range = {0.9, 1.1},
                     .behind = 3,
                     .behind_range = {2.8, 3.2},
                     .against = 4,
                     .against_range = {3.6, 4.4},
                     .ghost_share = 0.4,
                     .ghost_arcmin = 4.75,
                     .area = "road",
                     .off_deg = 6.5};
    pane_set_contrast(&f);
    return f;
}

/* Held against the most that its area allows. */
static inline void fixture_pane_judge(PaneFinding *f, double most) {
    judge_pane(f, NULL, AMBIENT_NIGHT, most);
}

static inline PaneFinding fixture_pane_hidden(void) {
    const double nan = (double)NAN;
    const MeanInterval none = {nan, nan};
    return (PaneFinding){.condition = "night",
                         .eye = "driver",
                         .display = "centre (centre)",
                         .pane = "side <glass>",
                         .none = "the pane ends before it",
                         .ends_share = 1,
                         .right_deg = nan,
                         .up_deg = nan,
                         .width_deg = nan,
                         .height_deg = nan,
                         .image = nan,
                         .image_range = none,
                         .behind = nan,
                         .behind_range = none,
                         .against = nan,
                         .against_range = none,
                         .contrast = nan,
                         .contrast_range = none,
                         .ghost_share = nan,
                         .ghost_arcmin = nan,
                         .off_deg = nan};
}
