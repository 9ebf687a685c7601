/* SPDX-License-Identifier: Apache-2.0 */
/* convolution.h -- the network's hot loop: one row of a 3x3 convolution and what follows it.
 *
 *   out[o](x) = max(0, bias[o] + sum over ky, kx, i of weight[o][ky][kx][i] in[i](x + kx, ky))
 *
 * Built once for each instruction set, as the kernel is (the build gives the others names of
 * their own: -Dconvolve=convolve_avx2); every one adds in the order above,
 * without fused operations, so that all of them compute the same bits.
 *
 * Layout   a pixel is its channels, one after the other, a multiple of CONVOLUTION_GROUP of
 *          them; a row begins and ends with a pixel of zeros, and has CONVOLUTION_SLACK more
 *          that may be read. Rows are aligned to 64 bytes.
 * Weights  [group of outputs][ky][kx][input][CONVOLUTION_GROUP outputs]
 * Threads  no shared state.  Fails  never.
 */
#pragma once
#include <stddef.h>

enum {
    CONVOLUTION_GROUP = 16, /* outputs that are computed together */
    CONVOLUTION_SLACK = 16  /* pixels */
};

typedef struct ConvolutionRow {
    const float *above, *here, *below; /* of the input, from the pixel of zeros on */
    const float *weights, *biases;     /* of the group */
    float *out;                        /* the group's first output of the first pixel */
    int width;                         /* pixels */
    int inputs, outputs;               /* channels of a pixel */
} ConvolutionRow;

/* One group of outputs. */
void convolve(const ConvolutionRow *row);

typedef void Convolve(const ConvolutionRow *row);

/* The builds of it that this processor and program have, the fastest one first; returns how
 * many. */
enum { CONVOLUTION_BUILDS = 3 };
int convolution_builds(Convolve *out[CONVOLUTION_BUILDS]);
