/* SPDX-License-Identifier: Apache-2.0 */
/* help_json.h -- what --help says as JSON: `parhelion help --json` is one document of every
 * command, from which the build makes the manual pages and what bash completes
 * (assets/install/pages.py).
 *
 * Fails    where stdout cannot be written.
 */
#pragma once
#include "cli/options/answer.h"
#include "cli/options/command.h"

/* common: the options that every command has. */
bool help_json_command(const CliCommand *command, const Option *common, int common_count,
                       Error *err);

/* A document whose last member is "commands", each of them by its own --help --json. head: its
 * other members, which it releases. */
bool help_json_group(json_t *head, const Command *const *commands, int count, Arena *arena,
                     Error *err);
