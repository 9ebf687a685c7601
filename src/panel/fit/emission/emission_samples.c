/* SPDX-License-Identifier: Apache-2.0 */
#include "panel/fit/emission/emission_samples.h"

#include <math.h>

#include "base/mathd.h"
#include "base/mathf.h"
#include "base/sort.h"
#include "base/units.h"
#include "panel/fit/common/direction_grid.h"
#include "panel/fit/common/scatter_surface.h"
#include "panel/fit/common/table_rows.h"

EmissionTable emission_samples_table(const Measurement *set, bool has_black, int index) {
    for (int p = 0; p < 3; p++) {
        const MeasuredPrimary *primary = &set->primary[p];
        if (index < primary->level_count)
            return (EmissionTable){&primary->table[index], p, index, (float)primary->level[index]};
        index -= primary->level_count;
    }
    return (EmissionTable){has_black && index == 0 ? &set->black : NULL, 3, 0, 0};
}

/* The rows of one table at the directions of the master, for tables with other directions:
 * cubic in the logarithm. */
typedef struct Resampler {
    const AngleTable *table;
    DirectionGrid grid;
    const float *cells; /* ln value */
} Resampler;

static Resampler start_resampler(const AngleTable *table, Arena *arena) {
    Resampler out = {.table = table};
    direction_grid_build(table, false, arena, &out.grid);
    float *cells = direction_grid_cells(&out.grid, table->value, 3, arena), most[3] = {0, 0, 0};
    int count = 3 * out.grid.thetas * out.grid.phis;
    for (int i = 0; i < count; i++) most[i % 3] = fmaxf(most[i % 3], cells[i]);
    for (int i = 0; i < count; i++)
        cells[i] = log_f(fmaxf(cells[i], fmaxf(1e-6f * most[i % 3], 1e-9f)));
    out.cells = cells;
    return out;
}

/* False: outside of the table. */
static bool resample(const Resampler *from, float theta, float phi, float value[3]) {
    GridTaps taps;
    direction_grid_taps(&from->grid, theta, phi, &taps);
    direction_grid_read(&taps, from->cells, 3, value);
    for (int j = 0; j < 3; j++) value[j] = exp_f(value[j]);
    return theta <= from->table->theta_max + 1e-4f;
}

/* Even a table without noise is not to be followed further than this share of the tolerance. */
#define LEAST_SIGMA 0.05

/* Relative sigma, at least, of values interpolated between a table's directions. */
#define RESAMPLED_SIGMA 0.002

double emission_samples_floor(const AngleTable *table, int channel, const uint8_t *outlier,
                              double share) {
    double most = 0;
    for (int i = 0; i < table->rows; i++)
        if (!outlier || !outlier[i])
            most = fmax(most, (double)table->value[3 * (size_t)i + (size_t)channel]);
    return fmax(share * most, EMISSION_NO_LIGHT);
}

/* Most rows stand on a ring of their own, which is what rings are looked for in first. */
bool emission_samples_are_scattered(const AngleTable *table, Arena scratch) {
    DirectionGrid grid;
    int rings = 0;
    for (int i = 0; i < table->rows; i = table_ring_end(table, i)) rings++;
    if (2 * rings <= table->rows) return false;
    direction_grid_build(table, false, &scratch, &grid);
    return grid.is_scattered;
}

/* ---- edges ------------------------------------------------------------------------------ */

/* A jump is a ratio of neighbours that no smooth lamp has, and by far more than the intervals
 * beside it: the flank of a narrow beam is as steep, but so are its neighbours. */
#define JUMP 8.0f
#define STEEPER 3.0f
#define SEEN 0.05f     /* of the largest light */
#define DARKNESS 1e-3f /* of the largest light: darkness below it is all the same */

/* Of four samples in a row: do the middle ones jump, and is there light? */
static bool jumps(const float at[4]) {
    float before = fabsf(at[1] - at[0]), here = fabsf(at[2] - at[1]), behind = fabsf(at[3] - at[2]);
    return fmaxf(at[1], at[2]) > log_f(SEEN) && here > log_f(JUMP) &&
           here > STEEPER * fmaxf(before, behind);
}

