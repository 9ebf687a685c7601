/* Emission: tables of XYZ to principal components in one Haar tree. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/units.h"
#include "panel/direction_grid.h"
#include "panel/fit_parts.h"
#include "panel/principal.h"

#define DEFAULT_LEVEL 6
#define CHANNELS_MAX (3 * (3 * PANEL_LEVELS_MAX + 1))

/* Where every leaf reads a table: shared by all tables of the same directions. */
typedef struct LeafTaps {
    const AngleTable *table; /* the one that it was made for */
    DirectionGrid     grid;
    GridTaps         *taps;  /* per leaf */
    struct LeafTaps  *next;
} LeafTaps;

typedef struct Leaves {
    int       level, count, channels;
    Vec3     *center;
    double   *area;
    float    *logs; /* count x channels */
    float    *floor; /* per channel, cd m^-2 */
    LeafTaps *taps;
    Arena    *arena;
    double    cone; /* radians: the narrowest table's */
} Leaves;

static double polar(Vec3 d)
{
    return acos(fmin(1, fmax(0, (double)d.z)));
}

static const LeafTaps *taps_for(Leaves *leaves, const AngleTable *table)
{
    for (LeafTaps *t = leaves->taps; t; t = t->next)
        if (direction_grid_same_rows(t->table, table)) return t;
    LeafTaps *taps = ARENA_NEW(leaves->arena, LeafTaps, 1);
    taps->table = table;
    taps->taps = ARENA_NEW(leaves->arena, GridTaps, leaves->count);
    direction_grid_build(table, false, leaves->arena, &taps->grid);
    for (int i = 0; i < leaves->count; i++) {
        Vec3 d = leaves->center[i];
        direction_grid_taps(&taps->grid, (float)polar(d), atan2f(d.y, d.x), &taps->taps[i]);
    }
    taps->next = leaves->taps;
    leaves->taps = taps;
    return taps;
}

/* XYZ of a table at every leaf; beyond the cone the last ring's value falls with cos theta. */
static float *leaf_values(Leaves *leaves, const AngleTable *table)
{
    const LeafTaps *taps = taps_for(leaves, table);
    float *cells = direction_grid_cells(&taps->grid, table->value, 3, leaves->arena);
    float *out = ARENA_NEW(leaves->arena, float, 3 * (size_t)leaves->count);
    float  edge = fmaxf(cosf(table->theta_max), 1e-3f);
    for (int i = 0; i < leaves->count; i++) {
        direction_grid_read(&taps->taps[i], cells, 3, out + 3 * i);
        if (taps->taps[i].is_outside)
            for (int j = 0; j < 3; j++) out[3 * i + j] *= leaves->center[i].z / edge;
    }
    return out;
}

static int by_value(const void *a, const void *b)
{
    double p = *(const double *)a, q = *(const double *)b;
    return p < q ? -1 : p > q;
}

double fit_noise(const AngleTable *table, int channel, Arena scratch)
{
    double *third = ARENA_NEW(&scratch, double, table->rows + 1);
    int     count = 0, size = table->channels;
    for (int i = 3; i < table->rows; i++) { /* rows are sorted: neighbours on a ring */
        if (table->theta[i] != table->theta[i - 3] || table->theta[i] > radians_from_degrees(70))
            continue;
        const float *v = table->value + (size_t)i * (size_t)size + channel;
        double a = (double)v[0], b = (double)v[-size], c = (double)v[-2 * size],
               d = (double)v[-3 * size], mean = (a + b + c + d) / 4;
        if (mean > 0) third[count++] = fabs(a - 3 * b + 3 * c - d) / mean;
    }
    if (count < 16) return 0;
    qsort(third, (size_t)count, sizeof *third, by_value);
    return third[count / 2] / (0.6745 * sqrt(20)); /* the median of |normal|, 1 3 3 1 */
}

static float table_maximum(const float *values, int count, int component)
{
    float most = 0;
    for (int i = 0; i < count; i++) most = fmaxf(most, values[3 * i + component]);
    return most;
}

/* ln of three components into the leaves' channels. `black` may be NULL. */
static void add_channels(Leaves *leaves, int first, const float *values, const float *black,
                         double noise)
{
    for (int j = 0; j < 3; j++) {
        float most = table_maximum(values, leaves->count, j);
        float floor = fmaxf(1e-6f * most, 1e-9f);
        leaves->floor[first + j] = floor;
        for (int i = 0; i < leaves->count; i++) {
            float total = values[3 * i + j], dark = black ? black[3 * i + j] : 0;
            /* what noise cannot tell from black stays at a fifth of the noise */
            float least = fmaxf(floor * leaves->center[i].z,
                                black ? 0.2f * (float)noise * total : 0);
            leaves->logs[(size_t)i * (size_t)leaves->channels + (size_t)(first + j)] =
                logf(fmaxf(total - dark, fmaxf(least, 1e-12f)));
        }
    }
}

