/* SPDX-License-Identifier: Apache-2.0 */
/* convolution.h -- adds up convolutions of planes with kernels as large as they are:
 *
 *     out(x, y) = sum over terms of sum over (u, v) of light(u, v) kernel(x - u, y - v)
 *
 * By Fourier transforms of a plane with so much nothing around it that nothing wraps. Kernels
 * are real, so that two planes are done at once, as the real and the imaginary part.
 *
 * Memory   planes from the arena: 16 bytes, and 24 a pair, of each pixel of a picture twice as
 *          wide and high.
 * Threads  `threads` share the work; the same bits for any number of them.
 * Fails    creating does, when memory is out.
 */
#pragma once
#include "base/arena.h"
#include "base/error.h"

typedef struct Convolution Convolution;

typedef struct ConvolutionSize {
    int width, height; /* of the planes, at least 1 */
    int pairs;         /* of planes, at least 1 */
} ConvolutionSize;

/* The kernel's values at (dx, dy): 2 * height - 1 rows from -(height - 1) on, of each its
 * 2 * width - 1 columns from -(width - 1) on. Mirrored: that at (-dx, dy), at (dx, -dy). */
typedef struct ConvolutionKernel {
    const double *values;
    bool          is_mirrored_x, is_mirrored_y;
} ConvolutionKernel;

/* A term of the sum: a kernel, and the light that it is convolved with. */
typedef struct ConvolutionTerm {
    ConvolutionKernel kernel;
    const void       *context;
    /* 2 * width numbers: two planes' light at (0, y), at (1, y) ...; pair: which two. Called
     * from several threads. */
    void (*light_row)(const void *context, int pair, int y, double *values);
} ConvolutionTerm;

/* To be destroyed. */
bool convolution_create(ConvolutionSize size, int threads, Arena *arena, Convolution **out,
                        Error *err);

void convolution_add(Convolution *convolution, const ConvolutionTerm *term);

/* After the last term, once: ends the sums. */
void convolution_finish(Convolution *convolution);

/* 2 * width numbers: row y of two planes, as light_row has them. */
const double *convolution_row(const Convolution *convolution, int pair, int y);

void convolution_destroy(Convolution *convolution); /* NULL is fine */
