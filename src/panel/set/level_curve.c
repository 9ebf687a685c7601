/* SPDX-License-Identifier: Apache-2.0 */
#include "panel/set/level_curve.h"

#include <math.h>

#include "base/mathd.h"
#include "panel/shape/panel_levels.h"

/* ---- the rows that a level curve needs --------------------------------------------------- */

#define LEVEL_STEP (1.0 / 256) /* of levels in a panel file */
#define LEVEL_POWER 2.2f       /* of a single level, as in a panel file */

/* The rows that shine, as logarithms, and which of them are kept. */
typedef struct CurveRows {
    const double *level, *cd_m2; /* the first that shines */
    int count;
    double black_cd_m2, full_cd_m2; /* full without black */
    float *log_level, *log_share;
    bool *is_kept;
} CurveRows;

static double share_of(const CurveRows *rows, int i) {
    return (rows->cd_m2[i] - rows->black_cd_m2) / rows->full_cd_m2;
}

/* The kept rows' levels and logarithms. */
static int kept_rows(const CurveRows *rows, float x[LEVEL_CURVE_MAX], float y[LEVEL_CURVE_MAX]) {
    int count = 0;
    for (int i = 0; i < rows->count; i++) {
        if (!rows->is_kept[i]) continue;
        x[count] = rows->log_level[i];
        y[count++] = rows->log_share[i];
    }
    return count;
}

/* How far the kept rows' curve misses a row, of what the eye compares it with. */
static double miss_of(const CurveRows *rows, int i, const float *x, const float *y, int count) {
    PanelLevelWeights w = panel_level_weights(x, y, count, LEVEL_POWER, rows->log_level[i]);
    double log_share = (double)w.offset;
    for (int k = 0; k < 4 && w.first + k < count; k++)
        log_share += (double)w.weight[k] * (double)y[w.first + k];
    double found = exp_d(log_share) * rows->full_cd_m2 + rows->black_cd_m2;
    return fabs(found - rows->cd_m2[i]) / (rows->cd_m2[i] + LEVEL_CURVE_FLOOR * rows->full_cd_m2);
}

/* Levels nearer than the file's steps are one. */
static bool is_beside_kept(const CurveRows *rows, int i) {
    for (int k = i - 1; k >= 0 && rows->level[i] - rows->level[k] < 2 * LEVEL_STEP; k--)
        if (rows->is_kept[k]) return true;
    for (int k = i + 1; k < rows->count; k++) {
        if (!(rows->level[k] - rows->level[i] < 2 * LEVEL_STEP)) break;
        if (rows->is_kept[k]) return true;
    }
    return false;
}

/* The row that is missed most, or -1; *miss of it. */
static int worst_row(const CurveRows *rows, double *miss) {
    float x[LEVEL_CURVE_MAX], y[LEVEL_CURVE_MAX];
    int count = kept_rows(rows, x, y), worst = -1;
    *miss = 0;
    for (int i = 0; i < rows->count; i++) {
        double one = rows->is_kept[i] ? 0 : miss_of(rows, i, x, y, count);
        if (!(one > *miss) || is_beside_kept(rows, i)) continue;
        *miss = one;
        worst = i;
    }
    return worst;
}

