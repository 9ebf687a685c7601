/* SPDX-License-Identifier: Apache-2.0 */
/* parhelion status: how far a job is that `--slurm` shared out, and what is left. */

#include "base/file.h"
#include "cli/commands.h"
#include "cli/options/answer.h"
#include "cli/options/cli.h"
#include "job/job_manifest.h"
#include "job/job_state.h"
#include "print/print.h"
#include "text/json_text.h"

#define STATE_COUNT (JOB_PART_DONE + 1)

static const char *const state_names[STATE_COUNT] = {
    [JOB_PART_MISSING] = "missing", [JOB_PART_QUEUED] = "queued", [JOB_PART_BEGUN] = "begun",
    [JOB_PART_RUNNING] = "running", [JOB_PART_FAILED] = "failed", [JOB_PART_DONE] = "done"};

typedef struct StatusRun {
    Cli            cli;
    Arena         *arena;
    SharedJob      job;
    JobQueue       queue;
    JobPartReport *reports;
    int            counts[STATE_COUNT];
    const char    *output; /* the frame's file, or the review's */
} StatusRun;

static bool parse(int argc, char **argv, StatusRun *work, Error *err)
{
    const CliCommand command = {
        "status", "which parts of a job are done, and how to do the others", "DIR",
        "parhelion status frame.exr.parts", NULL, 0, 1, 1};
    return cli_parse(&command, argc, argv, work->arena, &work->cli, err);
}

static bool look(StatusRun *work, Error *err)
{
    Lines folder;
    if (!job_manifest_read(work->cli.arguments[0], work->arena, &work->job, err) ||
        !job_folder_list(&work->job, work->arena, &folder, err))
        return false;
    work->queue = job_queue_read(&work->job, work->arena);
    work->reports = ARENA_NEW(work->arena, JobPartReport, work->job.part_count);
    for (int i = 0; i < work->job.part_count; i++) {
        work->reports[i] = job_part_report(&work->job, &folder, &work->queue, i,
                                           work->arena);
        work->counts[work->reports[i].state]++;
    }
    work->output = job_output_file(&work->job, work->arena);
    if (work->job.kind == JOB_REVIEW)
        work->output = arena_format(work->arena, "%s/review.json", work->output);
    return true;
}

static bool is_all_done(const StatusRun *work)
{
    return work->counts[JOB_PART_DONE] == work->job.part_count;
}

/* ---- as a document ----------------------------------------------------------------------- */

static json_t *part_json(const StatusRun *work, int index)
{
    const JobPartReport *report = &work->reports[index];
    bool    is_frame = work->job.kind == JOB_FRAME;
    json_t *item = json_pack(
        "{s:i, s:s, s:I, s:o, s:o, s:o, s:o}", "index", index, "state",
        state_names[report->state], is_frame ? "samples_kept" : "answers_kept",
        (json_int_t)report->kept, "status",
        report->reason ? json_integer(report->status) : json_null(), "error",
        json_text_or_null(report->reason), "worker", json_text_or_null(report->worker),
        "command", json_text(job_part_command(&work->job, index, work->arena)));
    if (is_frame) job_manifest_add_part(item, &work->job.parts[index]);
    return item;
}

/* A number of Slurm's, or null. */
static json_t *latest(const Lines *numbers)
{
    return numbers->count ? json_text(numbers->list[numbers->count - 1]) : json_null();
}

static bool print_json(const StatusRun *work, Error *err)
{
    json_t *parts = json_array();
    for (int i = 0; i < work->job.part_count; i++)
        json_array_append_new(parts, part_json(work, i));
    json_t *answer = json_pack("{s:o, s:s, s:o, s:b, s:i, s:b, s:o, s:o, s:o, s:o, s:o}", "job",
                               json_text(work->job.dir), "kind",
                               job_kind_names[work->job.kind], "output",
                               json_text(work->output),
                               "output_is_there", file_exists(work->output), "parts",
                               work->job.part_count, "complete", is_all_done(work), "merge",
                               json_text(job_merge_command(&work->job, work->arena)), "list",
                               parts, "array_job", latest(&work->queue.arrays), "merge_job",
                               latest(&work->queue.merges), "queue_error",
                               json_text_or_null(work->queue.silence));
    for (int i = 0; i < STATE_COUNT; i++)
        json_object_set_new(answer, state_names[i], json_integer(work->counts[i]));
    return cli_print_json(answer, err);
}

/* ---- as lines ---------------------------------------------------------------------------- */

static void print_kept(const StatusRun *work, int index)
{
    uint32_t kept = work->reports[index].kept;
    if (work->job.kind == JOB_REVIEW) {
        print(", %u answer%s kept", kept, kept == 1 ? " is" : "s are");
        return;
    }
    const JobPart *part = &work->job.parts[index];
    uint32_t       all = part->end_sample - part->first_sample;
    print(", %u of %u samples a pixel are kept", kept, all);
}

static void print_part(const StatusRun *work, int index)
{
    const JobPartReport *report = &work->reports[index];
    if (report->state == JOB_PART_DONE) return;
    print("part %d: %s", index, state_names[report->state]);
    if (report->worker) print(" (%s)", report->worker);
    if (report->kept) print_kept(work, index);
    if (report->reason) print(", status %d: %s", report->status, report->reason);
    print("\n    %s\n", job_part_command(&work->job, index, work->arena));
}

static void print_slurm(const JobQueue *queue)
{
    static const char *const states[] = {[JOB_NOT_QUEUED] = "not in its queue",
                                         [JOB_WAITS] = "queued", [JOB_RUNS] = "running"};
    if (!queue->arrays.count) return;
    print("Slurm's job");
    for (int i = 0; i < queue->arrays.count; i++)
        print("%s %s", i ? "," : "", queue->arrays.list[i]);
    if (queue->merges.count)
        print("; merged by %s, %s", queue->merges.list[queue->merges.count - 1],
              queue->silence ? "unknown" : states[queue->merge]);
    print("\n");
    if (queue->silence) print("its queue is not known: %s\n", queue->silence);
}

static void print_lines(const StatusRun *work)
{
    int count = work->job.part_count;
    print("%s: %d of %d part%s done", work->cli.arguments[0], work->counts[JOB_PART_DONE],
          count, count == 1 ? "" : "s");
    for (int i = 0; i < JOB_PART_DONE; i++)
        if (work->counts[i]) print(", %d %s", work->counts[i], state_names[i]);
    print("\n");
    print_slurm(&work->queue);
    for (int i = 0; i < count; i++) print_part(work, i);
    if (is_all_done(work) && file_exists(work->output))
        print("%s is there\n", work->output);
    else
        print("%s: %s\n", is_all_done(work) ? "merge them" : "then",
              job_merge_command(&work->job, work->arena));
}

/* No while something is left. */
static Outcome report(StatusRun *work, Error *err)
{
    if (!look(work, err) || (work->cli.json && !print_json(work, err))) return OUTCOME_FAILED;
    if (!work->cli.json) print_lines(work);
    return is_all_done(work) ? OUTCOME_DONE : OUTCOME_NO;
}

static Outcome run_status(int argc, char **argv, Arena *arena, Error *err)
{
    StatusRun work = {.arena = arena};
    if (!parse(argc, argv, &work, err)) return OUTCOME_FAILED;
    return work.cli.help_shown ? OUTCOME_DONE : report(&work, err);
}

const Command command_status = {
    "status", "how far a frame or review is that is shared among machines", run_status};
