/* SPDX-License-Identifier: Apache-2.0 */
/* compare_request.h -- what was asked of `parhelion compare`.
 *
 * Memory   texts are the command line's or the arena's. Threads: one at a time.
 * Fails    ERROR_USAGE with the option, what was found and what was wanted.
 */
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
