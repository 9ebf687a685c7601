/* SPDX-License-Identifier: Apache-2.0 */
/* Reading on until a verdict can be called: how long, how surely, and what is promised. */
#include "fixture.h"

#include "base/confidence.h"
#include "base/count.h"
#include "base/mathd.h"
#include "base/sampler.h"
#include "review/judge.h"
#include "review/light/read_on.h"
#include "review/light/setup.h"

#define PATHS 4096   /* of the first reading */
#define SPREAD 1.0   /* of a reading of PATHS: its standard error */
#define RUNS 4000

static double normal(uint32_t *random)
{
    double u[2];
    for (int i = 0; i < 2; i++) {
        *random = hash_u32(*random + 0x9e3779b9u);
        u[i] = ((double)*random + 0.5) * 0x1p-32;
    }
    return sqrt(-2 * log_d(u[0])) * cos_d(6.283185307179586 * u[1]);
}

/* ---- how many paths ---------------------------------------------------------------------- */

/* Rounds grow, and all of them together are the budget, to the path. */
TEST(the_whole_budget_is_spent)
{
    for (long budget = 3 * PATHS; budget < 100000000; budget = budget * 7 / 5 + 11) {
        long last = PATHS, left = budget - PATHS;
        for (long next; (next = read_on_paths(last, left)) > 0; last = next) {
            assert_true(next <= left && (next >= last || next == left));
            left -= next;
        }
        if (left) fail_msg("of %ld paths %ld are left", budget, left);
    }
}

/* A budget of READ_ON_BUDGET times some paths has a round of as many. */
TEST(what_is_needed_comes_within_its_budget)
{
    for (double needed = PATHS; needed < 1e9; needed *= 1.13) {
        long last = PATHS, left = (long)ceil(READ_ON_BUDGET * needed) - PATHS, most = PATHS;
        for (long next; (next = read_on_paths(last, left)) > 0; last = next) {
            left -= next;
            most = next > most ? next : most;
        }
        if ((double)most < needed) fail_msg("%g paths: the longest has %ld", needed, most);
    }
}

/* Student's quantiles for 31 degrees of freedom, by integrals of its density. */
TEST(rounds_have_wider_intervals)
{
    static const double QUANTILE[] = {2.039513446, 2.355568282, 2.651912689,
                                      2.933813566, 3.204873822, 3.467684916};
    for (int round = 0; round < COUNT_OF(QUANTILE); round++)
        assert_near(read_on_widening(round), QUANTILE[round] / QUANTILE[0], 2e-4);
}

/* ---- readings that are drawn ------------------------------------------------------------- */

typedef struct Drawn {
    double found, half;
    long   paths;
} Drawn;

static Drawn draw(double truth, long paths, double widening, uint32_t *random)
{
    double error = SPREAD * sqrt(PATHS / (double)paths);
    return (Drawn){truth + error * normal(random), NORMAL_QUANTILE * error * widening, paths};
}

static bool is_clear(const Drawn *drawn)
{
    return fabs(drawn->found) > drawn->half;
}

/* From a first reading on; the limit is 0. */
static Drawn read_on(double truth, Drawn drawn, long budget, uint32_t *random)
{
    long left = budget - drawn.paths;
    for (int round = 1; !is_clear(&drawn); round++) {
        long next = read_on_paths(drawn.paths, left);
        if (!next) break;
        drawn = draw(truth, next, read_on_widening(round), random);
        left -= next;
    }
    return drawn;
}

/* A verdict is wrong at most twice as often as one by a single reading, which is with 2.5 %
 * where the truth lies on the limit; as a rule far less. */
TEST(verdicts_are_wrong_as_seldom_as_they_may_be)
{
    uint32_t random = 5;
    for (double truth = 0; truth < 4; truth += 0.25) {
        int wrong = 0;
        for (int run = 0; run < RUNS; run++) {
            Drawn first = draw(truth, PATHS, 1, &random);
            Drawn last = read_on(truth, first, 64L * PATHS * 64, &random);
            wrong += is_clear(&last) && last.found < 0;
        }
        double most = 0.05 + 3 * sqrt(0.05 * 0.95 / RUNS);
        if ((double)wrong / RUNS > most) fail_msg("truth %g: %d of %d", truth, wrong, RUNS);
    }
}

static ReviewCase case_of(const Drawn *drawn, const LimitVerdict *limit)
{
    return (ReviewCase){.verdict = VERDICT_TOO_CLOSE, .limits = limit, .limit_count = 1,
                        .paths = drawn->paths};
}

static double paths_named(const Drawn *drawn, double fixed)
{
    LimitVerdict limit = {.found = 100 + drawn->found, .value = 100,
                          .low = 100 + drawn->found - drawn->half,
                          .high = 100 + drawn->found + drawn->half,
                          .verdict = VERDICT_TOO_CLOSE};
    ReviewCase c = case_of(drawn, &limit);
    judge_paths(&c, fixed);
    return c.paths_to_decide;
}

/* Truths lie anywhere about the limit; of those that a first reading cannot call, nine in ten
 * are called with what it names. */
TEST(what_is_named_decides_nine_times_in_ten)
{
    uint32_t random = 9;
    int      asked = 0, decided = 0;
    while (asked < RUNS) {
        random = hash_u32(random + 1);
        double truth = 20 * SPREAD * ((double)random * 0x1p-32 - 0.5);
        Drawn  first = draw(truth, PATHS, 1, &random);
        if (is_clear(&first)) continue;
        double named = READ_ON_BUDGET * paths_named(&first, 0);
        Drawn  last = read_on(truth, first, (long)named, &random);
        asked++;
        decided += is_clear(&last);
    }
    double share = (double)decided / asked, doubt = 3 * sqrt(0.1 * 0.9 / RUNS);
    if (share < 0.9 - doubt) fail_msg("%.3f are decided", share);
    if (share > 0.97) fail_msg("%.3f are decided: what is named is too much", share);
}

