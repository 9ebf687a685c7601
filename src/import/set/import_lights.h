/* SPDX-License-Identifier: Apache-2.0 */
/* import_lights.h -- the lights and directions that a set must have: every incidence at every
 * azimuth, with what a symmetric sample spared.
 *
 * Memory   the set's arena. Threads: one set per thread.
 */
#pragma once
#include "import/set/import.h"

/* Several azimuths of light that is not normal make the material anisotropic, unless the user
 * states otherwise; one is as good as any other and becomes 180. */
void import_find_anisotropy(ImportSet *set);

/* Fills directions and lights by the set's symmetry. */
bool import_mirror(ImportSet *set, Error *err);

/* Gives normal incidence to every azimuth of the light. */
bool import_complete_lights(ImportSet *set, Error *err);

/* Is every incidence there at every azimuth, with the same wavelengths? */
bool import_check_lights(const ImportSet *set, Error *err);
