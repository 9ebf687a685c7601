/* SPDX-License-Identifier: Apache-2.0 */
/* mask_fill.h -- a picture that ends where its mask does: for filters that reach over it.
 *
 * A pixel that does not count takes the value of the nearest one in its row that does; a row
 * without any is the nearest one that has some. So what lies under a mask decides nothing, and
 * pictures go on beyond it as FLIP lets them go on beyond their border.
 *
 * Memory   planes from the arena. Threads: a pure function. Fails: never.
 */
#pragma once
#include "base/arena.h"
#include "compare/metrics/planes.h"

/* The picture itself where every pixel counts, and black where none does. */
Planes mask_fill(const Planes *picture, PixelMask mask, Arena *arena);