static void narrow_cone(Leaves *leaves, const AngleTable *table)
{
    leaves->cone = fmin(leaves->cone, (double)table->theta_max);
}

/* A black pattern whose light is below every meter's reach is a true black. */
static bool black_shines(const Measurement *set)
{
    double sum = 0, noise = 0;
    if (!set->has_black) return false;
    for (int i = 0; i < set->black.rows; i++) {
        sum += (double)set->black.value[3 * i + 1];
        noise += fabs((double)set->black.value[3 * i + 1]);
    }
    return sum > 0.5 * noise && sum / set->black.rows > 1e-4;
}

static Leaves start_leaves(int level, int channels, HaarWeights weights, Arena *arena)
{
    (void)weights;
    Leaves leaves = {.level = level, .count = (int)geodesic_count(level), .channels = channels,
                     .arena = arena, .cone = 0.5 * PI};
    leaves.center = ARENA_NEW(arena, Vec3, leaves.count);
    leaves.area = ARENA_NEW(arena, double, leaves.count);
    leaves.logs = ARENA_NEW(arena, float, (size_t)leaves.count * (size_t)channels);
    leaves.floor = ARENA_NEW(arena, float, channels);
    for (int i = 0; i < leaves.count; i++) {
        leaves.center[i] = geodesic_center(level, (uint32_t)i);
        leaves.area[i] = geodesic_area(level, (uint32_t)i);
    }
    return leaves;
}

static void fill_channels(const Measurement *set, Leaves *leaves, FitEmission *out)
{
    const float *black = out->head.has_black ? leaf_values(leaves, &set->black) : NULL;
    int channel = 0, table = 0;
    for (int p = 0; p < 3; p++)
        for (int i = 0; i < set->primary[p].level_count; i++, channel += 3, table++) {
            const AngleTable *from = &set->primary[p].table[i];
            Arena saved = *leaves->arena;
            out->noise[table] = fit_noise(from, 1, saved);
            add_channels(leaves, channel, leaf_values(leaves, from), black, out->noise[table]);
            narrow_cone(leaves, from);
        }
    if (!black) return;
    out->noise[table] = fit_noise(&set->black, 1, *leaves->arena);
    add_channels(leaves, channel, black, NULL, out->noise[table]);
    narrow_cone(leaves, &set->black);
}

/* What a channel's relative error is worth: its share of the light that the eye gets with it,
 * the black pattern included (between 1% and 1). */
static void channel_weights(const Leaves *leaves, bool has_black, double *weight)
{
    int black = leaves->channels - 3;
    for (int c = 0; c < leaves->channels; c++) {
        double share = 0, area = 0;
        for (int i = 0; i < leaves->count; i += 7) {
            const float *row = leaves->logs + (size_t)i * (size_t)leaves->channels;
            double dark = has_black && c < black
                              ? exp((double)row[black + c % 3] - (double)row[c]) : 0;
            share += leaves->area[i] / (1 + dark);
            area += leaves->area[i];
        }
        weight[c] = fmax(0.01, share / area);
    }
}

/* Ranges of log X/Y and log Z/Y over the measured cone, where the light is clear of the
 * floor. Source 0..2: a primary's levels; 3: the black pattern. */
static void ratio_range(const Leaves *leaves, int first, int count, float low[2], float high[2])
{
    for (int k = 0; k < 2; k++) low[k] = 1e9f, high[k] = -1e9f;
    for (int i = 0; i < leaves->count; i++) {
        if (polar(leaves->center[i]) > leaves->cone) continue;
        const float *row = leaves->logs + (size_t)i * (size_t)leaves->channels;
        for (int c = first; c < first + count; c += 3) {
            float ratio[2] = {row[c] - row[c + 1], row[c + 2] - row[c + 1]};
            for (int k = 0; k < 2; k++) {
                if (logf(4 * leaves->floor[c + 2 * k]) > row[c + 2 * k]) continue;
                low[k] = fminf(low[k], ratio[k]);
                high[k] = fmaxf(high[k], ratio[k]);
            }
        }
    }
    for (int k = 0; k < 2; k++) {
        if (!(high[k] >= low[k])) low[k] = -1, high[k] = 1;
        low[k] -= 0.02f;
        high[k] += 0.02f;
    }
}

