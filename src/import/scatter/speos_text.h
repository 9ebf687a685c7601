/* SPDX-License-Identifier: Apache-2.0 */
/* speos_text.h -- the text form of Speos' .anisotropicbsdf and .brdf.
 *
 * Memory   the arena's. Threads: no shared state.
 * Fails    with the file, the line, what was found and what was required.
 */
#pragma once
#include "import/scatter/speos_table.h"

bool speos_text_read(const char *file, Arena *arena, Speos *out, Error *err);
