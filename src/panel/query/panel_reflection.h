/* panel_reflection.h -- what a panel reflects at any angles (panel.h: frame and units). HOT.
 *
 * Threads  any number. Fails: never; a panel without reflection data is black.
 */
#pragma once
#include <stdbool.h>

#include "base/vec.h"
#include "panel/query/panel.h"
#include "spectrum/wavelengths.h"

/* Has reflection data? Without them a panel reflects nothing. */
bool panel_reflects(const Panel *panel);

/* BRDF without the mirror part, sr^-1 per lane. wo: to the eye, wi: to the light. 0 when
 * either is below the surface. */
Spectrum panel_brdf(const Panel *panel, Vec3 wo, Vec3 wi, const Wavelengths *wavelengths);

/* Mirror reflectance (delta part), per lane, for a direction at cos_theta to the normal. */
Spectrum panel_mirror(const Panel *panel, float cos_theta, const Wavelengths *wavelengths);

/* Directional-hemispherical reflectance without the mirror part, mean over the lanes'
 * luminous weight: the probability of haze against mirror. */
float panel_haze_albedo(const Panel *panel, float cos_theta);
