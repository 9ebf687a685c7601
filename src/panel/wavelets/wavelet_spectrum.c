/* SPDX-License-Identifier: Apache-2.0 */
#include "panel/wavelets/wavelet_spectrum.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "hemisphere/wavelet1d.h"

static const double SHARES[WAVELET_SPECTRUM_SIZES] = {0.02, 0.05, 0.1, 0.2, 0.5};

static int spectrum_of(const Measurement *set, const AngleTable *table, float *out)
{
    if (set->has_spectra) {
        for (int i = 0; i < SPECTRAL_COUNT; i++)
            out[i] = set->spectrum[0][i] + set->spectrum[1][i] + set->spectrum[2][i];
        return SPECTRAL_COUNT;
    }
    if (table->channels < 4) return 0;
    for (int i = 0; i < table->rows; i++)
        for (int c = 0; c < table->channels; c++)
            out[c] += table->value[i * table->channels + c] / (float)table->rows;
    return table->channels;
}

typedef struct WaveletTerm {
    float worth;
    int   place;
} WaveletTerm;

static int by_worth(const void *a, const void *b)
{
    float x = ((const WaveletTerm *)a)->worth, y = ((const WaveletTerm *)b)->worth;
    return (x < y) - (x > y);
}

/* The relative error of the spectrum from its most significant coefficients. */
static double error_with(WaveletKind kind, const float *spectrum, int count, int kept)
{
    float       values[WAVELET_MAX_COUNT], norms[WAVELET_MAX_COUNT];
    WaveletTerm order[WAVELET_MAX_COUNT];
    double      error = 0, sum = 0;
    memcpy(values, spectrum, sizeof *values * (size_t)count);
    wavelet1d_forward(kind, values, count);
    wavelet1d_norms(kind, count, norms);
    for (int i = 0; i < count; i++) order[i] = (WaveletTerm){fabsf(values[i]) * norms[i], i};
    qsort(order, (size_t)count, sizeof *order, by_worth);
    for (int i = kept; i < count; i++) values[order[i].place] = 0;
    wavelet1d_inverse(kind, values, count);
    for (int i = 0; i < count; i++) {
        double e = (double)(values[i] - spectrum[i]), s = (double)spectrum[i];
        error += e * e;
        sum += s * s;
    }
    return sum > 0 ? sqrt(error / sum) : 0;
}

WaveletSpectrum wavelet_spectrum(const Measurement *set, const AngleTable *table, Arena scratch)
{
    float          *spectrum = ARENA_NEW(&scratch, float, WAVELET_MAX_COUNT);
    WaveletSpectrum out = {.count = spectrum_of(set, table, spectrum)};
    for (int i = 0; i < WAVELET_SPECTRUM_SIZES && out.count; i++) {
        int kept = (int)fmax(1, round(SHARES[i] * out.count));
        out.share[i] = (double)kept / out.count;
        for (int k = 0; k < 3; k++)
            out.rms[k][i] = error_with((WaveletKind)k, spectrum, out.count, kept);
    }
    return out;
}
