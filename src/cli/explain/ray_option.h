/* SPDX-License-Identifier: Apache-2.0 */
/* ray_option.h -- the file of rays that a command of this folder writes if it is asked to. */
#pragma once
#include "base/error.h"

/* Before anything is read: may rays be written there? path: NULL where nobody asks. */
bool ray_option_check(const char *path, Error *err);
