/* SPDX-License-Identifier: Apache-2.0 */
#include "review/light/light_parts.h"

#include <math.h>
#include <stdlib.h>

#define COUNTS_FROM 0.95 /* of the most cells that a part shows */
#define EQUAL 1e-6       /* parts that differ less are alike */
#define EVEN 0.01        /* of the mean light: what is known differs less among even parts */
#define SURE 2.0         /* standard errors by which samples must tell a part from another */

int light_parts_count(const LightParts *parts) {
    return (parts->columns - parts->wide + 1) * (parts->rows - parts->high + 1);
}

void light_parts_place(const LightParts *parts, int part, int *column, int *row) {
    int across = parts->columns - parts->wide + 1;
    *column = part % across;
    *row = part / across;
}

/* ---- sums over parts --------------------------------------------------------------------- */

/* sums[(row + 1) * (columns + 1) + column + 1]: of all cells up to there. */
typedef struct CellSum {
    double value;
    int count;
} CellSum;

static CellSum *sums_of(const LightParts *parts, const double *values, Arena *arena) {
    int across = parts->columns + 1;
    CellSum *sums = ARENA_NEW(arena, CellSum, (size_t)across * (size_t)(parts->rows + 1));
    for (int i = 0; i < parts->aim.target_count; i++) {
        int cell = parts->cell_of[i];
        int at = (cell / parts->columns + 1) * across + cell % parts->columns + 1;
        sums[at] = (CellSum){values[i], 1};
    }
    for (int row = 1; row <= parts->rows; row++)
        for (int column = 1; column < across; column++) {
            CellSum *to = &sums[row * across + column];
            CellSum left = to[-1], above = to[-across], both = to[-across - 1];
            to->value += left.value + above.value - both.value;
            to->count += left.count + above.count - both.count;
        }
    return sums;
}

static CellSum sum_of_part(const LightParts *parts, const CellSum *sums, int part) {
    int column, row, across = parts->columns + 1;
    light_parts_place(parts, part, &column, &row);
    const CellSum *low = &sums[row * across + column];
    const CellSum *high = low + parts->high * across;
    return (CellSum){
        high[parts->wide].value - high[0].value - low[parts->wide].value + low[0].value,
        high[parts->wide].count - high[0].count - low[parts->wide].count + low[0].count};
}

/* Twice how far a part lies from the middle, in cells. */
static int off_middle(const LightParts *parts, int part) {
    int column, row;
    light_parts_place(parts, part, &column, &row);
    return abs(2 * column + parts->wide - parts->columns) +
           abs(2 * row + parts->high - parts->rows);
}

/* Values that are the greater the worse. */
static double sign_of(const LightParts *parts) {
    return parts->takes_least ? -1 : 1;
}

/* Is part a worse than b? */
static bool is_worse(const LightParts *parts, const double *means, int a, int b) {
    double apart = sign_of(parts) * (means[a] - means[b]);
    if (fabs(apart) > EQUAL * fmax(fabs(means[a]), fabs(means[b]))) return apart > 0;
    return off_middle(parts, a) < off_middle(parts, b);
}

static int worst_of(const LightParts *parts, const double *means) {
    int worst = -1, count = light_parts_count(parts);
    for (int i = 0; i < count; i++)
        if (!isnan(means[i]) && (worst < 0 || is_worse(parts, means, i, worst))) worst = i;
    return worst;
}

int light_parts_worst(const LightParts *parts, const double *values, double *means, int *counts,
                      Arena scratch) {
    const CellSum *sums = sums_of(parts, values, &scratch);
    int count = light_parts_count(parts), most = 0;
    for (int i = 0; i < count; i++) {
        int seen = sum_of_part(parts, sums, i).count;
        most = seen > most ? seen : most;
    }
    for (int i = 0; i < count; i++) {
        CellSum sum = sum_of_part(parts, sums, i);
        bool is_counted = sum.count > 0 && sum.count >= COUNTS_FROM * most;
        means[i] = is_counted ? sum.value / sum.count : (double)NAN;
        if (counts) counts[i] = sum.count;
    }
    return worst_of(parts, means);
}

/* ---- what samples show of them ----------------------------------------------------------- */

/* Samples of a target less what is known of it; light by cell, so that cells of more paths
 * count no more. */
static double beside(const TargetLight *sampled, double known) {
    return sampled->paths > 0 ? (double)(sampled->sum / sampled->paths) - known : 0;
}

