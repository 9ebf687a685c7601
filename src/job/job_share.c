/* SPDX-License-Identifier: Apache-2.0 */
#include "job/job_share.h"

#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "base/count.h"
#include "base/file.h"
#include "base/file_write.h"
#include "print/print.h"
#include "job/job_manifest.h"
#include "job/job_scripts.h"
#include "job/job_state.h"
#include "job/slurm.h"
#include "render/identity.h"
#include "text/text.h"
#include "text/json_text.h"

#define PART_BYTES ((size_t)1 << 30) /* of address space, to look at one part */

/* The job and its submission. */
typedef struct Share {
    const ShareRequest *request;
    SharedJob           job;
    bool                was_there; /* the same job was planned before */
    const char         *array_id, *merge_id; /* Slurm's numbers; NULL: not submitted */
    int                 submitted;           /* parts, now */
} Share;

/* ---- the job ----------------------------------------------------------------------------- */

/* JSON holds texts of UTF-8, and a script's lines no control characters. */
static bool check_text(const char *text, Arena scratch, Error *err)
{
    return !strcmp(arena_printable(&scratch, text), text) ||
           error_set(err, ERROR_USAGE,
                     "'%.200s' cannot be kept in a job: required: UTF-8 without control "
                     "characters",
                     text);
}

static bool check_texts(const SharedJob *job, Arena scratch, Error *err)
{
    const char *texts[] = {job->dir, job->program, job->folder, job->output};
    for (int i = 0; i < COUNT_OF(texts); i++)
        if (!check_text(texts[i], scratch, err)) return false;
    for (int i = 0; i < job->word_count; i++)
        if (!check_text(job->words[i], scratch, err)) return false;
    return !strpbrk(job->dir, "\"\\") ||
           error_set(err, ERROR_USAGE,
                     "--job %.200s: quotes and backslashes do not go into a batch script — "
                     "name another folder",
                     job->dir);
}

/* A path that the program itself or the system knows. */
static bool find_place(const char *what, char *found, Arena *arena, const char **out,
                       Error *err)
{
    if (!found)
        return error_set(err, ERROR_INPUT, "%s cannot be found: %s", what, strerror(errno));
    *out = arena_string(arena, found, strlen(found));
    free(found);
    return true;
}

static bool find_places(const ShareRequest *share, SharedJob *job, Arena *arena, Error *err)
{
    return folder_make(share->dir, err) &&
           find_place("the job's folder", realpath(share->dir, NULL), arena, &job->dir, err) &&
           find_place("the program", realpath("/proc/self/exe", NULL), arena, &job->program,
                      err) &&
           find_place("the working folder", getcwd(NULL, 0), arena, &job->folder, err);
}

/* ---- the folder -------------------------------------------------------------------------- */

/* The manifest comes last: a folder without one was never finished, and holds the other files
 * at most. Everything else is somebody's. */
static bool check_is_free(const SharedJob *job, Arena scratch, Error *err)
{
    static const char *const ours[] = {".", "..", JOB_LOGS, JOB_ARRAY, JOB_MERGE, JOB_COMMANDS,
                                       JOB_REPLACES};
    Lines folder;
    if (!job_folder_list(job, &scratch, &folder, err)) return false;
    for (int i = 0; i < folder.count; i++) {
        bool is_ours = false;
        for (int j = 0; j < COUNT_OF(ours); j++)
            is_ours = is_ours || !strcmp(folder.list[i], ours[j]);
        if (!is_ours)
            return error_at(err, ERROR_OUTPUT, job->dir, "",
                            "is no folder of a job and holds %.200s — name another by "
                            "--job DIR",
                            folder.list[i]);
    }
    return true;
}

