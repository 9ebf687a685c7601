/* SPDX-License-Identifier: Apache-2.0 */
/* level_table.h -- a measured gamma table: the luminance on the axis at grey levels, read and
 * checked, as level curves of the primaries.
 *
 * A text table (text/csv_table.h): a column of levels (level, code, grey, gray) and columns of
 * luminance: white (W, Y, L, Lv, luminance, relative), or red, green and blue (R, G, B; each
 * shown alone), or all four. Units behind a name, in brackets or after '_', are passed over.
 * Luminance is in cd/m2, or relative to full level where all columns end at 1. Other columns are
 * left. Levels run to the highest code (as stated; else 255, 1023, 4095 or 65535) or to 1
 * (shares).
 *
 * Rows may fall below others, or below zero, by LEVEL_NOISE_SHARE (of neighbours,
 * LEVEL_NOISE_NEAR) of the others or LEVEL_NOISE_FULL of full level, whichever is more: an
 * instrument's noise, which is large beside black. They become their neighbours' mean.
 *
 * With L(g) the luminance at level g, the black pattern in it,
 *   share(g) = (L(g) - L(0)) / (L(255) - L(0))     of what full level adds to black
 *   black    = L(0) / L(255)                       0 without a row of level 0
 *
 * from which level_curve.h makes level curves.
 *
 * Units    levels as codes in [0, 255]; luminance in cd m^-2; shares without unit.
 * Memory   the arena's. Threads: const once read.
 * Fails    with file, line, found and required: fewer than two rows, no or an unclear full
 *          level, values below zero, luminance that falls, a level twice, no light at full
 *          level.
 */
#pragma once
#include "base/error.h"
#include "panel/set/level_curve.h"

#define LEVEL_NOISE_SHARE 0.01 /* of luminance, by which it may fall; */
#define LEVEL_NOISE_NEAR 0.05  /* the same below a level less than LEVEL_NEAR times lower */
#define LEVEL_NEAR 1.05
#define LEVEL_NOISE_FULL 1e-4 /* of full level: the same */
#define LEVEL_TABLE_ROWS_MAX 65536
#define LEVEL_TABLE_FULL_MISS 0.05 /* of full level to the set's white */

typedef struct LevelTable {
    const char *file;
    int rows;
    double *level;                            /* codes, rising */
    int *line;                                /* of the rows, in the file */
    bool has_white, has_primaries, has_black; /* black: a row of level 0 */
    bool is_relative;    /* what stands below as cd/m2: each column in its own scale */
    int noise_rows;      /* that fell by noise, in the column with most of them */
    double *white_cd_m2; /* rows; measured, or the sum of the primaries */
    double *primary_cd_m2[3];
    double black_share;
    int dark_rows;       /* above level 0 without more light than black: left out */
    LevelCurve curve[3]; /* of red, green, blue; all white's without their columns */
} LevelTable;

/* level_max: the highest code; 0: not stated. */
bool level_table_read(const char *file, double level_max, Arena *arena, LevelTable *out,
                      Error *err);

/* Full level against the white that a set has on the axis, cd m^-2, from `source`. */
bool level_table_check_white(const LevelTable *table, double white_cd_m2, const char *source,
                             Error *err);

/* The table as this project writes it: level, white or the primaries, or all of them. */
const char *level_table_text(const LevelTable *table, Arena *arena);

/* In one line: what was measured, what is made of it. */
const char *level_table_note(const LevelTable *table, Arena *arena);
