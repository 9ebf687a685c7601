/* SPDX-License-Identifier: Apache-2.0 */
/* parhelion review: from REVIEW.json to verdicts, with tables and a page for a meeting. */
#include "cli/review/cmd_review.h"

#include <stdio.h>
#include <string.h>

#include "base/arena.h"
#include "base/count.h"
#include "base/error.h"
#include "base/file.h"
#include "base/machine.h"
#include "cli/options/answer.h"
#include "cli/options/cli.h"
#include "cli/options/outputs.h"
#include "cli/options/scene_options.h"
#include "cli/review/review_merge.h"
#include "cli/review/review_print.h"
#include "print/print.h"
#include "render/signals.h"
#include "review/engine/engine.h"
#include "review/folder/review_files.h"
#include "review/folder/review_folder.h"
#include "review/request/request_start.h"
#include "review/request/request_read.h"
#include "review/review_decide.h"
#include "review/run/run.h"
#include "review/vary/variants.h"
#include "scene/load/scene_load.h"
#include "text/nearest_word.h"
#include "text/text.h"

#define FILES_BYTES ((size_t)1 << 32) /* address space: what is not touched costs nothing */

typedef struct ReviewWords {
    const char *folder, *profile, *root, *isa, *diff, *init, *responses, *summary;
    bool is_strict, dry_run, is_self_contained, is_alone, is_without_frames;
    CliTexts only;
    StateWords state_words;
    SceneState state;
    Cli cli;
    const char *const *typed; /* all of them but review_own_word's */
    int typed_count;
    const ReviewMerge *merge; /* NULL: it is none */
} ReviewWords;

/* That the words go together. */
static bool check(ReviewWords *out, Error *err) {
    if (!state_options_read(&out->state_words, &out->state, err)) return false;
    if (out->init) return true;
    if (out->cli.argument_count > 1)
        return error_set(err, ERROR_USAGE, "%s: one request at a time is reviewed",
                         out->cli.arguments[1]);
    return out->folder || out->dry_run ||
           error_set(err, ERROR_USAGE, "-o DIR: nothing says where the review goes");
}

/* Of --dry-run. */
static const Column PLAN[] = {
    COLUMN_TEXT("eyes", "eyes"),
    COLUMN_TEXT("symbols", "symbols, a rectangle of text as one"),
    COLUMN_TEXT("gazes", "gazes elsewhere, in each moment"),
    COLUMN_TEXT("moments", "moments"),
    COLUMN_TEXT("sweeps", "sweeps"),
    {.key = "responses", .words = "responses", .about = "that the sweeps need"},
    COLUMN_TEXT("responses_reused", "of them there already"),
};
static const TableKind PLAN_KIND = TABLE_KIND("plan", NULL, PLAN);

static bool parse(int argc, char **argv, Arena *arena, ReviewWords *out, Error *err) {
    const Option options[] = {
        {"-o", OPTION_TEXT, "DIR", "where everything is written", &out->folder,
         .file = OPTION_OUTPUT},
        {"--init", OPTION_TEXT, "REVIEW.json", "writes a request to start from, for the scene",
         &out->init, .file = OPTION_OUTPUT},
        {"--dry-run", OPTION_FLAG, NULL, "checks all, says what would be traced, and stops",
         &out->dry_run},
        {"--profile", OPTION_TEXT, "NAME|FILE.json", "limits instead of the request's",
         &out->profile},
        {"--strict", OPTION_FLAG, NULL,
         "too close to call and any material without optical "
         "data fail, too",
         &out->is_strict},
        {"--self-contained", OPTION_FLAG, NULL,
         "pictures in the page itself, not in files beside it: to send it by mail",
         &out->is_self_contained},
        {"--no-variants", OPTION_FLAG, NULL, "the review by itself, whatever variants it has",
         &out->is_alone},
        {"--no-frames", OPTION_FLAG, NULL, "no pictures are rendered, whatever the request has",
         &out->is_without_frames},
        {"--summary", OPTION_TEXT, "SYMBOL",
         "one page of paper about this symbol, instead of one about each", &out->summary},
        {"--only", OPTION_TEXTS, "CONDITION",
         "reviews this condition of the request: merge makes one review of several such",
         &out->only},
        {"--diff", OPTION_TEXT, "DIR", "an earlier review to hold this one against", &out->diff},
        {"--responses", OPTION_TEXT, "DIR",
         "where responses are kept and found (default: responses in the review's folder)",
         &out->responses},
        STATE_OPTIONS(&out->state_words),
        {"--root", OPTION_TEXT, "DIR", ROOT_HELP, &out->root},
        {"--isa", OPTION_TEXT, "NAME", "sse2, avx2, avx512 (default: the processor's best)",
         &out->isa},
    };
    const CliCommand command = {"review",
                                command_review.summary,
                                "REVIEW.json -o DIR | --init REVIEW.json SCENE.gltf ...",
                                "parhelion review scenes/car_dashboard.review.json -o review",
                                options,
                                COUNT_OF(options),
                                1,
                                -1,
                                .answers = (const Answer[]){{"--dry-run", &PLAN_KIND}, {0}}};
    if (!cli_parse(&command, argc, argv, arena, &out->cli, err)) return false;
    if (out->cli.help_shown) return true;
    return check(out, err);
}