/* Of one target's mean by chance: variance of a sample over the paths to a target. */
static double chance_of(const LightParts *parts, const TargetLight *sampled, const double *known) {
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

static double share_that_counts(const LightParts *parts, const double *means, const int *counts,
                                double chance) {
    double sum = 0, squares = 0, by_chance = 0;
    int of = 0, count = light_parts_count(parts);
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

static double mean_of(const double *values, int count) {
    double sum = 0;
    for (int i = 0; i < count; i++) sum += values[i];
    return count ? sum / count : 0;
}

/* How values rise from cell to cell along an axis. */
typedef struct Rise {
    double slope, middle; /* 0 in the middle */
    double variance;      /* of the slope by chance */
} Rise;

static double place_of_cell(const LightParts *parts, int target, int axis) {
    int cell = parts->cell_of[target];
    return axis ? cell / parts->columns : cell % parts->columns;
}

/* By least squares, less what chance explains of it; taken out of the values. */
static Rise take_rise(const LightParts *parts, int axis, double chance, double *values) {
    double n = parts->aim.target_count, x = 0, y = 0, xx = 0, xy = 0;
    for (int i = 0; i < parts->aim.target_count; i++) {
        double at = place_of_cell(parts, i, axis);
        x += at;
        y += values[i];
        xx += at * at;
        xy += at * values[i];
    }
    double spread = n > 0 ? xx - x * x / n : 0;
    if (!(spread > 0)) return (Rise){0, 0, 0};
    Rise rise = {(xy - x * y / n) / spread, x / n, chance / spread};
    double square = rise.slope * rise.slope;
    rise.slope *= square > rise.variance ? 1 - rise.variance / square : 0;
    for (int i = 0; i < parts->aim.target_count; i++)
        values[i] -= rise.slope * (place_of_cell(parts, i, axis) - rise.middle);
    return rise;
}

/* From where a rise is 0 to the middle of a part, or of all of them: LIGHT_PARTS_ALL. */
static double along_rise(const LightParts *parts, const Rise *rise, int part, int axis) {
    int place[2];
    if (part < 0) return 0;
    light_parts_place(parts, part, &place[0], &place[1]);
    return place[axis] + 0.5 * ((axis ? parts->high : parts->wide) - 1) - rise->middle;
}

/* What samples say of parts, each less the mean of all cells. */
typedef struct PartsSaid {
    Rise rise[2];
    const double *rest; /* [part] beside the rises, the share that counts of it */
    const int *counts;  /* [part] */
    double chance;      /* the variance of a cell's, as far as it counts in `rest` */
} PartsSaid;

static double said_of(const LightParts *parts, const PartsSaid *said, int part) {
    double sum = part < 0 ? 0 : said->rest[part];
    for (int k = 0; k < 2; k++)
        sum += said->rise[k].slope * along_rise(parts, &said->rise[k], part, k);
    return sum;
}

/* Of the difference between what is said of two parts. */
static double error_between(const LightParts *parts, const PartsSaid *said, int a, int b) {
    double variance = 0;
    for (int k = 0; k < 2; k++) {
        double apart =
            along_rise(parts, &said->rise[k], a, k) - along_rise(parts, &said->rise[k], b, k);
        variance += said->rise[k].variance * apart * apart;
    }
    if (a >= 0) variance += said->chance / said->counts[a];
    if (b >= 0) variance += said->chance / said->counts[b];
    return sqrt(variance);
}

/* values: of each target by samples, beside what is known; they are used up. */
static PartsSaid samples_say(const LightParts *parts, const TargetLight *sampled,
                             const double *known, Arena *arena) {
    PartsSaid said;
    int count = light_parts_count(parts), targets = parts->aim.target_count;
    double *values = ARENA_NEW(arena, double, targets);
    double *rest = ARENA_NEW(arena, double, count);
    int *counts = ARENA_NEW(arena, int, count);
    double chance = chance_of(parts, sampled, known);
    for (int i = 0; i < targets; i++) values[i] = beside(&sampled[i], known[i]);
    for (int k = 0; k < 2; k++) said.rise[k] = take_rise(parts, k, chance, values);
    double mean = mean_of(values, targets);
    light_parts_worst(parts, values, rest, counts, *arena);
    double share = share_that_counts(parts, rest, counts, chance);
    for (int i = 0; i < count; i++) rest[i] = share * (rest[i] - mean);
    said.rest = rest;
    said.counts = counts;
    said.chance = share * share * chance;
    return said;
}

int light_parts_choose(const LightParts *parts, const TargetLight *sampled, const double *known,
                       Arena scratch) {
    int count = light_parts_count(parts), targets = parts->aim.target_count;
    double *means = ARENA_NEW(&scratch, double, count);
    double *with = ARENA_NEW(&scratch, double, count);
    double even = mean_of(known, targets), light = 0;
    int by_known = light_parts_worst(parts, known, means, NULL, scratch);
    for (int i = 0; i < targets; i++) light += known[i] + beside(&sampled[i], known[i]);
    if (by_known >= 0 && !(sign_of(parts) * (means[by_known] - even) > EVEN * light / targets))
        by_known = LIGHT_PARTS_ALL;
    PartsSaid said = samples_say(parts, sampled, known, &scratch);
    for (int i = 0; i < count; i++) with[i] = means[i] + said_of(parts, &said, i);
    int worst = worst_of(parts, with);
    if (worst < 0) return LIGHT_PARTS_ALL;
    double without = (by_known < 0 ? even : means[by_known]) + said_of(parts, &said, by_known);
    double error = error_between(parts, &said, worst, by_known);
    return sign_of(parts) * (with[worst] - without) > SURE * error ? worst : by_known;
}
