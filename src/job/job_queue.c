/* SPDX-License-Identifier: Apache-2.0 */
#include "job/job_queue.h"

#include <errno.h>
#include <fcntl.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "base/count.h"
#include "base/file.h"
#include "job/slurm.h"

#define FILE_BYTES ((size_t)1 << 20)

/* ---- the numbers ------------------------------------------------------------------------- */

/* "array 41" is 41 of the kind "array"; NULL: it is no such line. */
static const char *number_in(const char *line, const char *kind, Arena *arena)
{
    size_t length = strlen(kind);
    if (strncmp(line, kind, length) != 0 || line[length] != ' ') return NULL;
    size_t digits = strspn(line + length + 1, "0123456789");
    return digits ? arena_string(arena, line + length + 1, digits) : NULL;
}

static void read_numbers(const SharedJob *job, JobQueue *out, Arena *arena)
{
    FileBytes   bytes;
    Error       ignored;
    const char *path = job_file(job, JOB_SUBMITTED, arena);
    if (!file_exists(path) || !file_read(path, FILE_BYTES, arena, &bytes, &ignored)) return;
    const char *line = arena_string(arena, (const char *)bytes.data, bytes.size);
    for (; line; line = strchr(line, '\n'), line += line != NULL) {
        const char *array = number_in(line, "array", arena);
        const char *merge = number_in(line, "merge", arena);
        if (array) lines_put(&out->arrays, array);
        if (merge) lines_put(&out->merges, merge);
    }
}

bool job_queue_note(const SharedJob *job, const char *kind, const char *id, Arena scratch,
                    Error *err)
{
    const char *path = job_file(job, JOB_SUBMITTED, &scratch);
    const char *line = arena_format(&scratch, "%s %s\n", kind, id);
    int         handle = open(path, O_WRONLY | O_APPEND | O_CREAT | O_CLOEXEC, 0666);
    ssize_t     written = handle < 0 ? -1 : write(handle, line, strlen(line));
    int         reason = errno;
    if (handle >= 0) close(handle);
    return written == (ssize_t)strlen(line) ||
           error_at(err, ERROR_OUTPUT, path, "", "cannot be written: %s", strerror(reason));
}

/* ---- the queue --------------------------------------------------------------------------- */

/* Slurm's states of a job that has not ended: what is no longer waiting counts as running. */
static JobQueued queued_as(const char *state)
{
    static const char *const waiting[] = {"PENDING", "REQUEUED", "REQUEUE_HOLD", "REQUEUE_FED",
                                          "SPECIAL_EXIT", "RESV_DEL_HOLD"};
    static const char *const running[] = {"RUNNING", "CONFIGURING", "COMPLETING", "SUSPENDED",
                                          "STOPPED", "SIGNALING", "STAGE_OUT", "RESIZING"};
    size_t length = strcspn(state, " \r\n");
    for (int i = 0; i < COUNT_OF(waiting); i++)
        if (strlen(waiting[i]) == length && !strncmp(state, waiting[i], length))
            return JOB_WAITS;
    for (int i = 0; i < COUNT_OF(running); i++)
        if (strlen(running[i]) == length && !strncmp(state, running[i], length))
            return JOB_RUNS;
    return JOB_NOT_QUEUED;
}

static bool has_number(const Lines *numbers, const char *text, size_t length)
{
    for (int i = 0; i < numbers->count; i++)
        if (strlen(numbers->list[i]) == length && !strncmp(numbers->list[i], text, length))
            return true;
    return false;
}

/* "41_3 RUNNING" of an array, "42 PENDING" of a merge. */
static void take_line(const char *line, int part_count, JobQueue *out)
{
    char       *end;
    size_t      digits = strspn(line, "0123456789");
    const char *state = strpbrk(line, " \n");
    JobQueued   queued = state && *state == ' ' ? queued_as(state + 1) : JOB_NOT_QUEUED;
    if (queued == JOB_NOT_QUEUED) return;
    if (line[digits] == ' ' && has_number(&out->merges, line, digits)) {
        if (queued > out->merge) out->merge = queued;
        return;
    }
    if (line[digits] != '_' || !has_number(&out->arrays, line, digits)) return;
    long index = strtol(line + digits + 1, &end, 10);
    if (end != state || index < 0 || index >= part_count) return;
    if (queued > out->parts[index]) out->parts[index] = (unsigned char)queued;
    if (!has_number(&out->active, line, digits))
        lines_put(&out->active, arena_string(out->active.arena, line, digits));
}

JobQueue job_queue_read(const SharedJob *job, Arena *arena)
{
    JobQueue    queue = {.arrays = {.arena = arena}, .merges = {.arena = arena},
                         .active = {.arena = arena},
                         .parts = ARENA_NEW(arena, unsigned char, job->part_count)};
    const char *jobs = "", *lines = "";
    Error       why;
    read_numbers(job, &queue, arena);
    /* The first twice: queried for one alone, squeue fails as soon as it has forgotten it. */
    if (queue.arrays.count) jobs = queue.arrays.list[0];
    for (int i = 0; i < queue.arrays.count; i++)
        jobs = arena_format(arena, "%s,%s", jobs, queue.arrays.list[i]);
    for (int i = 0; i < queue.merges.count; i++)
        jobs = arena_format(arena, "%s,%s", jobs, queue.merges.list[i]);
    if (queue.arrays.count && !slurm_queue(jobs, arena, &lines, &why))
        queue.silence = arena_string(arena, why.text, strlen(why.text));
    for (const char *line = lines; line; line = strchr(line, '\n'), line += line != NULL)
        take_line(line, job->part_count, &queue);
    return queue;
}
