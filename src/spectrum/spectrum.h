/* SPDX-License-Identifier: Apache-2.0 */
/* spectrum.h -- 16 numbers of one quantity, one per wavelength of a path.
 *
 * A Spectrum is a compiler vector; +, -, *, / work lane by lane, also with itself. C has no
 * scalar broadcast and no ?: for vectors: spectrum_all and spectrum_select cover both.
 * Which wavelength a lane stands for is given by a Wavelengths (wavelengths.h).
 * The unit is the quantity's own: radiance in W m^-2 sr^-1 nm^-1, reflectance without unit.
 */
#pragma once
#include <stdbool.h>

#include "base/mathf.h"

#define SPECTRUM_LANES 16

typedef float Spectrum __attribute__((vector_size(SPECTRUM_LANES * 4), aligned(64)));
typedef int SpectrumMask __attribute__((vector_size(SPECTRUM_LANES * 4), aligned(64)));

/* Inline functions pass no vector from one file to another: nothing to warn of. Those that do
 * are hot ones (CMakeLists.txt). */
#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wpsabi"

static inline Spectrum spectrum_all(float value) {
    return (Spectrum){value, value, value, value, value, value, value, value,
                      value, value, value, value, value, value, value, value};
}

/* a where mask is set (spectrum_above, or a comparison of Spectra), b elsewhere. */
static inline Spectrum spectrum_select(SpectrumMask mask, Spectrum a, Spectrum b) {
    return (Spectrum)(((SpectrumMask)a & mask) | ((SpectrumMask)b & ~mask));
}

/* All bits set in the lanes where a is above b; a lane with NaN may go either way. GCC takes
 * comparisons of vectors wider than the CPU's apart lane by lane, but not shifts: the sign of
 * a difference is exact (subtraction never rounds to zero or across it). */
static inline SpectrumMask spectrum_above(Spectrum a, Spectrum b) {
    return (SpectrumMask)(b - a) >> 31;
}

static inline Spectrum spectrum_max(Spectrum a, Spectrum b) {
    return spectrum_select(spectrum_above(a, b), a, b);
}

static inline Spectrum spectrum_min(Spectrum a, Spectrum b) {
    return spectrum_select(spectrum_above(b, a), a, b);
}

static inline Spectrum spectrum_clamp(Spectrum a, float low, float high) {
    return spectrum_min(spectrum_max(a, spectrum_all(low)), spectrum_all(high));
}

/* Sum over the lanes, in a fixed order (the same bits for every instruction set): halves are
 * folded onto each other until four numbers are left. */
static inline float spectrum_sum(Spectrum a) {
    typedef float Quarter __attribute__((vector_size(16)));
    Quarter part[SPECTRUM_LANES / 4];
    memcpy(part, &a, sizeof part);
    Quarter sum = (part[0] + part[2]) + (part[1] + part[3]);
    return (sum[0] + sum[2]) + (sum[1] + sum[3]);
}

static inline float spectrum_mean(Spectrum a) {
    return spectrum_sum(a) * (1.0f / SPECTRUM_LANES);
}

static inline float spectrum_max_lane(Spectrum a) {
    float half[8], quarter[4];
    for (int i = 0; i < 8; i++) half[i] = a[i] > a[i + 8] ? a[i] : a[i + 8];
    for (int i = 0; i < 4; i++) quarter[i] = half[i] > half[i + 4] ? half[i] : half[i + 4];
    float x = quarter[0] > quarter[2] ? quarter[0] : quarter[2];
    float y = quarter[1] > quarter[3] ? quarter[1] : quarter[3];
    return x > y ? x : y;
}

/* No lane NaN or infinite. */
static inline bool spectrum_is_finite(Spectrum a) {
    return isfinite(spectrum_sum(a * spectrum_all(0)));
}

/* No lane above 0. NaN is not nothing. */
static inline bool spectrum_is_zero(Spectrum a) {
    return spectrum_max_lane(a) <= 0 && spectrum_is_finite(a);
}

/* Four vectors of four as one, through vectors as wide as the CPU's: what is stored in parts
 * and loaded as a whole waits until the parts have left the store buffer. */
typedef float SpectrumQuarter __attribute__((vector_size(16)));

static inline Spectrum spectrum_joined(const SpectrumQuarter part[4]) {
    Spectrum whole;
#ifdef __AVX__
    typedef float Half __attribute__((vector_size(32)));
    Half half[2] = {__builtin_shufflevector(part[0], part[1], 0, 1, 2, 3, 4, 5, 6, 7),
                    __builtin_shufflevector(part[2], part[3], 0, 1, 2, 3, 4, 5, 6, 7)};
#ifdef __AVX512F__
    whole = __builtin_shufflevector(half[0], half[1], 0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13,
                                    14, 15);
#else
    memcpy(&whole, half, sizeof whole);
#endif
#else
    memcpy(&whole, part, sizeof whole);
#endif
    return whole;
}