/* ln of the light of a ring at an azimuth; a ring before the first lies across the pole, one
 * behind the last is as it. */
static float cell_log(const DirectionGrid *g, const float *cell, int ring, int azimuth) {
    int n = g->phis, first = g->has_pole;
    if (ring < 0) ring = first - 1 - ring, azimuth += n / 2;
    if (ring >= g->thetas) ring = g->thetas - 1;
    return cell[ring * n + (azimuth % n + n) % n];
}

static bool have_edges(const AngleTable *table, const uint8_t *outlier, Arena scratch) {
    DirectionGrid grid;
    size_t numbers = 3 * (size_t)table->rows;
    float *value = ARENA_NEW(&scratch, float, numbers);
    for (size_t i = 0; i < numbers; i++) value[i] = outlier[i / 3] ? NAN : table->value[i];
    direction_grid_build(table, false, &scratch, &grid);
    int rings = grid.thetas, n = grid.phis;
    float *cell = direction_grid_cells(&grid, value, 3, &scratch), most = 1e-30f;
    if (grid.is_scattered || rings < 3) return false;
    for (int i = 0; i < rings * n; i++) most = fmaxf(most, cell[3 * i + 1]);
    for (int i = 0; i < rings * n; i++)
        cell[i] = isnan(cell[3 * i + 1]) ? NAN : log_f(fmaxf(0, cell[3 * i + 1]) / most + DARKNESS);
    for (int i = 0; i < rings * n; i++) {
        int ring = i / n, a = i % n;
        float out[4], turn[4];
        for (int k = 0; k < 4; k++) {
            out[k] = cell_log(&grid, cell, ring + k - 1, a);
            turn[k] = cell_log(&grid, cell, ring, a + k - 1);
        }
        if (jumps(out) || (n >= 4 && jumps(turn))) return true;
    }
    return false;
}

double emission_noise_sigma(const EmissionNoise *noise, int channel, double value) {
    return noise->has_edges ? 0 : hypot_d(noise->relative[channel] * value, noise->dim[channel]);
}

EmissionNoise emission_samples_noise(const AngleTable *table, const uint8_t *outlier,
                                     Arena scratch) {
    EmissionNoise noise = {.has_edges = have_edges(table, outlier, scratch)};
    bool is_scattered = emission_samples_are_scattered(table, scratch);
    for (int j = 0; j < 3; j++) {
        noise.relative[j] = is_scattered ? scatter_surface_table_noise(table, j, true, scratch)
                                         : table_noise_relative(table, j, scratch);
        noise.dim[j] = table_noise_dim(table, j, scratch);
    }
    return noise;
}

/* A logarithm follows darkness without end: nothing goes below this share of the floor. */
#define HELD 0.003

static void put_row(EmissionSamples *out, int row, int channel, const float value[3],
                    const EmissionNoise *noise) {
    for (int j = 0; j < 3; j++) {
        double floor = out->floor[channel + j];
        size_t at = (size_t)row * (size_t)out->channels + (size_t)(channel + j);
        double held = HELD * floor;
        double m = (double)value[j], scale = fmax(fabs(m), floor);
        out->total[at] =
            m < held && noise->dim[j] < held && held > EMISSION_NO_LIGHT ? (float)held : value[j];
        double sigma = emission_noise_sigma(noise, j, m);
        out->sigma[at] = (float)hypot_d(sigma, LEAST_SIGMA * out->tolerance * scale);
    }
}

static void put_nothing(EmissionSamples *out, int row, int channel) {
    for (int j = 0; j < 3; j++) {
        size_t at = (size_t)row * (size_t)out->channels + (size_t)(channel + j);
        out->total[at] = 0;
        out->sigma[at] = INFINITY;
    }
}

/* By theta, then phi. */
static int order_of(const AngleTable *a, int i, const AngleTable *b, int j) {
    if (a->theta[i] != b->theta[j]) return a->theta[i] < b->theta[j] ? -1 : 1;
    if (a->phi[i] != b->phi[j]) return a->phi[i] < b->phi[j] ? -1 : 1;
    return 0;
}

