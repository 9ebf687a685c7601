/* SPDX-License-Identifier: Apache-2.0 */
/* What a review has to do: REVIEW.json. */
#include <math.h>

#include "harness.h"
#include "review/request/request_read.h"

static void write_named_files(Arena *arena) {
    fuzz_file("a.gltf", "", 0, arena);
    fuzz_file("p.png", "", 0, arena);
}

static void claim_condition(const ReviewRequest *request, const ReviewCondition *condition) {
    fuzz_claim(condition->level_id < request->level_count &&
                   condition->with_id < request->with_count &&
                   condition->weather_id < request->weather_count,
               "names are found");
    if (condition->kind == CONDITION_YEAR_SWEEP)
        fuzz_claim(condition->heading_count > 0 && condition->step_minutes > 0,
                   "a year has hours and headings");
    if (condition->kind != CONDITION_SUN_SWEEP) return;
    for (int i = 1; i < condition->azimuth_deg.count; i++)
        fuzz_claim(review_range_value(&condition->azimuth_deg, i) >
                       review_range_value(&condition->azimuth_deg, i - 1),
                   "a range rises");
}

static void claim_level(const ReviewLevel *level) {
    double last = 0;
    for (double lux = 1e-3; level->is_curve && lux < 1e8; lux *= 7) {
        double value = review_level_of_lux(level, lux);
        fuzz_claim(value >= last && value <= 100, "a level does not fall");
        last = value;
    }
}

void fuzz_review(const uint8_t *data, size_t size, Arena *arena) {
    Error err = {0};
    ReviewRequest request;
    double point[3];
    write_named_files(arena);
    Problems problems = problems_start(arena);
    const char *path = fuzz_file("t.review.json", data, size, arena);
    if (!review_request_read(path, NULL, arena, &problems, &request, &err)) {
        fuzz_claim_refusal(&err);
        return;
    }
    fuzz_claim(request.eye_count > 0 && request.symbol_count > 0 && request.gaze_count > 0 &&
                   request.condition_count > 0 && request.scene_count > 0,
               "a review has something to look at");
    for (int e = 0; e < request.eye_count; e++)
        for (int i = 0; i < review_eye_count(&request.eyes[e]); i++) {
            review_eye_point(&request.eyes[e], i, point);
            fuzz_claim(isfinite(point[0] + point[1] + point[2]), "an eye is somewhere");
        }
    for (int i = 0; i < request.level_count; i++) claim_level(&request.levels[i]);
    for (int i = 0; i < request.condition_count; i++)
        claim_condition(&request, &request.conditions[i]);
}
