/* SPDX-License-Identifier: Apache-2.0 */
/* job.h -- one frame shared among machines: a folder that lists its parts, and holds each as
 * soon as it is done. No process watches over it: what is there tells what is left.
 *
 *     manifest.json             what the frame is, and its parts (assets/schemas/job.md)
 *     array.sbatch              Slurm's array job, and the job that merges
 *     merge.sbatch
 *     commands.txt              the same parts as commands, one a line
 *     logs/                     what Slurm's tasks say
 *     part-0003.exr             a part that is done
 *     part-0003.HOST-PID.checkpoint   what a task has done of it so far
 *     part-0003.failed          the status and the line with which it failed last
 *
 * Memory   the arena's.
 * Threads  one at a time.
 * Fails    never.
 */
#pragma once
#include "film/film.h"

#define JOB_PARTS_MAX 100000

typedef struct JobPart {
    FilmRect crop;
    uint32_t first_sample, end_sample; /* half-open */
} JobPart;

typedef struct RenderJob {
    const char  *dir;      /* the job's folder, absolute */
    const char  *program;  /* that planned it, absolute */
    const char  *folder;   /* from where the names below are seen, absolute */
    const char  *line;     /* the command of one run, as frames say it (command_line.h) */
    const char  *output;   /* the frame, as typed */
    const char  *identity; /* of every part, but for what is learnt (render_identity.h) */
    const char  *isa;
    const char **words;    /* of `render`, without its name, the outputs and the range */
    int          word_count;
    int          width, height;
    bool         keeps_sums; /* one run would keep its sums: the frame is itself a part */
    JobPart     *parts;
    int          part_count;
} RenderJob;

/* A file of the job's folder. */
const char *job_file(const RenderJob *job, const char *name, Arena *arena);

/* "part-0003.exr" in it: of part 3, with this ending. */
const char *job_part_file(const RenderJob *job, int index, const char *ending, Arena *arena);

/* The frame's file, as seen from anywhere. */
const char *job_output_file(const RenderJob *job, Arena *arena);

/* The command that does part `index`, or the rest of it, for a shell. */
const char *job_part_command(const RenderJob *job, int index, Arena *arena);
const char *job_merge_command(const RenderJob *job, Arena *arena);
