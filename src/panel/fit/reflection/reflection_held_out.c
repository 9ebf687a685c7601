/* SPDX-License-Identifier: Apache-2.0 */
#include "panel/fit/reflection/reflection_held_out.h"

#include <math.h>

#include "base/mathd.h"
#include "base/sort.h"
#include "base/units.h"
#include "panel/fit/common/table_rows.h"
#include "panel/fit/reflection/reflection_read.h"

#define NEAR_DEG 15.0  /* rows nearer to the mirror direction than this */
#define NEAR_STEPS 2.0 /* or than so many steps */
#define STEEP 0.1      /* a logarithm that changes by more to the ring beside is steep */
#define CORE_FWHMS 1.6 /* under the image, times the instrument's width */
#define NOISE_SIGMAS 5.0
#define CUBIC_ORDER 8.0 /* a cubic through half as wide steps errs by so much less */
#define FEWEST 6        /* rings, azimuths: else there are no second ones */
#define SAME_ANGLE 1e-4f

/* A table of one channel without some of its rows. */
typedef struct Thinned {
    const ReflectionModel *model;
    int table;
    const float *ring, *azimuth; /* each once, rising */
    int rings, azimuths;
    double incidence, reach; /* rows within it may be left out */
    AngleTable kept;
    DirectionGrid grid;
    float *cells;
    ReflectionGuide guide;
    Arena *arena;
} Thinned;

static const AngleTable *rows_of(const Thinned *thinned) {
    return &thinned->model->parts->haze[thinned->table];
}

static float middle_value(const AngleTable *table, int row) {
    return table->value[(size_t)row * (size_t)table->channels + (size_t)table->channels / 2];
}

static float folded(const Thinned *thinned, float phi) {
    return direction_grid_fold(phi, thinned->model->set->azimuth_count < 2);
}

static int ring_of(const Thinned *thinned, int row) {
    return direction_grid_index(thinned->ring, thinned->rings, rows_of(thinned)->theta[row],
                                SAME_ANGLE);
}

static double angle_of(const Thinned *thinned, int row) {
    const AngleTable *table = rows_of(thinned);
    return peak_window_angle((double)table->theta[row], (double)table->phi[row],
                             thinned->incidence);
}

static bool is_guided(const Thinned *thinned) {
    return thinned->model->guide[thinned->table].is_used;
}

/* Is a row left out? Ways 0 and 1: every second ring; 2 and 3: every second azimuth. In a
 * guided table every second azimuth of every second ring, four ways. The pole never. */
static bool is_out(const Thinned *thinned, int row, int way) {
    const AngleTable *table = rows_of(thinned);
    if (!(table->theta[row] > SAME_ANGLE)) return false;
    int ring = ring_of(thinned, row) % 2;
    int azimuth = direction_grid_index(thinned->azimuth, thinned->azimuths,
                                       folded(thinned, table->phi[row]), SAME_ANGLE) %
                  2;
    if (is_guided(thinned))
        return ring == way % 2 && azimuth == way / 2 && angle_of(thinned, row) < thinned->reach;
    return way < 2 ? ring == way : azimuth == way - 2;
}

static void list_angles(Thinned *thinned) {
    const AngleTable *table = rows_of(thinned);
    float *ring = ARENA_NEW(thinned->arena, float, table->rows);
    float *azimuth = ARENA_NEW(thinned->arena, float, table->rows);
    int azimuths = 0;
    for (int i = 0; i < table->rows; i++) {
        ring[i] = table->theta[i];
        if (table->theta[i] > SAME_ANGLE) azimuth[azimuths++] = folded(thinned, table->phi[i]);
    }
    thinned->rings = sort_distinct(ring, table->rows, SAME_ANGLE);
    thinned->azimuths = sort_distinct(azimuth, azimuths, SAME_ANGLE);
    thinned->ring = ring;
    thinned->azimuth = azimuth;
}

static void keep_rows(Thinned *thinned, int way) {
    const AngleTable *table = rows_of(thinned);
    float *theta = ARENA_NEW(thinned->arena, float, table->rows);
    float *phi = ARENA_NEW(thinned->arena, float, table->rows);
    float *value = ARENA_NEW(thinned->arena, float, table->rows);
    int rows = 0;
    for (int i = 0; i < table->rows; i++) {
        if (is_out(thinned, i, way)) continue;
        theta[rows] = table->theta[i];
        phi[rows] = table->phi[i];
        value[rows++] = middle_value(table, i);
    }
    thinned->kept = (AngleTable){.rows = rows,
                                 .channels = 1,
                                 .theta = theta,
                                 .phi = phi,
                                 .value = value,
                                 .theta_max = table->theta_max};
}

