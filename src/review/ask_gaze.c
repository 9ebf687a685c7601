/* SPDX-License-Identifier: Apache-2.0 */
/* What light takes from an eye that looks elsewhere than at a symbol: at a road by night, out of
 * the windows, and by mirrors that throw the sun into it. */
#include "review/profile.h"
#include "review/quantity.h"
#include "review/road_verdict.h"

static Figure find_increment(const Evidence *e, bool is_upper) {
    const RoadAge *age = &e->gaze->road->ages[e->age];
    (void)is_upper;
    return (Figure){.found = age->increment_pct,
                    .low = age->increment_range.low,
                    .high = age->increment_range.high,
                    .age_years = age->age_years};
}

static Figure find_veil(const Evidence *e, bool is_upper) {
    (void)is_upper;
    return (Figure){
        .found = e->gaze->veil, .low = e->gaze->veil_range.low, .high = e->gaze->veil_range.high};
}

static Figure find_contrast(const Evidence *e, bool is_upper) {
    (void)is_upper;
    return (Figure){.found = e->gaze->contrast_left,
                    .low = e->gaze->contrast_range.low,
                    .high = e->gaze->contrast_range.high};
}

static Figure find_mirrored_sun(const Evidence *e, bool is_upper) {
    (void)is_upper;
    return figure_exact(e->sun->veil_cd_m2);
}

const ReviewQuantity quantity_threshold_increment = {.unit = "%",
                                                     .words = "threshold increment",
                                                     .of = OF_GAZE,
                                                     .is_of_light = true,
                                                     .has_one_bound = true,
                                                     .is_upper = true,
                                                     .find = find_increment};

const ReviewQuantity quantity_gaze_veil = {.unit = "cd/m2",
                                           .words = "veil in the eye",
                                           .of = OF_GAZE,
                                           .is_of_light = true,
                                           .has_one_bound = true,
                                           .is_upper = true,
                                           .find = find_veil};

const ReviewQuantity quantity_gaze_contrast = {.unit = "1",
                                               .words = "share of contrast left",
                                               .of = OF_GAZE,
                                               .is_of_light = true,
                                               .has_one_bound = true,
                                               .below = 1,
                                               .find = find_contrast};

const ReviewQuantity quantity_mirrored_sun = {.unit = "cd/m2",
                                              .words = "veil by the sun in a mirror",
                                              .of = OF_MIRROR,
                                              .is_of_light = true,
                                              .has_one_bound = true,
                                              .is_upper = true,
                                              .find = find_mirrored_sun};
