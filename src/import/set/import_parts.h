/* SPDX-License-Identifier: Apache-2.0 */
/* import_parts.h -- files that hold parts of one table: sections of one azimuth, one of X, Y
 * and Z, one wavelength.
 *
 * Memory   the set's arena. Threads: one set per thread.
 * Fails    with the file that has a part twice or lacks one.
 */
#pragma once
#include "import/set/import.h"

/* Joins them, so that every pattern and light has one table. Luminance alone gets the
 * chromaticity of the primaries' spectra, or that of D65. */
bool import_join_parts(ImportSet *set, Error *err);
