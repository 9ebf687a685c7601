/* SPDX-License-Identifier: Apache-2.0 */
/* level_table.h -- a measured gamma table: the luminance on the axis at grey levels, read and
 * checked, as level curves of the primaries.
 *
 * A text table (text/csv_table.h): a column of levels (level, code, grey, gray, input, signal,
 * drive, digital) and columns of luminance: white (W, Y, L, Lv, luminance), or red, green
 * and blue (R, G, B; each shown alone), or all four. Units behind a name, in brackets or after
 * '_', are passed over but for % of a level; luminance is in cd/m2. Other columns are left.
 * Levels run to 255 (codes), to 1 (shares), or to 100 in a column whose name has a %.
 *
 * With L(g) the luminance at level g, the black pattern in it,
 *   share(g) = (L(g) - L(0)) / (L(255) - L(0))     of what full level adds to black
 *   black    = L(0) / L(255)                       0 without a row of level 0
 *
 * A panel keeps at most LEVEL_CURVE_MAX levels a primary and interpolates between them as in
 * panel/shape/panel_levels.h (Fritsch and Butland's monotone cubic pieces of the logarithm
 * over ln code). Kept are the lowest row with more light than black, full level, and then, one
 * by one, the row that is missed most, until no row is missed by more than LEVEL_CURVE_MISS of
 * its luminance.
 *
 * Units    levels as codes in [0, 255]; luminance in cd m^-2; shares without unit.
 * Memory   the arena's. Threads: const once read.
 * Fails    with file, line, found and wanted: fewer than two rows, no or an unclear full level,
 *          values below zero, luminance that falls, a level twice, no light at full level.
 */
#pragma once
#include "base/error.h"
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

#define LEVEL_TABLE_ROWS_MAX 65536
#define LEVEL_TABLE_FULL_MISS 0.05 /* of full level to the set's white */

typedef struct LevelTable {
    const char *file;
    int         rows;
    double     *level;          /* codes, rising */
    int        *line;           /* of the rows, in the file */
    bool        has_white, has_primaries, has_black; /* black: a row of level 0 */
    double     *white_cd_m2;    /* rows; measured, or the sum of the primaries */
    double     *primary_cd_m2[3];
    double      black_share;
    int         dark_rows;      /* above level 0 without more light than black: left out */
    LevelCurve  curve[3];       /* of red, green, blue; all white's without their columns */
} LevelTable;

bool level_table_read(const char *file, Arena *arena, LevelTable *out, Error *err);

/* Full level against the white that a set has on the axis, cd m^-2, from `source`. */
bool level_table_check_white(const LevelTable *table, double white_cd_m2, const char *source,
                             Error *err);

/* The table as this project writes it: level, white or the primaries, or all of them. */
const char *level_table_text(const LevelTable *table, Arena *arena);

/* In one line: what was measured, what is made of it. */
const char *level_table_note(const LevelTable *table, Arena *arena);
