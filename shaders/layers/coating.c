/* SPDX-License-Identifier: Apache-2.0 */
#include "shaders/layers/coating.h"

static Spectrum between(const Curve *row, float t, const Wavelengths *wavelengths) {
    Spectrum low = curve_lookup(&row[0], wavelengths);
    if (t <= 0) return low;
    return low + (curve_lookup(&row[1], wavelengths) - low) * spectrum_all(t);
}

Spectrum coating_at(const CoatingTable *table, const Wavelengths *wavelengths, float cosine) {
    EnergyKnot c = energy_cosine_knot(cosine, table->count);
    return between(&table->row[c.low], c.t, wavelengths);
}

Spectrum coating_energy_at(const CoatingEnergy *energy, const Wavelengths *wavelengths,
                           float cosine, float alpha) {
    EnergyKnot a = energy_alpha_knot(alpha, COATING_PER_OCTAVE);
    EnergyKnot c = energy_cosine_knot(cosine, energy->count);
    const Curve *row = energy->directional + a.low * energy->count + c.low;
    Spectrum low = between(row, c.t, wavelengths);
    if (a.t <= 0) return low;
    Spectrum high = between(row + energy->count, c.t, wavelengths);
    return low + (high - low) * spectrum_all(a.t);
}

Spectrum coating_energy_average(const CoatingEnergy *energy, const Wavelengths *wavelengths,
                                float alpha) {
    EnergyKnot a = energy_alpha_knot(alpha, COATING_PER_OCTAVE);
    return between(&energy->average[a.low], a.t, wavelengths);
}
