/* SPDX-License-Identifier: Apache-2.0 */
#include "review/road_verdict.h"

#include "review/quantity.h"

const char *const road_windows[ROAD_WINDOWS + 1] = {
    [ROAD_WINDOW_OPEN] = "open", [ROAD_WINDOW_CLOSE] = "too close", [ROAD_WINDOW_EMPTY] = "empty"};
const char *const road_left_outs[ROAD_LEFT_OUTS + 1] = {
    [ROAD_BY_DAY] = "the sun is above the horizon",
    [ROAD_OTHER_TIME] = "the request names other conditions"};

bool road_has_limit(const GazeRoad *road) {
    return road->age_count > 0 && road->ages[0].limit.name;
}

const RoadAge *gaze_worst_age(const GazeFinding *gaze) {
    const RoadAge *worst = NULL;
    if (!gaze->road || !road_has_limit(gaze->road)) return NULL;
    for (int i = 0; i < gaze->road->age_count; i++) {
        const RoadAge *age = &gaze->road->ages[i];
        if (!worst || limit_is_worse(&age->limit, &worst->limit)) worst = age;
    }
    return worst;
}
