/* SPDX-License-Identifier: Apache-2.0 */
/* Verdicts on increments whose truth is a closed form: how many are wrong at six margins. A
 * small count of trials: tests/bench/roads.py has hundreds. */
#include "fixture.h"

#include "base/count.h"
#include "base/units.h"
#include "review/eye/eye_reading.h"
#include "review/judge.h"
#include "review/run/road.h"
#include "vision/road_glare.h"
#include "world_fixture.h"

#define TRIALS 12
#define ROUNDS 4
#define SKY 0.02
#define LAMP 3e4
#define HALF 0.002
#define LAMP_DEG 12.0

static const double AGE = 50;
static const ReviewRoad road = {.luminance_cd_m2 = 0.3, .s_p = NAN, .ages = &AGE, .age_count = 1};
static ReviewRequest request = {.forward = {0, 0, -1}, .observer = {50, 0.5}};

/* A lamp above the gaze, before an even sky that is everywhere. */
static World night_world(void) {
    World world = world_start();
    double t = radians_from_degrees(LAMP_DEG);
    builder_sky(world.scene, (float)SKY);
    builder_part(world.scene, builder_lamp((float)LAMP));
    builder_quad(world.scene, vec3(0, (float)sin(t), (float)-cos(t)), vec3((float)HALF, 0, 0),
                 vec3(0, (float)(HALF * cos(t)), (float)(HALF * sin(t))));
    return world;
}

/* Of the lamp as a small source and of the sky in rings; the lamp hides next to none of it. */
static double true_increment(void) {
    double step = 0.001, veil = LAMP * 4 * HALF * HALF * cos(radians_from_degrees(LAMP_DEG)) *
                                road_veil_at(LAMP_DEG, AGE);
    for (double at = 1 + step / 2; at < 89.9; at += step) {
        double t = radians_from_degrees(at);
        veil += SKY * road_veil_at(at, AGE) * 2 * PI * sin(t) * cos(t) * radians_from_degrees(step);
    }
    return road_threshold_increment(veil, road.luminance_cd_m2);
}

static RoadReading read_road(const Setup *setup, Arena *arena) {
    RoadAges ages = road_ages(&request, &road, arena);
    RoadReading found = road_reading_start(1, 0, arena);
    EyeLook look = {vec3(0, 0, 0), vec3(0, 0, -1), ROUNDS,
                    NULL,          false,          road_veils_start(setup->scene, &ages, arena)};
    eye_read(setup, &look, *arena);
    road_veils_read(look.road, &found);
    return found;
}

TEST(verdicts_are_not_wrong) {
    static const double margins[] = {-10, -5, -2, 2, 5, 10};
    const Kernel *kernel;
    SCOPED_WORLD world = night_world();
    double truth = true_increment();
    int wrong = 0, decided = 0;
    assert_done(kernel_choose(NULL, &kernel, &err));
    world_ready(&world, 16);
    Setup setup = {.request = &request,
                   .tools = {.kernel = kernel, .threads = 2},
                   .scene = world.scene,
                   .context = world.context};
    for (int i = 0; i < TRIALS; i++) {
        Arena room = world.arena;
        request.seed = (uint32_t)i + 1;
        RoadReading reading = read_road(&setup, &room);
        for (int m = 0; m < COUNT_OF(margins); m++) {
            Profile profile = {.increment_most_pct = truth * (1 + margins[m] / 100)};
            GazeRoad *found = road_of(&setup, &road, &reading, &profile, &room);
            Verdict never = margins[m] < 0 ? VERDICT_PASS : VERDICT_FAIL;
            Verdict right = margins[m] < 0 ? VERDICT_FAIL : VERDICT_PASS;
            GazeFinding gaze = {.road = found};
            judge_gaze(&gaze, &profile, &room);
            wrong += gaze.verdict == never;
            decided += fabs(margins[m]) == 10 && gaze.verdict == right;
        }
    }
    assert_int_equal(wrong, 0);
    assert_true(decided >= TRIALS); /* of twice as many */
}

TEST_PROGRAM(NULL, NULL)
