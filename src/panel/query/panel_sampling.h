/* SPDX-License-Identifier: Apache-2.0 */
/* panel_sampling.h -- directions drawn as a panel's reflection is distributed (panel.h). HOT.
 *
 * Threads  any number. Fails: never; there may be no direction.
 */
#pragma once
#include <stdbool.h>

#include "base/vec.h"
#include "panel/query/panel.h"

/* Density, sr^-1, with which panel_sample chooses wi for this wo (the haze and its lambertian
 * part; the discrete mirror lobe is the caller's). Integrates to one over the hemisphere. */
float panel_pdf(const Panel *panel, Vec3 wo, Vec3 wi);

/* Chooses wi for wo; u in [0,1)^3. *pdf is panel_pdf of wi, to rounding. False: no direction
 * (wo below the surface, no data). */
bool panel_sample(const Panel *panel, Vec3 wo, const float u[3], Vec3 *wi, float *pdf);
