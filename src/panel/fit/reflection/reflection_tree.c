/* SPDX-License-Identifier: Apache-2.0 */
#include "panel/fit/reflection/reflection_tree.h"

#include <math.h>
#include <string.h>

#include "base/mathd.h"
#include "base/parallel.h"
#include "hemisphere/haar/haar_tree.h"
#include "hemisphere/tree/tree_open.h"
#include "hemisphere/tree/tree_query.h"
#include "hemisphere/vertex/vertex.h"
#include "hemisphere/vertex/vertex_tree_build.h"
#include "panel/fit/common/table_rows.h"
#include "panel/fit/reflection/reflection_spectra.h"
#include "panel/query/panel_reach.h"

#define PLACE_SHARE 0.8    /* of the bound, for places: the rest is for what lies between */
#define PEAK_SHARE 0.35    /* of that where a grid is within 1/e of its largest value */
#define GUIDED_SHARE 0.6   /* of tables between whose rows no sample checks the tree */
#define HELD_FROM 0.05f    /* radians behind their edge: triangles reach across it */
#define HELD_ROOM 4.0      /* times the bound, for what is held outside of the samples */
#define TIGHTER 0.6        /* a miss makes the places around it so much more precise */
#define TIGHTEST 0.2       /* of the bound, beyond what the components leave out: rounding */
#define ROUNDS 5
#define HOPELESS 200 /* one miss in fewer samples: a finer level is required, not smaller
                        steps */
#define ATTEMPTS 8
#define LOOSER 1.3f
#define CHUNK 256

static void place_logs(const ReflectionModel *model, int place, int table, float *logs)
{
    reflection_spectra_logs(model, table,
                            model->score + (size_t)place * (size_t)model->components, logs);
}

static float largest_difference(const float *a, const float *b, int count)
{
    float most = 0;
    for (int w = 0; w < count; w++) {
        float difference = fabsf(a[w] - b[w]);
        most = difference > most ? difference : most;
    }
    return most;
}

/* ---- what a place may miss by ------------------------------------------------------------ */

/* Largest value of a table, mean over its wavelengths. */
static float table_peak(const ReflectionModel *model, int table)
{
    float most = -1e30f;
    for (int i = 0; i < model->places; i++) {
        const float *row = reflection_model_row(model, model->value, i, table);
        float sum = 0;
        for (int w = 0; w < model->wavelengths; w++) sum += row[w];
        most = fmaxf(most, sum / (float)model->wavelengths);
    }
    return most;
}

/* The share of the bound, and never less than what the components leave out. */
static void start_tolerances(ReflectionModel *model)
{
    float logs[MEASUREMENT_WAVELENGTHS_MAX];
    int   middle = model->wavelengths / 2;
    for (int t = 0; t < model->tables; t++) {
        float  peak = table_peak(model, t);
        ReflectionView view = reflection_view(model, t);
        for (int i = 0; i < model->places; i++) {
            const float *row = reflection_model_row(model, model->value, i, t);
            Vec3   local = reflection_view_local(&view, model->direction[i]);
            double f = exp_d((double)row[middle]) * reflection_view_reference(&view, local);
            double bound = fmax(model->bound,
                                5 * reflection_parts_noise(model->parts, t, f)) * PLACE_SHARE;
            if (row[middle] > peak - 1 && !model->scatter[t]) bound *= PEAK_SHARE;
            if (model->guide[t].is_used) bound *= GUIDED_SHARE;
            if (model->scatter[t] && panel_reach_room(&model->reach[t], local) < -HELD_FROM)
                bound *= HELD_ROOM;
            place_logs(model, i, t, logs);
            float lost = largest_difference(logs, row, model->wavelengths);
            model->tolerance[(size_t)i * (size_t)model->tables + (size_t)t] =
                fmaxf((float)bound, lost + (float)(TIGHTEST * model->bound));
        }
    }
}

static bool accepts(const void *context, uint32_t place, const float *reconstructed)
{
    const ReflectionModel *model = context;
    for (int t = 0; t < model->tables; t++) {
        size_t at = (size_t)place * (size_t)model->tables + (size_t)t;
        if (model->is_free[at]) continue;
        if (!reflection_spectra_is_near(model, t, reconstructed,
                                        model->value + at * (size_t)model->wavelengths,
                                        model->tolerance[at]))
            return false;
    }
    return true;
}

