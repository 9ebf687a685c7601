/* SPDX-License-Identifier: Apache-2.0 */
#include "review/judge_road.h"

#include <math.h>

static LimitVerdict held_against(const RoadAge *age, double most, bool is_known) {
    LimitVerdict limit = {.name = "threshold increment at most",
                          .kind = "threshold_increment",
                          .unit = "%",
                          .source = "the profile's own key threshold_increment_max_pct",
                          .value = most,
                          .is_upper = true,
                          .found = age->increment_pct,
                          .low = age->increment_range.low,
                          .high = age->increment_range.high};
    limit.margin = quantity_margin(LIMIT_KIND_COUNT, true, limit.found, most);
    limit.verdict = is_known ? quantity_verdict(&limit) : VERDICT_UNJUDGED;
    return limit;
}

void judge_road(GazeRoad *road, const Profile *profile, double unusable_share) {
    double most = profile->increment_most_pct;
    bool has_data = !(road->without_data_share > UNJUDGED_DATA_SHARE);
    bool is_usable = !(unusable_share > UNJUDGED_DATA_SHARE);
    road->has_limit = !road->left_out && most > 0 && road->age_count > 0;
    road->verdict = VERDICT_PASS;
    road->unjudged = UNJUDGED_NOT;
    for (int i = 0; i < road->age_count && road->has_limit; i++) {
        RoadAge *age = &road->ages[i];
        age->limit = held_against(age, most, has_data && is_usable);
        if (verdict_rank(age->limit.verdict) > verdict_rank(road->verdict))
            road->verdict = age->limit.verdict;
    }
    if (road->verdict == VERDICT_UNJUDGED)
        road->unjudged = !is_usable ? UNJUDGED_PANEL : !has_data ? UNJUDGED_DATA : UNJUDGED_FIGURE;
}
