/* SPDX-License-Identifier: Apache-2.0 */
/* bench_roads TRIALS REVIEW.json -- how often the verdict on a gaze at a road is wrong: of each
 * moment the first road as the first eye sees it, held against limits that leave its true
 * threshold increment a margin of -10 to 10 %, TRIALS seeds, by what decides a review's
 * verdicts. roads.py makes the reviews.
 *
 * The truth is the mean of as many readings with seeds of their own, for the first age.
 * Printed are, with tabs between: moment, "truth", increment, the error of that in percent;
 * then of each margin: moment, margin in percent, trials, passes, failures, too close. */
#include <string.h>

#include "coverage_trials.h"
#include "review/eye/eye_reading.h"
#include "review/request/request_read.h"
#include "review/judge.h"
#include "review/run/road.h"

#define ROUNDS 16 /* a review's */
#define MARGINS 6

static const double margins[MARGINS] = {-10, -5, -2, 2, 5, 10};

typedef struct Roads {
    ReviewRequest *request;
    const Setup *setup;
    const ReviewRoad *road;
    Vec3 eye, towards;
    Arena scratch;
} Roads;

static GazeRoad *judged(const Roads *r, const RoadReading *reading, double limit, Arena *arena) {
    Profile profile = {.id = "one", .increment_most_pct = limit};
    GazeFinding gaze = {.road = road_of(r->setup, r->road, reading, &profile, arena)};
    judge_gaze(&gaze, &profile, arena);
    return gaze.road;
}

static RoadReading read_road(const Roads *r, unsigned seed, Arena *room) {
    RoadAges ages = road_ages(r->request, r->road, room);
    RoadReading out = road_reading_start(ages.count, r->setup->scene->display_count, room);
    EyeLook look = {r->eye, r->towards, ROUNDS,
                    NULL,   false,      road_veils_start(r->setup->scene, &ages, room)};
    r->request->seed = seed;
    eye_read(r->setup, &look, *room);
    road_veils_read(look.road, &out);
    return out;
}

static Truth true_increment(const Roads *r, int trials, Arena arena) {
    Trial *list = ARENA_NEW(&arena, Trial, trials);
    for (int i = 0; i < trials; i++) {
        Arena room = r->scratch;
        RoadReading reading = read_road(r, (1u << 28) + (unsigned)i, &room);
        list[i].found = judged(r, &reading, 1, &room)->ages[0].increment_pct;
    }
    Truth truth = trials_mean(list, trials);
    printf("%s\ttruth\t%.6g\t%.4f\n", r->setup->condition->name, truth.value,
           100 * truth.error / truth.value);
    fflush(stdout);
    return truth;
}

/* One reading is held against all limits. */
static void try_road(const Roads *r, int trials, Arena arena) {
    Truth truth = true_increment(r, trials, arena);
    int count[MARGINS][4] = {{0}};
    for (int i = 0; i < trials; i++) {
        Arena room = r->scratch;
        RoadReading reading = read_road(r, 1u + (unsigned)i, &room);
        for (int m = 0; m < MARGINS; m++) {
            Arena own = room;
            double limit = truth.value * (1 + margins[m] / 100);
            count[m][judged(r, &reading, limit, &own)->ages[0].limit.verdict]++;
        }
    }
    for (int m = 0; m < MARGINS; m++)
        printf("%s\t%g\t%d\t%d\t%d\t%d\n", r->setup->condition->name, margins[m], trials,
               count[m][VERDICT_PASS], count[m][VERDICT_FAIL], count[m][VERDICT_TOO_CLOSE]);
    fflush(stdout);
}

static void try_moment(ReviewRequest *request, const ReviewCondition *c, int trials,
                       Problems *problems) {
    SetupOptions options = {
        .request = request, .condition = c, .means = {.root = "/", .threads = 2}};
    Arena arena = arena_reserve((size_t)1 << 36);
    Setup setup;
    Error err = {0};
    Roads r = {.request = request, .setup = &setup, .scratch = arena_reserve((size_t)1 << 34)};
    for (int g = 0; g < request->gaze_count && !r.road; g++) {
        r.road = request->gazes[g].road;
        r.towards = vec3_from_doubles(request->gazes[g].direction);
    }
    if (!r.road) {
        fprintf(stderr, "%s: no gaze is at a road\n", request->file);
        exit(1);
    }
    if (!setup_open(&options, &arena, problems, &setup, &err) ||
        !setup_light(&setup, NULL, &arena, &err) ||
        !setup_eye_middle(&setup, &request->eyes[0], arena, &r.eye, &err))
        trials_stop(&err);
    try_road(&r, trials, arena);
    arena_release(&r.scratch);
    setup_close(&setup);
    arena_release(&arena);
}

int main(int argc, char **argv) {
    Arena arena = arena_reserve((size_t)1 << 30);
    Error err = {0};
    Problems problems = problems_start(&arena);
    ReviewRequest request;
    int trials = argc == 3 ? atoi(argv[1]) : 0;
    if (trials < 2) {
        fprintf(stderr, "bench_roads TRIALS REVIEW.json\n");
        return 1;
    }
    if (!review_request_read(argv[2], "/", &arena, &problems, &request, &err)) trials_stop(&err);
    for (int i = 0; i < request.condition_count; i++)
        if (request.conditions[i].kind == CONDITION_MOMENT)
            try_moment(&request, &request.conditions[i], trials, &problems);
    arena_release(&arena);
    return 0;
}
