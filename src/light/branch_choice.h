/* SPDX-License-Identifier: Apache-2.0 */
/* branch_choice.h -- which branch of a tree's node a random number chooses. HOT.
 *
 * Threads  a pure function.
 */
#pragma once
#include "base/mathf.h"
#include "spectrum/spectrum.h"

#define BELOW_ONE 0x1.fffffep-1f /* the greatest number below 1 */

#pragma GCC diagnostic push /* inline: no vector goes from one file to another */
#pragma GCC diagnostic ignored "-Wpsabi"
/* prob: of the first `count` lanes, adding up to 1. The choice is taken off *u, in [0, 1),
 * which is uniform again. */
static inline int choose_branch(Spectrum prob, int count, float *u) {
    float below = 0;
    int i = 0;
    while (i + 1 < count && *u >= below + prob[i]) below += prob[i++];
    while (i > 0 && !(prob[i] > 0)) below -= prob[--i]; /* by rounding, beyond the last seen */
    *u = prob[i] > 0 ? clampf((*u - below) / prob[i], 0, BELOW_ONE) : 0;
    return i;
}
#pragma GCC diagnostic pop
