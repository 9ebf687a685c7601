/* SPDX-License-Identifier: Apache-2.0 */
#include "job/job.h"

#include "text/text.h"

const char *const job_kind_names[JOB_KINDS + 1] = {[JOB_FRAME] = "frame",
                                                     [JOB_REVIEW] = "review"};

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

/* ---- how a frame is cut ------------------------------------------------------------------ */

/* Where part i of `count` begins in [first, end). */
static uint64_t edge(uint64_t first, uint64_t end, int i, int count)
{
    return first + (end - first) * (uint64_t)i / (uint64_t)count;
}

bool job_split(const JobPart *whole, JobSplit how, int count, Arena *arena, JobPart **out,
               Error *err)
{
    bool     by_rows = how == JOB_SPLIT_ROWS;
    uint64_t first = by_rows ? (uint64_t)whole->crop.y0 : whole->first_sample;
    uint64_t end = by_rows ? (uint64_t)whole->crop.y1 : whole->end_sample;
    if (end - first < (uint64_t)count)
        return error_set(err, ERROR_USAGE,
                         "--slurm %d: there are only %llu %s to share — ask for fewer parts, "
                         "or cut another way (--split " JOB_SPLITS ")",
                         count, (unsigned long long)(end - first),
                         by_rows ? "rows of pixels" : "samples a pixel");
    JobPart *parts = ARENA_NEW(arena, JobPart, count);
    for (int i = 0; i < count; i++) {
        uint64_t a = edge(first, end, i, count), b = edge(first, end, i + 1, count);
        parts[i] = *whole;
        if (by_rows) {
            parts[i].crop.y0 = (int)a;
            parts[i].crop.y1 = (int)b;
        } else {
            parts[i].first_sample = (uint32_t)a;
            parts[i].end_sample = (uint32_t)b;
        }
    }
    *out = parts;
    return true;
}
