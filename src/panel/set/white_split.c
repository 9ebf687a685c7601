/* SPDX-License-Identifier: Apache-2.0 */
#include "panel/set/white_split.h"

#include <math.h>

#include "spectrum/spectral_table.h"

/* XYZ as non-negative amounts of the Rec.709 primaries: amounts below zero become zero and
 * the luminance is kept. */
static void split_white(const float xyz[3], float amount[3])
{
    float before = 0, after = 0;
    for (int p = 0; p < 3; p++) {
        amount[p] = 0;
        for (int j = 0; j < 3; j++) amount[p] += rgb_from_xyz_matrix[3 * p + j] * xyz[j];
        float weight = xyz_from_rgb_matrix[3 + p];
        before += amount[p] * weight;
        amount[p] = amount[p] > 0 ? amount[p] : 0;
        after += amount[p] * weight;
    }
    for (int p = 0; p < 3; p++) amount[p] *= after > 0 ? before / after : 0;
}

/* How far Rec.709 misses a colour, share of X + Y + Z. */
static double white_miss(const float xyz[3])
{
    float  amount[3];
    double off = 0, sum = 0;
    split_white(xyz, amount);
    for (int j = 0; j < 3; j++) {
        double again = 0;
        for (int p = 0; p < 3; p++)
            again += (double)(amount[p] * xyz_from_rgb_matrix[3 * j + p]);
        off += fabs(again - (double)xyz[j]);
        sum += fabs((double)xyz[j]);
    }
    return sum > 0 ? off / sum : 0;
}

static const float *brightest_row(const AngleTable *table)
{
    const float *brightest = table->value;
    for (int i = 1; i < table->rows; i++)
        if (table->value[3 * i + 1] > brightest[1]) brightest = table->value + 3 * i;
    return brightest;
}

#define OUTSIDE 0.002     /* what a miss may be, where there is light */
#define LEAST_SHARE 0.01f /* of a primary in a colour outside of Rec.709 */

/* Every colour that shines is one of Rec.709? */
static bool is_inside(const AngleTable *table)
{
    float least = 1e-3f * brightest_row(table)[1];
    for (int i = 0; i < table->rows; i++)
        if (table->value[3 * i + 1] > least && white_miss(table->value + 3 * i) > OUTSIDE)
            return false;
    return true;
}

/* Luminous shares of the primaries in the colour nearest to the brightest direction's. */
static void nearest_shares(const AngleTable *table, float share[3])
{
    float sum = 0;
    split_white(brightest_row(table), share);
    for (int p = 0; p < 3; p++) sum += share[p] *= xyz_from_rgb_matrix[3 + p];
    for (int p = 0; p < 3; p++) share[p] = fmaxf(sum > 0 ? share[p] / sum : 1, LEAST_SHARE);
    sum = share[0] + share[1] + share[2];
    for (int p = 0; p < 3; p++) share[p] /= sum;
}

/* Primary p's part of a direction's XYZ: in Rec.709's colours; where those cannot carry the
 * table (as of a saturated primary) a constant share of the table's own colour. */
static void part_of_white(const float xyz[3], const float *share, int p, float part[3])
{
    float amount[3];
    split_white(xyz, amount);
    for (int j = 0; j < 3; j++)
        part[j] = share ? share[p] * xyz[j] : amount[p] * xyz_from_rgb_matrix[3 * j + p];
}

/* ---- levels ----------------------------------------------------------------------------- */

/* Without a table of levels: full level alone, and no black. */
static const LevelCurve full_level = {.count = 1, .level = {255}, .share = {1}};

/* Inputs of a table of the split. */
typedef struct WhiteSplit {
    const AngleTable *white;
    const float      *share; /* of the primaries; NULL: amounts of Rec.709's */
    float             black; /* of white */
    Arena            *arena;
} WhiteSplit;

static AngleTable like_white(const WhiteSplit *split, const char *name, float **value)
{
    AngleTable out = *split->white;
    *value = ARENA_NEW(split->arena, float, 3 * (size_t)out.rows);
    out.name = name;
    out.value = *value;
    out.text_bytes = 0;
    return out;
}

/* Primary p alone at a share of its full level, black in it once. */
static AngleTable level_of_primary(const WhiteSplit *split, int p, double level, double share)
{
    float     *value, part[3];
    AngleTable out = like_white(split, arena_format(split->arena, "%s %03g", primary_names[p],
                                                    level), &value);
    for (int i = 0; i < out.rows; i++) {
        const float *white = split->white->value + 3 * i;
        part_of_white(white, split->share, p, part);
        for (int j = 0; j < 3; j++)
            value[3 * i + j] = part[j] * (1 - split->black) * (float)share +
                               white[j] * split->black;
    }
    return out;
}

static AngleTable black_of(const WhiteSplit *split)
{
    float     *value;
    AngleTable out = like_white(split, "black", &value);
    for (int i = 0; i < 3 * out.rows; i++) value[i] = split->white->value[i] * split->black;
    return out;
}

static void split_levels(const WhiteSplit *split, int p, const LevelCurve *curve,
                         MeasuredPrimary *out)
{
    out->level_count = curve->count;
    for (int i = 0; i < curve->count; i++) {
        out->level[i] = curve->level[i];
        out->table[i] = level_of_primary(split, p, curve->level[i], curve->share[i]);
    }
}

double white_split(const AngleTable *white, const LevelTable *levels, Arena *arena,
                   MeasuredPrimary primary[3], AngleTable *black)
{
    float share[3];
    bool  inside = is_inside(white);
    nearest_shares(white, share);
    WhiteSplit split = {.white = white, .share = inside ? NULL : share, .arena = arena,
                   .black = levels ? (float)levels->black_share : 0};
    for (int p = 0; p < 3; p++)
        split_levels(&split, p, levels ? &levels->curve[p] : &full_level, &primary[p]);
    primary[0].table[0].text_bytes = white->text_bytes; /* the source counts once */
    *black = split.black > 0 ? black_of(&split) : (AngleTable){.rows = 0};
    return inside ? 0 : white_miss(brightest_row(white));
}
