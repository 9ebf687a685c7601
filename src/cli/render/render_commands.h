/* SPDX-License-Identifier: Apache-2.0 */
/* render_commands.h -- the sub-commands that make frames. */
#pragma once
#include "cli/options/command.h"

extern const Command command_merge;
extern const Command command_render;
