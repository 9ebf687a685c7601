/* The formats, in the order in which they are asked whether a file is theirs: those with a sure
 * mark first, text of any layout last. */
#include "import/importers.h"

const Importer *const importers[] = {
    &importer_fred, &importer_mountain, &importer_zemax, &importer_lighttools,
    &importer_speos, &importer_astm, &importer_ssdd, &importer_window,
    &importer_rgl, &importer_pbsdf, &importer_merl, &importer_spreadsheet,
    &importer_ies, &importer_eulumdat,
    &importer_text,
    NULL,
};