static CurveRows shining_rows(const double *level, const double *cd_m2, int rows, bool has_black,
                              Arena *scratch) {
    double black = has_black ? cd_m2[0] : 0;
    int first = has_black;
    double least = black + LEVEL_SHARE_LEAST * (cd_m2[rows - 1] - black);
    while (first < rows - 1 && (!(cd_m2[first] > least) || level[first] < LEVEL_STEP)) first++;
    CurveRows out = {.level = level + first,
                     .cd_m2 = cd_m2 + first,
                     .count = rows - first,
                     .black_cd_m2 = black,
                     .full_cd_m2 = cd_m2[rows - 1] - black};
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

/* ---- through noise ----------------------------------------------------------------------- */

#define SMOOTH_LEVELS 32 /* about: even in the cube root of the code, as lightness is */

/* A row's weight where its luminance is compared with a floor, and the logarithm is fitted. */
static double weight_of(const CurveRows *rows, int i) {
    double part = share_of(rows, i) * rows->full_cd_m2;
    double of = part / (rows->cd_m2[i] + LEVEL_CURVE_FLOOR * rows->full_cd_m2);
    return of * of;
}

/* At a code the weighted least-squares line through the rows between two others, which count
 * the less the further away they are; NAN: there are none. */
static double line_at(const CurveRows *rows, double from, double at, double to) {
    double w = 0, x = 0, y = 0, xx = 0, xy = 0;
    for (int i = 0; i < rows->count; i++) {
        double d = (double)rows->log_level[i] - log_d(at);
        double near = 1 - d / log_d((d < 0 ? from : to) / at);
        double one = weight_of(rows, i) * near;
        if (!(near > 0)) continue;
        w += one;
        x += one * d;
        y += one * (double)rows->log_share[i];
        xx += one * d * d;
        xy += one * d * (double)rows->log_share[i];
    }
    double turn = w * xx - x * x;
    if (!(w > 0)) return NAN;
    return turn > 1e-9 * w * xx ? (y * xx - x * xy) / turn : y / w;
}

/* Few whole codes, and what the rows around each say together; full level stays. */
static void smooth_rows(const CurveRows *rows, float x[LEVEL_CURVE_MAX], float y[LEVEL_CURVE_MAX],
                        LevelCurve *out) {
    double first = fmax(1, ceil(rows->level[0])), code[SMOOTH_LEVELS];
    double low = pow_d(first, 1.0 / 3);
    double step = (pow_d(255, 1.0 / 3) - low) / (SMOOTH_LEVELS - 1);
    int count = 0;
    for (int k = 0; k < SMOOTH_LEVELS; k++) {
        double one = rint(pow_d(low + k * step, 3));
        if (!count || one > code[count - 1]) code[count++] = one;
    }
    for (int k = 0, n; k < count; k++) {
        double from = k ? code[k - 1] : fmin(code[0], rows->level[0]) / 2;
        double log_share = k + 1 < count ? line_at(rows, from, code[k], code[k + 1]) : 0;
        if (isnan(log_share)) continue;
        n = out->count++;
        x[n] = (float)log_d(code[k]);
        y[n] = fminf(n ? fmaxf((float)log_share, y[n - 1]) : (float)log_share, 0);
        out->level[n] = code[k];
        out->share[n] = exp_d((double)y[n]);
    }
    out->is_smooth = true;
}

/* ---- the curve --------------------------------------------------------------------------- */

/* False: the curve would have to follow the rows one by one, so they are noise about it. */
static bool keep_rows(CurveRows *rows) {
    for (int count = rows->count > 1 ? 2 : 1;; count++) {
        double miss;
        int worst = worst_row(rows, &miss);
        if (worst < 0 || miss <= LEVEL_CURVE_MISS) return true;
        if (count == LEVEL_CURVE_MAX) return false;
        rows->is_kept[worst] = true;
    }
}

int level_curve_choose(const double *level, const double *cd_m2, int rows, bool has_black,
                       Arena scratch, LevelCurve *out) {
    CurveRows of = shining_rows(level, cd_m2, rows, has_black, &scratch);
    float x[LEVEL_CURVE_MAX], y[LEVEL_CURVE_MAX];
    *out = (LevelCurve){.is_smooth = false};
    if (keep_rows(&of)) {
        kept_rows(&of, x, y);
        for (int i = 0; i < of.count; i++) {
            if (!of.is_kept[i]) continue;
            out->level[out->count] = of.level[i];
            out->share[out->count++] = share_of(&of, i);
        }
    } else {
        smooth_rows(&of, x, y, out);
    }
    double squares = 0;
    for (int i = 0; i < of.count; i++) {
        double miss = miss_of(&of, i, x, y, out->count);
        squares += miss * miss;
        out->miss = fmax(out->miss, miss);
    }
    out->rms = sqrt(squares / of.count);
    return rows - of.count - has_black;
}
