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
    FitPlaces places;
    int       count, channels;
    float    *logs; /* count x channels, leaves and rings */
    float    *doubt; /* count x channels: standard deviation of the logarithm */
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
        Vec3 d = leaves->places.direction[i];
        direction_grid_taps(&taps->grid, (float)polar(d), atan2f(d.y, d.x), &taps->taps[i]);
    }
    taps->next = leaves->taps;
    leaves->taps = taps;
    return taps;
}

/* About how a display falls to the horizon, in powers of cos theta: taken out of the
 * logarithms between rings, so that the last rings do not bend them. */
#define HORIZON_POWER 1.5f

static float horizon_fall(float theta)
{
    return HORIZON_POWER * logf(fmaxf(cosf(theta), 1e-4f));
}

/* ln of the cells over the fall to the horizon; what is below the floor (noise, zeros) is held
 * there. */
static float *log_cells(const DirectionGrid *grid, const AngleTable *table, Arena *arena)
{
    float *cells = direction_grid_cells(grid, table->value, 3, arena);
    size_t count = 3 * (size_t)(grid->thetas * grid->phis);
    float  most[3] = {0, 0, 0};
    for (size_t i = 0; i < count; i++) most[i % 3] = fmaxf(most[i % 3], cells[i]);
    for (size_t i = 0; i < count; i++)
        cells[i] = logf(fmaxf(cells[i], fmaxf(1e-6f * most[i % 3], 1e-9f))) -
                   horizon_fall(grid->theta[i / 3 / (size_t)grid->phis]);
    return cells;
}

/* d ln value / d ln cos theta between two rings of the cone's edge, at an azimuth, held
 * between 0.5 and 4: how the value goes on falling to 0 at the horizon (less HORIZON_POWER). */
static void edge_power(const DirectionGrid *grid, const float *cells, float phi, float power[3])
{
    GridTaps inner, outer;
    float    a[3], b[3], last = grid->theta[grid->thetas - 1];
    float    before = fmaxf(0, last - fmaxf((float)radians_from_degrees(3),
                                            1.5f * (last - grid->theta[grid->thetas - 2])));
    direction_grid_taps(grid, before, phi, &inner);
    direction_grid_taps(grid, last, phi, &outer);
    direction_grid_read(&inner, cells, 3, a);
    direction_grid_read(&outer, cells, 3, b);
    for (int j = 0; j < 3; j++) {
        float slope = (b[j] - a[j]) / logf(fmaxf(cosf(last), 1e-4f) / cosf(before));
        power[j] = fminf(4 - HORIZON_POWER, fmaxf(0.5f - HORIZON_POWER, slope));
    }
}

/* XYZ of a table at every leaf, the logarithm between rows; beyond the cone the power law in
 * cos theta that the last rings follow. */
static float *leaf_values(Leaves *leaves, const AngleTable *table)
{
    const LeafTaps *taps = taps_for(leaves, table);
    const DirectionGrid *grid = &taps->grid;
    float *cells = log_cells(grid, table, leaves->arena);
    float *out = ARENA_NEW(leaves->arena, float, 3 * (size_t)leaves->count);
    float  edge = fmaxf(cosf(table->theta_max), 1e-3f);
    for (int i = 0; i < leaves->count; i++) {
        float power[3] = {0, 0, 0}, *to = out + 3 * i;
        Vec3  d = leaves->places.direction[i];
        direction_grid_read(&taps->taps[i], cells, 3, to);
        bool outside = taps->taps[i].is_outside && grid->thetas > 1;
        if (outside) edge_power(grid, cells, atan2f(d.y, d.x), power);
        for (int j = 0; j < 3; j++)
            to[j] = expf(to[j] + horizon_fall(panel_polar_angle(d)) +
                         (outside ? power[j] * logf(d.z / edge) : 0));
    }
    return out;
}

static float table_maximum(const float *values, int count, int component)
{
    float most = 0;
    for (int i = 0; i < count; i++) most = fmaxf(most, values[3 * i + component]);
    return most;
}

