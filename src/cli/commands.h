/* SPDX-License-Identifier: Apache-2.0 */
/* commands.h -- the sub-commands: what main.c runs and `parhelion help` lists. */
#pragma once
#include "cli/options/command.h"

extern const Command *const command_table[];
extern const int command_count;

/* Those of this folder. */
extern const Command command_check;
extern const Command command_compare;
extern const Command command_develop;
extern const Command command_equip;
extern const Command command_help;
extern const Command command_measure;
extern const Command command_merge;
extern const Command command_schema;
extern const Command command_sky;