/* ---- what would be traced ---------------------------------------------------------------- */

static bool print_plan(const Cli *cli, const ReviewRequest *r, const ReviewPlan *plan, Error *err) {
    int moments = 0;
    for (int i = 0; i < r->condition_count; i++)
        moments += r->conditions[i].kind == CONDITION_MOMENT;
    return cli_print_answer(&PLAN_KIND,
                            json_pack("{s:i, s:i, s:i, s:i, s:i, s:i, s:i}", "eyes", r->eye_count,
                                      "symbols", r->symbol_count, "gazes", review_look_count(r),
                                      "moments", moments, "sweeps", r->condition_count - moments,
                                      "responses", plan->responses, "responses_reused",
                                      plan->responses_kept),
                            cli->json, err);
}

/* Points to the remains of a review that was stopped. */
static void print_unfinished(const ReviewFolder *folder, const Arena *arena) {
    if (review_has_unfinished(folder->target, *arena))
        print("%s/unfinished holds what is done of a review that was stopped: it goes on "
              "there\n",
              folder->target);
}

static bool plan(const ReviewWords *words, ReviewFolder *folder, ReviewRun *run, Arena *arena,
                 Error *err) {
    ReviewPlan found;
    if (folder->target || folder->responses) review_folder_responses(folder, arena);
    run->responses = folder->responses;
    run->responses_shown = "";
    if (!review_plan(run, arena, &found, err) || !review_variants_check(run, err)) return false;
    cli_print_warnings(run->problems);
    if (!print_plan(&words->cli, run->request, &found, err)) return false;
    if (folder->target && !words->cli.json) print_unfinished(folder, arena);
    return true;
}

/* ---- a request to start from ------------------------------------------------------------- */

static bool start(const ReviewWords *words, Arena *arena, Error *err) {
    SceneOptions options = {.paths = words->cli.arguments,
                            .path_count = words->cli.argument_count,
                            .root = words->root,
                            .state = words->state};
    ReviewStart asked = {options.paths, options.path_count, words->init, words->root, NULL, false};
    Problems problems = problems_start(arena);
    Scene *scene;
    if (!scene_load(&options, arena, &problems, &scene, err)) return false;
    cli_print_warnings(&problems);
    bool ok = outputs_spare(&words->cli.outputs, scene->inputs, scene->input_count, err) &&
              review_request_start(&asked, scene, arena, err);
    scene_close(scene);
    return ok;
}

/* ---- the command ------------------------------------------------------------------------- */

/* The line may be longer than an error's text. */
static Outcome report_stopped(const ReviewFolder *folder, Arena *arena) {
    const char *name = signals_name(signals_stop_requested());
    print_to(stderr,
             "parhelion: %s: stopped by %s; what is done is kept in %s — the same command goes "
             "on: %s\n",
             folder->target, name, folder->draft.unfinished, review_folder_command(folder, arena));
    return OUTCOME_STOPPED;
}

static Outcome tell_kept(const ReviewFolder *folder, Error *err) {
    const Error before = *err;
    if (err->code == ERROR_OUTPUT && review_has_unfinished(folder->target, *folder->draft.arena))
        error_at(err, before.code, before.file, before.path,
                 "%.900s — what is done is kept: the same command goes on", before.text);
    return OUTCOME_FAILED;
}

/* ---- all of it --------------------------------------------------------------------------- */

/* Who makes the review, and what it has said. */
typedef struct Teller {
    const ReviewWords *words;
    ReviewFolder *folder;
    const Progress *progress;
    Arena *arena;
    bool has_told;
} Teller;

