/* SPDX-License-Identifier: Apache-2.0 */
/* noise.h -- how noisy each pixel's light is, from its own samples and its halves.
 *
 * Threads  one; the buffers are changed in place.
 */
#pragma once
#include "denoise/buffers.h"

/* Puts a better estimate in the place of the variance: see noise.c. */
void noise_estimate(DenoiseBuffers *buffers, Arena scratch);
