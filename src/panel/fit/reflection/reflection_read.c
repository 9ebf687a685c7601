#include "panel/fit/reflection/reflection_read.h"

#include <math.h>

#include "base/mathd.h"
#include "base/mathf.h"
#include "base/parallel.h"
#include "base/units.h"
#include "hemisphere/specular_frame.h"

#define LEAST_SHARE 1e-6 /* of a table's largest value: values below it are held there */
#define LEAST_VALUE 1e-8 /* sr^-1 */
#define STEEPEST 0.5f    /* what a logarithm may change by beyond the last ring */
#define EDGE_CELLS 3.0f  /* so far beyond it places still count: triangles reach across */
#define CHUNK 512        /* places that one thread reads at a time */

double reflection_read_least(const AngleTable *table)
{
    double most = 0;
    size_t count = (size_t)table->rows * (size_t)table->channels;
    for (size_t i = 0; i < count; i++) most = fmax(most, (double)table->value[i]);
    return fmax(LEAST_VALUE, LEAST_SHARE * most);
}

static int count_below(const AngleTable *table, double least)
{
    int    count = 0;
    size_t values = (size_t)table->rows * (size_t)table->channels;
    for (size_t i = 0; i < values; i++) count += (double)table->value[i] < least;
    return count;
}

static float *log_cells(ReflectionModel *model, int table)
{
    const DirectionGrid *grid = &model->grid[table];
    float *cells = direction_grid_cells(grid, model->parts->haze[table].value,
                                        model->wavelengths, model->arena);
    size_t count = (size_t)(grid->thetas * grid->phis) * (size_t)model->wavelengths;
    float  least = (float)model->least_value[table];
    for (size_t i = 0; i < count; i++) cells[i] = log_f(fmaxf(cells[i], least));
    return cells;
}

void reflection_read_tables(ReflectionModel *model)
{
    bool mirrored = model->set->azimuth_count < 2;
    model->grid = ARENA_NEW(model->arena, DirectionGrid, model->tables);
    model->cells = ARENA_NEW(model->arena, float *, model->tables);
    model->least_value = ARENA_NEW(model->arena, double, model->tables);
    model->masked = 0;
    for (int t = 0; t < model->tables; t++) {
        const AngleTable *table = &model->parts->haze[t];
        model->least_value[t] = reflection_read_least(table);
        model->masked += count_below(table, model->least_value[t]);
        if (t > 0 && direction_grid_same_rows(table, &model->parts->haze[t - 1]))
            model->grid[t] = model->grid[t - 1];
        else direction_grid_build(table, mirrored, model->arena, &model->grid[t]);
        model->cells[t] = log_cells(model, t);
    }
}

static void read_at(const ReflectionModel *model, int table, float theta, float phi,
                    float *logs)
{
    GridTaps taps;
    direction_grid_taps(&model->grid[table], theta, phi, &taps);
    direction_grid_read(&taps, model->cells[table], model->wavelengths, logs);
}

/* ln f of a table at an outer direction; returns how far that lies beyond the last ring,
 * radians, where the logarithm goes on as steeply as it came. */
static float read_table(const ReflectionModel *model, int table, Vec3 outer, float *logs)
{
    const DirectionGrid *grid = &model->grid[table];
    float across = sqrtf(outer.x * outer.x + outer.y * outer.y);
    float theta = atan2_f(across, fmaxf(outer.z, 0)), phi = atan2_f(outer.y, outer.x);
    float last = grid->theta[grid->thetas - 1], beyond = theta - last;
    float inside[MEASUREMENT_WAVELENGTHS_MAX];
    read_at(model, table, fminf(theta, last), phi, logs);
    if (beyond <= 1e-5f) return 0;
    read_at(model, table, fmaxf(0, last - beyond), phi, inside);
    for (int w = 0; w < model->wavelengths; w++)
        logs[w] += fminf(STEEPEST, fmaxf(-STEEPEST, logs[w] - inside[w]));
    return beyond;
}

/* ---- all places -------------------------------------------------------------------------- */

static void read_chunk(void *context, int item, int worker)
{
    ReflectionModel *model = context;
    int   last = (item + 1) * CHUNK < model->places ? (item + 1) * CHUNK : model->places;
    float edge = EDGE_CELLS * 0.5f * PI_F / (float)(1 << model->lattice.level);
    (void)worker;
    for (int t = 0; t < model->tables; t++) {
        double        theta = reflection_model_incidence(model, t);
        float         offset = (float)log_d(reflection_fresnel(cos_d(theta)));
        SpecularFrame frame = specular_frame((float)theta, model->k);
        for (int i = item * CHUNK; i < last; i++) {
            float *row = reflection_model_row(model, model->value, i, t);
            Vec3   outer = specular_frame_outer(&frame, model->direction[i]);
            float  beyond = read_table(model, t, outer, row);
            model->is_free[(size_t)i * (size_t)model->tables + (size_t)t] = beyond > edge;
            for (int w = 0; w < model->wavelengths; w++) row[w] -= offset;
        }
    }
}

void reflection_read_places(ReflectionModel *model, int level)
{
    model->lattice.level = level;
    model->geodesic = geodesic_create(level, model->arena);
    bool is_vertex = model->options->basis == FIT_VERTEX;
    model->places = is_vertex ? (int)vertex_count(model->lattice)
                            : model->lattice.octants << 2 * level;
    model->direction = ARENA_NEW(model->arena, Vec3, model->places);
    if (is_vertex) vertex_directions(model->lattice, model->direction);
    for (int i = 0; i < model->places && !is_vertex; i++)
        model->direction[i] = geodesic_center(level, (uint32_t)i);
    size_t rows = (size_t)model->places * (size_t)model->tables;
    model->value = ARENA_NEW(model->arena, float, rows * (size_t)model->wavelengths);
    model->is_free = ARENA_NEW(model->arena, bool, rows);
    model->tolerance = ARENA_NEW(model->arena, float, rows);
    parallel_for(model->options->threads, (model->places + CHUNK - 1) / CHUNK, read_chunk,
                 model);
}
