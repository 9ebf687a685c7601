/* SPDX-License-Identifier: Apache-2.0 */
/* ambient.h -- contrast under diffuse light that comes evenly from the whole hemisphere.
 *
 *   C(d) = (L_white(d) + R(d) E / pi) / (L_black(d) + R(d) E / pi)
 *
 * E the illuminance on the panel, E / pi the luminance of the surround. R(d) is the panel's
 * hemispherical-directional luminous reflectance: what it sends into direction d from a
 * uniform surround, over what a perfect white diffuser would send,
 *   R(d) = integral of f(d, w) cos theta_w over the hemisphere of w, plus the mirror part,
 * f the panel's own BRDF (haze and lambertian part, as a renderer asks it), by 2048 directions
 * drawn like it, to about 0.3 %; light from beyond the last measured incidence (beyond 70
 * degrees 12 % of it) is extrapolated. The mirror part counts, since a uniform surround is
 * mirrored too (specular included). Of an anisotropic panel the mean over eight azimuths of d.
 * Weighted by V(lambda) for equal-energy light: lamps of other spectra change R where it
 * depends on the wavelength. Source: E. F. Kelley, M. Lindfors, J. Penczek, Display daylight
 * ambient contrast measurement methods and daylight readability, J. Soc. Inf. Display 14
 * (2006); also SID's Information Display Measurements Standard.
 *
 * Units    lux, radians, cd m^-2. Memory: the arena's. Threads: pure functions.
 */
#pragma once
#include "plot/panel/plot_data.h"

#define AMBIENT_FORMULA                                                                        \
    "(Lw + R E/π) / (Lb + R E/π): white and black at an angle, E the illuminance of an even "  \
    "diffuse surround, R the panel's hemispherical-directional reflectance into that angle, "  \
    "mirror included (Kelley, Lindfors, Penczek 2006)"

/* R above, at theta. */
double ambient_reflectance(const PlotData *data, double theta);

/* C above at an angle. */
double ambient_contrast(const PlotData *data, double theta, double phi, double lux);

/* The same over the hemisphere. */
Field ambient_contrast_field(const PlotData *data, double lux, Arena *arena);
