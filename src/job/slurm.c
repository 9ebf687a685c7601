/* SPDX-License-Identifier: Apache-2.0 */
#include "job/slurm.h"

#include <errno.h>
#include <fcntl.h>
#include <signal.h>
#include <spawn.h>
#include <stdlib.h>
#include <string.h>
#include <sys/wait.h>
#include <unistd.h>

#define SAID_MAX ((size_t)1 << 23) /* a line of 30 bytes for each of 100,000 tasks, and more */

extern char **environ;

/* Reads stdout and stderr as they come; beyond SAID_MAX they are dropped. */
static void listen_to(int handle, char *said)
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

/* The programs of Slurm that are started, by name and no others. */
typedef enum Tool { TOOL_SUBMIT, TOOL_QUEUE, TOOL_NODES } Tool;

static const char *const tools[] = {
    [TOOL_SUBMIT] = "sbatch", [TOOL_QUEUE] = "squeue", [TOOL_NODES] = "sinfo"};

/* 0, or errno. The signals that this program ignores are the other's to decide on. */
static int start(Tool tool, char *const words[], int output, pid_t *child)
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
    int reason = posix_spawnp(child, tools[tool], &actions, &attributes, words, environ);
    posix_spawnattr_destroy(&attributes);
    posix_spawn_file_actions_destroy(&actions);
    return reason;
}

/* 0, or errno; *status as waitpid has it. */
static int run(Tool tool, char *const words[], char *said, int *status)
{
    int   ends[2];
    pid_t child;
    if (pipe2(ends, O_CLOEXEC) != 0) return errno;
    int reason = start(tool, words, ends[1], &child);
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

/* What it said, in the arena; false where it cannot be started or failed. */
static bool query(Tool tool, char *words[], Arena *arena, char **said, Error *err)
{
    int   status = 0;
    char *heard = ARENA_NEW(arena, char, SAID_MAX);
    words[0] = arena_string(arena, tools[tool], strlen(tools[tool]));
    int   reason = run(tool, words, heard, &status);
    if (reason)
        return error_set(err, ERROR_INPUT, "%s cannot be started: %s", words[0],
                         strerror(reason));
    if (status != 0)
        return error_set(err, ERROR_INPUT, "%s failed: %.500s", words[0], last_line(heard));
    *said = heard;
    return true;
}

bool slurm_submit(const SlurmScript *script, Arena *arena, const char **id, Error *err)
{
    char *said, *words[6] = {NULL, "--parsable"};
    int   count = 2;
    Arena scratch = *arena;
    if (script->tasks) words[count++] = arena_format(&scratch, "--array=%s", script->tasks);
    if (script->after)
        words[count++] = arena_format(&scratch, "--dependency=afterany:%s", script->after);
    words[count] = arena_string(&scratch, script->file, strlen(script->file));
    if (!query(TOOL_SUBMIT, words, &scratch, &said, err)) return false;
    const char *found = find_id(said, &scratch);
    if (!found)
        return error_set(err, ERROR_INPUT, "sbatch gave no number of a job: %.500s",
                         last_line(said));
    *id = arena_string(arena, found, strlen(found));
    return true;
}

bool slurm_queue(const char *jobs, Arena *arena, const char **lines, Error *err)
{
    char *said, *words[] = {NULL, "--noheader", "--array", "--format=%i %T",
                            arena_format(arena, "--jobs=%s", jobs), NULL};
    if (!query(TOOL_QUEUE, words, arena, &said, err)) return false;
    *lines = said;
    return true;
}

/* As sbatch does, it looks at the partition that the environment names; of all, where it names
 * none. */
bool slurm_features(Arena *arena, const char **lines, Error *err)
{
    const char *partition = getenv("SBATCH_PARTITION");
    char       *said, *words[5] = {NULL, "--noheader", "--format=%f"};
    if (partition && partition[0])
        words[3] = arena_format(arena, "--partition=%s", partition);
    if (!query(TOOL_NODES, words, arena, &said, err)) return false;
    *lines = said;
    return true;
}
