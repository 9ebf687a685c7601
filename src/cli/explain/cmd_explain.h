/* SPDX-License-Identifier: Apache-2.0 */
/* cmd_explain.h -- the command of this folder. */
#pragma once
#include "cli/options/command.h"

extern const Command command_explain;
