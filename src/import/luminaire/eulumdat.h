/* SPDX-License-Identifier: Apache-2.0 */
/* eulumdat.h -- the intensities of an EULUMDAT file.
 *
 * Memory   the set's arena. Threads: no shared state.
 * Fails    with the file, the line, what was found and what was required.
 */
#pragma once
#include "import/luminaire/luminaire.h"

/* `bytes`: the file's, where they are there already; NULL: it is read here. Notes on what was
 * assumed or left out go to the set. */
bool eulumdat_read_luminaire(const char *file, const FileBytes *bytes, ImportSet *set,
                             Luminaire *out, Error *err);