static bool spare_files(void *user, const Scene *scene, Error *err) {
    const ReviewFolder *folder = ((Teller *)user)->folder;
    const Lines files = {.list = scene->inputs, .count = scene->input_count};
    Arena scratch = arena_reserve(FILES_BYTES);
    bool ok = review_files_spare(folder->target, folder->request, &files, scratch, err);
    arena_release(&scratch);
    return ok;
}

/* All that stands without pictures is whole in its place, and said, before they are begun. */
static bool tell_verdicts(void *user, ReviewOutcome *outcome, Error *err) {
    Teller *to = user;
    const Cli *cli = &to->words->cli;
    progress_clear(to->progress);
    if (!review_folder_write(to->folder, outcome, to->arena, err) ||
        (!cli->json && !review_print(cli, &outcome->review, *to->arena, err)))
        return false;
    to->has_told = !cli->json;
    fflush(stdout);
    if (!cli->quiet)
        print_to(stderr, "verdicts are there: %s/index.html; pictures follow\n",
                 to->folder->target);
    return true;
}

static bool make_all(Teller *teller, ReviewRun *run, ReviewOutcome *outcome, Error *err) {
    const ReviewWords *words = teller->words;
    ReviewFolder *folder = teller->folder;
    Arena *arena = teller->arena;
    run->news = (ReviewNews){spare_files, tell_verdicts, teller};
    bool ok = review_run(run, words->is_strict, arena, outcome, err);
    progress_clear(run->progress);
    cli_print_warnings(run->problems);
    if (words->merge && folder->has_own_responses)
        ok = ok &&
             review_merge_responses(words->merge, &outcome->review, folder->responses, *arena, err);
    return ok && review_folder_write(folder, outcome, arena, err);
}

static Outcome make(const ReviewWords *words, ReviewFolder *folder, ReviewRun *run, Arena *arena,
                    Error *err) {
    Teller teller = {words, folder, run->progress, arena, false};
    ReviewOutcome found;
    signals_watch();
    if ((!words->merge && !review_variants_check(run, err)) ||
        !review_folder_open(folder, arena, err))
        return OUTCOME_FAILED;
    run->folder = folder->name;
    run->unfinished = folder->draft.unfinished;
    run->responses = folder->responses;
    run->responses_shown = folder->responses_shown;
    if (!make_all(&teller, run, &found, err)) {
        Outcome outcome = err->code ? tell_kept(folder, err) : report_stopped(folder, arena);
        review_folder_close(folder);
        return outcome;
    }
    progress_end(run->progress, run->progress->total);
    review_folder_finish(folder);
    if (!teller.has_told && !review_print(&words->cli, &found.review, *arena, err))
        return OUTCOME_FAILED;
    return found.review.pass ? OUTCOME_DONE : OUTCOME_NO;
}

/* Symbols that are found in a content are "NAME 1", "NAME 2" ... */
static bool check_symbol(const ReviewRequest *request, const char *name, Arena scratch,
                         Error *err) {
    char advice[320];
    const char **names = ARENA_NEW(&scratch, const char *, request->symbol_count);
    for (int i = 0; i < request->symbol_count; i++) {
        const ReviewSymbol *symbol = &request->symbols[i];
        size_t length = strlen(symbol->name);
        names[i] = symbol->name;
        if (!strcmp(symbol->name, name) ||
            (symbol->find_text && !strncmp(symbol->name, name, length) && name[length] == ' '))
            return true;
    }
    return error_set(
        err, ERROR_USAGE, "--summary %.100s: is no symbol of %.200s: %s", name, request->file,
        nearest_word_advice(name, names, request->symbol_count, advice, sizeof advice));
}

/* *out: [condition]; NULL: all of them. */
static bool find_only(const ReviewRequest *request, const CliTexts *only, Arena *arena,
                      const bool **out, Error *err) {
    char advice[320];
    int count = request->condition_count;
    bool *is_wanted = ARENA_NEW(arena, bool, count);
    const char **names = ARENA_NEW(arena, const char *, count);
    *out = only->count ? is_wanted : NULL;
    for (int i = 0; i < count; i++) names[i] = request->conditions[i].name;
    for (int k = 0; k < only->count; k++) {
        const ReviewCondition *found = review_condition_named(request, only->list[k]);
        if (!found)
            return error_set(
                err, ERROR_USAGE, "--only %.100s: is no condition of %.200s: %s", only->list[k],
                request->file,
                nearest_word_advice(only->list[k], names, count, advice, sizeof advice));
        is_wanted[found - request->conditions] = true;
    }
    return true;
}

