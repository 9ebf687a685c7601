/* SPDX-License-Identifier: Apache-2.0 */
#include "review/road_verdict.h"

const char *const road_windows[ROAD_WINDOWS + 1] = {
    [ROAD_WINDOW_OPEN] = "open", [ROAD_WINDOW_CLOSE] = "too close", [ROAD_WINDOW_EMPTY] = "empty"};
const char *const road_left_outs[ROAD_LEFT_OUTS + 1] = {
    [ROAD_BY_DAY] = "the sun is above the horizon",
    [ROAD_OTHER_TIME] = "the request names other conditions"};

bool gaze_counts(const GazeFinding *gaze) {
    return gaze->road && gaze->road->has_limit;
}

const RoadAge *gaze_worst_age(const GazeFinding *gaze) {
    const RoadAge *worst = NULL;
    if (!gaze_counts(gaze)) return NULL;
    for (int i = 0; i < gaze->road->age_count; i++) {
        const RoadAge *age = &gaze->road->ages[i];
        if (age->limit.verdict != gaze->road->verdict) continue;
        if (!worst || age->limit.margin < worst->limit.margin) worst = age;
    }
    return worst;
}
