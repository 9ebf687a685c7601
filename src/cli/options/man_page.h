/* SPDX-License-Identifier: Apache-2.0 */
/* man_page.h -- commands as the sources of manual pages of section 1, by the tables that --help
 * prints: `parhelion help --man NAME`. Fails: never.
 */
#pragma once
#include "cli/options/command.h"
#include "cli/options/option.h"

/* common: the options that every command has. */
void man_page_print_command(const CliCommand *command, const Option *common, int common_count);

/* A command that only has commands of its own. */
void man_page_print_group(const Command *group);

/* The program's. */
void man_page_print_program(const char *summary, const Command *const *commands, int count);