/* Parts that are done stay done when the same line is typed again. */
static bool check_is_same(const SharedJob *job, Arena *arena, Error *err)
{
    SharedJob there;
    if (!job_manifest_read(job->dir, arena, &there, err)) return false;
    if (!strcmp(job_manifest_text(&there, arena), job_manifest_text(job, arena))) return true;
    const char *difference = identity_difference(there.identity, job->identity, arena);
    return error_at(err, ERROR_OUTPUT, job->dir, "",
                    "holds another job: %.400s — remove it, or name another by --job DIR",
                    difference ? difference
                               : arena_format(arena, "%d parts of `%s` there", there.part_count,
                                              there.line));
}

static bool write_folder(Share *work, Arena *arena, Error *err)
{
    const SharedJob *job = &work->job;
    work->was_there = job_manifest_is_there(job->dir, *arena);
    if (work->was_there ? !check_is_same(job, arena, err) : !check_is_free(job, *arena, err))
        return false;
    if (!folder_make(job_file(job, JOB_LOGS, arena), err) ||
        !job_scripts_write(job, work->request->threads, *arena, err) ||
        !job_note_replaced(job, *arena, err))
        return false;
    const char *text = job_manifest_text(job, arena);
    return work->was_there ||
           file_write(job_file(job, JOB_MANIFEST, arena), text, strlen(text), err);
}

/* ---- Slurm ------------------------------------------------------------------------------- */

/* "0,4-7": the parts that are neither done nor anybody's, how many they are. */
static int missing_parts(const SharedJob *job, const JobQueue *queue, const Lines *folder,
                         Arena *arena, const char **out)
{
    Text text = {.arena = arena};
    int  count = 0, first = -1;
    bool was_missing = false;
    for (int i = 0; i <= job->part_count; i++) {
        Arena        scratch = arena_reserve(PART_BYTES);
        JobPartState state = i < job->part_count
                                 ? job_part_report(job, folder, queue, i, &scratch).state
                                 : JOB_PART_DONE;
        bool is_missing = state != JOB_PART_DONE && state != JOB_PART_RUNNING &&
                          state != JOB_PART_QUEUED;
        arena_release(&scratch);
        if (is_missing && !was_missing) first = i;
        if (!is_missing && was_missing) {
            text_format(&text, "%s%d", text.size ? "," : "", first);
            if (first < i - 1) text_format(&text, "-%d", i - 1);
        }
        count += is_missing;
        was_missing = is_missing;
    }
    *out = text.data;
    return count;
}

/* Keeps its number as well. */
static bool submit_script(const SharedJob *job, const char *kind, const SlurmScript *script,
                          Arena *arena, const char **id, Error *err)
{
    return slurm_submit(script, arena, id, err) && job_queue_note(job, kind, *id, *arena, err);
}

static const char *latest(const Lines *numbers)
{
    return numbers->count ? numbers->list[numbers->count - 1] : NULL;
}

/* The numbers of what has to end before the merge, with colons; NULL: nothing. */
static const char *awaited(const JobQueue *queue, const char *array_id, Arena *arena)
{
    const char *list = array_id;
    for (int i = 0; i < queue->active.count; i++)
        list = list ? arena_format(arena, "%s:%s", list, queue->active.list[i])
                    : queue->active.list[i];
    return list;
}

/* Only what nobody does yet; and the merge behind all that is left, unless one waits already or
 * has done it. */
static bool submit_missing(Share *work, const JobQueue *queue, Arena *arena, Error *err)
{
    const SharedJob *job = &work->job;
    Lines            folder;
    SlurmScript      array = {.file = job_file(job, JOB_ARRAY, arena)};
    SlurmScript      merge = {.file = job_file(job, JOB_MERGE, arena)};
    if (!job_folder_list(job, arena, &folder, err)) return false;
    work->submitted = missing_parts(job, queue, &folder, arena, &array.tasks);
    if (work->submitted == job->part_count) array.tasks = NULL; /* as the script says */
    if (work->submitted &&
        !submit_script(job, "array", &array, arena, &work->array_id, err))
        return false;
    merge.after = awaited(queue, work->array_id, arena);
    if (!work->submitted && (queue->merge != JOB_NOT_QUEUED ||
                             (!merge.after && job_is_merged(job, *arena))))
        return true;
    return submit_script(job, "merge", &merge, arena, &work->merge_id, err);
}

