#include "spectrum/wavelengths.h"

#include "spectrum/spectral_table.h"

/* One nanometre's row as a vector, so that a lane costs one interpolation, not eight. */
typedef float Row __attribute__((vector_size(32), aligned(32)));
_Static_assert(sizeof(SpectralRow) == sizeof(Row), "a row is eight floats");

static Row load_row(int i)
{
    Row row;
    memcpy(&row, &spectral_table[i], sizeof row);
    return row;
}

/* The density is constant within a nanometre, so the inverse of its integral is linear there.
 * Shares are whole multiples of 2^-24, so their differences are exact. */
void wavelengths_sample(float offset, Wavelengths *out)
{
    const float k_m = (float)(LUMINOUS_EFFICACY_MAX / SPECTRUM_LANES) * 0x1p24f;
    for (int i = 0; i < SPECTRUM_LANES; i++) {
        float share = ((float)i + offset) * (0x1p24f / SPECTRUM_LANES);
        share = share < 0x1p24f ? share : 0x1p24f - 1; /* i + offset may round up */
        int   cell = wavelength_guide[(int)(share * (WAVELENGTH_GUIDES * 0x1p-24f))];
        while (wavelength_steps[cell + 1] <= share) cell++;
        float width = 1 / (wavelength_steps[cell + 1] - wavelength_steps[cell]);
        float t = (share - wavelength_steps[cell]) * width, weight = k_m * width;
        Row   low = load_row(cell), high = load_row(cell + 1);
        Row   row = low + (high - low) * (Row){t, t, t, t, t, t, t, t};
        for (int k = 0; k < 3; k++) out->xyz[k][i] = row[k] * weight;
        for (int k = 0; k < 3; k++) out->rgb[k][i] = row[k + 3];
        out->d65[i] = row[6];
        out->nm[i] = (float)(SPECTRAL_FIRST_NM + cell) + t;
    }
}
