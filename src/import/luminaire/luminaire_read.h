/* SPDX-License-Identifier: Apache-2.0 */
/* luminaire_read.h -- a luminaire file of either format: EULUMDAT by its ending (.ldt), else
 * IES LM-63.
 *
 * Memory   the set's arena. Threads: no shared state.
 * Fails    with the file, the line, what was found and what was required.
 */
#pragma once
#include "import/luminaire/luminaire.h"

bool luminaire_is_eulumdat(const char *file);

/* The file's bytes; `file` names them. Notes on what was assumed or left out go to the set. */
bool luminaire_read(const char *file, FileBytes bytes, ImportSet *set, Luminaire *out, Error *err);