static bool submit(Share *work, Arena *arena, Error *err)
{
    const SharedJob *job = &work->job;
    Error            why;
    if (!work->request->submits) return true;
    JobQueue queue = job_queue_read(job, arena);
    if (queue.silence) {
        error_set(&why, ERROR_INPUT, "what Slurm has of it is not known: %s", queue.silence);
    } else if (submit_missing(work, &queue, arena, &why)) {
        if (!work->array_id) work->array_id = latest(&queue.arrays);
        if (!work->merge_id) work->merge_id = latest(&queue.merges);
        return true;
    }
    if (work->array_id)
        return error_at(err, why.code, job->dir, "",
                        "job %s does the parts, but its merge is not submitted: %s — when it "
                        "has ended: %s",
                        work->array_id, why.text, job_merge_command(job, arena));
    return error_at(err, why.code, job->dir, "",
                    "is ready, but not submitted: %s — by hand: %s", why.text,
                    job_scripts_by_hand(job, arena));
}

/* ---- the answer -------------------------------------------------------------------------- */

static json_t *answer_json(const Share *work, Arena *arena)
{
    const SharedJob *job = &work->job;
    return json_pack(
        "{s:o, s:o, s:i, s:s, s:b, s:s, s:i, s:o, s:o, s:o, s:o, s:o, s:o}", "output",
        json_text(job->output), "job", json_text(job->dir), "parts", job->part_count, "split",
        work->request->split_name, "was_there", work->was_there, "isa", job->isa, "submitted",
        work->submitted, "manifest", json_text(job_file(job, JOB_MANIFEST, arena)), "commands",
        json_text(job_file(job, JOB_COMMANDS, arena)), "array",
        json_text(job_file(job, JOB_ARRAY, arena)), "merge",
        json_text(job_file(job, JOB_MERGE, arena)), "array_job",
        json_text_or_null(work->array_id), "merge_job", json_text_or_null(work->merge_id));
}

static void print_submitted(const Share *work)
{
    const char *merge = work->merge_id ? work->merge_id : "nobody";
    if (work->submitted == work->job.part_count)
        print("Slurm's job %s does them, %s merges them\n", work->array_id, merge);
    else if (work->submitted)
        print("Slurm's job %s does the %d that nobody did yet, %s merges them\n",
              work->array_id, work->submitted, merge);
    else
        print("every part is done, or somebody's; %s merges them\n", merge);
}

static void print_lines(const Share *work, Arena *arena)
{
    const SharedJob *job = &work->job;
    const char      *dir = escape_shell(work->request->dir, arena);
    print("%s: %d part%s of %s%s\n", work->request->dir, job->part_count,
          job->part_count == 1 ? "" : "s", job->output,
          work->was_there ? ", as before" : "");
    print("instruction set %s, which every machine needs (--isa takes another)\n", job->isa);
    if (work->request->submits) print_submitted(work);
    else
        print("by Slurm: %s\n", job_scripts_by_hand(job, arena));
    print("here: xargs -L 1 -P 2 env <%s/" JOB_COMMANDS "\nthen: parhelion merge %s\n", dir,
          dir);
}

bool job_share(const ShareRequest *request, const SharedJob *job, Arena *arena, json_t **answer,
               Error *err)
{
    Share work = {.request = request, .job = *job};
    work.job.words = request->words;
    work.job.word_count = request->word_count;
    work.job.part_count = (int)request->parts;
    if (!find_places(request, &work.job, arena, err) || !check_texts(&work.job, *arena, err) ||
        !write_folder(&work, arena, err) || !submit(&work, arena, err))
        return false;
    if (answer) *answer = answer_json(&work, arena);
    else print_lines(&work, arena);
    return true;
}
