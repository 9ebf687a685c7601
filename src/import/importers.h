/* SPDX-License-Identifier: Apache-2.0 */
/* importers.h -- one row a foreign format; each stands in the file of its name.
 */
#pragma once
#include "import/set/import.h"

/* ---- scatter ----------------------------------------------------------------------------- */
extern const Importer importer_zemax, importer_speos, importer_astm, importer_rgl, importer_merl;

/* ---- luminaires -------------------------------------------------------------------------- */
extern const Importer importer_eulumdat, importer_ies;

/* ---- columns and matrices ---------------------------------------------------------------- */
extern const Importer importer_text;

/* All importers (importers.c), in the order in which they are tried; ends with a NULL. */
extern const Importer *const importers[];

/* Reads a file with the importer that --format names, or that recognises it. */
bool import_file(const char *file, const ImportOptions *options, ImportSet *set, Error *err);
