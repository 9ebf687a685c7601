/* SPDX-License-Identifier: Apache-2.0 */
/* wavelet_study.h -- one measured table in the paper's basis: triangles, means and details, the
 * largest details kept; and how far each level and each size is from the samples.
 *
 * Frame    the display's. Units: the table's; errors relative to the rms of the samples, both
 *          weighted by solid angle, over all channels.
 * Memory   the arena's, from first to last: about 60 bytes a triangle and channel of the
 *          largest level. Threads: one.
 * Fails    with the option or table, found and required.
 */
#pragma once
#include "base/error.h"
#include "hemisphere/tree.h"
#include "panel/set/measurement.h"

#define WAVELET_SPECTRUM_SIZES 5

typedef struct WaveletSpectrum {
    int    count; /* numbers of the spectrum; 0: none is known */
    double share[WAVELET_SPECTRUM_SIZES];  /* of them that are kept */
    double rms[3][WAVELET_SPECTRUM_SIZES]; /* relative; Haar, CDF 5/3, CDF 9/7 */
} WaveletSpectrum;

#define WAVELET_LEVEL_MAX 9
#define WAVELET_TIMED_LEVEL 8 /* queries are timed up to this level */
#define WAVELET_SIZES_MAX 8
#define WAVELET_KEEP 0.05

typedef struct WaveletOptions {
    const char *table; /* its name; NULL: the brightest */
    int         level; /* of the leaves; -1: as many triangles as the samples need */
    double      keep;  /* share of the table's numbers that the tree keeps; 0: WAVELET_KEEP,
                          or the means of the four octants where these are more */
    bool        is_lossless; /* everything, as float32 */
    double      noise; /* added to the table, relative; 0: none */
} WaveletOptions;

/* Relative errors at the samples: of means over triangles, and interpolated between these. */
typedef struct WaveletErrors {
    double rms, max, smooth_rms, smooth_max;
} WaveletErrors;

typedef struct WaveletLevel {
    uint32_t      triangles;      /* 4^(i+1) */
    double        resolution_deg; /* edge of a square of a triangle's mean area */
    WaveletErrors errors;
} WaveletLevel;

typedef struct WaveletSize {
    double        share; /* of the table's numbers that are kept */
    uint32_t      rows;  /* means and details, of `channels` numbers */
    size_t        bytes;
    double        leaf_rms, leaf_max; /* relative, at the leaves */
    WaveletErrors errors;
    double        truth_rms; /* beside the table without the added noise, interpolated */
} WaveletSize;

typedef struct WaveletStudy {
    const char      *file;
    const AngleTable *source; /* with noise, where some is added */
    const Geodesic  *geodesic;
    int              level;
    double           sample_rms; /* in the table's unit */
    size_t           source_bytes; /* its numbers as float32 */
    Tree             tree;       /* as it was requested */
    WaveletSize      kept;       /* the same */
    double           mean_miss;  /* largest difference of a father and his children's mean */
    WaveletLevel     levels[WAVELET_LEVEL_MAX + 1];
    Tree             level_tree[WAVELET_LEVEL_MAX + 1]; /* the tree's means of a level */
    int              size_count;
    WaveletSize      sizes[WAVELET_SIZES_MAX];
    double           noise, noise_rms; /* the latter as it came out */
    WaveletSpectrum  spectrum;
    double           query_ns[WAVELET_TIMED_LEVEL + 1]; /* of a mean; interpolated: */
    double           smooth_ns[WAVELET_TIMED_LEVEL + 1];
} WaveletStudy;

bool wavelet_study(const Measurement *set, const WaveletOptions *options, Arena *arena,
                   WaveletStudy *out, Error *err);

/* Luminance, or the mean over wavelengths, at a direction: of the tree's means of a level, or
 * interpolated between them. */
double wavelet_study_value(const WaveletStudy *study, int level, bool is_smooth,
                           Vec3 direction);
