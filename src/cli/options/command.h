/* SPDX-License-Identifier: Apache-2.0 */
/* command.h -- sub-commands: each a constant in its own file, listed in a table.
 *
 * Adding one touches its file, the header of its folder that declares it, and the table that
 * lists it (cli/commands.c, cli/panel/cmd_panel.c).
 */
#pragma once
#include <stdbool.h>

#include "base/arena.h"
#include "base/error.h"

typedef struct Command {
    const char *name;
    const char *summary; /* one line, lower case, no full stop */
    /* argv[0] is the command's name; everything it keeps lies in the arena, which its caller
     * releases. True: exit status 0; else the status of err->code. */
    bool (*run)(int argc, char **argv, Arena *arena, Error *err);
    const struct Command *const *sub; /* its own commands, or NULL */
    int sub_count;
} Command;

#define COMMANDS_MAX 32

/* The one of this name, or NULL and an ERROR_USAGE that lists them. within: "panel" for its own
 * commands, NULL for the program's. */
const Command *command_find(const Command *const *list, int count, const char *within,
                            const char *name, Error *err);