/* ---- the two bases ----------------------------------------------------------------------- */

static bool build_vertex(ReflectionModel *model, Error *err)
{
    VertexTreeOptions options = {.lattice = model->lattice, .components = model->components,
                                 .accepts = accepts, .context = model,
                                 .threads = model->options->threads};
    return vertex_tree_build(&options, model->score, model->arena, &model->tree,
                             &model->tree_report, err);
}

static bool build_haar(ReflectionModel *model, Error *err)
{
    float scale[PANEL_REFLECTION_COMPONENTS_MAX] = {0};
    int   n = model->components, w_count = model->wavelengths, m = model->coefficients;
    for (int i = 0; i < model->tables * m; i++)
        for (int w = 0; w < w_count; w++)
            for (int c = 0; c < n; c++)
                scale[c] = fmaxf(scale[c], fabsf(model->loading[i * n + c] *
                                                 model->basis[i % m * w_count + w]));
    double numbers = 0;
    for (int t = 0; t < model->tables; t++)
        numbers += (double)model->parts->kept[t].rows * w_count;
    HaarTreeOptions options = {
        .shape = {model->lattice.level, model->lattice.octants, n, HAAR_AREA},
        .keep_share = fit_haar_share(model->options, numbers, model->places, n),
        .component_scale = scale, .rows = TREE_ROWS_INT16};
    return haar_tree_build(&options, model->score, model->arena, &model->tree,
                           &model->tree_report, err);
}

static void loosen(ReflectionModel *model)
{
    size_t count = (size_t)model->places * (size_t)model->tables;
    for (size_t i = 0; i < count; i++) model->tolerance[i] *= LOOSER;
}

/* The coder's steps are as fine as the tightest places need, and may then be too fine for the
 * largest details: less is required of it until it reaches what is required. */
static bool build_tree(ReflectionModel *model, Error *err)
{
    bool ok = false;
    for (int attempt = 0; attempt < ATTEMPTS && !ok; attempt++) {
        if (attempt) loosen(model);
        *err = (Error){0};
        ok = model->options->basis == FIT_VERTEX ? build_vertex(model, err) : build_haar(model,
                                                                                         err);
        if (model->options->basis != FIT_VERTEX) break;
    }
    return ok || error_prefix(err, "reflection");
}

/* ---- all measured samples ---------------------------------------------------------------- */

typedef struct SampleCheck {
    ReflectionModel  *model;
    Tree              tree;
    int               first[PANEL_TABLES_MAX + 1]; /* chunk of each table */
    ReflectionMisses *part; /* per chunk */
} SampleCheck;

/* Error over bound of one row of a table. */
static double row_error(const SampleCheck *check, int t, int row, const ReflectionView *view,
                        Vec3 *stored)
{
    ReflectionModel  *model = check->model;
    const AngleTable *haze = &model->parts->haze[t], *kept = &model->parts->kept[t];
    float  component[PANEL_REFLECTION_COMPONENTS_MAX], logs[MEASUREMENT_WAVELENGTHS_MAX];
    Vec3   local = table_row_direction(haze, row);
    double reference = reflection_view_reference(view, local), worst = 0;
    *stored = reflection_view_stored(view, local);
    tree_interpolate(&check->tree, *stored, component);
    reflection_spectra_logs(model, t, component, logs);
    for (int w = 0; w < model->wavelengths; w++) {
        size_t at = (size_t)row * (size_t)model->wavelengths + (size_t)w;
        double f = (double)haze->value[at], all = fmax((double)kept->value[at], f);
        if (f < model->least_value[t]) continue;
        double error = fabs(exp_d((double)logs[w]) * reference - f) / all;
        double noise = reflection_parts_noise(model->parts, t, all);
        worst = fmax(worst, error / fmax(model->bound, 5 * noise));
    }
    return worst;
}

/* The places around a sample that was missed become more precise. */
static void tighten(ReflectionModel *model, int table, Vec3 stored, float *wanted)
{
    VertexPoint at = vertex_find(model->geodesic, model->lattice, stored);
    for (int k = 0; k < 3; k++)
        wanted[(size_t)at.vertex[k] * (size_t)model->tables + (size_t)table] = 1;
}

