/* SPDX-License-Identifier: Apache-2.0 */
/* import_write.h -- an imported set as MANIFEST.json and its tables.
 *
 * Fails    with the file that cannot be written, or that is one of those to import: nothing
 *          half-written stays (panel/set/set_writer.h).
 */
#pragma once
#include "import/set/import.h"

/* The file's name of a table in the set: "emission/red_031.csv", "brdf/i30_a180.csv". */
const char *import_table_file(const ImportSet *set, const ImportTable *table, Arena *arena);

/* Writes the tables beside the manifest (folders emission/ and brdf/), then the manifest. The
 * set is complete. */
bool import_write(const ImportSet *set, const char *manifest, Error *err);
