/* SPDX-License-Identifier: Apache-2.0 */
/* parhelion: physically correct frames of dashboards with measured displays.
 * The sub-commands stand in commands.c; the exit status is that of their outcome. */
#include <errno.h>
#include <fcntl.h>
#include <signal.h>
#include <stdio.h>
#include <string.h>
#include <unistd.h>

#include "base/file.h"
#include "base/machine.h"
#include "cli/cmd_help.h"
#include "cli/commands.h"
#include "cli/options/answer.h"
#include "cli/options/cli.h"
#include "openimageio/image_file.h"
#include "render/signals.h"
#include "text/name_hint.h"

static Outcome run_command(int argc, char **argv, Error *err) {
    const Command *command = command_find(command_table, command_count, NULL, argv[1], err);
    if (!command || !machine_check_stack(err)) return OUTCOME_FAILED;
    image_file_take_share();
    /* address space: what is touched counts */
    Arena arena = arena_reserve(machine_memory_bytes());
    Outcome outcome = command->run(argc - 1, argv + 1, &arena, err);
    arena_release(&arena);
    return outcome;
}

static bool has_word(int argc, char **argv, const char *word) {
    for (int i = 1; i < argc && strcmp(argv[i], "--"); i++)
        if (!strcmp(argv[i], word)) return true;
    return false;
}

/* A reader who goes away and a limit on files' sizes are errors of the write, with a line and a
 * status, instead of a death that leaves hours of work nowhere. */
static void ignore_deadly_signals(void) {
    signal(SIGPIPE, SIG_IGN);
    signal(SIGXFSZ, SIG_IGN);
}

/* Where standard streams are closed, a frame that is opened must not become one of them. True:
 * stdout was open. If not it becomes one that refuses what is written: an answer that nobody
 * can have is reported, as on a full disk. */
static bool fill_streams(void) {
    bool has_stdout = fcntl(STDOUT_FILENO, F_GETFD) >= 0;
    int handle;
    do handle = open("/dev/null", has_stdout ? O_RDWR : O_RDONLY);
    while (handle >= 0 && handle <= STDERR_FILENO);
    if (handle > STDERR_FILENO) close(handle);
    return has_stdout;
}

/* Reports output that was lost to a full disk or a closed pipe. */
static bool check_stdout(Error *err) {
    errno = 0;
    if (!fflush(stdout) && !ferror(stdout)) return true;
    return error_at(err, ERROR_OUTPUT, "stdout", NULL, "cannot be written: %s",
                    strerror(errno ? errno : EIO));
}

/* The path of a table that OpenColorIO did not find, of its message; else the error's file. */
static const char *missing_file(const Error *err, char *buffer, size_t size) {
    static const char words[] = "The following attempts were made: '";
    const char *tried = strstr(err->text, words);
    if (!tried) return err->file;
    tried += sizeof words - 1;
    snprintf(buffer, size, "%.*s", (int)strcspn(tried, "'"), tried);
    return buffer;
}

/* Of an input that is not there, the one that may be meant. */
static void add_hint(Error *err) {
    char buffer[sizeof err->text];
    const char *path = missing_file(err, buffer, sizeof buffer);
    if (err->code != ERROR_INPUT || !path[0] || file_exists(path)) return;
    Arena arena = arena_reserve((size_t)1 << 30);
    const Error was = *err;
    const char *hint = name_hint(path, &arena);
    if (*hint && !strstr(err->text, hint))
        error_at(err, was.code, was.file, was.path, "%s%s", was.text, hint);
    arena_release(&arena);
}

static int report(Error *err, bool json) {
    add_hint(err);
    cli_report_error(err, json);
    return error_exit_status(err->code);
}

static int exit_status(Outcome outcome, const Error *err) {
    if (outcome == OUTCOME_STOPPED) return 128 + signals_stop_requested();
    return outcome == OUTCOME_FAILED ? error_exit_status(err->code) : outcome == OUTCOME_NO;
}

int main(int argc, char **argv) {
    Error err = {0};
    ignore_deadly_signals();
    bool has_stdout = fill_streams();
    Outcome outcome = OUTCOME_DONE;
    if (argc < 2) {
        cmd_help_print(stderr);
        return error_exit_status(ERROR_USAGE);
    }
    if (cli_is_version(argv[1])) version_print();
    else if (cli_is_help(argv[1])) cmd_help_print(stdout);
    else outcome = run_command(argc, argv, &err);
    bool wants_json = has_word(argc, argv, "--json");
    if (outcome == OUTCOME_FAILED && err.text[0]) return report(&err, wants_json);
    int status = exit_status(outcome, &err);
    if (outcome == OUTCOME_STOPPED) return status;
    /* what -o names is the answer; the line about it may go nowhere where none is read */
    if (!has_stdout && !wants_json && has_word(argc, argv, "-o")) return status;
    return check_stdout(&err) ? status : report(&err, false);
}
