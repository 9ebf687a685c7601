/* SPDX-License-Identifier: Apache-2.0 */
/* import_beside.h -- measurements beside a set's tables: a gamma table of white alone; a
 * reflectometer's table or gloss meters' readings of a reflection.
 *
 * Units    cd m^-2; degrees, nm, reflectances of 1, gloss units.
 * Memory   the set's arena. Threads: one at a time.
 * Fails    with the table's file and line (panel/set/level_table.h, specular_table.h), or when
 *          the set has nothing to which it would belong.
 */
#pragma once
#include "import/set/import.h"
#include "panel/set/specular_table.h"

/* Reads the table, holds it against the set's white and keeps it in the set. level_max: the
 * highest code, 0: not stated. */
bool import_beside_levels(const char *file, double level_max, ImportSet *set, Error *err);

/* file NULL and no gloss: nothing is added. */
typedef struct ImportSpecular {
    const char *file;
    double      aperture_deg; /* full angle; 0: the mirror alone */
    Gloss       gloss;
} ImportSpecular;

bool import_beside_specular(const ImportSpecular *asked, ImportSet *set, Error *err);
