/* SPDX-License-Identifier: Apache-2.0 */
/* completion.h -- what bash completes a command line of parhelion by, from the tables that
 * --help prints: `parhelion help --completion bash`. It begins with a shell function that knows
 * each command by a row; completion.bash, behind it, does the work. Fails: never.
 */
#pragma once
#include "cli/options/command.h"

/* A row: options that take a value and those that take none, values from lists, files. */
void completion_print_command(const CliCommand *command, const Option *common,
                              int common_count);

/* A row of commands; name "": the program's. */
void completion_print_group(const char *name, const Command *const *commands, int count);

/* Before the first row and after the last. */
void completion_print_head(void);
void completion_print_tail(void);
