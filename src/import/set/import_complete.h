/* SPDX-License-Identifier: Apache-2.0 */
/* import_complete.h -- from the tables of many files to one set.
 *
 * Memory   the set's arena. Threads: one set per thread.
 * Fails    with the file or the role that is missing, twice or not as the others.
 */
#pragma once
#include "import/set/import.h"

/* Makes of the tables a set: applies references, joins X, Y and Z and wavelengths that lie in
 * several tables, takes the mean where one direction stands twice, fills by symmetry, gives
 * normal incidence to every azimuth of the light, and checks what a manifest needs. */
bool import_complete(ImportSet *set, Error *err);
