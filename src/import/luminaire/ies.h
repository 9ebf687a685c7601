/* SPDX-License-Identifier: Apache-2.0 */
/* ies.h -- the intensities of an IES LM-63 file.
 *
 * Memory   the set's arena. Threads: no shared state.
 * Fails    with the file, the line, what was found and what was required.
 */
#pragma once
#include "import/luminaire/luminaire.h"

/* `bytes`: the file's, where they are there already; NULL: it is read here. Notes on what was
 * assumed or left out go to the set. */
bool ies_read_luminaire(const char *file, const FileBytes *bytes, ImportSet *set, Luminaire *out,
                        Error *err);

/* The tilt factors of a file that TILT= names. On failure *out is left as it was. */
bool ies_read_tilt(const char *file, const FileBytes *bytes, ImportSet *set, LuminaireTilt *out,
                   Error *err);