static Outcome review(const ReviewWords *words, Arena *arena, Error *err) {
    const char *file = words->cli.arguments[0];
    Problems problems = problems_start(arena);
    ReviewRequest request;
    const Profile *profile;
    const bool *only;
    ReviewFolder folder = {.target = words->folder,
                           .request = &request,
                           .diff = words->diff,
                           .profile = words->profile,
                           .root = words->root,
                           .state_text = state_options_text(&words->state, arena),
                           .responses = words->responses,
                           .threads = words->cli.threads,
                           .is_strict = words->is_strict,
                           .only = words->only.list,
                           .only_count = words->only.count,
                           .summary = words->summary,
                           .is_alone = words->is_alone,
                           .is_without_frames = words->is_without_frames,
                           .is_self_contained = words->is_self_contained};
    if (!review_request_read(file, words->root, arena, &problems, &request, err))
        return OUTCOME_FAILED;
    const Lines files = review_request_files(&request, arena);
    if (!profile_load(words->profile ? words->profile : request.profile, arena, &profile, err))
        return words->profile ? OUTCOME_FAILED : error_in_file(err, request.file);
    if (request.privacy.is_given)
        profile = profile_with_security(profile, request.privacy.security_min, arena);
    if (words->is_alone) {
        request.variant_count = 0;
        request.is_compared = false;
    }
    if (words->is_without_frames) request.frames.worst = 0;
    if (!find_only(&request, &words->only, arena, &only, err) ||
        (words->summary && !check_symbol(&request, words->summary, *arena, err)) ||
        !review_check(&request, *arena, err) ||
        (folder.target && (!review_files_check(folder.target, &request, *arena, err) ||
                           !review_files_spare(folder.target, &request, &files, *arena, err))))
        return OUTCOME_FAILED;
    Progress progress =
        progress_start(words->cli.progress, "review", "steps", review_steps(&request, only));
    ReviewRun run = {.request = &request,
                     .profile = profile,
                     .means = {.root = words->root,
                               .state = words->state,
                               .threads = words->cli.threads,
                               .isa = words->isa},
                     .only = only,
                     .state_text = folder.state_text,
                     .words = words->typed,
                     .word_count = words->typed_count,
                     .problems = &problems,
                     .progress = &progress};
    if (words->merge && !review_merge_check(words->merge, &run, arena, err)) return OUTCOME_FAILED;
    return words->dry_run ? outcome_of(plan(words, &folder, &run, arena, err))
                          : make(words, &folder, &run, arena, err);
}

static Outcome run_words(int argc, char **argv, const ReviewMerge *merge, Arena *arena,
                         Error *err) {
    ReviewWords words = {.merge = merge};
    if (!parse(argc, argv, arena, &words, err)) return OUTCOME_FAILED;
    if (words.cli.help_shown) return OUTCOME_DONE;
    words.typed = review_merge_words(argc, argv, arena, &words.typed_count);
    return words.init ? outcome_of(start(&words, arena, err)) : review(&words, arena, err);
}

Outcome cmd_review_merge(const Cli *cli, const char *output, Arena *arena, Error *err) {
    ReviewMerge merge;
    const char *own[] = {"review",
                         "-o",
                         output,
                         cli->quiet ? "--quiet" : "--progress=plain",
                         arena_format(arena, "--threads=%d", cli->threads),
                         "--json"};
    int own_count = COUNT_OF(own) - !cli->json, argc = 0;
    if (!review_merge_find(cli->arguments, cli->argument_count, arena, &merge, err))
        return OUTCOME_FAILED;
    char **argv = ARENA_NEW(arena, char *, own_count + merge.words.count + 1);
    for (int i = 0; i < own_count + merge.words.count; i++) {
        const char *word = i < own_count ? own[i] : merge.words.list[i - own_count];
        argv[argc++] = arena_string(arena, word, strlen(word));
    }
    return run_words(argc, argv, &merge, arena, err);
}

static Outcome run(int argc, char **argv, Arena *arena, Error *err) {
    return run_words(argc, argv, NULL, arena, err);
}

const Command command_review = {
    "review", "can displays be read, under every light? verdicts, causes, a page", run};
