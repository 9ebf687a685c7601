/* commands.h -- the table of sub-commands: what main.c runs and `parhelion help` lists. */
#pragma once
#include <stdbool.h>

#include "base/error.h"

typedef struct Command {
    const char *name;
    const char *summary; /* one line, lower case, no full stop */
    bool (*run)(int argc, char **argv, Error *err); /* argv[0] is the name */
} Command;

extern const Command command_table[];
extern const int     command_count;
