/* SPDX-License-Identifier: Apache-2.0 */
/* ray_option.h -- the file of rays that a command of this folder writes if it is requested. */
#pragma once
#include "base/error.h"

/* Before anything is read: may rays be written there? path: NULL where none is requested. */
bool ray_option_check(const char *path, Error *err);
