/* SPDX-License-Identifier: Apache-2.0 */
#include "cli/job/sbatch.h"

#include <errno.h>
#include <fcntl.h>
#include <signal.h>
#include <spawn.h>
#include <string.h>
#include <sys/wait.h>
#include <unistd.h>

#define SAID_MAX 8192

extern char **environ;

/* Reads sbatch's stdout and stderr as they come; beyond SAID_MAX they are dropped. */
static void listen_to(int handle, char said[SAID_MAX])
{
    size_t  size = 0;
    char    rest[512];
    ssize_t got;
    for (;;) {
        bool is_full = size + 1 == SAID_MAX;
        got = read(handle, is_full ? rest : said + size,
                   is_full ? sizeof rest : SAID_MAX - 1 - size);
        if (got < 0 && errno == EINTR) continue;
        if (got <= 0) break;
        if (!is_full) size += (size_t)got;
    }
    said[size] = '\0';
}

/* 0, or errno. The signals that this program ignores are sbatch's to decide on. */
static int start(char *const words[], int output, pid_t *child)
{
    posix_spawn_file_actions_t actions;
    posix_spawnattr_t          attributes;
    sigset_t                   signals;
    sigemptyset(&signals);
    sigaddset(&signals, SIGPIPE);
    sigaddset(&signals, SIGXFSZ);
    posix_spawn_file_actions_init(&actions);
    posix_spawn_file_actions_adddup2(&actions, output, STDOUT_FILENO);
    posix_spawn_file_actions_adddup2(&actions, output, STDERR_FILENO);
    posix_spawnattr_init(&attributes);
    posix_spawnattr_setsigdefault(&attributes, &signals);
    posix_spawnattr_setflags(&attributes, POSIX_SPAWN_SETSIGDEF);
    int reason = posix_spawnp(child, "sbatch", &actions, &attributes, words, environ);
    posix_spawnattr_destroy(&attributes);
    posix_spawn_file_actions_destroy(&actions);
    return reason;
}

/* 0, or errno; *status as waitpid has it. */
static int run(char *const words[], char said[SAID_MAX], int *status)
{
    int   ends[2];
    pid_t child;
    if (pipe2(ends, O_CLOEXEC) != 0) return errno;
    int reason = start(words, ends[1], &child);
    close(ends[1]);
    if (!reason) {
        listen_to(ends[0], said);
        while (waitpid(child, status, 0) < 0 && errno == EINTR) {}
    }
    close(ends[0]);
    return reason;
}

static const char *last_line(char *said)
{
    size_t length = strlen(said);
    while (length && (said[length - 1] == '\n' || said[length - 1] == ' '))
        said[--length] = '\0';
    const char *newline = strrchr(said, '\n');
    return newline ? newline + 1 : said;
}

/* --parsable prints "NUMBER" or "NUMBER;CLUSTER" on a line; warnings may stand before it. */
static const char *find_id(const char *said, Arena *arena)
{
    for (const char *line = said;; line++) {
        size_t digits = strspn(line, "0123456789");
        if (digits && line[digits] && strchr(";\n", line[digits]))
            return arena_string(arena, line, digits);
        line = strchr(line, '\n');
        if (!line) return NULL;
    }
}

bool sbatch_submit(const char *script, const char *after, Arena *arena, const char **id,
                   Error *err)
{
    char  said[SAID_MAX] = "";
    int   status = 0;
    char *file = arena_string(arena, script, strlen(script));
    char *words[] = {"sbatch", "--parsable",
                     after ? arena_format(arena, "--dependency=afterany:%s", after) : file,
                     after ? file : NULL, NULL};
    int   reason = run(words, said, &status);
    if (reason)
        return error_set(err, ERROR_INPUT, "sbatch cannot be started: %s", strerror(reason));
    const char *found = status == 0 ? find_id(said, arena) : NULL;
    if (!found)
        return error_set(err, ERROR_INPUT, "sbatch %s: %.500s",
                         status == 0 ? "gave no number of a job" : "failed", last_line(said));
    *id = found;
    return true;
}
