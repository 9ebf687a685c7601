/* SPDX-License-Identifier: Apache-2.0 */
/* correction.h -- gives back what the filter took away and noise cannot have been.
 *
 * Threads  as many as asked; the same bits for any number.
 */
#pragma once
#include "denoise/buffers.h"

/* light: the filtered light, R, G, B. The difference between it and the buffers' own, averaged
 * over pixels of like features at most `reach` away, is added as far as it is larger than its
 * standard error lets expect. */
void correction_add(const DenoiseBuffers *buffers, float *const light[3], int reach,
                    int threads, Arena scratch);
