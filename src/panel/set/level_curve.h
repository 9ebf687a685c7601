/* SPDX-License-Identifier: Apache-2.0 */
/* level_curve.h -- the rows of a gamma table that a panel needs for its level curve.
 *
 * A panel keeps at most LEVEL_CURVE_MAX levels a primary and interpolates between them as in
 * panel/shape/panel_levels.h (Fritsch and Butland's monotone cubic pieces of the logarithm
 * over ln code). Kept are the lowest row with more light than black, full level, and then, one
 * by one, the row that is missed most, until no row is missed by more than LEVEL_CURVE_MISS of
 * its luminance.
 *
 * Threads  pure functions. Fails: never.
 */
#pragma once
#include <stdbool.h>

#include "base/arena.h"

#define LEVEL_CURVE_MAX 64
#define LEVEL_CURVE_MISS 0.0005 /* of the luminance at any row, by levels left out */

/* One level curve: the levels that are kept, and what they are of full level. */
typedef struct LevelCurve {
    int    count;
    double level[LEVEL_CURVE_MAX]; /* codes, rising, above 0 up to 255 */
    double share[LEVEL_CURVE_MAX]; /* rising to 1 */
    double miss;                   /* largest error at a row that is left out, of its
                                      luminance */
} LevelCurve;

/* level: codes, rising to 255; cd_m2: their luminance, which does not fall, and more at the
 * last row than at the first. has_black: row 0 is of level 0. Returns the number of rows above
 * level 0 that have no more light than black. */
int level_curve_choose(const double *level, const double *cd_m2, int rows, bool has_black,
                       Arena scratch, LevelCurve *out);
