/* SPDX-License-Identifier: Apache-2.0 */
/* level_curve.h -- the few levels that stand for a gamma table's rows.
 *
 * A panel keeps at most LEVEL_CURVE_MAX levels a primary and interpolates between them as in
 * panel/shape/panel_levels.h (Fritsch and Butland's monotone cubic pieces of the logarithm
 * over ln code). Kept are the lowest row with more light than black (LEVEL_SHARE_LEAST of full
 * level), full level, and then, one by one, the row that is missed most, until no row is missed
 * by more than LEVEL_CURVE_MISS of its luminance and LEVEL_CURVE_FLOOR of full level together:
 * beside white, an eye or a picture of 8 bits does not resolve less. Both would show a step of
 * half a per cent. Where LEVEL_CURVE_MAX rows do not do, the table is noise about a smooth
 * curve, and about 32 whole codes have what the least-squares line through the rows around each
 * says (local linear regression, Cleveland 1979); full level stays.
 *
 * Units    levels as codes in [0, 255]; luminance in cd m^-2; shares without unit.
 * Threads  pure functions. Fails: never.
 */
#pragma once
#include <stdbool.h>

#include "base/arena.h"

#define LEVEL_CURVE_MAX 64
#define LEVEL_CURVE_MISS 0.0005 /* at any row, by levels left out */
#define LEVEL_CURVE_FLOOR 0.001 /* of full level: what a row's luminance is compared with */
#define LEVEL_SHARE_LEAST 1e-6  /* of full level: less is black */

/* One level curve: the levels that are kept, and what they are of full level. */
typedef struct LevelCurve {
    int count;
    double level[LEVEL_CURVE_MAX]; /* codes, rising, above 0 up to 255 */
    double share[LEVEL_CURVE_MAX]; /* rising to 1 */
    double miss, rms;              /* errors at the rows, largest and root of the mean square,
                                      of their luminance and LEVEL_CURVE_FLOOR of full level */
    bool is_smooth;                /* fitted through noise */
} LevelCurve;

/* level: codes, rising to 255; cd_m2: their luminance, which does not fall, and more at the
 * last row than at the first. has_black: row 0 is of level 0. Returns the number of rows above
 * level 0 that have no more light than black, to LEVEL_SHARE_LEAST. */
int level_curve_choose(const double *level, const double *cd_m2, int rows, bool has_black,
                       Arena scratch, LevelCurve *out);
