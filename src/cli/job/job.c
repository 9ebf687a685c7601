/* SPDX-License-Identifier: Apache-2.0 */
#include "cli/job/job.h"

#include "text/escape.h"

const char *const job_kind_names[JOB_KINDS] = {[JOB_FRAME] = "frame", [JOB_REVIEW] = "review"};

const char *job_part_ending(const SharedJob *job)
{
    return job->kind == JOB_REVIEW ? ".answers" : ".exr";
}

const char *job_file(const SharedJob *job, const char *name, Arena *arena)
{
    return arena_format(arena, "%s/%s", job->dir, name);
}

const char *job_part_file(const SharedJob *job, int index, const char *ending, Arena *arena)
{
    return arena_format(arena, "%s/part-%04d%s", job->dir, index, ending);
}

const char *job_output_file(const SharedJob *job, Arena *arena)
{
    if (job->output[0] == '/') return job->output;
    return arena_format(arena, "%s/%s", job->folder, job->output);
}

static const char *command(const SharedJob *job, const char *name, Arena *arena)
{
    return arena_format(arena, "%s %s %s", escape_shell(job->program, arena), name,
                        escape_shell(job->dir, arena));
}

const char *job_part_command(const SharedJob *job, int index, Arena *arena)
{
    return arena_format(arena, "%s %d", command(job, "part", arena), index);
}

const char *job_merge_command(const SharedJob *job, Arena *arena)
{
    return command(job, "merge", arena);
}
