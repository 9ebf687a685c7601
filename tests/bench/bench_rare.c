/* SPDX-License-Identifier: Apache-2.0 */
/* bench_rare TRIALS REFLECTED REVIEW.json [MARGIN ...] -- what a review says of light that few
 * paths find: the first symbol as the first eye sees it at the first moment, TRIALS seeds, held
 * against limits that leave its true contrast a margin of so many percent. rare.py makes the
 * reviews and the tables.
 *
 * REFLECTED is the true light, cd m^-2, of which, with what is shown, the true contrast is
 * made. No margin: readings as the review's precision requires, held against nothing.
 *
 * Printed, with tabs: first what is shown, foreground and background, and the judged part; then
 * a line a trial: margin (nan: none), seed, verdict (verdict.h's number), reflected, low, high,
 * paths, seconds. */
#include <math.h>
#include <string.h>
#include <time.h>

#include "coverage_trials.h"
#include "review/request/request_read.h"
#include "review/run/cases.h"

typedef struct RareTrials {
    ReviewRequest *request; /* whose seed is the trial's */
    const Setup *setup;
    const SetupSymbol *symbol;
    int count;
    double reflected;
    Arena scratch;
} RareTrials;

static double now_s(void) {
    struct timespec t;
    clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &t);
    return (double)t.tv_sec + 1e-9 * (double)t.tv_nsec;
}

static ReviewCase judged(const RareTrials *t, const Profile *profile, unsigned seed) {
    Arena room = t->scratch;
    CaseTools tools = {.setup = t->setup, .profile = profile};
    ReviewCase c = {.display_lux = 1000};
    Error err = {0};
    t->request->seed = seed;
    if (!setup_verdict(&tools, t->symbol, &t->request->eyes[0], &room, &c, &err)) trials_stop(&err);
    return c;
}

/* Prints what is shown; returns the true contrast. */
static double tell_shown(const RareTrials *t) {
    Profile open = {.id = "none"};
    ReviewCase c = judged(t, &open, 1u << 30);
    CaseBox part = c.whole.part;
    CaseLuminances l = c.luminance_cd_m2;
    printf("shown\t%.9g\t%.9g\t%.9g\t%.9g\t%.9g\t%.9g\n", l.foreground, l.background, part.left,
           part.top, part.right, part.bottom);
    fflush(stdout);
    return luminance_contrast(l.foreground, l.background, t->reflected);
}

static void try_profile(const RareTrials *t, const Profile *profile, double margin,
                        unsigned first) {
    for (int i = 0; i < t->count; i++) {
        double start = now_s();
        ReviewCase c = judged(t, profile, first + (unsigned)i);
        printf("trial\t%g\t%u\t%d\t%.9g\t%.9g\t%.9g\t%ld\t%.6f\n", margin, first + (unsigned)i,
               (int)c.verdict, c.luminance_cd_m2.reflected, c.reflected_range.low,
               c.reflected_range.high, c.paths, now_s() - start);
        fflush(stdout);
    }
}

static void try_margin(const RareTrials *t, double ratio, double percent, unsigned first) {
    ProfileLimit limit = {.name = "limit",
                          .kind = LIMIT_CONTRAST_RATIO,
                          .ambients = {true, true, true, true},
                          .value = ratio / (1 + percent / 100)};
    Profile profile = {.id = "one", .limits = &limit, .limit_count = 1};
    try_profile(t, &profile, percent, first);
}

static void try_moment(RareTrials *t, int margins, char **margin) {
    const ReviewCondition *c = &t->request->conditions[0];
    SetupOptions options = {
        .request = t->request, .condition = c, .means = {.root = "/", .threads = 1}};
    Arena arena = arena_reserve((size_t)1 << 36);
    Problems problems = problems_start(&arena);
    Profile open = {.id = "none"};
    Setup setup;
    SetupSymbol *symbols;
    int count;
    Error err = {0};
    if (!setup_open(&options, &arena, &problems, &setup, &err) ||
        !setup_light(&setup, NULL, &arena, &err) ||
        !setup_symbols(&setup, &arena, &symbols, &count, &err) ||
        !setup_learn(&setup, symbols, count, &arena, &err))
        trials_stop(&err);
    t->setup = &setup;
    t->symbol = &symbols[0];
    double ratio = tell_shown(t);
    if (!margins) try_profile(t, &open, NAN, 1u << 28);
    for (int i = 0; i < margins; i++)
        try_margin(t, ratio, atof(margin[i]), (unsigned)(i + 1) << 20);
    setup_close(&setup);
    arena_release(&arena);
}

int main(int argc, char **argv) {
    Arena arena = arena_reserve((size_t)1 << 30);
    Error err = {0};
    Problems problems = problems_start(&arena);
    ReviewRequest request;
    RareTrials trials = {.request = &request,
                         .count = argc >= 4 ? atoi(argv[1]) : 0,
                         .scratch = arena_reserve((size_t)1 << 33)};
    if (trials.count < 1) {
        fprintf(stderr, "bench_rare TRIALS REFLECTED REVIEW.json [MARGIN ...]\n");
        return 1;
    }
    trials.reflected = atof(argv[2]);
    if (!review_request_read(argv[3], "/", &arena, &problems, &request, &err)) trials_stop(&err);
    try_moment(&trials, argc - 4, argv + 4);
    arena_release(&trials.scratch);
    arena_release(&arena);
    return 0;
}
