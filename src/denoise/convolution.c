/* SPDX-License-Identifier: Apache-2.0 */
#include "denoise/convolution.h"

#include <stdbool.h>

/* As many sums as the registers hold besides the weights: the compiler keeps them there. */
#if defined(__AVX512F__)
enum { LANES = 16, PIXELS = 12 };
#elif defined(__AVX2__)
enum { LANES = 8, PIXELS = 4 };
#else
enum { LANES = 4, PIXELS = 2 };
#endif

enum { VECTORS = CONVOLUTION_GROUP / LANES };

typedef float Lanes __attribute__((vector_size(4 * LANES)));

/* PIXELS neighbours from x on; those beyond the row are computed, but not stored. */
static inline void convolve_pixels(const ConvolutionRow *row, int x) {
    const float *const rows[3] = {row->above, row->here, row->below};
    const float *weights = row->weights;
    const size_t inputs = (size_t)row->inputs;
    Lanes sums[PIXELS][VECTORS];
    for (int p = 0; p < PIXELS; p++)
        for (int v = 0; v < VECTORS; v++)
            sums[p][v] = *(const Lanes *)(const void *)(row->biases + LANES * v);
    for (int tap = 0; tap < 9; tap++) {
        const float *in = rows[tap / 3] + (size_t)(x + tap % 3) * inputs;
        for (size_t i = 0; i < inputs; i++, weights += CONVOLUTION_GROUP)
            for (int v = 0; v < VECTORS; v++) {
                const Lanes weight = *(const Lanes *)(const void *)(weights + LANES * v);
                for (int p = 0; p < PIXELS; p++) sums[p][v] += weight * in[(size_t)p * inputs + i];
            }
    }
    for (int p = 0; p < PIXELS && x + p < row->width; p++) {
        float *out = row->out + (size_t)(x + p) * (size_t)row->outputs;
        for (int v = 0; v < VECTORS; v++)
            for (int lane = 0; lane < LANES; lane++)
                out[LANES * v + lane] = sums[p][v][lane] > 0 ? sums[p][v][lane] : 0;
    }
}

void convolve(const ConvolutionRow *row) {
    for (int x = 0; x < row->width; x += PIXELS) convolve_pixels(row, x);
}

/* ---- the builds, named by the one for every processor ------------------------------------ */

#ifndef convolve
#ifdef PARHELION_KERNELS
Convolve convolve_avx2, convolve_avx512;
#endif

int convolution_builds(Convolve *out[CONVOLUTION_BUILDS]) {
    int count = 0;
#ifdef PARHELION_KERNELS
    const bool has_avx2 = __builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma") &&
                          __builtin_cpu_supports("bmi2");
    if (has_avx2 && __builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512bw") &&
        __builtin_cpu_supports("avx512vl") && __builtin_cpu_supports("avx512dq") &&
        __builtin_cpu_supports("avx512cd"))
        out[count++] = convolve_avx512;
    if (has_avx2) out[count++] = convolve_avx2;
#endif
    out[count++] = convolve;
    return count;
}
#endif
