/* SPDX-License-Identifier: Apache-2.0 */
/* wavelet_spectrum.h -- the spectrum of a study: of white where a set has its primaries' spectra,
 * else the mean one of a reflection table; thresholded in three wavelets (wavelet1d.h).
 *
 * Threads  pure. Fails: never; without a spectrum spectrum_count stays 0.
 */
#pragma once
#include "panel/wavelets/wavelet_study.h"

void wavelet_spectrum(const Measurement *set, const AngleTable *table, Arena scratch,
                      WaveletStudy *out);
