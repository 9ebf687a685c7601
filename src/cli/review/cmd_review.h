/* SPDX-License-Identifier: Apache-2.0 */
/* cmd_review.h -- the command of this folder. */
#pragma once
#include "cli/options/command.h"

extern const Command command_review;
