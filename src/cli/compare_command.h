/* compare_command.h -- the parts of `parhelion compare`; private to src/cli. */
#pragma once
#include "cli/options/cli.h"
#include "compare/compare.h"

typedef struct CompareRequest {
    const char    *reference, *test; /* two files or two folders */
    const char    *report, *junit;   /* NULL: none */
    bool           allow_extra;
    CompareOptions options;
    Cli            cli;
} CompareRequest;

/* True with cli.help_shown when only help was asked for. */
bool compare_parse(int argc, char **argv, Arena *arena, CompareRequest *out, Error *err);

/* Metrics, notes and the verdict of two files. */
void compare_print_pair(const CompareRequest *request, const Comparison *c);

/* One line for a pair of two folders. */
void compare_print_line(const char *name, const Comparison *c);
