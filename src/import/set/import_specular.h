/* SPDX-License-Identifier: Apache-2.0 */
/* import_specular.h -- a reflectometer's table or gloss meters' readings beside a reflection.
 *
 * Units    degrees, nm, reflectances of 1, gloss units. Memory: the set's arena. Threads: one
 *          at a time.
 * Fails    with the table's file and line (panel/set/specular_table.h), or when the set has no
 *          reflection to which it would belong.
 */
#pragma once
#include "import/set/import.h"
#include "panel/set/specular_table.h"

/* file NULL and no gloss: nothing is added. */
typedef struct ImportSpecular {
    const char *file;
    double      aperture_deg; /* full angle; 0: the mirror alone */
    Gloss       gloss;
} ImportSpecular;

bool import_specular(const ImportSpecular *asked, ImportSet *set, Error *err);
