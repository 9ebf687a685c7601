/* SPDX-License-Identifier: Apache-2.0 */
/* cmd_help.h -- what `parhelion`, `parhelion --help` and `parhelion help` print alike. */
#pragma once
#include <stdio.h>

/* The commands and the guides, a line each. */
void cmd_help_print(FILE *out);
