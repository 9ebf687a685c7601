/* luminaire_read.h -- a luminaire file of either format: EULUMDAT by its ending (.ldt), else
 * IES LM-63.
 *
 * Memory   the set's arena. Threads: no shared state.
 * Fails    with the file, the line, what was found and what was wanted.
 */
#pragma once
#include "import/luminaire/luminaire.h"

/* Notes on what was assumed or left out go to the set. */
bool luminaire_read(const char *file, ImportSet *set, Luminaire *out, Error *err);
