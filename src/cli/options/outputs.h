/* SPDX-License-Identifier: Apache-2.0 */
/* outputs.h -- an output never replaces an input: one rule for every command. cli_parse holds
 * it for all that is typed; a command for what it finds named inside files, before its work.
 *
 * Threads  one at a time.
 * Fails    ERROR_OUTPUT with the output and its option.
 */
#pragma once
#include "base/error.h"
#include "cli/options/command.h"

#define OUTPUTS_MAX 12

typedef struct Output {
    const char *option, *path;
} Output;

/* The files that a command will write. */
typedef struct Outputs {
    Output list[OUTPUTS_MAX];
    int count;
} Outputs;

/* One that is not typed, such as a checkpoint's usual name. `path` must outlive it. */
void outputs_note(Outputs *outputs, const char *option, const char *path);

/* Whether no output is one of these files, which are read; those that are not there are fine,
 * and NULL. */
bool outputs_spare(const Outputs *outputs, const char *const *files, int count, Error *err);

/* The same of all words of the command line, as they name files: FILE, NAME=FILE, kind:FILE. */
bool outputs_spare_words(const Outputs *outputs, const CliTexts *words, Error *err);
