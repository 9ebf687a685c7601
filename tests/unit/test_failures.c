/* SPDX-License-Identifier: Apache-2.0 */
/* For how long a sweep fails, between its steps. */
#include "fixture.h"

#include "review/suns/sweep_suns.h"

#define DAY 1440.0

/* Fails every day for some minutes; where they begin moves on by `drift` a day, within an hour.
 * is_sure: for sure, else by the figure only. */
typedef struct Daily {
    double from, minutes, drift, step_minutes;
    bool is_sure;
    double spread; /* up to so many minutes more, another day by day */
} Daily;

static StepState state_at(const Daily *daily, const SweepSun *sun) {
    double time = (sun->step + 0.5) * daily->step_minutes + sun->later_minutes;
    double day = floor(time / DAY), since = daily->from + 60 * fmod(daily->drift * day, 1);
    double minute = time - day * DAY;
    double lasts = daily->minutes + daily->spread * fmod(0.37 * day, 1);
    if (minute < since || minute >= since + lasts) return STEP_PASSES;
    return daily->is_sure ? STEP_FAILS_SURELY : STEP_FAILS;
}

static int asked, steps_told; /* suns */

static void tell(void *user, const SweepSuns *suns, unsigned char *states, Arena scratch) {
    (void)scratch;
    asked += suns->count;
    for (int i = 0; i < suns->count; i++) states[i] = (unsigned char)state_at(user, &suns->list[i]);
}

/* Minutes of a year with two headings, and the longest of its failures. */
static Failures failures_of(Daily daily, bool with_ask) {
    Arena arena = arena_reserve((size_t)1 << 28);
    double headings[] = {0, 90};
    ReviewCondition year = {.kind = CONDITION_YEAR_SWEEP,
                            .year = 2026,
                            .weather_id = NO_ID,
                            .where = {48.14, 11.58, 520},
                            .headings_deg = headings,
                            .heading_count = 2,
                            .step_minutes = daily.step_minutes};
    SweepSuns suns = sweep_suns(&year, 2, &arena);
    unsigned char *states = ARENA_NEW(&arena, unsigned char, suns.count);
    FailureArgs args = {tell, &daily};
    tell(&daily, &suns, states, arena);
    steps_told = suns.count;
    Failures found = sweep_failures(&year, &suns, states, with_ask ? &args : NULL, arena);
    found.share *= suns.count * daily.step_minutes / 2; /* minutes of one heading */
    arena_release(&arena);
    return found;
}

TEST(hours_find_the_minutes_of_a_failure) {
    for (double minutes = 75; minutes < 240; minutes += 41) {
        Failures found = failures_of((Daily){557, minutes, 0.618, 60, true, 0}, true);
        assert_near(found.share, 365 * minutes, 365);
        assert_near(found.share / (365 * minutes), 1, 0.005);
        assert_near(found.longest_minutes, minutes, 1);
    }
}

/* Every step is sampled once; 1,460 edges to a minute would take 8,760 more. */
TEST(many_failures_are_told_by_fewer_questions) {
    asked = 0;
    Failures found = failures_of((Daily){557, 130, 0.618, 60, true, 100}, true);
    int more = asked - steps_told;
    double all = 0, longest = 0;
    for (int day = 0; day < 365; day++) {
        double lasts = 130 + 100 * fmod(0.37 * day, 1);
        all += lasts;
        longest = fmax(longest, lasts);
    }
    assert_near(found.share / all, 1, 0.003);
    assert_near(found.longest_minutes, longest, 1);
    if (more > 6000) fail_msg("%d questions", more);
}

/* Shorter than a step: few are met, and count for those that are not. */
TEST(failures_between_steps_are_counted_by_those_that_are_met) {
    for (double minutes = 5; minutes < 60; minutes += 15) {
        Failures found = failures_of((Daily){600, minutes, 0.61803398875, 60, true, 0}, true);
        assert_near(found.share, 365 * minutes, 0.03 * 365 * minutes);
        assert_near(found.longest_minutes, minutes, 1);
    }
}

TEST(steps_are_whole_where_nobody_is_asked) {
    Failures found = failures_of((Daily){600, 180, 0, 60, true, 0}, false);
    assert_near(found.share, 365 * 180, 1e-6);
    assert_near(found.longest_minutes, 180, 1e-9);
}

TEST(what_fails_by_its_figure_alone_does_not_count) {
    Failures found = failures_of((Daily){600, 180, 0.3, 60, false, 0}, true);
    assert_near(found.share, 0, 0);
    assert_near(found.longest_minutes, 0, 0);
}

TEST_PROGRAM(make_arena, drop_arena)
