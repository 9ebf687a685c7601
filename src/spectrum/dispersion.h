/* SPDX-License-Identifier: Apache-2.0 */
/* dispersion.h -- how the index of refraction of clear bodies falls with the wavelength.
 *
 * Cauchy's first two terms through the index at the d line (587.6 nm) and the Abbe number
 * V = (nd - 1) / (nF - nC), F and C at 486.1 and 656.3 nm; never below 1.
 *
 * Units    wavelengths in nm; indices without unit.
 * Source   Khronos' KHR_materials_dispersion; Born and Wolf, "Principles of Optics", 2.3.4.
 * Threads  pure.
 */
#pragma once

#define LINE_D_NM 587.6

/* dispersion: 20 / V, as glTF has it, 0 and up. */
static inline double dispersion_index(double nd, double dispersion, double nm) {
    const double f = 1 / (486.1 * 486.1), c = 1 / (656.3 * 656.3);
    const double d = 1 / (LINE_D_NM * LINE_D_NM);
    double spread = (nd - 1) * dispersion / 20;
    double n = nd + spread * (1 / (nm * nm) - d) / (f - c);
    return n > 1 ? n : 1;
}
