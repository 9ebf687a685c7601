/* SPDX-License-Identifier: Apache-2.0 */
#include "cli/review/review_part.h"

#include <dirent.h>
#include <stdint.h>
#include <stdio.h>
#include <string.h>

#include "base/file.h"
#include "base/file_write.h"
#include "cli/options/answer.h"
#include "cli/review/review_draft.h"
#include "render/signals.h"
#include "review/pace/work.h"
#include "review/run/run.h"

void review_take_answers(Journal *journal, const ReviewTask *task, Arena scratch)
{
    for (int i = 0; i < task->found_count; i++)
        journal_take_over(journal, task->found[i], scratch);
}

static bool copy(const char *from, const char *to, Arena scratch, Error *err)
{
    FileBytes bytes;
    return file_exists(to) || (file_read(from, SIZE_MAX, &scratch, &bytes, err) &&
                               file_write(to, bytes.data, bytes.size, err));
}

bool review_take_responses(const char *folder, const ReviewTask *task, Arena scratch,
                           Error *err)
{
    bool ok = true;
    DIR *names = opendir(task->responses);
    if (!names) return true; /* there are no sweeps */
    for (struct dirent *entry; ok && (entry = readdir(names));) {
        Arena room = scratch;
        if (strcmp(path_ending(entry->d_name), ".response") != 0) continue;
        ok = copy(arena_format(&room, "%s/%s", task->responses, entry->d_name),
                  arena_format(&room, "%s/%s", folder, entry->d_name), room, err);
    }
    closedir(names);
    return ok;
}

/* The mark alone distinguishes a part that is done from one that was stopped. */
static bool answer(ReviewRun *run, const ReviewTask *task, Arena *arena, Error *err)
{
    ReviewOutcome ignored;
    const char    done = 1;
    review_take_answers(run->journal, task, *arena);
    bool is_run = review_run(run, arena, &ignored, err);
    cli_print_warnings(run->problems);
    if (!is_run) return false;
    journal_add(run->journal, task->mark, &done, sizeof done);
    return journal_ok(run->journal, err);
}

static void report_stopped(const ReviewTask *task, Error *err)
{
    fprintf(stderr, "parhelion: %s: stopped by %s; what is done is kept — go on with: %s\n",
            task->name, signals_name((int)err->code - 128), task->resume_line);
    err->text[0] = '\0';
}

bool review_part(ReviewRun *run, const ReviewTask *task, const char *responses, Arena *arena,
                 Error *err)
{
    signals_watch();
    run->share = task->share;
    run->responses = responses ? responses : task->responses;
    run->responses_shown = "";
    run->lessons = task->responses;
    if (!folder_make(run->responses, err) || !folder_make(run->lessons, err) ||
        !journal_open(task->answers, arena, run->problems, &run->journal, err))
        return false;
    run->work->total = work_of_conditions(run->request, false) / run->share.count;
    bool ok = answer(run, task, arena, err);
    if (ok) progress_end(run->work, run->work->total);
    journal_close(run->journal);
    if (!ok && err->code > 128) report_stopped(task, err);
    return ok;
}