static void find_ranges(const Measurement *set, const Leaves *leaves, FitEmission *out)
{
    int first = 0;
    for (int p = 0; p < 4; p++) {
        int count = p < 3 ? 3 * set->primary[p].level_count : out->head.has_black ? 3 : 0;
        ratio_range(leaves, first, count, out->ratio_low[p], out->ratio_high[p]);
        int axis = 0, last = first + count - 3;
        for (int i = 0; i < leaves->count; i++)
            if (leaves->center[i].z > leaves->center[axis].z) axis = i;
        for (int j = 0; j < 3 && count; j++)
            out->peak_xyz[p][j] =
                exp((double)leaves->logs[(size_t)axis * (size_t)leaves->channels +
                                         (size_t)(last + j)]);
        first += count;
    }
}

static void mean_luminances(const Leaves *leaves, float *mean_y)
{
    for (int c = 1; c < leaves->channels; c += 3) {
        double sum = 0, weight = 0;
        for (int i = 0; i < leaves->count; i++) {
            double w = leaves->area[i] * (double)leaves->center[i].z;
            sum += w * exp((double)leaves->logs[(size_t)i * (size_t)leaves->channels + (size_t)c]);
            weight += w;
        }
        mean_y[c / 3] = (float)(sum / weight);
    }
}

static bool build_tree(const Leaves *leaves, const FitOptions *options, const Principal *rank,
                       FitEmission *out, Error *err)
{
    float scale[PANEL_COMPONENTS_MAX];
    for (int k = 0; k < rank->components; k++) {
        double most = 0;
        for (int c = 0; c < leaves->channels; c++)
            most = fmax(most, fabs(rank->weight[c] * (double)rank->loading[c * rank->components + k]));
        scale[k] = (float)fmax(most, 1e-6);
    }
    TreeOptions tree = {.shape = {leaves->level, 4, rank->components, options->weights},
                        .keep_share = options->keep_share, .max_error = options->max_error,
                        .component_scale = scale, .rows = TREE_ROWS_INT16};
    return tree_build(&tree, rank->score, leaves->arena, &out->tree, &out->tree_report, err) ||
           error_prefix(err, "emission");
}

static void note_grids(const Leaves *leaves, FitNotes *notes)
{
    for (const LeafTaps *t = leaves->taps; t; t = t->next) {
        if (t->grid.widest_gap > radians_from_degrees(30))
            fit_note(notes, "table '%s': azimuths up to %.0f degrees apart; between them the "
                     "values are interpolated (periodic cubic), not measured", t->table->name,
                     degrees_from_radians((double)t->grid.widest_gap));
        if (t->grid.is_scattered)
            fit_note(notes, "table '%s': directions without a grid's order; resampled by "
                     "moving least squares", t->table->name);
        else if (t->grid.filled_cells)
            fit_note(notes, "table '%s': %d of %d grid directions are missing; filled from "
                     "their neighbours", t->table->name, t->grid.filled_cells,
                     t->grid.thetas * t->grid.phis);
    }
}

bool fit_emission(const Measurement *set, const FitOptions *options, Arena *arena,
                  FitNotes *notes, FitEmission *out, Error *err)
{
    double weight[CHANNELS_MAX];
    int    channels = 0;
    out->head.has_black = black_shines(set);
    for (int p = 0; p < 3; p++) {
        const MeasuredPrimary *from = &set->primary[p];
        out->head.level_count[p] = (uint32_t)from->level_count;
        for (int i = 0; i < from->level_count; i++) out->head.level[p][i] = (float)from->level[i];
        channels += 3 * from->level_count;
    }
    channels += out->head.has_black ? 3 : 0;
    int level = options->level ? options->level : DEFAULT_LEVEL;
    Leaves leaves = start_leaves(level, channels, options->weights, arena);
    fill_channels(set, &leaves, out);
    channel_weights(&leaves, out->head.has_black, weight);
    find_ranges(set, &leaves, out);
    out->mean_y = ARENA_NEW(arena, float, channels / 3);
    mean_luminances(&leaves, out->mean_y);
    double tolerance = options->max_error > 0 ? 0.15 * (double)options->max_error : 3e-4;
    Principal rank = principal_components(leaves.logs, leaves.area, weight,
                                          (PrincipalShape){leaves.count, channels,
                                              PANEL_COMPONENTS_MAX / 2, tolerance}, arena);
    out->rank_residual = rank.residual;
    out->mean = rank.mean;
    out->loading = rank.loading;
    out->head.channels = (uint32_t)channels;
    out->head.components = (uint32_t)rank.components;
    out->head.cone_cos = cosf((float)leaves.cone);
    out->head.level_power = 2.2f;
    note_grids(&leaves, notes);
    if (set->has_black && !out->head.has_black)
        fit_note(notes, "the black pattern is below 0.0001 cd/m2 or noise: black is 0");
    return build_tree(&leaves, options, &rank, out, err);
}
