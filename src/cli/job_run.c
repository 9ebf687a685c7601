/* SPDX-License-Identifier: Apache-2.0 */
#include "cli/job_run.h"

#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "base/count.h"
#include "cli/render/command_line.h"
#include "cli/review/cmd_review.h"
#include "cli/review/review_job.h"
#include "job/job_manifest.h"
#include "job/job_scripts.h"
#include "render/identity.h"

static const char *progress_word(const Cli *cli, Arena *arena)
{
    static const char *const names[] = {
        [PROGRESS_AUTO] = "auto", [PROGRESS_BAR] = "bar", [PROGRESS_PLAIN] = "plain",
        [PROGRESS_JSON] = "json", [PROGRESS_NONE] = "none"};
    return cli->quiet ? "--quiet" : arena_format(arena, "--progress=%s", names[cli->progress]);
}

static void add(JobWords *words, const char *text, Arena *arena)
{
    words->list[words->count++] = arena_string(arena, text, strlen(text));
}

JobWords job_words(const SharedJob *job, const Cli *cli, const char *const *own, int own_count,
                   Arena *arena)
{
    JobWords words = {ARENA_NEW(arena, char *, own_count + job->word_count + 3), 0};
    for (int i = 0; i < own_count; i++) add(&words, own[i], arena);
    add(&words, arena_format(arena, "--threads=%d", cli->threads), arena);
    add(&words, progress_word(cli, arena), arena);
    for (int i = 0; i < job->word_count; i++) add(&words, job->words[i], arena);
    return words;
}

/* Options that do something else than the job: those that control a run do not come so far. */
static bool is_elsewhere(const SharedJob *job, const char *word)
{
    static const char *const names[JOB_KINDS][3] = {[JOB_FRAME] = {"--replay"},
                                                    [JOB_REVIEW] = {"--init", "--dry-run",
                                                                    "--watch"}};
    bool found = cli_is_help(word) || cli_is_version(word);
    for (int i = 0; i < 3 && names[job->kind][i]; i++)
        found = found || cli_is_option(word, names[job->kind][i]);
    return found;
}

/* What `--slurm` would keep of them is all of them. */
bool job_check_words(const SharedJob *job, Arena scratch, Error *err)
{
    int    count = 1, kept_count, i = 0;
    char **argv = ARENA_NEW(&scratch, char *, job->word_count + 1);
    for (int k = 0; k < job->word_count; k++)
        argv[count++] = arena_string(&scratch, job->words[k], strlen(job->words[k]));
    const char **kept = (job->kind == JOB_REVIEW ? review_part_words : command_line_part_words)(
        count, argv, &scratch, &kept_count);
    while (i < kept_count && kept[i] == argv[i + 1] &&
           (!strcmp(kept[i], "--") || !is_elsewhere(job, kept[i])))
        i = strcmp(kept[i], "--") ? i + 1 : job->word_count;
    if (i >= job->word_count) return true;
    return error_at(err, ERROR_INPUT, job_file(job, JOB_MANIFEST, &scratch),
                    arena_format(&scratch, "/words/%d", i),
                    "is '%.200s', required: words that `--slurm` lets through", job->words[i]);
}

bool job_enter(const SharedJob *job, Arena scratch, Error *err)
{
    if (!job_check_words(job, scratch, err)) return false;
    return chdir(job->folder) == 0 ||
           error_at(err, ERROR_INPUT, job->folder, "",
                    "cannot be entered: %s — the job was planned there", strerror(errno));
}

/* Slurm's task goes to another node then (job_scripts.c). */
bool job_check_machine(const SharedJob *job, const char *name, Error *err)
{
    const Kernel *kernel;
    Error         why;
    char          host[64] = "";
    gethostname(host, sizeof host - 1);
    return kernel_choose(job->isa, &kernel, &why) ||
           error_at(err, ERROR_MACHINE, name, "",
                    "was planned for %.20s, and %s cannot: %.200s — take another machine, or "
                    "plan the job with the --isa that all have, in another folder",
                    job->isa, host, why.text);
}

/* The mark comes last, and then the file gets its name. */
Outcome job_review_part(const SharedJob *job, const Cli *cli, const JobReviewPart *part,
                        Arena *arena, Error *err)
{
    const char *own[] = {"review", "-o", job->output};
    const Lines *folder = part->folder;
    JobWords       words = job_words(job, cli, own, COUNT_OF(own), arena);
    const char *answers = job_own_checkpoint(job, part->index, arena);
    const char *done = job_part_file(job, part->index, job_part_ending(job), arena);
    ReviewTask  task = {.name = part->name, .identity = job->identity, .isa = job->isa,
                        .share = {part->index, job->part_count}, .answers = answers,
                        .mark = job_part_mark(job, part->index, *arena),
                        .found = ARENA_NEW(arena, const char *, folder->count),
                        .responses = job_file(job, JOB_RESPONSES, arena),
                        .resume_line = job_part_command(job, part->index, arena)};
    for (int i = 0; i < folder->count; i++)
        if (job_is_checkpoint(folder->list[i], part->index))
            task.found[task.found_count++] = job_file(job, folder->list[i], arena);
    Outcome outcome = cmd_review_run(words.count, words.list, &task, arena, err);
    if (outcome != OUTCOME_DONE || rename(answers, done) == 0) return outcome;
    return error_at(err, ERROR_OUTPUT, done, "", "cannot be written: %s", strerror(errno));
}

/* As seen from where the user is, who then goes elsewhere. */
static bool find_output(const char *typed, Arena *arena, const char **out, Error *err)
{
    char *here = typed[0] == '/' ? NULL : getcwd(NULL, 0);
    *out = typed;
    if (typed[0] == '/') return true;
    if (!here)
        return error_set(err, ERROR_INPUT, "the working folder cannot be found: %s",
                         strerror(errno));
    *out = arena_format(arena, "%s/%s", here, typed);
    free(here);
    return true;
}

Outcome job_review_merge(const SharedJob *job, const Cli *cli, const char *output,
                         Arena *arena, Error *err)
{
    if (!output) output = job->output;
    else if (!find_output(output, arena, &output, err)) return OUTCOME_FAILED;
    const char *own[] = {"review", "-o", output, "--json"};
    JobWords       words = job_words(job, cli, own, COUNT_OF(own) - !cli->json, arena);
    ReviewTask  task = {.name = job->dir, .identity = job->identity, .isa = job->isa,
                        .found = ARENA_NEW(arena, const char *, job->part_count),
                        .found_count = job->part_count,
                        .responses = job_file(job, JOB_RESPONSES, arena),
                        .resume_line = job_merge_command(job, arena)};
    for (int i = 0; i < job->part_count; i++)
        task.found[i] = job_part_file(job, i, job_part_ending(job), arena);
    if (!job_check_machine(job, job->dir, err) || !job_enter(job, *arena, err))
        return OUTCOME_FAILED;
    return cmd_review_run(words.count, words.list, &task, arena, err);
}
