/* importers.h -- one row a foreign format; each stands in the file of its name.
 */
#pragma once
#include "import/import.h"

/* ---- scatter ---- */
extern const Importer importer_zemax, importer_lighttools, importer_mountain, importer_fred,
    importer_speos, importer_astm, importer_ssdd;

/* ---- columns and matrices ---- */
extern const Importer importer_text;
