/* SPDX-License-Identifier: Apache-2.0 */
/* How an estimate stops, and how often its interval holds, on light that one path in some
 * hundreds finds. */
#include "fixture.h"

#include "base/sampler.h"
#include "estimate/estimate.h"
#include "estimate/estimate_plan.h"

#define RARE 700 /* one path in so many finds the light, whose mean is 1 */
#define RUNS 1000
#define LEAST 256
#define MOST 16384
#define PRECISION 0.3

/* Paths of one seed. */
typedef struct Rare {
    EstimateSums sums;
    uint32_t seed;
    double each; /* light that a path finds */
} Rare;

static Rare rare_start(uint32_t seed) {
    return (Rare){
        .seed = seed, .each = RARE, .sums = {.batches = ESTIMATE_BATCHES, .piece = 1, .share = 1}};
}

static void rare_read(void *user, long paths) {
    Rare *rare = user;
    for (long i = rare->sums.paths; i < paths; i++) {
        uint32_t bits = hash_combine(hash_u32(rare->seed), (uint32_t)i);
        double light = bits < (uint32_t)(4294967296.0 / RARE) ? rare->each : 0;
        rare->sums.batch[i % ESTIMATE_BATCHES] += light;
        bright_add(&rare->sums.bright, light);
    }
    rare->sums.paths = paths;
    rare->sums.unmet =
        rare->sums.bright.squares > 0 ? 0 : estimate_unmet(rare->each, (double)paths);
}

static bool rare_will_do(void *user, long pilot, long paths) {
    const Rare *rare = user;
    Estimate now = estimate_of(&rare->sums);
    Estimate then = estimate_expected(&now, (double)paths / (double)pilot);
    return then.sigma <= PRECISION * then.mean && then.unmet <= PRECISION;
}

static EstimatePlan plan_of(Rare *pilot) {
    return (EstimatePlan){.pilot = LEAST / 2,
                          .least = LEAST,
                          .most = MOST,
                          .reach = 4,
                          .user = pilot,
                          .read_pilot = rare_read,
                          .will_do = rare_will_do};
}

static bool holds(const Rare *rare) {
    Estimate found = estimate_of(&rare->sums);
    return found.interval.low <= 1 && 1 <= found.interval.high;
}

/* A standard deviation of 1,000 runs is 0.7 %. */
TEST(intervals_of_fresh_paths_hold) {
    int held = 0;
    for (uint32_t run = 0; run < RUNS; run++) {
        Rare pilot = rare_start(2 * run), fresh = rare_start(2 * run + 1);
        EstimatePlan plan = plan_of(&pilot);
        rare_read(&fresh, estimate_plan(&plan));
        held += holds(&fresh);
    }
    if (!(held >= 0.93 * RUNS)) fail_msg("%d of %d", held, RUNS);
}

/* Nothing was found: how often it is there all the same is what is stated. */
TEST(an_interval_of_nothing_holds_what_may_be_there) {
    int held = 0;
    for (uint32_t run = 0; run < RUNS; run++) {
        Rare few = rare_start(run);
        rare_read(&few, LEAST);
        held += holds(&few);
    }
    if (!(held >= 0.93 * RUNS)) fail_msg("%d of %d", held, RUNS);
    assert_near(estimate_unmet(2, 1000), 2 * 3.688879 / 1000, 1e-8);
    assert_true(estimate_unmet(2, 1) == 2 && estimate_unmet(2, 0) == 2);
}

/* It goes on until it is a quarter of what it requires, and requires no more than there are. */
TEST(a_pilot_reaches_no_farther_than_it_may) {
    for (uint32_t run = 0; run < 100; run++) {
        Rare pilot = rare_start(run);
        EstimatePlan plan = plan_of(&pilot);
        long paths = estimate_plan(&plan);
        assert_true(paths >= LEAST && paths <= MOST);
        assert_true(paths <= plan.reach * pilot.sums.paths);
    }
}

