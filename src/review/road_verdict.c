/* SPDX-License-Identifier: Apache-2.0 */
#include "review/road_verdict.h"

const char *const road_windows[ROAD_WINDOWS + 1] = {
    [ROAD_WINDOW_OPEN] = "open", [ROAD_WINDOW_CLOSE] = "too close",
    [ROAD_WINDOW_EMPTY] = "empty"};
const char *const road_left_outs[ROAD_LEFT_OUTS + 1] = {
    [ROAD_BY_DAY] = "the sun is above the horizon",
    [ROAD_OTHER_TIME] = "the request names other conditions"};

bool gaze_counts(const GazeFinding *gaze)
{
    return gaze->road && gaze->road->has_limit;
}

const RoadAge *gaze_worst_age(const GazeFinding *gaze)
{
    const RoadAge *worst = NULL;
    if (!gaze_counts(gaze)) return NULL;
    for (int i = 0; i < gaze->road->age_count; i++) {
        const RoadAge *age = &gaze->road->ages[i];
        if (age->limit.verdict != gaze->road->verdict) continue;
        if (!worst || age->limit.margin < worst->limit.margin) worst = age;
    }
    return worst;
}

/* Of both the age that decides; without a limit the last, whose increment is the greatest. */
bool road_is_worse(const GazeFinding *a, const GazeFinding *b)
{
    const RoadAge *x = gaze_worst_age(a), *y = gaze_worst_age(b);
    int more = verdict_rank(a->road->verdict) - verdict_rank(b->road->verdict);
    if (!x || !y) {
        int last = a->road->age_count - 1;
        return last >= 0 &&
               a->road->ages[last].increment_pct > b->road->ages[last].increment_pct;
    }
    return more > 0 || (more == 0 && x->limit.margin < y->limit.margin);
}
