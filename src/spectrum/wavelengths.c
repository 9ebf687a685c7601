/* SPDX-License-Identifier: Apache-2.0 */
#include "spectrum/wavelengths.h"

#include "spectrum/spectral_table.h"

/* One nanometre's row as a vector, so that a lane costs one interpolation, not eight. */
typedef float Row __attribute__((vector_size(32), aligned(32)));
typedef float Quarter __attribute__((vector_size(16)));
_Static_assert(sizeof(SpectralRow) == sizeof(Row), "a row is eight floats");

static inline Row row_between(int cell, float t) {
    Row low, high;
    memcpy(&low, &spectral_table[cell], sizeof low);
    memcpy(&high, &spectral_table[cell + 1], sizeof high);
    return low + (high - low) * (Row){t, t, t, t, t, t, t, t};
}

/* Columns of four rows of four, to where the lanes of four quantities stand. */
static inline void put_columns(const Quarter row[4], float *const to[4]) {
    Quarter a = __builtin_shufflevector(row[0], row[1], 0, 4, 1, 5);
    Quarter b = __builtin_shufflevector(row[2], row[3], 0, 4, 1, 5);
    Quarter c = __builtin_shufflevector(row[0], row[1], 2, 6, 3, 7);
    Quarter d = __builtin_shufflevector(row[2], row[3], 2, 6, 3, 7);
    const Quarter column[4] = {
        __builtin_shufflevector(a, b, 0, 1, 4, 5), __builtin_shufflevector(a, b, 2, 3, 6, 7),
        __builtin_shufflevector(c, d, 0, 1, 4, 5), __builtin_shufflevector(c, d, 2, 3, 6, 7)};
    for (int k = 0; k < 4; k++) memcpy(to[k], &column[k], sizeof column[k]);
}

/* The interpolated rows of all lanes: value[quantity], eight of them. */
static inline void read_rows(const SpectrumMask *cell, const Spectrum *t,
                             float value[8][SPECTRUM_LANES]) {
    for (int i = 0; i < SPECTRUM_LANES; i += 4) {
        Quarter half[2][4];
        for (int k = 0; k < 4; k++) {
            Row row = row_between((*cell)[i + k], (*t)[i + k]);
            half[0][k] = __builtin_shufflevector(row, row, 0, 1, 2, 3);
            half[1][k] = __builtin_shufflevector(row, row, 4, 5, 6, 7);
        }
        for (int h = 0; h < 2; h++)
            put_columns(half[h], (float *const[4]){&value[4 * h][i], &value[4 * h + 1][i],
                                                   &value[4 * h + 2][i], &value[4 * h + 3][i]});
    }
}

static inline Spectrum load(const float value[SPECTRUM_LANES]) {
    Spectrum lanes;
    memcpy(&lanes, value, sizeof lanes);
    return lanes;
}

/* The density is constant within a nanometre, so the inverse of its integral is linear there.
 * Shares are whole multiples of 2^-24, so their differences are exact. */
void wavelengths_sample(float offset, Wavelengths *out) {
    const float k_m = (float)(LUMINOUS_EFFICACY_MAX / SPECTRUM_LANES) * 0x1p24f;
    const Spectrum lane = {0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15};
    Spectrum share = (lane + spectrum_all(offset)) * spectrum_all(0x1p24f / SPECTRUM_LANES);
    share = spectrum_min(share, spectrum_all(0x1p24f - 1)); /* lane + offset may round up */
    SpectrumMask cell =
        __builtin_convertvector(share * spectrum_all(WAVELENGTH_GUIDES * 0x1p-24f), SpectrumMask);
    Spectrum begin, end;
    float value[8][SPECTRUM_LANES];
    for (int i = 0; i < SPECTRUM_LANES; i++) {
        int at = wavelength_guide[cell[i]];
        while (wavelength_steps[at + 1] <= share[i]) at++;
        cell[i] = at;
    }
    spectrum_neighbours(wavelength_steps, cell, &begin, &end);
    Spectrum width = spectrum_all(1) / (end - begin);
    Spectrum t = (share - begin) * width, weight = spectrum_all(k_m) * width;
    read_rows(&cell, &t, value);
    for (int k = 0; k < 3; k++) out->xyz[k] = load(value[k]) * weight;
    for (int k = 0; k < 3; k++) out->rgb[k] = load(value[k + 3]);
    out->d65 = load(value[6]);
    out->nm = __builtin_convertvector(cell + SPECTRAL_FIRST_NM, Spectrum) + t;
}
