/* SPDX-License-Identifier: Apache-2.0 */
/* import_reference.h -- what an instrument reads without light, and white references.
 *
 * Memory   the set's arena. Threads: one set per thread.
 */
#pragma once
#include "import/set/import.h"

/* Subtracts the dark and divides signals by the white reference's; then both leave the set. */
bool import_apply_references(ImportSet *set, Error *err);
