/* SPDX-License-Identifier: Apache-2.0 */
#include "job/job_state.h"

#include <dirent.h>
#include <errno.h>
#include <fcntl.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>
#define XXH_INLINE_ALL
#include <xxhash.h>

#include "base/file.h"
#include "base/file_write.h"
#include "job/job_scripts.h"
#include "film/film_part.h"
#include "render/checkpoint.h"
#include "text/text.h"

#define CHECKPOINT ".checkpoint"
#define FAILED ".failed"
#define RUNNING ".running"
#define WORKER_BYTES 128
#define FAILURE_BYTES 4096

/* ---- the folder -------------------------------------------------------------------------- */

bool job_folder_list(const SharedJob *job, Arena *arena, Lines *out, Error *err)
{
    Lines folder = {.arena = arena};
    DIR  *names = opendir(job->dir);
    if (!names)
        return error_at(err, ERROR_INPUT, job->dir, "", "cannot be opened: %s",
                        strerror(errno));
    for (struct dirent *entry; (entry = readdir(names));)
        lines_put(&folder, arena_string(arena, entry->d_name, strlen(entry->d_name)));
    closedir(names);
    *out = folder;
    return true;
}

bool job_is_checkpoint(const char *name, int index)
{
    char   begin[32];
    int    length = snprintf(begin, sizeof begin, "part-%04d.", index);
    size_t size = strlen(name), end = strlen(CHECKPOINT);
    return !strncmp(name, begin, (size_t)length) && size >= (size_t)length - 1 + end &&
           !strcmp(name + size - end, CHECKPOINT);
}

/* ---- what the output replaces ------------------------------------------------------------ */

#define OUTPUT_BYTES_MAX ((size_t)1 << 36)

/* "": there is no such file. */
static const char *hash_of_output(const SharedJob *job, Arena *arena)
{
    FileBytes   bytes;
    Error       none;
    const char *path = job_output_file(job, arena);
    if (job->kind == JOB_REVIEW || !file_exists(path) ||
        !file_read(path, OUTPUT_BYTES_MAX, arena, &bytes, &none))
        return "";
    return arena_format(arena, "%016llx\n",
                        (unsigned long long)XXH3_64bits(bytes.data, bytes.size));
}

bool job_note_replaced(const SharedJob *job, Arena scratch, Error *err)
{
    const char *path = job_file(job, JOB_REPLACES, &scratch);
    const char *hash = hash_of_output(job, &scratch);
    if (hash[0]) return file_write(path, hash, strlen(hash), err);
    file_remove(path);
    return true;
}

bool job_may_replace(const SharedJob *job, Arena scratch)
{
    FileBytes   bytes;
    Error       none;
    const char *hash = hash_of_output(job, &scratch);
    return hash[0] && file_read(job_file(job, JOB_REPLACES, &scratch), 64, &scratch, &bytes,
                                &none) &&
           !strcmp((const char *)bytes.data, hash);
}

static bool is_older(const struct stat *a, const struct stat *b)
{
    return a->st_mtim.tv_sec != b->st_mtim.tv_sec ? a->st_mtim.tv_sec < b->st_mtim.tv_sec
                                                  : a->st_mtim.tv_nsec < b->st_mtim.tv_nsec;
}

bool job_is_merged(const SharedJob *job, Arena scratch)
{
    struct stat output, part;
    const char *path = job_output_file(job, &scratch);
    if (job->kind == JOB_REVIEW) path = arena_format(&scratch, "%s/review.json", path);
    bool is_merged = !stat(path, &output);
    for (int i = 0; i < job->part_count && is_merged; i++)
        is_merged = !stat(job_part_file(job, i, job_part_ending(job), &scratch), &part) &&
                    !is_older(&output, &part);
    return is_merged;
}

/* ---- a part that is done ----------------------------------------------------------------- */

static bool check_file(const SharedJob *job, const JobPart *wanted, const FilmPartReader *from,
                       Error *err)
{
    const FilmPart *part = &from->part;
    const char *identity = frame_string(exr_reader_picture(from->file), "parhelion:identity");
    if (!identity || strncmp(identity, job->identity, strlen(job->identity)) != 0)
        return error_set(err, ERROR_INPUT, "is a part of another frame");
    if (memcmp(&part->crop, &wanted->crop, sizeof part->crop) != 0 ||
        part->first_sample != wanted->first_sample)
        return error_set(err, ERROR_INPUT, "is another part of the frame");
    return part->end_sample == wanted->end_sample ||
           error_set(err, ERROR_INPUT, "has samples %u:%u, required: %u:%u", part->first_sample,
                     part->end_sample, wanted->first_sample, wanted->end_sample);
}