/* low: every lane's value[at[lane]], high: the one behind it. Each two are loaded as one number
 * of twice the size. */
static inline void spectrum_neighbours(const float *value, SpectrumMask at, Spectrum *low,
                                       Spectrum *high) {
    typedef SpectrumQuarter Quarter;
    typedef double Pairs __attribute__((vector_size(16)));
    Quarter below[SPECTRUM_LANES / 4], above[SPECTRUM_LANES / 4];
    for (int i = 0; i < SPECTRUM_LANES; i += 4) {
        double pair[4];
        for (int k = 0; k < 4; k++) memcpy(&pair[k], value + at[i + k], sizeof pair[k]);
        Quarter a = (Quarter)(Pairs){pair[0], pair[1]}, b = (Quarter)(Pairs){pair[2], pair[3]};
        below[i / 4] = __builtin_shufflevector(a, b, 0, 2, 4, 6);
        above[i / 4] = __builtin_shufflevector(a, b, 1, 3, 5, 7);
    }
    *low = spectrum_joined(below);
    *high = spectrum_joined(above);
}

/* All bits set in the lanes that hold NaN. */
static inline SpectrumMask spectrum_nan_lanes(Spectrum a) {
    const int infinity = 0x7f800000, rest = 0x7fffffff;
    SpectrumMask bits = (SpectrumMask)a & (rest + (SpectrumMask){0});
    return (infinity - bits) >> 31;
}

/* e^a, relative error below 3e-7 for a in [-87, 88]; 0 below, infinity above, NaN of NaN. With
 * n the whole number next to a / ln 2, the rest r = a - n ln 2 is within 0.347: eight terms of
 * the series. ln 2 has two parts, the first with so few bits that n times it is exact; 2^n is
 * two factors, since one alone may be beyond the range. */
static inline Spectrum spectrum_exp(Spectrum a) {
    static const float terms[] = {1 / 5040.0f, 1 / 720.0f, 1 / 120.0f, 1 / 24.0f,
                                  1 / 6.0f,    0.5f,       1,          1};
    Spectrum x = spectrum_clamp(a, -87.3f, 88.7f), power = {0};
    SpectrumMask n = __builtin_convertvector(x * spectrum_all(1.44269504f) + spectrum_all(128.5f),
                                             SpectrumMask) -
                     128;
    Spectrum whole = __builtin_convertvector(n, Spectrum);
    Spectrum r = x - whole * spectrum_all(0.693359375f);
    r = r + whole * spectrum_all(2.12194440e-4f);
    for (int i = 0; i < 8; i++) power = power * r + spectrum_all(terms[i]);
    SpectrumMask half = n >> 1, other = n - half;
    power = power * (Spectrum)((half + 127) << 23) * (Spectrum)((other + 127) << 23);
    SpectrumMask large = spectrum_above(a, spectrum_all(88.7f));
    SpectrumMask small = spectrum_above(spectrum_all(-87.3f), a);
    power = spectrum_select(large, spectrum_all(INFINITY), power);
    power = spectrum_select(small, spectrum_all(0), power);
    return spectrum_select(spectrum_nan_lanes(a), a, power);
}

/* ln a of a > 0, error below 3e-7 max(1, |ln a|); -87.5 at 0 and below, what lies between 0 and
 * the least normal number included. With 2^n the power of two for which a / 2^n is within
 * [sqrt(1/2), sqrt(2)): the series of 2 artanh((m - 1) / (m + 1)). */
static inline Spectrum spectrum_log(Spectrum a) {
    const int root_half = 0x3f3504f3;
    static const float terms[] = {2 / 11.0f, 2 / 9.0f, 2 / 7.0f, 2 / 5.0f, 2 / 3.0f, 2};
    const Spectrum least = spectrum_all(1.2e-38f);
    SpectrumMask bits = (SpectrumMask)spectrum_max(a, least), n = (bits - root_half) >> 23;
    Spectrum whole = __builtin_convertvector(n, Spectrum);
    Spectrum m = (Spectrum)(bits - n * 0x800000);
    Spectrum t = (m - spectrum_all(1)) / (m + spectrum_all(1)), t2 = t * t, sum = {0};
    for (int i = 0; i < 6; i++) sum = sum * t2 + spectrum_all(terms[i]);
    sum = sum * t + whole * spectrum_all(-2.12194440e-4f) + whole * spectrum_all(0.693359375f);
    return spectrum_select(spectrum_above(a, least), sum, spectrum_all(-87.5f));
}

/* a^exponent of a in [0, 1]; exponent at least 1. 1 at 1, 0 at 0: exactly. */
static inline Spectrum spectrum_pow(Spectrum a, float exponent) {
    return spectrum_exp(spectrum_log(a) * spectrum_all(exponent));
}

#pragma GCC diagnostic pop