/* The haze's model of the rows that are left; where the table has no guide, none. */
static void fit_guide(Thinned *thinned) {
    const ReflectionGuide *whole = &thinned->model->guide[thinned->table];
    thinned->guide = *whole;
    if (!whole->is_used) return;
    PeakWindow window =
        peak_window_collect(&thinned->kept, whole->incidence, 1.5 * whole->reach, thinned->arena);
    window.width[0] = 0.2 * whole->width, window.width[1] = fmin(1.5, 5 * whole->width);
    if (window.count < PEAK_RANGE_ROWS) return;
    PeakModel model = peak_window_choose_haze(&window, whole->width);
    if (!(model.a > 0)) return;
    thinned->guide.a = model.a, thinned->guide.width = model.width;
    thinned->guide.power = model.power;
    thinned->guide.lambertian = fmax(1e-9, window.lambertian);
}

/* 0 without a guide. */
static double guide_log(const Thinned *thinned, double theta, double phi) {
    return thinned->guide.is_used ? reflection_guide_log(&thinned->guide, theta, phi) : 0;
}

/* Cells hold values over the guide, so that missing rows are filled relative to it. */
static void build_cells(Thinned *thinned) {
    const AngleTable *kept = &thinned->kept;
    float least = (float)thinned->model->least_value[thinned->table];
    float *over = ARENA_NEW(thinned->arena, float, kept->rows);
    for (int i = 0; i < kept->rows; i++)
        over[i] = (float)((double)fmaxf(kept->value[i], least) *
                          exp_d(-guide_log(thinned, (double)kept->theta[i], (double)kept->phi[i])));
    direction_grid_build(kept, thinned->model->set->azimuth_count < 2, thinned->arena,
                         &thinned->grid);
    thinned->cells = direction_grid_cells(&thinned->grid, over, 1, thinned->arena);
    for (int c = 0; c < thinned->grid.thetas * thinned->grid.phis; c++)
        thinned->cells[c] = (float)log_d((double)fmaxf(thinned->cells[c], 1e-30f));
}

static double predict(const Thinned *thinned, float theta, float phi) {
    GridTaps taps;
    float log;
    direction_grid_taps(&thinned->grid, theta, phi, &taps);
    direction_grid_read(&taps, thinned->cells, 1, &log);
    return exp_d((double)log + guide_log(thinned, (double)theta, (double)phi));
}

/* Rings on which, near the mirror direction, the logarithm changes by much to the next one. */
static bool *steep_rings(const Thinned *thinned) {
    const AngleTable *table = rows_of(thinned);
    float *most = ARENA_NEW(thinned->arena, float, thinned->rings);
    bool *steep = ARENA_NEW(thinned->arena, bool, thinned->rings);
    for (int i = 0; i < table->rows; i++) {
        int ring = ring_of(thinned, i);
        if (angle_of(thinned, i) < thinned->reach)
            most[ring] = fmaxf(most[ring], middle_value(table, i));
    }
    for (int i = 0; i + 1 < thinned->rings; i++)
        if (most[i] > 0 && most[i + 1] > 0 && fabs(log_d((double)(most[i] / most[i + 1]))) > STEEP)
            steep[i] = steep[i + 1] = true;
    return steep;
}

/* Does a row that was left out lie between those that are left, where the table is steep? */
static bool is_between(const Thinned *thinned, int row, const bool *steep) {
    const AngleTable *table = rows_of(thinned), *kept = &thinned->kept;
    return table->theta[row] >= kept->theta[0] &&
           table->theta[row] <= kept->theta[kept->rows - 1] && steep[ring_of(thinned, row)];
}

/* core: rows nearer to the mirror direction do not count. */
static void compare(const Thinned *thinned, int way, double core, const bool *steep, HeldOut *out) {
    const AngleTable *table = rows_of(thinned);
    const ReflectionParts *parts = thinned->model->parts;
    for (int i = 0; i < table->rows; i++) {
        double theta = (double)table->theta[i], phi = (double)table->phi[i];
        double angle = angle_of(thinned, i), value = (double)middle_value(table, i);
        if (!is_out(thinned, i, way) || angle < core || angle > thinned->reach ||
            !is_between(thinned, i, steep) || value < thinned->model->least_value[thinned->table])
            continue;
        double noise = NOISE_SIGMAS * reflection_parts_noise(parts, thinned->table, value);
        double found = predict(thinned, table->theta[i], table->phi[i]);
        double miss = fabs(found / value - 1) - noise;
        if (miss > out->error) out->error = miss, out->theta = theta, out->phi = phi;
    }
}

/* ---- tables without a grid's order ------------------------------------------------------- */

