/* SPDX-License-Identifier: Apache-2.0 */
/* fireflies.h -- single pixels that one rare sample made far too bright.
 *
 * Threads  one; the buffers are changed in place.
 */
#pragma once
#include "denoise/buffers.h"

/* A firefly is a pixel brighter than 2.5 times the third brightest of the 24 around, whose
 * standard error is more than 0.7 of itself. It becomes as bright as that limit. What it had
 * more is light that was there, and none is lost: it is spread over the pixels of its kind at
 * most 5 away, most on those of like features; as far as 40 away where it would be more than
 * 5 % of the light there. One without four like pixels keeps its light. Returns how many there
 * were. */
long fireflies_spread(DenoiseBuffers *buffers, Arena scratch);
