/* SPDX-License-Identifier: Apache-2.0 */
/* primaries.h -- spectra of the primaries: a column of wavelengths, one each for red, green and
 * blue, and one for black if it was measured.
 *
 * Memory   the set's arena. Threads: one set per thread.
 * Fails    with the file, the line, what was found and what was required.
 */
#pragma once
#include "import/set/import.h"
#include "import/text/text_options.h"

bool primaries_read(const char *file, const TextOptions *options, ImportSet *set, Error *err);
