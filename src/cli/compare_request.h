/* SPDX-License-Identifier: Apache-2.0 */
/* compare_request.h -- what was requested of `parhelion compare`.
 *
 * Memory   texts are the command line's or the arena's. Threads: one at a time.
 * Fails    ERROR_USAGE with the option, what was found and what was required; ERROR_INPUT with
 *          a line of --pairs.
 */
#pragma once
#include "cli/options/cli.h"
#include "compare/compare.h"

/* A line of --pairs: what goes for one pair of two folders. */
typedef struct ComparePair {
    const char *name;  /* of the picture in both, with or without its ending */
    const char *place; /* "line 3" */
    CompareOptions options;
} ComparePair;

typedef struct CompareRequest {
    const char *reference, *test;        /* two files or two folders */
    const char *report, *junit, *answer; /* files; NULL: none */
    bool allow_extra;
    CompareOptions options;
    const char *pairs_file; /* NULL: `options` go for every pair */
    ComparePair *pairs;
    int pair_count;
    Cli cli;
} CompareRequest;

extern const Answer compare_answers[]; /* cmd_compare.c */

/* True with cli.help_shown when only help was requested. */
bool compare_parse(int argc, char **argv, Arena *arena, CompareRequest *out, Error *err);
