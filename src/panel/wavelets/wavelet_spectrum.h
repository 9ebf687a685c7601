/* SPDX-License-Identifier: Apache-2.0 */
/* wavelet_spectrum.h -- a spectrum thresholded in three wavelets (wavelet1d.h): white's where a
 * set has its primaries' spectra, else the mean one of a reflection table.
 *
 * Threads  pure. Fails: never; without a spectrum count is 0.
 */
#pragma once
#include "panel/set/measurement.h"

#define WAVELET_SPECTRUM_SIZES 5

typedef struct WaveletSpectrum {
    int    count; /* numbers of the spectrum; 0: none is known */
    double share[WAVELET_SPECTRUM_SIZES];  /* of them that are kept */
    double rms[3][WAVELET_SPECTRUM_SIZES]; /* relative; Haar, CDF 5/3, CDF 9/7 */
} WaveletSpectrum;

WaveletSpectrum wavelet_spectrum(const Measurement *set, const AngleTable *table,
                                 Arena scratch);
