/* SPDX-License-Identifier: Apache-2.0 */
#include "cli/job_review.h"

#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "base/count.h"
#include "cli/job/job_scripts.h"
#include "cli/job_words.h"
#include "cli/review/cmd_review.h"

/* The mark comes last, and then the file gets its name. */
bool job_review_part(const SharedJob *job, const Cli *cli, const JobReviewPart *part,
                     Arena *arena, Error *err)
{
    const char *own[] = {"review", "-o", job->output};
    const JobFolder *folder = part->folder;
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
        if (job_is_checkpoint(folder->names[i], part->index))
            task.found[task.found_count++] = job_file(job, folder->names[i], arena);
    if (!cmd_review_run(words.count, words.list, &task, arena, err)) return false;
    return rename(answers, done) == 0 ||
           error_at(err, ERROR_OUTPUT, done, "", "cannot be written: %s", strerror(errno));
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

bool job_review_merge(const SharedJob *job, const Cli *cli, const char *output, Arena *arena,
                      Error *err)
{
    if (!output) output = job->output;
    else if (!find_output(output, arena, &output, err)) return false;
    const char *own[] = {"review", "-o", output, "--json"};
    JobWords       words = job_words(job, cli, own, COUNT_OF(own) - !cli->json, arena);
    ReviewTask  task = {.name = job->dir, .identity = job->identity, .isa = job->isa,
                        .found = ARENA_NEW(arena, const char *, job->part_count),
                        .found_count = job->part_count,
                        .responses = job_file(job, JOB_RESPONSES, arena),
                        .resume_line = job_merge_command(job, arena)};
    for (int i = 0; i < job->part_count; i++)
        task.found[i] = job_part_file(job, i, job_part_ending(job), arena);
    return job_enter(job, err) &&
           cmd_review_run(words.count, words.list, &task, arena, err);
}
