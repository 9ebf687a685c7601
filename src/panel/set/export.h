/* SPDX-License-Identifier: Apache-2.0 */
/* export.h -- a panel's tables written back as a measurement set.
 *
 * MANIFEST.json, emission/ at every stored level and black, primaries.csv, brdf/ at the
 * measured incidences and wavelengths; of several spots in a folder for each, spot_1/ and on;
 * a uniformity map as uniformity.csv; `panel fit` reads it again. The numbers are what the
 * panel answers, so within its stated bound of what was measured. The mirror part, a delta,
 * is drawn as an instrument of a stated width sees it; the manifest declares that width, and a
 * fit takes it out again.
 *
 * Units    degrees; XYZ with Y in cd m^-2; sr^-1 without the cosine; nm. Decimal figures enough
 *          for float32. Every file states them in a comment.
 * Fails    with the folder or file that cannot be written; a folder that holds something
 *          already is left as it is. Nothing half-written stays.
 */
#pragma once
#include "base/error.h"
#include "base/progress.h"
#include "panel/query/panel_info.h"

typedef struct ExportOptions {
    double theta_step_deg, phi_step_deg; /* 0: 1 and 3, of reflection 0.5 and 1 */
    bool extrapolates;                   /* up to 90 degrees, beyond the measured cone */
    double mirror_fwhm_deg;              /* below 0: 2.4 steps; 0: the mirror part is left out */
    ProgressMode progress;
} ExportOptions;

/* name: the panel's file, for the note in the manifest. */
bool panel_export(const Panel *panel, const char *name, const ExportOptions *options,
                  const char *folder, Error *err);

/* One table as a file: "black", "white 255", "red 127.5" (any code), "primaries", "brdf 30"
 * or "brdf 30 at 90" (incidence and azimuth of the light, degrees; any incidence). */
bool panel_export_table(const Panel *panel, const char *table, const ExportOptions *options,
                        const char *file, Error *err);
