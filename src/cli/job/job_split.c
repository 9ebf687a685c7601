/* SPDX-License-Identifier: Apache-2.0 */
#include "cli/job/job_split.h"

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
