/* SPDX-License-Identifier: Apache-2.0 */
#include "shaders/layers/coating.h"

/* Between two neighbours of `count` nodes spaced evenly in sqrt(cosine). */
static EnergyKnot knot_of(float cosine, int count)
{
    float place = safe_sqrtf(cosine) * (float)(count - 1);
    int   low = (int)place;
    if (low > count - 2) low = count - 2;
    return (EnergyKnot){low, clampf(place - (float)low, 0, 1)};
}

static Spectrum between(const Curve *row, float t, const Wavelengths *wavelengths)
{
    Spectrum low = curve_lookup(&row[0], wavelengths);
    if (t <= 0) return low;
    return low + (curve_lookup(&row[1], wavelengths) - low) * spectrum_all(t);
}

Spectrum coating_at(const CoatingTable *table, const Wavelengths *wavelengths, float cosine)
{
    EnergyKnot c = knot_of(cosine, table->count);
    return between(&table->row[c.low], c.t, wavelengths);
}

Spectrum coating_energy_at(const CoatingEnergy *energy, const Wavelengths *wavelengths,
                           float cosine, float alpha)
{
    EnergyKnot a = energy_alpha_knot(alpha, COATING_PER_OCTAVE);
    EnergyKnot c = knot_of(cosine, energy->count);
    const Curve *row = energy->directional + a.low * energy->count + c.low;
    Spectrum     low = between(row, c.t, wavelengths);
    if (a.t <= 0) return low;
    Spectrum high = between(row + energy->count, c.t, wavelengths);
    return low + (high - low) * spectrum_all(a.t);
}

Spectrum coating_energy_average(const CoatingEnergy *energy, const Wavelengths *wavelengths,
                                float alpha)
{
    EnergyKnot a = energy_alpha_knot(alpha, COATING_PER_OCTAVE);
    return between(&energy->average[a.low], a.t, wavelengths);
}
