/* SPDX-License-Identifier: Apache-2.0 */
/* convolution.h -- adds up convolutions of planes with kernels as large as they are:
 *
 *     out(x, y) = sum over terms of sum over (u, v) of light(u, v) kernel(x - u, y - v)
 *
 * By Fourier transforms of a plane with so much nothing around it that nothing wraps. Kernels
 * are real, so that two planes are done at once, as the real and the imaginary part.
 *
 * Memory   planes from the arena: 64 bytes a pixel of one twice as wide and high.
 * Threads  `threads` share the work; the same bits for any number of them.
 * Fails    creating does, when memory is out.
 */
#pragma once
#include "base/arena.h"
#include "base/error.h"

enum { CONVOLUTION_PAIRS = 2 };

typedef struct Convolution Convolution;

/* What a term is made of; called from several threads. */
typedef struct ConvolutionTerm {
    const void *context;
    /* The kernel at (dx, dy) for dx of -(width - 1) to width - 1, in this order. */
    void (*kernel_row)(const void *context, int dy, double *values);
    /* 2 * width numbers: two planes' light at (0, y), at (1, y) ...; pair: which two. */
    void (*light_row)(const void *context, int pair, int y, double *values);
} ConvolutionTerm;

/* width, height: at least 1. To be destroyed. */
bool convolution_create(int width, int height, int threads, Arena *arena, Convolution **out,
                        Error *err);

void convolution_add(Convolution *convolution, const ConvolutionTerm *term);

/* After the last term, once: ends the sums. */
void convolution_finish(Convolution *convolution);

/* 2 * width numbers: row y of two planes, as light_row has them. */
const double *convolution_row(const Convolution *convolution, int pair, int y);

void convolution_destroy(Convolution *convolution); /* NULL is fine */
