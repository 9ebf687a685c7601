/* SPDX-License-Identifier: Apache-2.0 */
/* tensor_tree.h -- Radiance's tensor tree as tables.
 *
 * Memory   the set's arena. Threads: one set per thread.
 * Fails    with the file, the line, what was found and what was required.
 */
#pragma once
#include "import/scatter/window_xml.h"

/* nm: the one wavelength of the values; it stays. */
bool tensor_tree_add(const WindowXml *in, const float *nm, ImportSet *set, Error *err);
