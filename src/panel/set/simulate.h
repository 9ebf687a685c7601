/* SPDX-License-Identifier: Apache-2.0 */
/* simulate.h -- a virtual Fourier-optics instrument that measures a synthetic panel.
 *
 * Writes a measurement set (assets/schemas): MANIFEST.json, tables in emission/ and brdf/ (one
 * file an incidence, one column a wavelength) and primaries.csv. The instrument sees all
 * azimuths up to its cone; its own width shows in the image of a mirror-like reflection only:
 * emission and haze are taken as smooth over that width.
 *
 * Noise    normal, a hash of (seed, table, value): the same set on every run.
 */
#pragma once
#include "base/progress.h"
#include "panel/set/synthetic_panel.h"

/* `folder` and its sub-folders are made when absent; existing files are replaced. */
bool simulate_measurement(const SyntheticPanel *panel, const char *folder, ProgressMode mode,
                          Error *err);
