/* SPDX-License-Identifier: Apache-2.0 */
/* ocio_file.h -- a file of an OpenColorIO configuration is looked over before the library opens
 * it, which would wait at a pipe, read a device for ever, and follow what a table refers to.
 *
 * Memory   scratch of its own, gone at return.
 * Threads  no shared state.
 * Fails    ERROR_INPUT with the file.
 */
#pragma once
#include "base/error.h"

#define OCIO_FILE_BYTES_MAX ((size_t)256 << 20)

/* The configuration itself, or a table that it names. */
bool ocio_file_check(const char *path, Error *err);
