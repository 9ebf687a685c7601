/* SPDX-License-Identifier: Apache-2.0 */
/* man_page.h -- the sources of manual pages: commands in section 1, by the tables that --help
 * prints, and guides in section 7. `parhelion help --man NAME`. Fails: never.
 */
#pragma once
#include "cli/options/command.h"
#include "cli/options/guides.h"

/* common: the options that every command has. */
void man_page_print_command(const CliCommand *command, const Option *common, int common_count);

/* A command that only has commands of its own. */
void man_page_print_group(const Command *group);

/* The program's. */
void man_page_print_program(const char *summary, const Command *const *commands, int count);

/* Of Markdown it knows what guides use: headings, paragraphs, lists, tables, blocks of code,
 * and what stands within lines. */
void man_guide_print(const Guide *guide);
