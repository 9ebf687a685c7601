/* SPDX-License-Identifier: Apache-2.0 */
/* parhelion part: one part of a job that `render --slurm` or `review --slurm` shared out,
 * wherever the folder is.
 *
 * It may be run any number of times, also twice at once: the part's file appears whole or not
 * at all, and has the same bits from any writer. */
#include <errno.h>
#include <stdio.h>
#include <stdlib.h>

#include "base/count.h"
#include "base/file.h"
#include "cli/commands.h"
#include "cli/job_run.h"
#include "cli/options/answer.h"
#include "cli/options/cli.h"
#include "cli/render/cmd_render.h"
#include "job/job_manifest.h"
#include "job/job_state.h"
#include "print/print.h"
#include "text/json_text.h"

typedef struct PartRun {
    Cli         cli;
    Arena      *arena;
    SharedJob   job;
    int         index;
    const char *name;      /* "DIR: part 3", for messages */
    bool        was_there; /* nothing had to be done */
} PartRun;

static bool parse(int argc, char **argv, PartRun *work, Error *err)
{
    const CliCommand command = {
        "part", "do one part of a job that `render --slurm` or `review --slurm` made",
        "DIR INDEX",
        "parhelion part frame.exr.parts 3", NULL, 0, 2, 2};
    return cli_parse(&command, argc, argv, work->arena, &work->cli, err);
}

static bool read_index(PartRun *work, Error *err)
{
    const char *text = work->cli.arguments[1];
    char       *end;
    errno = 0;
    long index = strtol(text, &end, 10);
    if (end == text || *end || errno || index < 0 || index >= work->job.part_count)
        return error_set(err, ERROR_USAGE,
                         "part %.80s: required: a number from 0 to %d, as %.400s has %d parts",
                         text, work->job.part_count - 1, work->cli.arguments[0],
                         work->job.part_count);
    work->index = (int)index;
    work->name = arena_format(work->arena, "%s: part %d", work->cli.arguments[0], work->index);
    return true;
}

/* A damaged file is reported and made again. */
static bool is_done(const PartRun *work)
{
    Error why;
    char  line[2048];
    if (job_part_is_done(&work->job, work->index, true, *work->arena, &why)) return true;
    if (!why.text[0]) return false;
    error_line(&why, line, (int)sizeof line);
    print_to(stderr, "parhelion: warning: %s — it is done again\n", line);
    return false;
}

static Outcome render(PartRun *work, const Lines *folder, Error *err)
{
    const SharedJob *job = &work->job;
    const JobPart   *part = &job->parts[work->index];
    const FilmRect   crop = part->crop;
    Arena           *arena = work->arena;
    const char *checkpoint = job_take_checkpoint(job, folder, work->index, arena);
    const char *own[] = {
        "render", "--samples", arena_format(arena, "%u:%u", part->first_sample,
                                            part->end_sample),
        "--crop", arena_format(arena, "%d,%d,%d,%d", crop.x0, crop.y0, crop.x1, crop.y1),
        "-o", job_part_file(job, work->index, ".exr", arena), "--checkpoint", checkpoint,
        "--resume"};
    int   has_nothing = !file_exists(checkpoint); /* to go on from */
    JobWords words = job_words(job, &work->cli, own, COUNT_OF(own) - has_nothing, arena);
    const RenderTask task = {work->name, job->identity, job->isa,
                             job_part_command(job, work->index, arena)};
    return cmd_render_run(words.count, words.list, &task, arena, err);
}

static Outcome run_one(PartRun *work, Error *err)
{
    const SharedJob    *job = &work->job;
    Lines               folder;
    const JobReviewPart part = {work->index, work->name, &folder};
    if (!job_check_machine(job, work->name, err) || !job_enter(job, *work->arena, err) ||
        !job_folder_list(job, work->arena, &folder, err))
        return OUTCOME_FAILED;
    return job->kind == JOB_REVIEW ? job_review_part(job, &work->cli, &part, work->arena, err)
                                   : render(work, &folder, err);
}

/* Whatever the words of the manifest did instead: nothing is done without the part. */
static Outcome run_whole(PartRun *work, Error *err)
{
    Error   why;
    Outcome outcome = run_one(work, err);
    if (outcome != OUTCOME_DONE ||
        job_part_is_done(&work->job, work->index, false, *work->arena, &why))
        return outcome;
    return error_at(err, ERROR_INPUT, work->name, "", "is not done: the command of the job "
                    "ended well and made no such part");
}

/* Notes why a task failed. One that lost the race to another that did the same part did not
 * fail. */
static bool end_badly(PartRun *work, Error *err)
{
    Error ignored;
    char  line[2048];
    if (job_part_is_done(&work->job, work->index, false, *work->arena, &ignored)) {
        *err = (Error){0};
        return true;
    }
    cli_error_line(err, line, (int)sizeof line);
    job_part_note_failure(&work->job, work->index, error_exit_status(err->code), line,
                          *work->arena);
    return false;
}

static bool print_answer(const PartRun *work, Error *err)
{
    const char *file = job_part_file(&work->job, work->index, job_part_ending(&work->job),
                                     work->arena);
    if (work->cli.json)
        return cli_print_json(json_pack("{s:i, s:i, s:o, s:b}", "part", work->index, "parts",
                                        work->job.part_count, "output", json_text(file),
                                        "was_there", work->was_there),
                              err);
    print("%s of %d: %s\n", work->name, work->job.part_count,
          work->was_there ? "is there already" : "done");
    return true;
}

static Outcome do_part(PartRun *work, Error *err)
{
    if (!job_manifest_read(work->cli.arguments[0], work->arena, &work->job, err) ||
        !read_index(work, err))
        return OUTCOME_FAILED;
    work->was_there = is_done(work);
    if (!work->was_there) {
        job_part_forget_failure(&work->job, work->index, *work->arena);
        int     lock = job_part_begin(&work->job, work->index, *work->arena);
        Outcome outcome = run_whole(work, err);
        if (outcome == OUTCOME_FAILED) outcome = outcome_of(end_badly(work, err));
        job_part_end(&work->job, work->index, lock, *work->arena);
        if (outcome != OUTCOME_DONE) return outcome;
    }
    job_part_clean(&work->job, work->index, *work->arena);
    return outcome_of(print_answer(work, err));
}

static Outcome run_part(int argc, char **argv, Arena *arena, Error *err)
{
    PartRun work = {.arena = arena};
    if (!parse(argc, argv, &work, err)) return OUTCOME_FAILED;
    return work.cli.help_shown ? OUTCOME_DONE : do_part(&work, err);
}

const Command command_part = {
    "part", "do one part of a frame or review that is shared among machines", run_part};