/* Into a film of its own, which is thrown away. */
static bool read_sums(FilmPartReader *from, Arena scratch, Error *err)
{
    const FilmPart *part = &from->part;
    if (film_bytes(part->crop, part->layers, part->lights.count) >= arena_left(&scratch))
        return error_set(err, ERROR_MEMORY, "does not go into this machine's memory");
    Film *film = film_create(part->width, part->height, part->crop, part->layers,
                             &part->lights, &scratch);
    while (from->next_y < part->crop.y1)
        if (!film_part_add_band(from, film, scratch, err)) return false;
    return true;
}

JournalKey job_part_mark(const SharedJob *job, int index, Arena scratch)
{
    Text text = {.arena = &scratch};
    text_format(&text, "part %d of %d is done\n", index, job->part_count);
    text_add(&text, job->identity);
    return journal_key(text.data);
}

/* A review's part is small: it is always read as a whole. */
static bool has_all_answers(const SharedJob *job, int index, const char *path, Arena scratch,
                            Error *err)
{
    return journal_file_has(path, job_part_mark(job, index, scratch)) ||
           error_at(err, ERROR_INPUT, path, "",
                    "is damaged, or another part, or of another review");
}

bool job_part_is_done(const SharedJob *job, int index, bool with_sums, Arena scratch,
                      Error *err)
{
    const char    *path = job_part_file(job, index, job_part_ending(job), &scratch);
    FilmPartReader from;
    if (!file_exists(path)) return error_set(err, ERROR_INPUT, "%s", "");
    if (job->kind == JOB_REVIEW) return has_all_answers(job, index, path, scratch, err);
    if (!film_part_open(path, &scratch, &from, err)) return error_in_file(err, path);
    bool done = check_file(job, &job->parts[index], &from, err) &&
                (with_sums ? read_sums(&from, scratch, err)
                           : film_part_check_end(&from, scratch, err));
    film_part_close(&from);
    return done || error_in_file(err, path);
}

/* ---- checkpoints ------------------------------------------------------------------------- */

/* Samples of every pixel, or answers, that it holds; 0: it is damaged, or of something else. */
static uint32_t kept_in(const SharedJob *job, int index, const char *path, Arena scratch)
{
    if (job->kind == JOB_REVIEW) return (uint32_t)journal_file_count(path);
    const JobPart *part = &job->parts[index];
    const FilmPart wanted = {.crop = part->crop, .first_sample = part->first_sample,
                             .end_sample = part->end_sample};
    Checkpoint     found;
    Error          ignored;
    if (!checkpoint_open(path, &scratch, &found, &ignored) ||
        strncmp(found.identity, job->identity, strlen(job->identity)) != 0 ||
        !checkpoint_fits(&found, &wanted, &ignored))
        return 0;
    return found.done.end_sample - found.done.first_sample;
}

/* The path of the furthest one, or NULL. removes: those that are worth nothing. */
static const char *furthest(const SharedJob *job, const Lines *folder, int index,
                            bool removes, uint32_t *kept, Arena *arena)
{
    const char *best = NULL;
    *kept = 0;
    for (int i = 0; i < folder->count; i++) {
        if (!job_is_checkpoint(folder->list[i], index)) continue;
        const char *path = job_file(job, folder->list[i], arena);
        uint32_t    found = kept_in(job, index, path, *arena);
        if (!found && removes) file_remove(path);
        if (found <= *kept) continue;
        *kept = found;
        best = path;
    }
    return best;
}

/* "HOST-PID", of letters that do well in a name: no other process that runs has it. */
static const char *process_name(Arena *arena)
{
    char host[64] = "";
    gethostname(host, sizeof host - 1);
    host[32] = '\0';
    for (char *c = host; *c; c++)
        if (!strchr("-0123456789ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz", *c))
            *c = '-';
    return arena_format(arena, ".%s-%ld", host, (long)getpid());
}

const char *job_own_checkpoint(const SharedJob *job, int index, Arena *arena)
{
    return job_part_file(job, index, arena_format(arena, "%s" CHECKPOINT, process_name(arena)),
                         arena);
}

/* By a rename: of two tasks that begin together one gets it, and the other begins anew. A task
 * that still writes to it, since its node was only thought dead, writes a new one. */
const char *job_take_checkpoint(const SharedJob *job, const Lines *folder, int index,
                                Arena *arena)
{
    uint32_t    kept;
    const char *own = job_own_checkpoint(job, index, arena);
    const char *best = furthest(job, folder, index, true, &kept, arena);
    if (best) rename(best, own);
    return own;
}