typedef struct GapRead {
    const ReflectionModel *model;
    int table;
} GapRead;

static double read_gap(void *context, Vec3 at, double *off) {
    const GapRead *read = context;
    float logs[MEASUREMENT_WAVELENGTHS_MAX];
    *off = 0;
    reflection_read_logs(read->model, read->table, at, logs);
    return (double)logs[read->model->wavelengths / 2];
}

static HeldOut find_gaps(const ReflectionModel *model, int table, Arena scratch) {
    GapRead read = {model, table};
    ScatterAsked asked = {model->scatter[table], read_gap, &read};
    HeldOut out = {.is_scattered = true};
    Vec3 mirror = table_direction(reflection_model_incidence(model, table), 0);
    out.gaps = scatter_gaps_find(&asked, scratch);
    scatter_surface_doubt(asked.surface, &mirror, 1, &out.mirror, scratch);
    return out;
}

void reflection_held_out_peaks(const ReflectionModel *model, HeldOut *held_out) {
    double roughness = 0, spread = 0;
    for (int t = 0; t < model->tables; t++) {
        roughness = fmax(roughness, held_out[t].mirror.roughness);
        spread = fmax(spread, held_out[t].mirror.spread);
    }
    for (int t = 0; t < model->tables; t++) {
        HeldOut *out = &held_out[t];
        ScatterDoubt doubt = out->mirror;
        doubt.roughness = roughness, doubt.spread = spread;
        double miss = scatter_gaps_miss(scatter_doubt_sigma(&doubt));
        if (!doubt.is_between || miss <= out->gaps.worst) continue;
        out->gaps.worst = miss, out->gaps.gap = doubt.gap;
        out->gaps.theta = reflection_model_incidence(model, t), out->gaps.phi = 0;
    }
}

/* ---- one table --------------------------------------------------------------------------- */

HeldOut reflection_held_out(const ReflectionModel *model, int table, Arena scratch) {
    HeldOut out = {0};
    if (model->scatter[table]) return find_gaps(model, table, scratch);
    Thinned thinned = {.model = model,
                       .table = table,
                       .arena = &scratch,
                       .incidence = reflection_model_incidence(model, table)};
    PeakSpacing spacing = peak_window_spacing(rows_of(&thinned), thinned.incidence, scratch);
    double fwhm = radians_from_degrees(model->set->instrument_fwhm_deg);
    thinned.reach = fmax(radians_from_degrees(NEAR_DEG), NEAR_STEPS * spacing.widest);
    list_angles(&thinned);
    bool *steep = steep_rings(&thinned);
    for (int way = 0; way < 4; way++) {
        if ((way < 2 ? thinned.rings : thinned.azimuths) < FEWEST) continue;
        Arena inner = scratch;
        Thinned one = thinned;
        one.arena = &inner;
        keep_rows(&one, way);
        fit_guide(&one);
        build_cells(&one);
        compare(&one, way,
                model->parts->has_mirror && !model->parts->is_apart ? CORE_FWHMS * fwhm : 0, steep,
                &out);
    }
    out.estimate = out.error / (is_guided(&thinned) ? 1 : CUBIC_ORDER);
    return out;
}

/* ---- azimuths of the light --------------------------------------------------------------- */

#define TABLES_ENOUGH 48

/* The light that a table's two neighbours in azimuth miss of it, a share of its own. In the
 * specular-following frame tables of one incidence are mixed at the same direction. */
static double azimuth_missed(const ReflectionModel *model, int table) {
    int n = model->set->incidence_count, m = model->set->azimuth_count;
    int around[2] = {(table + n) % (n * m), (table + n * (m - 1)) % (n * m)};
    const AngleTable *rows = &model->parts->haze[table];
    int middle = model->wavelengths / 2;
    double missed = 0, sum = 0;
    for (int i = 0; i < rows->rows; i++) {
        float logs[2][MEASUREMENT_WAVELENGTHS_MAX];
        double weight = table_row_weight(rows, i), value = (double)middle_value(rows, i);
        for (int k = 0; k < 2; k++)
            reflection_read_logs(model, around[k], table_row_direction(rows, i), logs[k]);
        double told = exp_d(0.5 * ((double)logs[0][middle] + (double)logs[1][middle]));
        missed += weight * fabs(told - value);
        sum += weight * value;
    }
    return sum > 0 ? missed / sum : 0;
}

double reflection_held_out_azimuths(const ReflectionModel *model) {
    double worst = 0;
    if (model->set->azimuth_count < 2) return 0;
    for (int t = 0; t < model->tables; t += 1 + model->tables / TABLES_ENOUGH)
        worst = fmax(worst, azimuth_missed(model, t));
    return worst;
}