/* For every row of `to` the row of `from` in the same direction, or -1. Returns how many have
 * one. */
static int match_rows(const AngleTable *to, const AngleTable *from, int *row) {
    int j = 0, matched = 0;
    for (int i = 0; i < to->rows; i++) {
        while (j < from->rows && order_of(from, j, to, i) < 0) j++;
        row[i] = j < from->rows && order_of(from, j, to, i) == 0 ? j : -1;
        matched += row[i] >= 0;
    }
    return matched;
}

/* Tables on one grid differ by a few missing directions at most. */
static bool is_on_grid(const AngleTable *grid, const AngleTable *table, Arena scratch) {
    return 2 * match_rows(grid, table, ARENA_NEW(&scratch, int, grid->rows)) > table->rows;
}

static void put_table(EmissionSamples *out, const AngleTable *table, int channel,
                      const uint8_t *outlier, EmissionNoise noise, Arena scratch) {
    int *row = ARENA_NEW(&scratch, int, out->rows);
    if (2 * match_rows(out->master, table, row) > table->rows) {
        for (int i = 0; i < out->rows; i++)
            if (row[i] < 0 || outlier[row[i]]) put_nothing(out, i, channel);
            else put_row(out, i, channel, table->value + 3 * row[i], &noise);
        return;
    }
    Resampler from = start_resampler(table, &scratch);
    for (int j = 0; j < 3; j++) noise.relative[j] = fmax(noise.relative[j], RESAMPLED_SIGMA);
    for (int i = 0; i < out->rows; i++) {
        float value[3];
        if (resample(&from, out->master->theta[i], out->master->phi[i], value))
            put_row(out, i, channel, value, &noise);
        else put_nothing(out, i, channel);
    }
}

/* Unknown numbers start from the known rows before and behind them. */
static void fill_unknown(EmissionSamples *out, int channel) {
    size_t step = (size_t)out->channels, known = SIZE_MAX;
    for (size_t i = 0; i < (size_t)out->rows; i++) {
        size_t at = i * step + (size_t)channel;
        if (!isinf(out->sigma[at])) {
            known = at;
            continue;
        }
        size_t next = i + 1;
        while (next < (size_t)out->rows && isinf(out->sigma[next * step + (size_t)channel])) next++;
        bool has_next = next < (size_t)out->rows;
        float behind = has_next ? out->total[next * step + (size_t)channel] : 0;
        float before = known == SIZE_MAX ? behind : out->total[known];
        out->total[at] = has_next ? sqrtf(fmaxf(before, 0) * fmaxf(behind, 0)) : before;
    }
}

/* Rows' areas: the ring's share of the hemisphere over its rows; and how dense they are. */
static void measure_rows(EmissionSamples *out, Arena scratch) {
    const AngleTable *table = out->master;
    float *phi = ARENA_NEW(&scratch, float, table->rows);
    int rings = 0, azimuths = 0;
    for (int i = 0; i < table->rows;) {
        int end = table_ring_end(table, i);
        double theta = (double)table->theta[i];
        double before = i ? (double)table->theta[i - 1] : -theta;
        double after = end < table->rows ? (double)table->theta[end] : 2 * theta - before;
        double low = fmax(0, 0.5 * (before + theta));
        double high = fmin(PI / 2, 0.5 * (theta + after));
        for (int k = i; k < end; k++)
            out->area[k] = fmax(1e-9, (cos_d(low) - cos_d(high)) / (end - i));
        rings++;
        i = end;
    }
    for (int i = 0; i < table->rows; i++) phi[i] = table->phi[i];
    sort_floats(phi, table->rows);
    for (int i = 0; i < table->rows; i++) azimuths += i == 0 || phi[i] - phi[i - 1] > 1e-3f;
    out->azimuths = azimuths;
    out->step_deg = degrees_from_radians((double)table->theta_max) / (rings > 1 ? rings - 1 : 1);
}