void job_part_clean(const SharedJob *job, int index, Arena scratch)
{
    Lines folder;
    Error     ignored;
    job_part_forget_failure(job, index, scratch);
    if (!job_folder_list(job, &scratch, &folder, &ignored)) return;
    for (int i = 0; i < folder.count; i++)
        if (job_is_checkpoint(folder.list[i], index))
            file_remove(job_file(job, folder.list[i], &scratch));
}

/* ---- failures ---------------------------------------------------------------------------- */

void job_part_note_failure(const SharedJob *job, int index, int status, const char *line,
                           Arena scratch)
{
    Error       ignored;
    const char *text = arena_format(&scratch, "%d %s\n", status, line);
    file_write(job_part_file(job, index, FAILED, &scratch), text, strlen(text), &ignored);
}

void job_part_forget_failure(const SharedJob *job, int index, Arena scratch)
{
    unlink(job_part_file(job, index, FAILED, &scratch));
}

/* NULL: it did not fail. */
static const char *failure_of(const SharedJob *job, int index, int *status, Arena *arena)
{
    FileBytes   bytes;
    Error       ignored;
    const char *path = job_part_file(job, index, FAILED, arena);
    if (!file_exists(path) || !file_read_start(path, FAILURE_BYTES, arena, &bytes, &ignored))
        return NULL;
    char *end, *line = arena_string(arena, (const char *)bytes.data, bytes.size);
    *status = (int)strtol(line, &end, 10);
    end += *end == ' ';
    end[strcspn(end, "\n")] = '\0';
    return arena_printable(arena, end);
}

/* ---- who is at it ------------------------------------------------------------------------ */

int job_part_begin(const SharedJob *job, int index, Arena scratch)
{
    struct flock lock = {.l_type = F_WRLCK, .l_whence = SEEK_SET};
    const char  *path = job_part_file(job, index, RUNNING, &scratch);
    const char  *name = process_name(&scratch) + 1; /* without its dot */
    int          handle = open(path, O_RDWR | O_CREAT | O_CLOEXEC, 0666);
    ssize_t      size = (ssize_t)strlen(name);
    if (handle < 0) return -1;
    if (fcntl(handle, F_SETLK, &lock) == 0 && ftruncate(handle, 0) == 0 &&
        write(handle, name, (size_t)size) == size)
        return handle;
    close(handle);
    return -1;
}

void job_part_end(const SharedJob *job, int index, int lock, Arena scratch)
{
    if (lock < 0) return;
    unlink(job_part_file(job, index, RUNNING, &scratch));
    close(lock);
}

/* NULL: nobody that is known. A file without a lock is of a process that was killed. */
static const char *worker_of(const SharedJob *job, int index, Arena *arena)
{
    struct flock lock = {.l_type = F_WRLCK, .l_whence = SEEK_SET};
    const char  *path = job_part_file(job, index, RUNNING, arena);
    int          handle = open(path, O_RDONLY | O_CLOEXEC | O_NOFOLLOW);
    char         name[WORKER_BYTES];
    if (handle < 0) return NULL;
    bool    is_locked = fcntl(handle, F_GETLK, &lock) == 0 && lock.l_type != F_UNLCK;
    ssize_t size = read(handle, name, sizeof name);
    close(handle);
    return is_locked ? arena_printable(arena, arena_string(arena, name,
                                                           size > 0 ? (size_t)size : 0))
                     : NULL;
}

static JobPartState state_of(const JobPartReport *report, JobQueued queued)
{
    return report->worker || queued == JOB_RUNS ? JOB_PART_RUNNING
           : queued == JOB_WAITS                ? JOB_PART_QUEUED
           : report->reason                     ? JOB_PART_FAILED
           : report->kept                       ? JOB_PART_BEGUN
                                                : JOB_PART_MISSING;
}

JobPartReport job_part_report(const SharedJob *job, const Lines *folder,
                              const JobQueue *queue, int index, Arena *arena)
{
    JobPartReport report = {.worker = worker_of(job, index, arena)};
    Error         err;
    char          line[2048];
    if (job_part_is_done(job, index, false, *arena, &err)) {
        report.state = JOB_PART_DONE;
        return report;
    }
    furthest(job, folder, index, false, &report.kept, arena);
    report.reason = failure_of(job, index, &report.status, arena);
    if (!report.reason && err.text[0]) {
        error_line(&err, line, (int)sizeof line);
        report.reason = arena_string(arena, line, strlen(line));
        report.status = error_exit_status(err.code);
    }
    report.state = state_of(&report, (JobQueued)queue->parts[index]);
    return report;
}