/* What no paths shorten: a figure nearer than that to its limit is never called. Beside the
 * same doubt of sampling it takes more of them. */
TEST(what_paths_do_not_shorten_is_not_promised)
{
    Drawn near = {0.3, 1, PATHS}, far = {0.95, 1, PATHS}, known = {0.95, 1 / 0.7, PATHS};
    assert_true(isinf(paths_named(&near, 0.5)));
    assert_true(isinf(paths_named(&near, 1)));
    assert_true(paths_named(&known, 0.3) > paths_named(&far, 0));
    assert_true(isfinite(paths_named(&known, 0.3)));
}

/* ---- beside an error that the panel states ----------------------------------------------- */

#define LIGHT_ERROR 0.5 /* cd m^-2, of a reading of PATHS */
#define ON_LIMIT 40.0   /* of 110 and 10 cd m^-2: 150 / 50, a contrast of 3 */

typedef struct Panelled {
    double truth, error; /* cd m^-2; what the panel states of its reflection, relative */
} Panelled;

static ReviewCase read_case(const Panelled *of, long paths, int round, uint32_t *random,
                            Arena scratch)
{
    const ProfileLimit limit = {.kind = LIMIT_CONTRAST_RATIO, .value = 3,
                                .ambients = {true, true, true, true}};
    const Profile profile = {.limits = &limit, .limit_count = 1};
    double     error = LIGHT_ERROR * sqrt(PATHS / (double)paths);
    double     light = of->truth + error * normal(random);
    double     half = NORMAL_QUANTILE * error * read_on_widening(round);
    ReviewCase c = {.ambient = AMBIENT_DAY, .visible_share = 1, .height_arcmin = 25,
                    .paths = paths, .panel = {.reflection_error = of->error},
                    .luminance_cd_m2 = {.foreground = 110, .background = 10,
                                        .reflected = light, .veil = NAN}};
    judge_contrasts(&c, (MeanInterval){light - half, light + half});
    judge_case(&c, &profile, &scratch);
    judge_paths(&c, 0);
    return c;
}

static bool is_promised(const ReviewCase *c)
{
    return isfinite(c->paths_to_decide);
}

/* With all that a case names: until it is called, or no paths would. */
static ReviewCase read_as_named(const Panelled *of, ReviewCase c, uint32_t *random,
                                Arena scratch)
{
    long left = (long)(READ_ON_BUDGET * c.paths_to_decide) - c.paths;
    for (int round = 1; is_promised(&c); round++) {
        long next = read_on_paths(c.paths, left);
        if (!next) break;
        c = read_case(of, next, round, random, scratch);
        left -= next;
    }
    return c;
}

typedef struct Told {
    int open, promised, settled, called, never, right; /* never: said of the first reading */
} Told;

static Told tell(double error, int runs, Arena scratch)
{
    Told     told = {0};
    uint32_t random = 77;
    double   within = INTERVAL_SIGMAS * error * ON_LIMIT;
    while (told.open < runs) {
        random = hash_u32(random + 1);
        double spread = 2 * (within + 6 * LIGHT_ERROR);
        Panelled   one = {ON_LIMIT + spread * ((double)random * 0x1p-32 - 0.5), error};
        ReviewCase c = read_case(&one, PATHS, 0, &random, scratch);
        if (c.verdict != VERDICT_TOO_CLOSE) continue;
        told.open++;
        told.promised += is_promised(&c);
        told.never += !is_promised(&c);
        told.right += !is_promised(&c) && fabs(one.truth - ON_LIMIT) < within;
        if (!is_promised(&c)) continue;
        c = read_as_named(&one, c, &random, scratch);
        told.settled += !is_promised(&c);
        told.called += c.verdict != VERDICT_TOO_CLOSE;
    }
    return told;
}

/* Errors from a fortieth of what sampling leaves in doubt to ten times as much. Of what is
 * promised nine in ten are settled, and half at least are called; what is said to be beyond all
 * paths lies within the panel's error more often than not. Without such an error nothing is,
 * and to be settled is to be called. */
ARENA_TEST(what_is_named_settles_nine_times_in_ten)
{
    static const double ERROR[] = {0, 0.0003, 0.001, 0.003, 0.01, 0.03, 0.1};
    for (int i = 0; i < COUNT_OF(ERROR); i++) {
        Told   told = tell(ERROR[i], RUNS, arena);
        double doubt = 3 * sqrt(0.1 * 0.9 / fmax(told.promised, 1));
        if (told.settled < (0.9 - doubt) * told.promised)
            fail_msg("error %g: %d of %d are settled", ERROR[i], told.settled, told.promised);
        if (told.called < 0.5 * told.promised - 1.5 * sqrt(told.promised))
            fail_msg("error %g: %d of %d are called", ERROR[i], told.called, told.promised);
        if (told.right < 0.5 * told.never - 1.5 * sqrt(told.never))
            fail_msg("error %g: %d of %d lie within it", ERROR[i], told.right, told.never);
        if (!(ERROR[i] > 0)) assert_int_equal(told.never, 0);
        if (!(ERROR[i] > 0)) assert_int_equal(told.called, told.settled);
        if (ERROR[i] > 0.05) assert_true(told.never > 0.9 * told.open);
    }
}

TEST_PROGRAM(make_arena, drop_arena)
