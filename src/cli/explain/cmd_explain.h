/* SPDX-License-Identifier: Apache-2.0 */
/* cmd_explain.h -- the commands of this folder. */
#pragma once
#include "cli/options/command.h"

extern const Command command_explain;
extern const Command command_probe;
