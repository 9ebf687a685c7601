/* parhelion: physically correct frames of dashboards with measured displays.
 * The sub-commands stand in commands.c; the exit status is the code of the error. */
#include <errno.h>
#include <fcntl.h>
#include <signal.h>
#include <stdio.h>
#include <string.h>
#include <unistd.h>

#include "base/machine.h"
#include "bvh/bvh.h"
#include "cli/cmd_help.h"
#include "cli/commands.h"
#include "cli/options/answer.h"
#include "render/render.h"

static void print_version(void)
{
    const Kernel *kernel;
    Error         err;
    bool          chosen = kernel_choose(NULL, &kernel, &err);
    printf("parhelion %s\nsources: %s\ninstruction set: %s\nlibraries: %s, %s\n",
           PARHELION_VERSION, SOURCES_HASH, chosen ? kernel->isa : "none", bvh_library(),
           LIBRARY_VERSIONS);
}

static bool run_command(int argc, char **argv, Error *err)
{
    const char    *nearest;
    const Command *command = command_find(command_table, command_count, argv[1], &nearest);
    if (!command)
        return error_set(
            err, ERROR_USAGE, "unknown command %s — %s%s%s`parhelion --help` lists them",
            argv[1], nearest ? "did you mean " : "", nearest ? nearest : "",
            nearest ? "? " : "");
    /* address space: what is touched counts */
    Arena arena = arena_reserve(machine_memory_bytes());
    bool  ok = command->run(argc - 1, argv + 1, &arena, err);
    arena_release(&arena);
    return ok;
}

static bool asks_for_json(int argc, char **argv)
{
    for (int i = 1; i < argc && strcmp(argv[i], "--"); i++)
        if (!strcmp(argv[i], "--json")) return true;
    return false;
}

/* A reader who goes away and a limit on files' sizes are errors of the write, with a line and a
 * status, instead of a death that leaves hours of work nowhere. */
static void ignore_deadly_signals(void)
{
    signal(SIGPIPE, SIG_IGN);
    signal(SIGXFSZ, SIG_IGN);
}

/* Where standard streams are closed, a frame that is opened must not become one of them. */
static void fill_streams(void)
{
    int handle;
    do handle = open("/dev/null", O_RDWR);
    while (handle >= 0 && handle <= STDERR_FILENO);
    if (handle > STDERR_FILENO) close(handle);
}

/* What was printed to a full disk or a closed pipe has not been said. */
static bool check_stdout(Error *err)
{
    errno = 0;
    if (!fflush(stdout) && !ferror(stdout)) return true;
    return error_at(err, ERROR_OUTPUT, "stdout", NULL, "cannot be written: %s",
                    strerror(errno ? errno : EIO));
}

static int report(const Error *err, bool json)
{
    if (err->text[0]) cli_report_error(err, json);
    return error_exit_status(err->code);
}

int main(int argc, char **argv)
{
    Error err = {0};
    ignore_deadly_signals();
    fill_streams();
    if (argc < 2) {
        cmd_help_print(stderr);
        return error_exit_status(ERROR_USAGE);
    }
    if (!strcmp(argv[1], "--version"))
        print_version();
    else if (!strcmp(argv[1], "--help"))
        cmd_help_print(stdout);
    else if (!run_command(argc, argv, &err))
        return report(&err, asks_for_json(argc, argv));
    return check_stdout(&err) ? 0 : report(&err, false);
}
