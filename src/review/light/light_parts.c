/* SPDX-License-Identifier: Apache-2.0 */
#include "review/light/light_parts.h"

#include <math.h>
#include <stdlib.h>

#define COUNTS_FROM 0.95 /* of the most cells that a part shows */
#define EQUAL 1e-6       /* parts that differ less are alike */

int light_parts_count(const LightParts *parts)
{
    return (parts->columns - parts->wide + 1) * (parts->rows - parts->high + 1);
}

void light_parts_place(const LightParts *parts, int part, int *column, int *row)
{
    int across = parts->columns - parts->wide + 1;
    *column = part % across;
    *row = part / across;
}

/* ---- sums over parts --------------------------------------------------------------------- */

/* sums[(row + 1) * (columns + 1) + column + 1]: of all cells up to there. */
typedef struct CellSum {
    double value;
    int    count;
} CellSum;

static CellSum *sums_of(const LightParts *parts, const double *values, Arena *arena)
{
    int      across = parts->columns + 1;
    CellSum *sums = ARENA_NEW(arena, CellSum, (size_t)across * (size_t)(parts->rows + 1));
    for (int i = 0; i < parts->aim.target_count; i++) {
        int cell = parts->cell_of[i];
        int at = (cell / parts->columns + 1) * across + cell % parts->columns + 1;
        sums[at] = (CellSum){values[i], 1};
    }
    for (int row = 1; row <= parts->rows; row++)
        for (int column = 1; column < across; column++) {
            CellSum *to = &sums[row * across + column];
            CellSum  left = to[-1], above = to[-across], both = to[-across - 1];
            to->value += left.value + above.value - both.value;
            to->count += left.count + above.count - both.count;
        }
    return sums;
}

static CellSum sum_of_part(const LightParts *parts, const CellSum *sums, int part)
{
    int column, row, across = parts->columns + 1;
    light_parts_place(parts, part, &column, &row);
    const CellSum *low = &sums[row * across + column];
    const CellSum *high = low + parts->high * across;
    return (CellSum){high[parts->wide].value - high[0].value - low[parts->wide].value +
                         low[0].value,
                     high[parts->wide].count - high[0].count - low[parts->wide].count +
                         low[0].count};
}

/* Twice how far a part lies from the middle, in cells. */
static int off_middle(const LightParts *parts, int part)
{
    int column, row;
    light_parts_place(parts, part, &column, &row);
    return abs(2 * column + parts->wide - parts->columns) +
           abs(2 * row + parts->high - parts->rows);
}

/* Is part a worse than b? */
static bool is_worse(const LightParts *parts, const double *means, int a, int b)
{
    double apart = means[a] - means[b];
    if (fabs(apart) > EQUAL * fmax(fabs(means[a]), fabs(means[b]))) return apart > 0;
    return off_middle(parts, a) < off_middle(parts, b);
}

static int worst_of(const LightParts *parts, const double *means)
{
    int worst = -1, count = light_parts_count(parts);
    for (int i = 0; i < count; i++)
        if (!isnan(means[i]) && (worst < 0 || is_worse(parts, means, i, worst))) worst = i;
    return worst;
}

int light_parts_worst(const LightParts *parts, const double *values, double *means,
                      int *counts, Arena scratch)
{
    const CellSum *sums = sums_of(parts, values, &scratch);
    int count = light_parts_count(parts), most = 0;
    for (int i = 0; i < count; i++) {
        int seen = sum_of_part(parts, sums, i).count;
        most = seen > most ? seen : most;
    }
    for (int i = 0; i < count; i++) {
        CellSum sum = sum_of_part(parts, sums, i);
        bool    is_counted = sum.count > 0 && sum.count >= COUNTS_FROM * most;
        means[i] = is_counted ? sum.value / sum.count : (double)NAN;
        if (counts) counts[i] = sum.count;
    }
    return worst_of(parts, means);
}

/* ---- what samples tell of them ----------------------------------------------------------- */

/* Samples of a target less what is known of it; light by cell, so that cells of more paths
 * count no more. */
static double beside(const TargetLight *sampled, double known)
{
    return sampled->paths > 0 ? (double)(sampled->sum / sampled->paths) - known : 0;
}

/* Of one target's mean by chance: variance of a sample over the paths to a target. */
static double chance_of(const LightParts *parts, const TargetLight *sampled,
                        const double *known)
{
    double paths = 0, sum = 0, squares = 0;
    for (int i = 0; i < parts->aim.target_count; i++) {
        const TargetLight *t = &sampled[i];
        double n = (double)t->paths, x = (double)t->sum, k = known[i];
        paths += n;
        sum += x - n * k;
        squares += (double)t->squares - 2 * k * x + n * k * k;
    }
    if (!(paths > 0)) return 0;
    double mean = sum / paths;
    return fmax(squares / paths - mean * mean, 0) * parts->aim.target_count / paths;
}

static double share_that_counts(const LightParts *parts, const double *means,
                                const int *counts, double chance)
{
    double sum = 0, squares = 0, by_chance = 0;
    int    of = 0, count = light_parts_count(parts);
    for (int i = 0; i < count; i++) {
        if (isnan(means[i])) continue;
        sum += means[i];
        squares += means[i] * means[i];
        by_chance += chance / counts[i];
        of++;
    }
    double spread = of ? squares - sum * sum / of : 0;
    return spread > by_chance ? 1 - by_chance / spread : 0;
}

int light_parts_choose(const LightParts *parts, const TargetLight *sampled,
                       const double *known, Arena scratch)
{
    int     count = light_parts_count(parts), targets = parts->aim.target_count;
    double *values = ARENA_NEW(&scratch, double, targets);
    double *means = ARENA_NEW(&scratch, double, count);
    double *with = ARENA_NEW(&scratch, double, count);
    int    *counts = ARENA_NEW(&scratch, int, count);
    for (int i = 0; i < targets; i++) values[i] = beside(&sampled[i], known[i]);
    light_parts_worst(parts, values, means, counts, scratch);
    double share =
        share_that_counts(parts, means, counts, chance_of(parts, sampled, known));
    light_parts_worst(parts, known, with, NULL, scratch);
    for (int i = 0; i < count; i++) with[i] += share * means[i];
    return worst_of(parts, with);
}