static void read_nothing(void *user, long paths) {
    *(long *)user += paths;
}

TEST(a_plan_without_a_choice_reads_no_pilot) {
    long read = 0;
    EstimatePlan plan = {.pilot = 128,
                         .least = LEAST,
                         .most = 2 * LEAST - 1,
                         .reach = 4,
                         .user = &read,
                         .read_pilot = read_nothing};
    assert_int_equal(estimate_plan(&plan), LEAST);
    assert_int_equal(read, 0);
}

/* Batches whose lengths differ by one path: means and errors of those of equal length. */
TEST(batches_may_differ_in_length) {
    Rare even = rare_start(3), odd = rare_start(3);
    rare_read(&even, 64L * ESTIMATE_BATCHES);
    rare_read(&odd, 64L * ESTIMATE_BATCHES + 5);
    Estimate a = estimate_of(&even.sums), b = estimate_of(&odd.sums);
    assert_near(a.mean, b.mean, 0.01 * a.mean + RARE / 2048.0);
    assert_near(a.sigma, b.sigma, 0.1 * a.sigma + RARE / 2048.0);
    double mean = 0;
    for (int i = 0; i < ESTIMATE_BATCHES; i++) mean += estimate_batch(&odd.sums, i);
    assert_near(mean / ESTIMATE_BATCHES, b.mean, 1e-12);
}

TEST(what_is_known_shifts_and_widens) {
    Rare rare = rare_start(9);
    Estimate before, after;
    rare_read(&rare, MOST);
    before = after = estimate_of(&rare.sums);
    estimate_add_known(&after, 10, 0.5);
    assert_near(after.mean, before.mean + 10, 1e-12);
    assert_near(after.sigma, hypot(before.sigma, 0.5), 1e-12);
    assert_near(after.interval.low, before.interval.low + 9, 1e-12);
    assert_near(after.interval.high, before.interval.high + 11, 1e-12);
    assert_near(estimate_expected(&after, 1e12).sigma, 0.5, 1e-6);
}

/* However many paths there are, it is in the upper end, once; of what none met fewer and fewer
 * is left. */
TEST(no_number_of_paths_lessens_what_is_unseen) {
    static const double TIMES[] = {0.25, 1, 64, 1e12};
    Rare rare = rare_start(11);
    rare_read(&rare, MOST);
    rare.sums.unmet = 3;
    Estimate without = estimate_of(&rare.sums);
    rare.sums.unseen = 5;
    Estimate with = estimate_of(&rare.sums);
    assert_near(with.interval.high, without.interval.high + 5, 1e-12);
    assert_near(with.interval.low, without.interval.low, 1e-12);
    assert_near(with.mean, without.mean, 1e-12);
    for (int i = 0; i < 4; i++) {
        Estimate a = estimate_expected(&without, TIMES[i]);
        Estimate b = estimate_expected(&with, TIMES[i]);
        assert_near(b.interval.high, a.interval.high + 5, 1e-9);
        assert_near(b.unseen, 5, 1e-12);
        assert_near(b.unmet, 3 / TIMES[i], 1e-9);
        assert_true(b.interval.high >= b.mean + b.unseen);
    }
}

/* The same as one set of paths whose light is the sum, where the numbers are the same. */
TEST(two_kinds_of_paths_add_up) {
    Rare a = rare_start(5), b = rare_start(6);
    rare_read(&a, MOST / 2);
    rare_read(&b, MOST);
    Estimate one = estimate_of(&a.sums), other = estimate_of(&b.sums);
    estimate_sums_add(&a.sums, &b.sums);
    Estimate both = estimate_of(&a.sums);
    assert_near(both.mean, one.mean + other.mean, 1e-12);
    assert_true(both.interval.high < one.interval.high + other.interval.high);
    assert_true(both.interval.low > one.interval.low);
}

TEST_PROGRAM(NULL, NULL)
