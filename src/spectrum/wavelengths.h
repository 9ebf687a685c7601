/* SPDX-License-Identifier: Apache-2.0 */
/* wavelengths.h -- the 16 wavelengths of one path, and what every lane needs to know of them.
 *
 * The wavelengths are one stratified set over 360..830 nm, moved by a single random offset and
 * spread by a density that follows the CIE 1931 observer. `xyz` holds the observer divided by
 * that density, so that the sum over lanes of radiance * xyz is an unbiased estimate of the
 * tristimulus values in cd m^-2.
 *
 * Threads  plain values; the tables behind them are constant data.
 */
#pragma once
#include "spectrum/spectrum.h"

typedef struct Wavelengths {
    Spectrum nm;
    Spectrum xyz[3]; /* K_m * observer / (16 * density): sum of radiance * xyz[1] is cd m^-2 */
    Spectrum rgb[3]; /* reflectance spectra of linear Rec.709 R, G, B; they sum to one */
    Spectrum d65;    /* spectral radiance, W m^-2 sr^-1 nm^-1, of a D65 source of 1 cd m^-2 */
} Wavelengths;

/* offset: in [0, 1). */
void wavelengths_sample(float offset, Wavelengths *out);

#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wpsabi"

/* Reflectance of a linear Rec.709 colour (each in [0, 1]; the result then lies there too). */
static inline Spectrum spectrum_from_rgb(const Wavelengths *w, const float rgb[3]) {
    return w->rgb[0] * spectrum_all(rgb[0]) + w->rgb[1] * spectrum_all(rgb[1]) +
           w->rgb[2] * spectrum_all(rgb[2]);
}

/* Spectral radiance of a source whose linear Rec.709 colour is rgb in cd m^-2: its luminance
 * is 0.2126 R + 0.7152 G + 0.0722 B. */
static inline Spectrum spectrum_from_rgb_emission(const Wavelengths *w, const float rgb[3]) {
    return spectrum_from_rgb(w, rgb) * w->d65;
}

/* Adds the tristimulus values (cd m^-2) of a spectral radiance to xyz. */
static inline void spectrum_add_xyz(const Wavelengths *w, Spectrum radiance, float xyz[3]) {
    for (int i = 0; i < 3; i++) xyz[i] += spectrum_sum(radiance * w->xyz[i]);
}

#pragma GCC diagnostic pop
