/* SPDX-License-Identifier: Apache-2.0 */
/* render_commands.h -- the command of this folder. */
#pragma once
#include "cli/options/command.h"

extern const Command command_render;
