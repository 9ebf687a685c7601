/* SPDX-License-Identifier: Apache-2.0 */
/* balance.h -- gives back the light that a filter took from a picture, block by block.
 *
 * A filter that cuts peaks loses light, most of it from the brightest pixels. So what a block
 * of 64x64 pixels lacks is put onto its pixels by the square of what they have: flat parts
 * hardly change, and what is white in a picture stays white. Between blocks the shares run
 * smoothly; what they are follows from the requirement that each block has its light.
 *
 *     after'(x) = after(x) (1 + g(x) after(x) / rms(x))
 *
 * rms: root mean square of `after` in a block; g, rms: of the blocks, each at its middle, and
 * joined by 3 t^2 - 2 t^3. The g are the least-squares solution (conjugate gradients on the
 * normal equations: M. R. Hestenes, E. Stiefel, J. Res. Nat. Bur. Stand. 49, 409-436, 1952).
 *
 * A block may still lack BALANCE_BAND of its light, or have that much too much: it is not seen,
 * and noise is more. A block whose g would exceed BALANCE_MOST is taken for one with light of
 * a rare path rather than of a place: it stays as it is.
 *
 * Units    any, the same for all.
 * Threads  as many as requested; the same bits for any number.
 * Memory   scratch: 12 bytes for each row and column, 136 for each block.
 * Fails    never.
 */
#pragma once
#include <stddef.h>

#include "base/arena.h"

#define BALANCE_BAND 0.008 /* of the block's light */
#define BALANCE_MOST 0.5
enum { BALANCE_BLOCK = 64 }; /* pixels; the last of a row or column has 32 to 95 */

/* Luminances of a pixel. Where it was not filtered, `before` and `after` are 0. */
typedef struct BalanceLight {
    float before, after; /* of what was filtered, at least 0 */
    float total;         /* of everything, before: the band is a share of it; 0 if not finite */
} BalanceLight;

typedef struct BalancePicture {
    int width, height;
    void *user;
    /* Both are called by several threads, for one pixel by one at a time. */
    void (*light)(void *user, size_t pixel, BalanceLight *out);
    void (*scale)(void *user, size_t pixel, float gain); /* at least 0.5 */
} BalancePicture;

/* Returns by which share of its light the worst block differs afterwards. */
double balance_run(const BalancePicture *picture, int threads, Arena scratch);
