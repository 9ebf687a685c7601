/* SPDX-License-Identifier: Apache-2.0 */
/* cmd_equip.h -- parhelion equip. */
#pragma once
#include "cli/options/command.h"

extern const Command command_equip;
