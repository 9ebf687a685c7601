/* SPDX-License-Identifier: Apache-2.0 */
/* panel_emission.h -- what a panel emits at any angle (panel.h: frame and units). HOT.
 *
 * Threads  any number. Fails: never; a panel that emits nothing is dark.
 */
#pragma once
#include <stdbool.h>

#include "base/vec.h"
#include "panel/query/panel.h"
#include "spectrum/wavelengths.h"

/* XYZ in cd m^-2 that the panel sends along `direction` when a pixel's codes are rgb, each in
 * 0..255 (fractions are 16-bit codes scaled). M_black + E_R(r) + E_G(g) + E_B(b); never
 * negative. Below the surface (direction.z <= 0): zero.
 * Returns true where the value is measured, false where it is extrapolated beyond the cone. */
bool panel_emission_xyz(const Panel *panel, Vec3 direction, const float rgb[3], float xyz[3]);

/* The same as a spectral radiance, W m^-2 sr^-1 nm^-1: the primaries' measured spectra,
 * warped so that their tristimulus values are the measured ones (spectral_warp.h). */
Spectrum panel_emission_spectrum(const Panel *panel, Vec3 direction, const float rgb[3],
                                 const Wavelengths *wavelengths);

/* The same at every angle, code and wavelength. */
PanelPolarisation panel_polarisation(const Panel *panel);

/* Luminance in cd m^-2 averaged over the hemisphere with the cosine (luminous exitance / pi),
 * for codes rgb: what light sampling needs to weigh displays against other lights. */
float panel_mean_luminance(const Panel *panel, const float rgb[3]);
