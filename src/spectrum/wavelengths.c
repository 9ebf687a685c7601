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

/* The nanometre with cdf[cell] <= u < cdf[cell + 1], not below `low`: lanes ask in rising order,
 * so that the search gallops from the cell of the lane before. */
static int find_cell(float u, int low)
{
    int high = SPECTRAL_COUNT - 1;
    int step = 8;
    while (low + step < high && wavelength_cdf[low + step] <= u) {
        low += step;
        step *= 2;
    }
    if (low + step < high) high = low + step;
    while (high - low > 1) {
        int middle = (low + high) / 2;
        if (wavelength_cdf[middle] <= u)
            low = middle;
        else
            high = middle;
    }
    return low;
}

/* The density is constant within a nanometre, so the inverse of its integral is linear there;
 * the cdf's values are multiples of 2^-24, so their differences are exact. */
void wavelengths_sample(float offset, Wavelengths *out)
{
    const float k_m = (float)(LUMINOUS_EFFICACY_MAX / SPECTRUM_LANES);
    float lanes[8][SPECTRUM_LANES];
    int   cell = 0;
    for (int i = 0; i < SPECTRUM_LANES; i++) {
        float u = ((float)i + offset) * (1.0f / SPECTRUM_LANES);
        cell = find_cell(u, cell);
        float width = 1 / (wavelength_cdf[cell + 1] - wavelength_cdf[cell]);
        float t = clampf((u - wavelength_cdf[cell]) * width, 0, 1);
        Row   low = load_row(cell), high = load_row(cell + 1);
        Row   row = low + (high - low) * (Row){t, t, t, t, t, t, t, t};
        float weight = k_m * width;
        for (int k = 0; k < 3; k++) lanes[k][i] = row[k] * weight;
        for (int k = 3; k < 7; k++) lanes[k][i] = row[k];
        lanes[7][i] = (float)(SPECTRAL_FIRST_NM + cell) + t;
    }
    memcpy(&out->xyz, lanes[0], sizeof out->xyz);
    memcpy(&out->rgb, lanes[3], sizeof out->rgb);
    memcpy(&out->d65, lanes[6], sizeof out->d65);
    memcpy(&out->nm, lanes[7], sizeof out->nm);
}

float wavelengths_pdf(float nm)
{
    if (!(nm >= SPECTRAL_FIRST_NM && nm < SPECTRAL_LAST_NM)) return 0;
    int cell = (int)nm - SPECTRAL_FIRST_NM;
    return wavelength_cdf[cell + 1] - wavelength_cdf[cell];
}
