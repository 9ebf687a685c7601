/* SPDX-License-Identifier: Apache-2.0 */
#include "cli/review/review_job.h"

#include <dirent.h>
#include <stdint.h>
#include <stdio.h>
#include <string.h>

#include "base/count.h"
#include "base/file.h"
#include "base/file_write.h"
#include "cli/options/answer.h"
#include "cli/options/cli.h"
#include "job/job_isa.h"
#include "print/print.h"
#include "render/signals.h"
#include "review/run/run.h"

void review_take_answers(Journal *journal, const ReviewTask *task)
{
    for (int i = 0; i < task->found_count; i++)
        journal_take_over(journal, task->found[i]);
}

static bool copy(const char *from, const char *to, Arena scratch, Error *err)
{
    FileBytes bytes;
    return file_exists(to) || (file_read(from, SIZE_MAX, &scratch, &bytes, err) &&
                               file_write(to, bytes.data, bytes.size, err));
}

bool review_take_responses(const char *folder, const ReviewTask *task, Arena scratch,
                           Error *err)
{
    bool ok = true;
    DIR *names = opendir(task->responses);
    if (!names) return true; /* there are no sweeps */
    for (struct dirent *entry; ok && (entry = readdir(names));) {
        Arena room = scratch;
        if (strcmp(path_ending(entry->d_name), ".response") != 0) continue;
        ok = copy(arena_format(&room, "%s/%s", task->responses, entry->d_name),
                  arena_format(&room, "%s/%s", folder, entry->d_name), room, err);
    }
    closedir(names);
    return ok;
}

/* The mark alone distinguishes a part that is done from one that was stopped. */
static bool answer(ReviewRun *run, const ReviewTask *task, Arena *arena, Error *err)
{
    ReviewOutcome ignored;
    const char    done = 1;
    review_take_answers(run->means.journal, task);
    bool is_run = review_run_conditions(run, arena, &ignored, err);
    cli_print_warnings(run->problems);
    if (!is_run) return false;
    journal_add(run->means.journal, task->mark, &done, sizeof done);
    return journal_ok(run->means.journal, err);
}

static Outcome report_stopped(const ReviewTask *task)
{
    print_to(stderr, "parhelion: %s: stopped by %s; what is done is kept — go on with: %s\n",
             task->name, signals_name(signals_stop_requested()), task->resume_line);
    return OUTCOME_STOPPED;
}

Outcome review_part(ReviewRun *run, const ReviewTask *task, const char *responses,
                    Arena *arena, Error *err)
{
    signals_watch();
    run->share = task->share;
    run->responses = responses ? responses : task->responses;
    run->responses_shown = "";
    run->means.guides = task->responses;
    if (!folder_make(run->responses, err) || !folder_make(run->means.guides, err) ||
        !journal_open(task->answers, arena, run->problems, &run->means.journal, err))
        return OUTCOME_FAILED;
    bool ok = answer(run, task, arena, err);
    if (ok) progress_end(run->progress, run->progress->total);
    journal_close(run->means.journal);
    return ok || err->code ? outcome_of(ok) : report_stopped(task);
}

bool review_share_check(const ShareRequest *share, const char *not_traced, Error *err)
{
    if (share->parts)
        return !not_traced || error_set(err, ERROR_USAGE, "%s does not go with --slurm",
                                        not_traced);
    return !(share->submits || share->dir) ||
           error_set(err, ERROR_USAGE, "%s says how a review is shared — add --slurm N, the "
                                       "number of parts",
                     share->submits ? "--submit" : "--job");
}

/* How many words, this one first, a part has of its own. */
static int own_words(const char *word)
{
    static const struct {
        const char *name;
        bool        has_value;
    } own[] = {{"-o", true}, {"--slurm", true}, {"--job", true}, {"--submit", false},
               {"--threads", true}, {"--progress", true}, {"--json", false},
               {"--quiet", false}};
    for (int i = 0; i < COUNT_OF(own); i++)
        if (cli_is_option(word, own[i].name)) return cli_option_words(word, own[i].has_value);
    return 0;
}

const char **review_part_words(int argc, char **argv, Arena *arena, int *count)
{
    const char **words = ARENA_NEW(arena, const char *, argc);
    bool         has_options = true;
    *count = 0;
    for (int i = 1; i < argc; i++) {
        int skipped = has_options ? own_words(argv[i]) : 0;
        if (!strcmp(argv[i], "--")) has_options = false;
        if (skipped) i += skipped - 1;
        else words[(*count)++] = argv[i];
    }
    return words;
}

void review_share_set(ShareRequest *share, int argc, char **argv, const char *output,
                      const Cli *cli, Arena *arena)
{
    if (!share->dir) share->dir = arena_format(arena, "%s.parts", output);
    share->split_name = "questions";
    share->threads = cli->threads_given ? cli->threads : 0;
    share->words = review_part_words(argc, argv, arena, &share->word_count);
}

bool review_share(const ShareRequest *share, ReviewFolder *folder, ReviewRun *run, bool json,
                  Arena *arena, Error *err)
{
    ReviewPlan found;
    json_t    *answer = NULL;
    review_folder_responses(folder, arena);
    run->responses = folder->responses;
    run->responses_shown = "";
    bool ok = job_isa_choose(run->means.isa, share->dir, arena, &run->means.isa, err) &&
              review_plan(run, arena, &found, err);
    cli_print_warnings(run->problems);
    if (!ok) return false;
    SharedJob job = {.kind = JOB_REVIEW, .line = review_folder_command(folder, arena),
                     .output = folder->target, .identity = found.identity,
                     .isa = run->means.isa};
    return job_share(share, &job, arena, json ? &answer : NULL, err) &&
           (!answer || cli_print_json(answer, err));
}
