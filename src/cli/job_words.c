/* SPDX-License-Identifier: Apache-2.0 */
#include "cli/job_words.h"

#include <errno.h>
#include <string.h>
#include <unistd.h>

static const char *progress_word(const Cli *cli, Arena *arena)
{
    static const char *const names[] = {
        [PROGRESS_AUTO] = "auto", [PROGRESS_BAR] = "bar", [PROGRESS_PLAIN] = "plain",
        [PROGRESS_JSON] = "json", [PROGRESS_NONE] = "none"};
    return cli->quiet ? "--quiet" : arena_format(arena, "--progress=%s", names[cli->progress]);
}

static void add(JobWords *words, const char *text, Arena *arena)
{
    words->list[words->count++] = arena_string(arena, text, strlen(text));
}

JobWords job_words(const SharedJob *job, const Cli *cli, const char *const *own, int own_count,
                Arena *arena)
{
    JobWords words = {ARENA_NEW(arena, char *, own_count + job->word_count + 3), 0};
    for (int i = 0; i < own_count; i++) add(&words, own[i], arena);
    add(&words, arena_format(arena, "--threads=%d", cli->threads), arena);
    add(&words, progress_word(cli, arena), arena);
    for (int i = 0; i < job->word_count; i++) add(&words, job->words[i], arena);
    return words;
}

bool job_enter(const SharedJob *job, Error *err)
{
    return chdir(job->folder) == 0 ||
           error_at(err, ERROR_INPUT, job->folder, "",
                    "cannot be entered: %s — the job was planned there", strerror(errno));
}
