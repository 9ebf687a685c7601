/* SPDX-License-Identifier: Apache-2.0 */
/* road_fixture.h -- a gaze at a road, as a review has found it. */
#pragma once
#include <math.h>

#include "base/arena.h"
#include "review/road_verdict.h"

static inline RoadAge fixture_road_age(double years, double pct, double half,
                                       RoadDisplay *displays) {
    return (RoadAge){.age_years = years,
                     .veil = pct / 170,
                     .veil_range = {(pct - half) / 170, (pct + half) / 170},
                     .increment_pct = pct,
                     .increment_range = {pct - half, pct + half},
                     .increment_by_spread_pct = 0.9 * pct,
                     .limit = {.value = NAN, .found = NAN, .low = NAN, .high = NAN, .margin = NAN},
                     .displays = displays,
                     .display_count = 2};
}

/* Two displays, two ages, the older one's increment so much. */
static inline GazeRoad *fixture_road(Arena *memory, double old_pct, double half) {
    static RoadDisplay displays[2];
    GazeRoad *road = ARENA_NEW(memory, GazeRoad, 1);
    displays[0] = (RoadDisplay){.display = "wide screen",
                                .level = 0.5,
                                .share = 0.8,
                                .increment_pct = 9,
                                .increment_range = {8.9, 9.1},
                                .straight_share = 1,
                                .level_most = NAN,
                                .level_most_range = {NAN, NAN}};
    displays[1] = (RoadDisplay){.display = "cluster",
                                .level = 0.1,
                                .share = 0.1,
                                .increment_pct = 1,
                                .increment_range = {0.9, 1.1},
                                .straight_share = 0.2,
                                .mirrored_share = 0.7,
                                .scattered_share = 0.1,
                                .mirrored_by = "windscreen (glass)",
                                .mirrored_by_share = 0.6,
                                .level_most = 0.4,
                                .level_most_range = {0.3, 0.5}};
    *road = (GazeRoad){.luminance_cd_m2 = 0.3,
                       .s_p = 1.4,
                       .mesopic_cd_m2 = 0.325,
                       .ages = ARENA_NEW(memory, RoadAge, 2),
                       .age_count = 2};
    road->ages[0] = fixture_road_age(25, 0.5 * old_pct, half, displays);
    road->ages[1] = fixture_road_age(70, old_pct, half, displays);
    return road;
}

static inline void fixture_dimming(GazeRoad *road) {
    static RoadDimming rows[4];
    static const RoadWindow windows[] = {ROAD_WINDOW_EMPTY, ROAD_WINDOW_CLOSE, ROAD_WINDOW_OPEN,
                                         ROAD_WINDOW_NONE};
    for (int i = 0; i < 4; i++)
        rows[i] = (RoadDimming){.display = i < 3 ? "wide screen" : NULL,
                                .age_years = 70,
                                .road_cd_m2 = 0.1 * (i + 1),
                                .level = 0.5,
                                .level_most = 0.02 * i,
                                .level_most_range = {0.018 * i, 0.022 * i},
                                .level_least = 0.02,
                                .level_least_sure = 0.021,
                                .symbol = "speed",
                                .window = windows[i]};
    road->dimming = rows;
    road->dimming_count = 4;
}