static void check_chunk(void *context, int item, int worker)
{
    SampleCheck *check = context;
    int          t = 0;
    (void)worker;
    while (check->first[t + 1] <= item) t++;
    ReflectionModel  *model = check->model;
    const AngleTable *table = &model->parts->haze[t];
    ReflectionView view = reflection_view(model, t);
    int begin = (item - check->first[t]) * CHUNK;
    int end = begin + CHUNK < table->rows ? begin + CHUNK : table->rows;
    ReflectionMisses *part = &check->part[item];
    for (int i = begin; i < end; i++) {
        Vec3   stored;
        double error = row_error(check, t, i, &view, &stored);
        part->samples++;
        part->worst = fmax(part->worst, error);
        part->misses += error > 1;
    }
}

static void start_chunks(SampleCheck *check, Arena *arena)
{
    int count = 0;
    for (int t = 0; t < check->model->tables; t++) {
        check->first[t] = count;
        count += (check->model->parts->haze[t].rows + CHUNK - 1) / CHUNK;
    }
    check->first[check->model->tables] = count;
    check->part = ARENA_NEW(arena, ReflectionMisses, count + 1);
}

/* Marks what has to be more precise. */
static void mark_misses(SampleCheck *check, float *wanted)
{
    ReflectionModel *model = check->model;
    for (int t = 0; t < model->tables; t++) {
        ReflectionView view = reflection_view(model, t);
        for (int c = check->first[t]; c < check->first[t + 1]; c++) {
            if (!check->part[c].misses) continue;
            int begin = (c - check->first[t]) * CHUNK, rows = model->parts->haze[t].rows;
            for (int i = begin; i < begin + CHUNK && i < rows; i++) {
                Vec3 stored;
                if (row_error(check, t, i, &view, &stored) > 1)
                    tighten(model, t, stored, wanted);
            }
        }
    }
}

/* The tolerances of marked places shrink; false when none can shrink further. */
static bool shrink(ReflectionModel *model, const float *wanted)
{
    size_t count = (size_t)model->places * (size_t)model->tables;
    float  logs[MEASUREMENT_WAVELENGTHS_MAX], least = (float)(TIGHTEST * model->bound);
    bool   any = false;
    for (size_t i = 0; i < count; i++) {
        if (wanted[i] == 0) continue;
        int place = (int)(i / (size_t)model->tables), t = (int)(i % (size_t)model->tables);
        place_logs(model, place, t, logs);
        float lost = largest_difference(logs,
                                        reflection_model_row(model, model->value, place, t),
                                        model->wavelengths);
        float next = fmaxf(TIGHTER * model->tolerance[i], lost + least);
        any |= next < 0.99f * model->tolerance[i];
        model->tolerance[i] = fminf(next, model->tolerance[i]);
    }
    return any;
}

static bool check_samples(SampleCheck *check, ReflectionMisses *misses, Error *err)
{
    ReflectionModel *model = check->model;
    const void      *blob = model->tree;
    if (!tree_open(blob, tree_size(blob), model->geodesic, &check->tree, err))
        return error_prefix(err, "reflection");
    int chunks = check->first[model->tables];
    memset(check->part, 0, sizeof *check->part * (size_t)chunks);
    parallel_for(model->options->threads, chunks, check_chunk, check);
    *misses = (ReflectionMisses){0};
    for (int c = 0; c < chunks; c++) {
        misses->samples += check->part[c].samples;
        misses->misses += check->part[c].misses;
        misses->worst = fmax(misses->worst, check->part[c].worst);
    }
    return true;
}

bool reflection_tree_build(ReflectionModel *model, ReflectionMisses *misses, Error *err)
{
    SampleCheck *check = ARENA_NEW(model->arena, SampleCheck, 1);
    size_t count = (size_t)model->places * (size_t)model->tables;
    check->model = model;
    start_chunks(check, model->arena);
    start_tolerances(model);
    for (int round = 0;; round++) {
        if (!build_tree(model, err) || !check_samples(check, misses, err)) return false;
        bool is_hopeless = !model->is_last && misses->misses > misses->samples / HOPELESS;
        if (!misses->misses || round == ROUNDS || model->is_trial || is_hopeless ||
            model->options->basis != FIT_VERTEX)
            return true;
        Arena  scratch = *model->arena;
        float *wanted = ARENA_NEW(&scratch, float, count);
        mark_misses(check, wanted);
        if (!shrink(model, wanted)) return true;
    }
}
