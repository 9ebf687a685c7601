/* SPDX-License-Identifier: Apache-2.0 */
/* speos_binary.h -- the binary form of Speos' .anisotropicbsdf, known from one public file of
 * version 9.0: every field that is not understood must have the value that it has there.
 *
 * Memory   the arena's. Threads: no shared state.
 * Fails    with the file and the byte.
 */
#pragma once
#include "import/scatter/speos_table.h"

bool speos_binary_read(const char *file, Arena *arena, Speos *out, Error *err);
