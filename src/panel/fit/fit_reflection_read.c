/* Reflection tables as logarithms at any direction of the specular-following frame. */
#include <math.h>
#include <string.h>

#include "base/mathd.h"
#include "base/mathf.h"
#include "base/parallel.h"
#include "base/units.h"
#include "hemisphere/specular_frame.h"
#include "panel/fit/fit_reflect.h"
#include "spectrum/fresnel.h"

#define FLOOR_SHARE 1e-6 /* of a table's largest value: values below it are held there */
#define FLOOR_LEAST 1e-8 /* sr^-1 */
#define STEEPEST 0.5f    /* what a logarithm may change by beyond the last ring */
#define EDGE_CELLS 3.0f  /* so far beyond it places still count: triangles reach across */
#define CHUNK 512        /* places that one thread reads at a time */

double fit_fresnel(double cos_theta)
{
    return fresnel_unpolarised_d(fmin(1, fmax(0, cos_theta)), FIT_REFRACTIVE_INDEX);
}

double reflect_noise(const FitReflection *out, int table, double f)
{
    double dim = f > 0 ? out->dim_noise[table] / f : 0;
    return sqrt(out->noise[table] * out->noise[table] + dim * dim);
}

/* Zeros, and noise that went below them, have no logarithm: they are held above a floor. */
static double table_floor(const AngleTable *table, int *masked)
{
    double most = 0;
    size_t count = (size_t)table->rows * (size_t)table->channels;
    for (size_t i = 0; i < count; i++) most = fmax(most, (double)table->value[i]);
    double floor = fmax(FLOOR_LEAST, FLOOR_SHARE * most);
    for (size_t i = 0; i < count; i++) *masked += (double)table->value[i] < floor;
    return floor;
}

static float *log_cells(ReflectionFit *fit, int table)
{
    const DirectionGrid *grid = &fit->grid[table];
    float *cells = direction_grid_cells(grid, fit->out->haze[table].value, fit->wavelengths,
                                        fit->arena);
    size_t count = (size_t)(grid->thetas * grid->phis) * (size_t)fit->wavelengths;
    float  floor = (float)fit->value_floor[table];
    for (size_t i = 0; i < count; i++) cells[i] = log_f(fmaxf(cells[i], floor));
    return cells;
}

void reflect_read_tables(ReflectionFit *fit)
{
    bool mirrored = fit->set->azimuth_count < 2;
    fit->grid = ARENA_NEW(fit->arena, DirectionGrid, fit->tables);
    fit->cells = ARENA_NEW(fit->arena, float *, fit->tables);
    fit->value_floor = ARENA_NEW(fit->arena, double, fit->tables);
    fit->out->masked = 0;
    for (int t = 0; t < fit->tables; t++) {
        const AngleTable *table = &fit->out->haze[t];
        fit->value_floor[t] = table_floor(table, &fit->out->masked);
        if (t > 0 && direction_grid_same_rows(table, &fit->out->haze[t - 1]))
            fit->grid[t] = fit->grid[t - 1];
        else direction_grid_build(table, mirrored, fit->arena, &fit->grid[t]);
        fit->cells[t] = log_cells(fit, t);
    }
}

static void read_at(const ReflectionFit *fit, int table, float theta, float phi, float *logs)
{
    GridTaps taps;
    direction_grid_taps(&fit->grid[table], theta, phi, &taps);
    direction_grid_read(&taps, fit->cells[table], fit->wavelengths, logs);
}

/* Beyond the last ring the logarithm goes on as steeply as it came. */
float reflect_read(const ReflectionFit *fit, int table, Vec3 outer, float *logs)
{
    const DirectionGrid *grid = &fit->grid[table];
    float across = sqrtf(outer.x * outer.x + outer.y * outer.y);
    float theta = atan2_f(across, fmaxf(outer.z, 0)), phi = atan2_f(outer.y, outer.x);
    float last = grid->theta[grid->thetas - 1], beyond = theta - last;
    float inside[MEASUREMENT_WAVELENGTHS_MAX];
    read_at(fit, table, fminf(theta, last), phi, logs);
    if (beyond <= 1e-5f) return 0;
    read_at(fit, table, fmaxf(0, last - beyond), phi, inside);
    for (int w = 0; w < fit->wavelengths; w++)
        logs[w] += fminf(STEEPEST, fmaxf(-STEEPEST, logs[w] - inside[w]));
    return beyond;
}

/* ---- all places -------------------------------------------------------------------------- */

static void read_chunk(void *context, int item, int worker)
{
    ReflectionFit *fit = context;
    int   last = (item + 1) * CHUNK < fit->places ? (item + 1) * CHUNK : fit->places;
    float edge = EDGE_CELLS * 0.5f * PI_F / (float)(1 << fit->lattice.level);
    (void)worker;
    for (int t = 0; t < fit->tables; t++) {
        double        theta = reflect_incidence(fit, t);
        float         offset = (float)log_d(fit_fresnel(cos_d(theta)));
        SpecularFrame frame = specular_frame((float)theta, fit->k);
        for (int i = item * CHUNK; i < last; i++) {
            float *row = reflect_row(fit, fit->value, i, t);
            Vec3   outer = specular_frame_outer(&frame, fit->direction[i]);
            float  beyond = reflect_read(fit, t, outer, row);
            fit->is_free[(size_t)i * (size_t)fit->tables + (size_t)t] = beyond > edge;
            for (int w = 0; w < fit->wavelengths; w++) row[w] -= offset;
        }
    }
}

void reflect_read_places(ReflectionFit *fit, int level)
{
    fit->lattice.level = level;
    fit->geodesic = geodesic_create(level, fit->arena);
    bool is_vertex = fit->options->basis == FIT_VERTEX;
    fit->places = is_vertex ? (int)vertex_count(fit->lattice)
                            : fit->lattice.octants << 2 * level;
    fit->direction = ARENA_NEW(fit->arena, Vec3, fit->places);
    if (is_vertex) vertex_directions(fit->lattice, fit->direction);
    for (int i = 0; i < fit->places && !is_vertex; i++)
        fit->direction[i] = geodesic_center(level, (uint32_t)i);
    size_t rows = (size_t)fit->places * (size_t)fit->tables;
    fit->value = ARENA_NEW(fit->arena, float, rows * (size_t)fit->wavelengths);
    fit->is_free = ARENA_NEW(fit->arena, bool, rows);
    fit->tolerance = ARENA_NEW(fit->arena, float, rows);
    parallel_for(fit->options->threads, (fit->places + CHUNK - 1) / CHUNK, read_chunk, fit);
}
