/* SPDX-License-Identifier: Apache-2.0 */
/* job.h -- one frame, or one review, shared among machines: a folder that lists its parts, and
 * holds each as soon as it is done. No process watches over it: its files show what is left.
 *
 *     manifest.json             what is made, and its parts (assets/schemas/job.md)
 *     array.sbatch              Slurm's array job, and the job that merges
 *     merge.sbatch
 *     commands.txt              the same parts as commands, one a line
 *     replaces.txt              the hash of the file that had the output's name when it was
 *                               planned: that one was meant to be written over
 *     submitted                 Slurm's numbers of it
 *     part-0003.running         whose lock says that a process is at it
 *     logs/                     what Slurm's tasks print
 *     part-0003.exr             a part that is done; of a review part-0003.answers
 *     part-0003.HOST-PID.checkpoint   what a task has done of it so far
 *     part-0003.failed          the status and the line with which it failed last
 *     responses/                of a review's sweeps, unless they have a folder of their own;
 *                               in *.lesson, its trained guides
 *
 * Memory   the arena's.
 * Threads  one at a time.
 * Fails    never but in job_split.
 */
#pragma once
#include "base/error.h"
#include "film/film.h"

#define JOB_PARTS_MAX 100000

typedef enum JobKind { JOB_FRAME, JOB_REVIEW, JOB_KINDS } JobKind;

/* A part of a frame; how a review is cut: review/run/job.h. */
typedef struct JobPart {
    FilmRect crop;
    uint32_t first_sample, end_sample; /* half-open */
} JobPart;

typedef struct SharedJob {
    JobKind      kind;
    const char  *dir;      /* the job's folder, absolute */
    const char  *program;  /* that planned it, absolute */
    const char  *folder;   /* from where the names below are seen, absolute */
    const char  *line;     /* the command of one run, as in frames (command_line.h) */
    const char  *output;   /* the frame, or the review's folder, as typed */
    const char  *identity; /* of all parts, but for the guide (render_identity.h); of a
                              review that of each condition */
    const char  *isa;
    const char **words;    /* of the command, without its name, the output and the range */
    int          word_count;
    int          part_count;
    /* of a frame: */
    int          width, height;
    bool         keeps_sums; /* one run would keep its sums: the frame is itself a part */
    JobPart     *parts;
} SharedJob;

/* A file of the job's folder. */
const char *job_file(const SharedJob *job, const char *name, Arena *arena);

/* "part-0003.exr" in it: of part 3, with this ending. */
const char *job_part_file(const SharedJob *job, int index, const char *ending, Arena *arena);

/* The ending of a part that is done: ".exr", ".answers". */
const char *job_part_ending(const SharedJob *job);

/* "frame", "review": how manifests and messages call it. */
extern const char *const job_kind_names[JOB_KINDS + 1]; /* and NULL */

/* The output, as seen from anywhere. */
const char *job_output_file(const SharedJob *job, Arena *arena);

/* The command that does part `index`, or the rest of it, for a shell. */
const char *job_part_command(const SharedJob *job, int index, Arena *arena);
const char *job_merge_command(const SharedJob *job, Arena *arena);

/* ---- how a frame is cut ------------------------------------------------------------------ */

typedef enum JobSplit {
    JOB_SPLIT_SAMPLES, /* every part has all pixels: equal work; each holds a whole film */
    JOB_SPLIT_ROWS     /* all samples of some rows: little memory and small files */
} JobSplit;

/* The names of --split, in the order of JobSplit. */
#define JOB_SPLITS "samples|rows"

/* `count` parts of `whole`, in order, whose sizes differ by one at most. ERROR_USAGE: there are
 * fewer samples, or rows. */
bool job_split(const JobPart *whole, JobSplit how, int count, Arena *arena, JobPart **out,
               Error *err);
