/* SPDX-License-Identifier: Apache-2.0 */
/* The commands of the program that tests/hostile/run.py meets models with, in the place of
 * src/cli/commands.c: the others would be built for nothing. */
#include "base/count.h"
#include "cli/commands.h"
#include "cli/render/cmd_render.h"

const Command *const command_table[] = {&command_check, &command_render, &command_help};
const int            command_count = COUNT_OF(command_table);
