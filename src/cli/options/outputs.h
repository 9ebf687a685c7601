/* SPDX-License-Identifier: Apache-2.0 */
/* outputs.h -- an output never replaces an input: one rule for every command. cli_parse holds it
 * for all that is typed; a command for what it finds named inside files, before its work.
 *
 * Threads  one at a time.
 * Fails    ERROR_OUTPUT with the output and its option.
 */
#pragma once
#include "cli/options/cli.h"

/* One that is not typed, such as a checkpoint's usual name. `path` must outlive it. */
void outputs_note(Cli *cli, const char *option, const char *path);

/* Whether no output is one of these files, which are read; those that are not there are fine,
 * and NULL. */
bool outputs_spare(const Cli *cli, const char *const *files, int count, Error *err);

/* The same of all words of the command line, as they name files: FILE, NAME=FILE, kind:FILE. */
bool outputs_spare_words(const Cli *cli, const CliTexts *words, Error *err);