/* ln of three components into the leaves' channels, and how far noise may have moved it. */
static void add_channels(Leaves *leaves, int first, const AngleTable *table,
                         const float *values, const float *black, double noise)
{
    for (int j = 0; j < 3; j++) {
        float floor = fmaxf(1e-6f * table_maximum(values, leaves->count, j), 1e-9f);
        float dim_noise = (float)fit_dim_noise(table, j, *leaves->arena);
        for (int i = 0; i < leaves->count; i++) {
            float total = values[3 * i + j], dark = black ? black[3 * i + j] : 0;
            float sigma = sqrtf((float)(noise * noise) * total * total +
                                (black ? 2 : 1) * dim_noise * dim_noise);
            /* what noise cannot tell from black stays at a fifth of the noise */
            float least = fmaxf(1e-12f, fmaxf(floor * leaves->places.direction[i].z,
                                              black ? 0.2f * sigma : 0));
            float  value = fmaxf(total - dark, least);
            size_t at = (size_t)i * (size_t)leaves->channels + (size_t)(first + j);
            leaves->logs[at] = logf(value);
            leaves->doubt[at] = fminf(sigma / value, 1e3f);
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

static Leaves start_leaves(int level, int channels, Arena *arena)
{
    Leaves leaves = {.places = fit_places(level, 4, arena), .channels = channels,
                     .arena = arena, .cone = 0.5 * PI};
    leaves.count = leaves.places.count;
    leaves.logs = ARENA_NEW(arena, float, (size_t)leaves.count * (size_t)channels);
    leaves.doubt = ARENA_NEW(arena, float, (size_t)leaves.count * (size_t)channels);
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
            add_channels(leaves, channel, from, leaf_values(leaves, from), black,
                         out->noise[table]);
            narrow_cone(leaves, from);
        }
    if (!black) return;
    out->noise[table] = fit_noise(&set->black, 1, *leaves->arena);
    add_channels(leaves, channel, &set->black, black, NULL, out->noise[table]);
    narrow_cone(leaves, &set->black);
}

/* A place's channels. */
static float *row_of(const Leaves *leaves, int place)
{
    return leaves->logs + (size_t)place * (size_t)leaves->channels;
}

/* ---- noise ----------------------------------------------------------------------------- */

#define DOUBT 0.015 /* where noise exceeds this share a brighter table speaks as well */

/* Weight of a channel's own word at a place. */
static double own_word(const Leaves *leaves, int place, int channel)
{
    double s = (double)leaves->doubt[(size_t)place * (size_t)leaves->channels +
                                     (size_t)channel] / DOUBT;
    return 1 / (1 + s * s * s * s);
}

/* ln of the ratio of two channels' sums over the hemisphere: what is known of a channel that is
 * nowhere clear of the noise. */
static double ratio_of_sums(const Leaves *leaves, int channel, int brighter)
{
    double sum[2] = {0, 0};
    for (int i = 0; i < leaves->places.leaves; i++) {
        const float *row = row_of(leaves, i);
        double w = leaves->places.area[i] * (double)leaves->places.direction[i].z;
        sum[0] += w * exp((double)row[channel]);
        sum[1] += w * exp((double)row[brighter]);
    }
    return log(sum[0] / sum[1]);
}

/* The difference of two channels' logarithms, line[0] + line[1] sin^2 theta, fitted where the
 * first can be trusted. */
static void fit_difference(const Leaves *leaves, int channel, int brighter, double line[2])
{
    double m[2][2] = {{0}}, r[2] = {0, 0};
    for (int i = 0; i < leaves->places.leaves; i++) {
        const float *row = row_of(leaves, i);
        double z = (double)leaves->places.direction[i].z, s = 1 - z * z;
        double w = leaves->places.area[i] * own_word(leaves, i, channel);
        double d = (double)(row[channel] - row[brighter]);
        m[0][0] += w, m[0][1] += w * s, m[1][1] += w * s * s;
        r[0] += w * d, r[1] += w * s * d;
    }
    double det = m[0][0] * m[1][1] - m[0][1] * m[0][1];
    line[0] = ratio_of_sums(leaves, channel, brighter);
    line[1] = 0;
    if (!(det > 1e-6 * m[0][0] * m[0][0]) || !(m[0][0] > 0.2)) return; /* too little light */
    line[0] = (r[0] * m[1][1] - r[1] * m[0][1]) / det;
    line[1] = (r[1] * m[0][0] - r[0] * m[0][1]) / det;
}

/* Where a channel drowns in noise it follows a brighter one. */
static void follow(Leaves *leaves, int channel, int brighter)
{
    double line[2];
    fit_difference(leaves, channel, brighter, line);
    for (int i = 0; i < leaves->count; i++) {
        float *row = row_of(leaves, i);
        float *doubt = leaves->doubt + (size_t)i * (size_t)leaves->channels;
        double z = (double)leaves->places.direction[i].z;
        double told = (double)row[brighter] + line[0] + line[1] * (1 - z * z);
        double w = own_word(leaves, i, channel);
        row[channel] = (float)(w * (double)row[channel] + (1 - w) * told);
        doubt[channel] = (float)w * doubt[channel] + (float)(1 - w) * doubt[brighter];
    }
}

/* X and Z of the brightest level follow its Y, each dimmer level the next brighter one. */
static void quieten(Leaves *leaves, const FitEmission *out)
{
    int first = 0;
    for (int p = 0; p < 4; p++) {
        int count = p < 3 ? (int)out->head.level_count[p] : (int)out->head.has_black;
        int top = first + 3 * (count - 1);
        for (int j = 0; j < 3 && count; j++)
            if (j != 1) follow(leaves, top + j, top + 1);
        for (int c = top - 1; c >= first; c--) follow(leaves, c, c + 3);
        first += 3 * count;
    }
}

/* What a channel's relative error is worth: its share of the light that the eye gets with it,
 * the black pattern included (between 1% and 1). */
static void channel_weights(const Leaves *leaves, bool has_black, double *weight)
{
    int black = leaves->channels - 3;
    for (int c = 0; c < leaves->channels; c++) {
        double share = 0, area = 0;
        for (int i = 0; i < leaves->count; i += 7) {
            const float *row = row_of(leaves, i);
            double dark = has_black && c < black
                              ? exp((double)row[black + c % 3] - (double)row[c]) : 0;
            share += leaves->places.area[i] / (1 + dark);
            area += leaves->places.area[i];
        }
        weight[c] = fmax(0.01, share / area);
    }
}

/* Axes of a cloud of (ln X/Y, ln Z/Y): its centre and the direction of its largest spread. */
static void cloud_axes(double *const ratio[2], int count, PanelBend *out)
{
    double mean[2] = {0, 0}, m[3] = {0, 0, 0};
    for (int i = 0; i < count; i++)
        for (int k = 0; k < 2; k++) mean[k] += ratio[k][i] / count;
    for (int i = 0; i < count; i++) {
        double u = ratio[0][i] - mean[0], v = ratio[1][i] - mean[1];
        m[0] += u * u, m[1] += u * v, m[2] += v * v;
    }
    double angle = 0.5 * atan2(2 * m[1], m[0] - m[2]);
    for (int k = 0; k < 2; k++) out->origin[k] = (float)mean[k];
    out->along[0] = (float)cos(angle);
    out->along[1] = (float)sin(angle);
}

/* Where the colours lie along and across these axes; half a percent at either end is left
 * out, a margin is added. */
static void cloud_range(double *const ratio[2], int count, PanelBend *out)
{
    for (int i = 0; i < count; i++) {
        double u = ratio[0][i] - (double)out->origin[0];
        double v = ratio[1][i] - (double)out->origin[1];
        ratio[0][i] = u * (double)out->along[0] + v * (double)out->along[1];
        ratio[1][i] = v * (double)out->along[0] - u * (double)out->along[1];
    }
    for (int k = 0; k < 2; k++) {
        qsort(ratio[k], (size_t)count, sizeof(double), fit_by_value);
        double low = ratio[k][count / 200], high = ratio[k][count - 1 - count / 200];
        double margin = 0.002 + 0.05 * (high - low);
        out->low[k] = (float)(low - margin);
        out->high[k] = (float)(high + margin);
    }
}

/* Colours over the measured cone, where a table's light is above a fiftieth of its maximum
 * (and 0.2 cd/m2): noise has no colour. Source 0..2: a primary's levels; 3: black. */
static void find_range(const Leaves *leaves, int first, int count, PanelBend *out)
{
    double *ratio[2];
    int     kept = 0;
    Arena   scratch = *leaves->arena;
    *out = (PanelBend){.along = {1, 0}, .low = {-1, -1}, .high = {1, 1}};
    for (int k = 0; k < 2; k++)
        ratio[k] = ARENA_NEW(&scratch, double, (size_t)leaves->count * (size_t)(count / 3 + 1));
    for (int c = first; c < first + count; c += 3) {
        float most = logf(0.2f * 50);
        for (int i = 0; i < leaves->count; i++)
            most = fmaxf(most, row_of(leaves, i)[c + 1]);
        for (int i = 0; i < leaves->count; i++) {
            const float *row = row_of(leaves, i) + c;
            if (polar(leaves->places.direction[i]) > leaves->cone) continue;
            if (row[1] < most - logf(50)) continue;
            ratio[0][kept] = (double)(row[0] - row[1]);
            ratio[1][kept++] = (double)(row[2] - row[1]);
        }
    }
    if (!kept) return;
    cloud_axes(ratio, kept, out);
    cloud_range(ratio, kept, out);
}

static void find_ranges(const Measurement *set, const Leaves *leaves, FitEmission *out)
{
    int first = 0;
    for (int p = 0; p < 4; p++) {
        int count = p < 3 ? 3 * set->primary[p].level_count : out->head.has_black ? 3 : 0;
        find_range(leaves, first, count, &out->range[p]);
        int axis = 0, last = first + count - 3;
        for (int i = 0; i < leaves->count; i++)
            if (leaves->places.direction[i].z > leaves->places.direction[axis].z) axis = i;
        for (int j = 0; j < 3 && count; j++)
            out->peak_xyz[p][j] =
                exp((double)row_of(leaves, axis)[last + j]);
        first += count;
    }
}

static void mean_luminances(const Leaves *leaves, float *mean_y)
{
    for (int c = 1; c < leaves->channels; c += 3) {
        double sum = 0, weight = 0;
        for (int i = 0; i < leaves->count; i++) {
            double w = leaves->places.area[i] * (double)leaves->places.direction[i].z;
            sum += w * exp((double)row_of(leaves, i)[c]);
            weight += w;
        }
        mean_y[c / 3] = (float)(sum / weight);
    }
}

/* What all channels lose towards the horizon, d ln / d ln cos theta over the last 15 degrees of
 * the hemisphere, is taken out of the logarithms. */
static void share_cosine_power(Leaves *leaves, PanelEmission *head)
{
    double sum = 0, weight = 0;
    int    near = leaves->places.leaves + 150 * FIT_RING, far = near + 26 * FIT_RING;
    for (int i = 0; i < FIT_RING; i++)
        for (int c = 0; c < leaves->channels; c++) {
            const float *a = leaves->logs + (size_t)(near + i) * (size_t)leaves->channels + c;
            const float *b = leaves->logs + (size_t)(far + i) * (size_t)leaves->channels + c;
            sum += (double)(*b - *a) / log((double)leaves->places.direction[far + i].z /
                                           (double)leaves->places.direction[near + i].z);
            weight++;
        }
    head->cosine_power = (float)fmin(5, fmax(0, sum / weight));
    for (int i = 0; i < leaves->count; i++) {
        float fall = head->cosine_power * logf(fmaxf(leaves->places.direction[i].z, 1e-4f));
        for (int c = 0; c < leaves->channels; c++)
            leaves->logs[(size_t)i * (size_t)leaves->channels + (size_t)c] -= fall;
    }
}

/* The tables' noise need not be stored. */
static double median_noise(const double *noise, int count)
{
    double sorted[3 * PANEL_LEVELS_MAX + 1];
    memcpy(sorted, noise, sizeof *sorted * (size_t)count);
    qsort(sorted, (size_t)count, sizeof *sorted, fit_by_value);
    return sorted[count / 2];
}

/* What the smooth profile leaves at a place is believed as far as it stands out of the noise
 * there: shrunk by 1 - (2 sigma / rest)^2, sigma the channels' doubt carried to a component. */
static void shrink_noise(const Leaves *leaves, const Principal *rank)
{
    for (int i = 0; i < leaves->places.leaves; i++)
        for (int k = 0; k < rank->components; k++) {
            double variance = 1e-20;
            float *rest = &rank->score[(size_t)i * (size_t)rank->components + (size_t)k];
            for (int c = 0; c < leaves->channels; c++) {
                double w = rank->weight[c];
                double part = w * w * (double)rank->loading[c * rank->components + k] *
                    (double)leaves->doubt[(size_t)i * (size_t)leaves->channels + (size_t)c];
                variance += part * part;
            }
            double share = 1 - 4 * variance / ((double)*rest * (double)*rest + 1e-20);
            *rest *= (float)fmax(0, share);
        }
}

static bool build_tree(const Leaves *leaves, const FitOptions *options, const Principal *rank,
                       FitEmission *out, Error *err)
{
    out->head.harmonics = FIT_EMISSION_HARMONICS;
    out->profile = fit_profile(&leaves->places, rank->score, rank->components,
                               FIT_EMISSION_HARMONICS, leaves->arena);
    shrink_noise(leaves, rank);
    float scale[PANEL_COMPONENTS_MAX];
    for (int k = 0; k < rank->components; k++) {
        double most = 0;
        for (int c = 0; c < leaves->channels; c++)
            most = fmax(most, rank->weight[c] *
                                  fabs((double)rank->loading[c * rank->components + k]));
        scale[k] = (float)fmax(most, 1e-6);
    }
    double bound = fmax((double)options->max_error, 3 * median_noise(out->noise,
                                                                     leaves->channels / 3));
    TreeOptions tree = {.shape = {leaves->places.level, 4, rank->components, options->weights},
                        .keep_share = options->keep_share,
                        .max_error = options->max_error > 0 ? (float)bound : 0,
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
        for (int i = 0; i < from->level_count; i++)
            out->head.level[p][i] = (float)from->level[i];
        channels += 3 * from->level_count;
    }
    channels += out->head.has_black ? 3 : 0;
    int level = options->level ? options->level : DEFAULT_LEVEL;
    Leaves leaves = start_leaves(level, channels, arena);
    fill_channels(set, &leaves, out);
    quieten(&leaves, out);
    channel_weights(&leaves, out->head.has_black, weight);
    find_ranges(set, &leaves, out);
    out->mean_y = ARENA_NEW(arena, float, channels / 3);
    mean_luminances(&leaves, out->mean_y);
    double tolerance = options->max_error > 0 ? 0.15 * (double)options->max_error : 3e-4;
    tolerance = fmax(tolerance, median_noise(out->noise, channels / 3));
    share_cosine_power(&leaves, &out->head);
    Principal rank = principal_components(leaves.logs, leaves.places.area, weight,
                                          (PrincipalShape){leaves.count, channels,
                                              PANEL_COMPONENTS_MAX / 2, tolerance}, arena);
    out->rank_residual = rank.residual;
    out->mean = rank.mean;
    out->loading = rank.loading;
    out->head.channels = (uint32_t)channels;
    out->head.components = (uint32_t)rank.components;
    out->head.cone_cos = fmaxf(0, cosf((float)leaves.cone));
    out->head.level_power = 2.2f;
    note_grids(&leaves, notes);
    if (set->has_black && !out->head.has_black)
        fit_note(notes, "the black pattern is below 0.0001 cd/m2 or noise: black is 0");
    return build_tree(&leaves, options, &rank, out, err);
}
