/* SPDX-License-Identifier: Apache-2.0 */
/* exr_header.h -- a look at an OpenEXR file's header before the library reads it.
 *
 * The library takes memory for an attribute of any size that a file states, before it finds
 * that the file ends: a kilobyte could ask for two gigabytes.
 *
 * Memory   none. Threads: no shared state.
 */
#pragma once
#include <stddef.h>

#include "base/error.h"
#ifdef __cplusplus
extern "C" {
#endif

/* So much of a file's start is enough to look at. */
#define EXR_HEADER_BYTES ((size_t)1 << 20)

/* bytes: the first `size` of a file of file_size bytes. Refuses an attribute that the file
 * cannot hold. What lies behind the bytes given, and what else is wrong with the header, is
 * left to the library. */
bool exr_check_header(const unsigned char *bytes, size_t size, size_t file_size, Error *err);

#ifdef __cplusplus
}
#endif
