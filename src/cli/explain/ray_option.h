/* SPDX-License-Identifier: Apache-2.0 */
/* ray_option.h -- the file of rays that a command of this folder writes if it is asked to. */
#pragma once
#include "cli/options/cli.h"

/* Before anything is read: may rays be written there? path: NULL where nobody asks. Never over
 * a file that the command reads. */
bool ray_option_check(const char *path, const Cli *cli, Error *err);
