#include "review/run.h"

#include <string.h>

#include "review/cases.h"
#include "review/output/review_decide.h"
#include "review/request/request_check.h"
#include "review/sweep.h"

/* The most address space that a stage takes; what is not touched costs nothing. */
#define STAGE_BYTES ((size_t)1 << 36)

static int most_cases(const ReviewRequest *request)
{
    return request->condition_count * request->eye_count * request->symbol_count *
           SYMBOLS_FOUND_MOST;
}

/* Names of symbols that were found live in the stage's memory. */
static void keep_names(ReviewCase *cases, int count, Arena *arena)
{
    for (int i = 0; i < count; i++)
        cases[i].symbol = arena_string(arena, cases[i].symbol, strlen(cases[i].symbol));
}

static bool run_moment(const ReviewRun *run, Stage *stage, Arena *scratch, Arena *arena,
                       ReviewOutcome *out, Error *err)
{
    const ReviewCondition *condition = stage->condition;
    Review   *review = &out->review;
    CaseTools tools = {.stage = stage, .profile = run->profile};
    StageSymbol *symbols;
    if (!stage_light(stage, condition->has_environment ? &condition->environment : NULL, scratch,
                     err) ||
        !stage_symbols(stage, scratch, &symbols, &tools.symbol_count, err))
        return false;
    tools.symbols = symbols;
    ReviewCase *cases = review->cases + review->case_count;
    if (!stage_cases(&tools, arena, cases, err)) return false;
    int count = tools.symbol_count * run->request->eye_count;
    keep_names(cases, count, arena);
    review->case_count += count;
    return true;
}

static bool run_condition(const ReviewRun *run, const ReviewCondition *condition, Arena *arena,
                          ReviewOutcome *out, Error *err)
{
    StageOptions options = {run->request, condition, run->root, run->threads, run->isa};
    Arena scratch = arena_reserve(STAGE_BYTES);
    Stage stage;
    bool  ok = stage_open(&options, &scratch, run->problems, &stage, err);
    if (ok) {
        ok = review_request_check(run->request, stage.scene, run->problems, err) &&
             (condition->kind == CONDITION_MOMENT
                  ? run_moment(run, &stage, &scratch, arena, out, err)
                  : run_sweep(run, &stage, &scratch, arena, out, err));
        stage_close(&stage);
    }
    arena_release(&scratch);
    return ok;
}

bool review_run(const ReviewRun *run, Arena *arena, ReviewOutcome *out, Error *err)
{
    const ReviewRequest *request = run->request;
    int      most = most_cases(request);
    Progress progress = progress_start(run->progress, "review", "conditions",
                                       request->condition_count);
    *out = (ReviewOutcome){.tables = ARENA_NEW(arena, SweepTable, most)};
    out->review = (Review){.title = request->title,
                           .profile = arena_format(arena, "%s, %s", run->profile->title,
                                                   run->profile->edition),
                           .cases = ARENA_NEW(arena, ReviewCase, most),
                           .sweeps = ARENA_NEW(arena, ReviewSweep, most),
                           .responses = ARENA_NEW(arena, ReviewResponse, most)};
    for (int i = 0; i < request->condition_count; i++) {
        if (!run_condition(run, &request->conditions[i], arena, out, err)) return false;
        progress_update(&progress, i + 1);
    }
    progress_end(&progress, request->condition_count);
    review_decide(&out->review);
    return true;
}
