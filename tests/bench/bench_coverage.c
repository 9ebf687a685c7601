/* SPDX-License-Identifier: Apache-2.0 */
/* bench_coverage RUNS REVIEW.json ... -- how often intervals of readings hold the converged
 * value: of each moment's first symbol as the first eye sees it, RUNS readings of other seeds
 * with so many paths each, and as many that end when a limit is clear. The converged value is
 * the mean of all paths of the longest fixed readings.
 *
 * Limits stand at 1, 1.25 and 2 times the converged value: too close, near, far. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>

#include "review/request/request_read.h"
#include "review/run/cases.h"

#define SHORT_PATHS 1024
#define LONG_PATHS 4096
#define NEVER 1e-9     /* a precision that no reading reaches */
#define TOLERANCE 0.1  /* coarse, so that a run takes few paths */
#define CLEAR 0.2

typedef struct Probing {
    const Stage *stage;
    ProbeAim     aim;
    int          runs;
    Arena        scratch;
} Probing;

static _Noreturn void stop(const Error *err)
{
    fprintf(stderr, "%s: %s\n", err->path, err->text);
    exit(2);
}

static bool is_clear_of(void *user, MeanInterval reflected, Arena scratch)
{
    (void)scratch;
    const double *limit = user;
    return reflected.low > *limit || reflected.high < *limit;
}

static void print_coverage(const Probing *p, const char *what, const Reading *list,
                           double truth)
{
    double paths = 0, squares = 0, sigmas = 0;
    int    held = 0, above = 0;
    for (int i = 0; i < p->runs; i++) {
        const MeanInterval *in = &list[i].interval;
        held += in->low <= truth && truth <= in->high;
        above += truth > in->high;
        paths += (double)list[i].paths / p->runs;
        squares += (list[i].reflected - truth) * (list[i].reflected - truth);
        sigmas += list[i].sigma * list[i].sigma;
    }
    printf("%-28s %-16s %8.0f paths  %5.1f %% held, %4.1f %% lie below; error %5.2f %%, stated "
           "%5.2f %%\n", p->stage->condition->name, what, paths, 100.0 * held / p->runs,
           100.0 * above / p->runs, 100 * sqrt(squares / p->runs) / truth,
           100 * sqrt(sigmas / p->runs) / truth);
    fflush(stdout);
}

/* seed: of the first run. */
static Reading *readings(const Probing *p, const ReadingGoal *goal, uint32_t seed, Arena *arena)
{
    Reading *list = ARENA_NEW(arena, Reading, p->runs);
    ProbeAim aim = p->aim;
    for (int i = 0; i < p->runs; i++) {
        aim.seed = seed + (uint32_t)i;
        list[i] = reading_take(&aim, goal, &p->stage->tools, p->scratch);
    }
    return list;
}

static void measure(const Probing *p, Arena arena)
{
    ReadingGoal goal = {.precision = NEVER, .most = LONG_PATHS};
    Reading    *list = readings(p, &goal, 1, &arena);
    double      truth = 0;
    for (int i = 0; i < p->runs; i++) truth += list[i].reflected / p->runs;
    print_coverage(p, "fixed", list, truth);
    goal.most = SHORT_PATHS;
    print_coverage(p, "fixed", readings(p, &goal, 1u << 20, &arena), truth);
    static const double limits[] = {1, 1.25, 2};
    for (int k = 0; k < 3; k++) {
        char            what[32];
        double          limit = limits[k] * truth;
        ReadingQuestion question = {is_clear_of, &limit, CLEAR, "limit"};
        goal = (ReadingGoal){.precision = TOLERANCE, .most = 1 << 18, .question = &question};
        snprintf(what, sizeof what, "limit at %g", limits[k]);
        list = readings(p, &goal, (uint32_t)(k + 2) << 20, &arena);
        print_coverage(p, what, list, truth);
        int wrong = 0;
        for (int i = 0; i < p->runs; i++) {
            const MeanInterval *in = &list[i].interval;
            wrong += limits[k] > 1 ? in->low > limit : is_clear_of(&limit, *in, p->scratch);
        }
        printf("%-28s %-16s %.1f %% wrong verdicts\n", p->stage->condition->name, what,
               100.0 * wrong / p->runs);
    }
}

static void measure_moment(const ReviewRequest *request, const ReviewCondition *c, int runs,
                           Problems *problems)
{
    StageOptions options = {.request = request, .condition = c, .threads = 1};
    Arena        arena = arena_reserve((size_t)1 << 34);
    Stage        stage;
    StageSymbol *symbols;
    int          count;
    Vec3         eye;
    Error        err = {0};
    if (!stage_open(&options, &arena, problems, &stage, &err) ||
        !stage_light(&stage, c->has_environment ? &c->environment : NULL, &arena, &err) ||
        !stage_symbols(&stage, &arena, &symbols, &count, &err) ||
        !stage_learn(&stage, symbols, count, &arena, &err) ||
        !stage_eye_middle(&stage, &request->eyes[0], arena, &eye, &err))
        stop(&err);
    const SymbolSurface *surface = &symbols[0].surface;
    bool *is_visible = ARENA_NEW(&arena, bool, surface->point_count);
    Probing p = {&stage, {.context = &stage.context, .eye = eye}, runs,
                 arena_reserve((size_t)1 << 28)};
    symbol_visibility(surface, &stage.context, eye, is_visible);
    symbol_aim(surface, is_visible, &arena, &p.aim);
    if (p.aim.target_count) measure(&p, arena);
    arena_release(&p.scratch);
    stage_close(&stage);
    arena_release(&arena);
}

int main(int argc, char **argv)
{
    Arena arena = arena_reserve((size_t)1 << 30);
    Error err = {0};
    int   runs = argc > 2 ? atoi(argv[1]) : 0;
    if (runs < 2) {
        fprintf(stderr, "bench_coverage RUNS REVIEW.json ...\n");
        return 1;
    }
    for (int a = 2; a < argc; a++) {
        ReviewRequest request;
        Problems      problems = problems_start(&arena);
        if (!review_request_read(argv[a], NULL, &arena, &problems, &request, &err)) stop(&err);
        for (int i = 0; i < request.condition_count; i++)
            if (request.conditions[i].kind == CONDITION_MOMENT)
                measure_moment(&request, &request.conditions[i], runs, &problems);
    }
    arena_release(&arena);
    return 0;
}
