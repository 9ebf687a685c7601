/* SPDX-License-Identifier: Apache-2.0 */
#include "job/job_scripts.h"

#include "base/file.h"
#include "text/text.h"

/* A path inside a line of #SBATCH, where % begins a pattern. Quotes and backslashes do not come
 * here: such a folder is refused when the job is planned. */
static void add_log(Text *text, const SharedJob *job, const char *name)
{
    text_add(text, "#SBATCH --output=\"");
    for (const char *c = job_file(job, JOB_LOGS, text->arena); *c; c++)
        text_add(text, *c == '%' ? "%%" : (const char[2]){*c, '\0'});
    text_format(text, "/%s\"\n", name);
}

/* Blanks would end the name. */
static void add_job_name(Text *text, const SharedJob *job, const char *ending)
{
    text_add(text, "#!/bin/sh\n#SBATCH --job-name=");
    for (const char *c = path_name(job->output); *c; c++) {
        bool is_plain = (*c >= 'a' && *c <= 'z') || (*c >= 'A' && *c <= 'Z') ||
                        (*c >= '0' && *c <= '9') || *c == '.' || *c == '-' || *c == '_';
        text_add(text, is_plain ? (const char[2]){*c, '\0'} : "_");
    }
    text_format(text, "%s\n", ending);
}

#define WARNING "--signal=B:TERM@60"

/* The shell around a task. The last 60 s of its time begin with a TERM to this shell alone
 * (B:), which hands it on. A task that is cancelled, or must make room for another, gets it as
 * well as its shell: the second one ends the program at once, and what it did since its last
 * checkpoint, a minute at most, is lost. `squeue` distinguishes a task at its limit from one
 * that was cancelled, which must not come back; an array's last task has the whole array's
 * number, so that each is named by its index. Bad input (2, 3) fails the same way again and is
 * not tried again; a full disk (4) may be gone. A node that lacks the job's instruction set (5)
 * is excluded, once the task waits again: Slurm excludes none of one that runs. */
static const char task[] =
    "# A part's file is written only when it is whole: a task that runs twice does no harm.\n"
    "job=${SLURM_ARRAY_JOB_ID:+${SLURM_ARRAY_JOB_ID}_$SLURM_ARRAY_TASK_ID}\n"
    "job=${job:-$SLURM_JOB_ID}\n"
    "again()\n"
    "{\n"
    "    [ \"${SLURM_RESTART_COUNT:-0}\" -lt 100 ] || return\n"
    "    [ \"$(squeue --noheader --jobs=\"$job\" --format=%T)\" = RUNNING ] &&\n"
    "        scontrol requeue \"$job\"\n"
    "}\n"
    "elsewhere()\n"
    "{\n"
    "    trap '' TERM # which a requeue sends\n"
    "    nodes=$(squeue --noheader --jobs=\"$job\" --format=%x)\n"
    "    again && scontrol update JobId=\"$job\" \\\n"
    "        ExcNodeList=\"${nodes:+$nodes,}$SLURMD_NODENAME\"\n"
    "}\n"
    "trap 'stopped=1; kill -TERM \"$task\"' TERM\n"
    "stopped=\n";

static const char task_end[] =
    "task=$!\n"
    "wait \"$task\"\n"
    "status=$?\n"
    "while [ \"$stopped\" ] && [ \"$status\" -gt 128 ]; do # what ended is the wait\n"
    "    stopped=\n"
    "    wait \"$task\"\n"
    "    status=$?\n"
    "done\n"
    "case $status in 4 | 143) again ;; 5) elsewhere ;; esac\n"
    "exit \"$status\"\n";

static bool write_array(const SharedJob *job, int threads, Arena scratch, Error *err)
{
    Text text = {.arena = &scratch};
    add_job_name(&text, job, "");
    text_format(&text, "#SBATCH --array=0-%d\n#SBATCH --requeue\n"
                       "#SBATCH " WARNING "\n#SBATCH --open-mode=append\n",
                job->part_count - 1);
    if (threads) text_format(&text, "#SBATCH --cpus-per-task=%d\n", threads);
    add_log(&text, job, "part-%a.log");
    text_format(&text, "# Part $SLURM_ARRAY_TASK_ID of %d, as manifest.json lists them.\n%s",
                job->part_count, task);
    text_format(&text, "%s part ${SLURM_CPUS_PER_TASK:+--threads \"$SLURM_CPUS_PER_TASK\"} \\\n"
                       "    --progress plain %s \"$SLURM_ARRAY_TASK_ID\" &\n%s",
                escape_shell(job->program, &scratch), escape_shell(job->dir, &scratch),
                task_end);
    return text_write(&text, job_file(job, JOB_ARRAY, &scratch), err);
}

static bool write_merge(const SharedJob *job, Arena scratch, Error *err)
{
    Text text = {.arena = &scratch};
    add_job_name(&text, job, "-merge");
    text_add(&text, "#SBATCH --open-mode=append\n");
    if (job->kind == JOB_REVIEW) text_add(&text, "#SBATCH --requeue\n#SBATCH " WARNING "\n");
    add_log(&text, job, "merge.log");
    text_add(&text, "# After all tasks, well or not (afterany): what is missing is listed.\n");
    if (job->kind == JOB_REVIEW) /* which traces, and keeps what it has */
        text_format(&text, "%s%s --quiet &\n%s", task, job_merge_command(job, &scratch),
                    task_end);
    else
        text_format(&text, "exec %s --quiet\n", job_merge_command(job, &scratch));
    return text_write(&text, job_file(job, JOB_MERGE, &scratch), err);
}

static bool write_commands(const SharedJob *job, Arena scratch, Error *err)
{
    Text text = {.arena = &scratch};
    for (int i = 0; i < job->part_count; i++)
        text_format(&text, "%s part %s %d\n", escape_shell(job->program, &scratch),
                    escape_shell(job->dir, &scratch), i);
    return text_write(&text, job_file(job, JOB_COMMANDS, &scratch), err);
}

bool job_scripts_write(const SharedJob *job, int threads, Arena scratch, Error *err)
{
    return write_array(job, threads, scratch, err) && write_merge(job, scratch, err) &&
           write_commands(job, scratch, err);
}

const char *job_scripts_by_hand(const SharedJob *job, Arena *arena)
{
    return arena_format(arena,
                        "J=$(sbatch --parsable %s) && "
                        "sbatch --dependency=afterany:${J%%%%;*} %s",
                        escape_shell(job_file(job, JOB_ARRAY, arena), arena),
                        escape_shell(job_file(job, JOB_MERGE, arena), arena));
}