/* The directions of both. */
static const AngleTable *unite(const AngleTable *a, const AngleTable *b, Arena *arena) {
    AngleTable *out = ARENA_NEW(arena, AngleTable, 1);
    float *theta = ARENA_NEW(arena, float, a->rows + b->rows);
    float *phi = ARENA_NEW(arena, float, a->rows + b->rows);
    int rows = 0, i = 0, j = 0;
    while (i < a->rows || j < b->rows) {
        int order = i == a->rows ? 1 : j == b->rows ? -1 : order_of(a, i, b, j);
        theta[rows] = order <= 0 ? a->theta[i] : b->theta[j];
        phi[rows++] = order <= 0 ? a->phi[i] : b->phi[j];
        i += order <= 0;
        j += order >= 0;
    }
    *out = (AngleTable){.name = a->name,
                        .rows = rows,
                        .theta = theta,
                        .phi = phi,
                        .theta_max = fmaxf(a->theta_max, b->theta_max)};
    return out;
}

/* The grid of the largest table, with the directions that others on this grid have besides. */
static void find_master(const Measurement *set, bool has_black, Arena *arena,
                        EmissionSamples *out) {
    const AngleTable *table;
    out->cone = PI / 2;
    for (int i = 0; (table = emission_samples_table(set, has_black, i).table); i++) {
        out->channels += 3;
        out->cone = fmin(out->cone, (double)table->theta_max);
        if (!out->master || table->rows > out->master->rows) out->master = table;
    }
    for (int i = 0; (table = emission_samples_table(set, has_black, i).table); i++)
        if (!angle_table_same_rows(out->master, table) && is_on_grid(out->master, table, *arena))
            out->master = unite(out->master, table, arena);
    out->rows = out->master->rows;
    out->black = has_black ? out->channels - 3 : -1;
}

void emission_samples_note(const EmissionSamples *samples, Arena scratch, FitNotes *notes) {
    DirectionGrid grid;
    direction_grid_build(samples->master, false, &scratch, &grid);
    if (grid.widest_gap > radians_from_degrees(30))
        fit_note(notes,
                 "azimuths up to %.0f degrees apart; between them the values are "
                 "interpolated, not measured",
                 degrees_from_radians((double)grid.widest_gap));
    if (grid.is_scattered)
        fit_note(notes, "table '%s': directions without a grid's order", samples->master->name);
}

#define DARK_SHARE 0.02 /* of the rows: fewer are dead pixels */

/* Zeros, which no logarithm follows: only then does the fit need the floor. Without them it
 * holds the darkest values relative to themselves, which is more than is required. */
static bool has_darkness(const AngleTable *table, int channel) {
    int dark = 0;
    for (int i = 0; i < table->rows; i++)
        dark += !(table->value[3 * (size_t)i + (size_t)channel] > 0);
    return dark > DARK_SHARE * table->rows;
}

void emission_samples_gather(const Measurement *set, bool has_black, uint8_t *const *outlier,
                             const EmissionNoise *noise, Arena *arena, EmissionSamples *out) {
    const AngleTable *table;
    *out =
        (EmissionSamples){.set = set, .tolerance = out->tolerance, .floor_share = out->floor_share};
    find_master(set, has_black, arena, out);
    size_t rows = (size_t)out->rows, numbers = rows * (size_t)out->channels;
    out->direction = ARENA_NEW(arena, Vec3, rows);
    out->area = ARENA_NEW(arena, double, rows);
    out->total = ARENA_NEW(arena, float, numbers);
    out->sigma = ARENA_NEW(arena, float, numbers);
    for (int i = 0; i < out->rows; i++) out->direction[i] = table_row_direction(out->master, i);
    measure_rows(out, *arena);
    out->floor = ARENA_NEW(arena, double, out->channels);
    for (int i = 0; (table = emission_samples_table(set, has_black, i).table); i++)
        for (int j = 0; j < 3; j++)
            out->floor[3 * i + j] =
                has_darkness(table, j)
                    ? emission_samples_floor(table, j, outlier[i], out->floor_share)
                    : EMISSION_NO_LIGHT;
    for (int i = 0; (table = emission_samples_table(set, has_black, i).table); i++)
        put_table(out, table, 3 * i, outlier[i], noise[i], *arena);
    for (int c = 0; c < out->channels; c++) fill_unknown(out, c);
}
