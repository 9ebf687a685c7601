/* SPDX-License-Identifier: Apache-2.0 */
/* wavelet_sheet.h -- pictures of a wavelet study: the table level by level as means over
 * triangles and interpolated, and the curves of its errors, sizes and times.
 *
 * Memory   the arena's. Threads: one picture at a time per arena. Fails: with cairo's reason.
 */
#pragma once
#include "base/error.h"
#include "panel/wavelets/wavelet_study.h"
#include "plot/draw/picture.h"

/* PNGs. */
bool wavelet_levels_picture(const WaveletStudy *study, Arena *arena, PlotBytes *out,
                            Error *err);
bool wavelet_curves_picture(const WaveletStudy *study, Arena *arena, PlotBytes *out,
                            Error *err);
