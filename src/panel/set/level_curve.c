/* SPDX-License-Identifier: Apache-2.0 */
#include "panel/set/level_curve.h"

#include <math.h>

#include "base/mathd.h"
#include "panel/shape/panel_levels.h"

#define LEVEL_STEP (1.0 / 256) /* of levels in a panel file */
#define LEVEL_POWER 2.2f       /* of a single level, as in a panel file */

/* The rows that shine, as logarithms, and which of them are kept. */
typedef struct CurveRows {
    const double *level, *cd_m2; /* the first that shines */
    int           count;
    double        black_cd_m2, full_cd_m2; /* full without black */
    float        *log_level, *log_share;
    bool         *is_kept;
} CurveRows;

static double share_of(const CurveRows *rows, int i)
{
    return (rows->cd_m2[i] - rows->black_cd_m2) / rows->full_cd_m2;
}

/* The kept rows' levels and logarithms. */
static int kept_rows(const CurveRows *rows, float x[LEVEL_CURVE_MAX], float y[LEVEL_CURVE_MAX])
{
    int count = 0;
    for (int i = 0; i < rows->count; i++) {
        if (!rows->is_kept[i]) continue;
        x[count] = rows->log_level[i];
        y[count++] = rows->log_share[i];
    }
    return count;
}

/* How far the kept rows' curve misses a row, of its luminance. */
static double miss_of(const CurveRows *rows, int i, const float *x, const float *y, int count)
{
    PanelLevelWeights w = panel_level_weights(x, y, count, LEVEL_POWER, rows->log_level[i]);
    double log_share = (double)w.offset;
    for (int k = 0; k < 4 && w.first + k < count; k++)
        log_share += (double)w.weight[k] * (double)y[w.first + k];
    double found = exp_d(log_share) * rows->full_cd_m2 + rows->black_cd_m2;
    return fabs(found / rows->cd_m2[i] - 1);
}

/* Levels nearer than the file's steps are one. */
static bool is_beside_kept(const CurveRows *rows, int i)
{
    for (int k = i - 1; k >= 0 && rows->level[i] - rows->level[k] < 2 * LEVEL_STEP; k--)
        if (rows->is_kept[k]) return true;
    for (int k = i + 1; k < rows->count; k++) {
        if (!(rows->level[k] - rows->level[i] < 2 * LEVEL_STEP)) break;
        if (rows->is_kept[k]) return true;
    }
    return false;
}

/* The row that is missed most, or -1; *miss of it. */
static int worst_row(const CurveRows *rows, double *miss)
{
    float x[LEVEL_CURVE_MAX], y[LEVEL_CURVE_MAX];
    int   count = kept_rows(rows, x, y), worst = -1;
    *miss = 0;
    for (int i = 0; i < rows->count; i++) {
        double one = rows->is_kept[i] ? 0 : miss_of(rows, i, x, y, count);
        if (!(one > *miss) || is_beside_kept(rows, i)) continue;
        *miss = one;
        worst = i;
    }
    return worst;
}

static CurveRows shining_rows(const double *level, const double *cd_m2, int rows,
                              bool has_black, Arena *scratch)
{
    double black = has_black ? cd_m2[0] : 0;
    int    first = has_black;
    while (first < rows - 1 && (!(cd_m2[first] > black) || level[first] < LEVEL_STEP)) first++;
    CurveRows out = {.level = level + first, .cd_m2 = cd_m2 + first, .count = rows - first,
                     .black_cd_m2 = black, .full_cd_m2 = cd_m2[rows - 1] - black};
    out.log_level = ARENA_NEW(scratch, float, out.count);
    out.log_share = ARENA_NEW(scratch, float, out.count);
    out.is_kept = ARENA_NEW(scratch, bool, out.count);
    for (int i = 0; i < out.count; i++) {
        out.log_level[i] = (float)log_d(out.level[i]);
        out.log_share[i] = (float)log_d(share_of(&out, i));
    }
    out.is_kept[0] = out.is_kept[out.count - 1] = true;
    return out;
}

int level_curve_choose(const double *level, const double *cd_m2, int rows, bool has_black,
                       Arena scratch, LevelCurve *out)
{
    CurveRows of = shining_rows(level, cd_m2, rows, has_black, &scratch);
    int       count = of.count > 1 ? 2 : 1;
    *out = (LevelCurve){0};
    for (;;) {
        int worst = worst_row(&of, &out->miss);
        if (worst < 0 || out->miss <= LEVEL_CURVE_MISS || count == LEVEL_CURVE_MAX) break;
        of.is_kept[worst] = true;
        count++;
    }
    for (int i = 0; i < of.count; i++) {
        if (!of.is_kept[i]) continue;
        out->level[out->count] = of.level[i];
        out->share[out->count++] = share_of(&of, i);
    }
    return rows - of.count - has_black;
}
