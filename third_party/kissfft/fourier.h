/* SPDX-License-Identifier: Apache-2.0 */
/* fourier.h -- discrete Fourier transforms of one dimension. The only C view of kissfft.
 *
 *     out[k] = sum over n of in[n] exp(-+ 2 pi i k n / length)
 *
 * with - forwards and + backwards, neither with a factor: there and back is `length` times.
 *
 * Layout   complex numbers as pairs of doubles, real part first.
 * Memory   fourier_create owns C++ memory until fourier_destroy.
 * Threads  any number may transform with one Fourier.
 * Fails    fourier_create, when memory is out.
 */
#pragma once
#include "base/error.h"

#ifdef __cplusplus
extern "C" {
#endif

typedef struct Fourier Fourier;

/* length: at least 2, of factors 2, 3 and 5. */
bool fourier_create(int length, bool is_backwards, Fourier **out, Error *err);

/* 2 * length doubles each, which must not overlap. */
void fourier_transform(const Fourier *fourier, const double *in, double *out);

void fourier_destroy(Fourier *fourier); /* NULL is fine */

#ifdef __cplusplus
}
#endif
