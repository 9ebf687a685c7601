/* The reflection's tree, and whether what it says again is good enough at every place and at
 * every measured sample. */
#include <math.h>
#include <string.h>

#include "base/mathd.h"
#include "base/parallel.h"
#include "base/units.h"
#include "hemisphere/specular_frame.h"
#include "hemisphere/tree_query.h"
#include "panel/fit/fit_reflect.h"

#define PLACE_SHARE 0.8    /* of the bound, for places: the rest is for what lies between */
#define PEAK_SHARE 0.35    /* of that where a table is within 1/e of its largest value */
#define TIGHTER 0.6        /* a miss makes the places around it so much more precise */
#define TIGHTEST 0.2       /* of the bound, beyond what the components leave out: rounding */
#define ROUNDS 5
#define HOPELESS 200 /* one miss in fewer samples: a finer level is wanted, not smaller steps */
#define ATTEMPTS 8
#define LOOSER 1.3f
#define CHUNK 256

static void place_logs(const ReflectionFit *fit, int place, int table, float *logs)
{
    reflect_logs(fit, table, fit->score + (size_t)place * (size_t)fit->components, logs);
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
static float table_peak(const ReflectionFit *fit, int table)
{
    float most = -1e30f;
    for (int i = 0; i < fit->places; i++) {
        const float *row = reflect_row(fit, fit->value, i, table);
        float sum = 0;
        for (int w = 0; w < fit->wavelengths; w++) sum += row[w];
        most = fmaxf(most, sum / (float)fit->wavelengths);
    }
    return most;
}

/* The share of the bound, and never less than what the components leave out. */
static void start_tolerances(ReflectionFit *fit)
{
    float logs[MEASUREMENT_WAVELENGTHS_MAX];
    int   middle = fit->wavelengths / 2;
    for (int t = 0; t < fit->tables; t++) {
        float  peak = table_peak(fit, t);
        double fresnel = fit_fresnel(cos_d(reflect_incidence(fit, t)));
        for (int i = 0; i < fit->places; i++) {
            const float *row = reflect_row(fit, fit->value, i, t);
            double f = exp_d((double)row[middle]) * fresnel;
            double bound = fmax(fit->bound, 5 * reflect_noise(fit->out, t, f)) * PLACE_SHARE;
            if (row[middle] > peak - 1) bound *= PEAK_SHARE;
            place_logs(fit, i, t, logs);
            float lost = largest_difference(logs, row, fit->wavelengths);
            fit->tolerance[(size_t)i * (size_t)fit->tables + (size_t)t] =
                fmaxf((float)bound, lost + (float)(TIGHTEST * fit->bound));
        }
    }
}

static bool accepts(const void *context, uint32_t place, const float *reconstructed)
{
    const ReflectionFit *fit = context;
    for (int t = 0; t < fit->tables; t++) {
        size_t at = (size_t)place * (size_t)fit->tables + (size_t)t;
        if (fit->is_free[at]) continue;
        if (!reflect_is_near(fit, t, reconstructed,
                             fit->value + at * (size_t)fit->wavelengths, fit->tolerance[at]))
            return false;
    }
    return true;
}

/* ---- the two bases ----------------------------------------------------------------------- */

static bool build_vertex(ReflectionFit *fit, Error *err)
{
    VertexTreeOptions options = {.lattice = fit->lattice, .components = fit->components,
                                 .accepts = accepts, .context = fit,
                                 .threads = fit->options->threads};
    return vertex_tree_build(&options, fit->score, fit->arena, &fit->out->tree,
                             &fit->out->tree_report, err);
}

static bool build_haar(ReflectionFit *fit, Error *err)
{
    float scale[PANEL_REFLECTION_COMPONENTS_MAX] = {0};
    int   n = fit->components, w_count = fit->wavelengths, m = fit->coefficients;
    for (int i = 0; i < fit->tables * m; i++)
        for (int w = 0; w < w_count; w++)
            for (int c = 0; c < n; c++)
                scale[c] = fmaxf(scale[c], fabsf(fit->loading[i * n + c] *
                                                 fit->basis[i % m * w_count + w]));
    TreeOptions options = {
        .shape = {fit->lattice.level, fit->lattice.octants, n, fit->options->weights},
        .keep_share = fit->options->keep_share,
        .max_error = fit->options->keep_share > 0 ? 0 : (float)(PLACE_SHARE * fit->bound),
        .component_scale = scale, .rows = TREE_ROWS_INT16};
    return tree_build(&options, fit->score, fit->arena, &fit->out->tree, &fit->out->tree_report,
                      err);
}

static void loosen(ReflectionFit *fit)
{
    size_t count = (size_t)fit->places * (size_t)fit->tables;
    for (size_t i = 0; i < count; i++) fit->tolerance[i] *= LOOSER;
}

/* The coder's steps are as fine as the tightest places need, and may then be too fine for the
 * largest details: it is asked for less until it can do what it is asked for. */
static bool build_tree(ReflectionFit *fit, Error *err)
{
    bool ok = false;
    for (int attempt = 0; attempt < ATTEMPTS && !ok; attempt++) {
        if (attempt) loosen(fit);
        *err = (Error){0};
        ok = fit->options->basis == FIT_VERTEX ? build_vertex(fit, err) : build_haar(fit, err);
        if (fit->options->basis != FIT_VERTEX) break;
    }
    return ok || error_prefix(err, "reflection");
}

/* ---- all measured samples ---------------------------------------------------------------- */

typedef struct Check {
    ReflectionFit *fit;
    Tree           tree;
    int            first[PANEL_TABLES_MAX + 1]; /* chunk of each table */
    ReflectionMisses *part; /* per chunk */
} Check;

/* Error over bound of one row of a table. */
static double row_error(const Check *check, int t, int row, const SpecularFrame *frame,
                        Vec3 *stored)
{
    ReflectionFit    *fit = check->fit;
    const AngleTable *haze = &fit->out->haze[t], *kept = &fit->out->kept[t];
    float  component[PANEL_REFLECTION_COMPONENTS_MAX], logs[MEASUREMENT_WAVELENGTHS_MAX];
    double fresnel = fit_fresnel(cos_d(reflect_incidence(fit, t))), worst = 0;
    *stored = specular_frame_stored(frame, fit_row_direction(haze, row));
    tree_interpolate(&check->tree, *stored, component);
    reflect_logs(fit, t, component, logs);
    for (int w = 0; w < fit->wavelengths; w++) {
        size_t at = (size_t)row * (size_t)fit->wavelengths + (size_t)w;
        double f = (double)haze->value[at], all = fmax((double)kept->value[at], f);
        if (f < fit->value_floor[t]) continue;
        double error = fabs(exp_d((double)logs[w]) * fresnel - f) / all;
        worst = fmax(worst, error / fmax(fit->bound, 5 * reflect_noise(fit->out, t, all)));
    }
    return worst;
}

/* The places around a sample that was missed become more precise. */
static void tighten(ReflectionFit *fit, int table, Vec3 stored, float *wanted)
{
    VertexPoint at = vertex_find(fit->geodesic, fit->lattice, stored);
    for (int k = 0; k < 3; k++)
        wanted[(size_t)at.vertex[k] * (size_t)fit->tables + (size_t)table] = 1;
}

static void check_chunk(void *context, int item, int worker)
{
    Check *check = context;
    int    t = 0;
    (void)worker;
    while (check->first[t + 1] <= item) t++;
    ReflectionFit    *fit = check->fit;
    const AngleTable *table = &fit->out->haze[t];
    SpecularFrame frame = specular_frame((float)reflect_incidence(fit, t), fit->k);
    int begin = (item - check->first[t]) * CHUNK;
    int end = begin + CHUNK < table->rows ? begin + CHUNK : table->rows;
    ReflectionMisses *part = &check->part[item];
    for (int i = begin; i < end; i++) {
        Vec3   stored;
        double error = row_error(check, t, i, &frame, &stored);
        part->samples++;
        part->worst = fmax(part->worst, error);
        part->misses += error > 1;
    }
}

static void start_chunks(Check *check, Arena *arena)
{
    int count = 0;
    for (int t = 0; t < check->fit->tables; t++) {
        check->first[t] = count;
        count += (check->fit->out->haze[t].rows + CHUNK - 1) / CHUNK;
    }
    check->first[check->fit->tables] = count;
    check->part = ARENA_NEW(arena, ReflectionMisses, count + 1);
}

/* Marks what has to be more precise. */
static void mark_misses(Check *check, float *wanted)
{
    ReflectionFit *fit = check->fit;
    for (int t = 0; t < fit->tables; t++) {
        SpecularFrame frame = specular_frame((float)reflect_incidence(fit, t), fit->k);
        for (int c = check->first[t]; c < check->first[t + 1]; c++) {
            if (!check->part[c].misses) continue;
            int begin = (c - check->first[t]) * CHUNK, rows = fit->out->haze[t].rows;
            for (int i = begin; i < begin + CHUNK && i < rows; i++) {
                Vec3 stored;
                if (row_error(check, t, i, &frame, &stored) > 1)
                    tighten(fit, t, stored, wanted);
            }
        }
    }
}

/* The tolerances of marked places shrink; false when none can shrink further. */
static bool shrink(ReflectionFit *fit, const float *wanted)
{
    size_t count = (size_t)fit->places * (size_t)fit->tables;
    float  logs[MEASUREMENT_WAVELENGTHS_MAX], least = (float)(TIGHTEST * fit->bound);
    bool   any = false;
    for (size_t i = 0; i < count; i++) {
        if (wanted[i] == 0) continue;
        int place = (int)(i / (size_t)fit->tables), t = (int)(i % (size_t)fit->tables);
        place_logs(fit, place, t, logs);
        float lost = largest_difference(logs, reflect_row(fit, fit->value, place, t),
                                        fit->wavelengths);
        float next = fmaxf(TIGHTER * fit->tolerance[i], lost + least);
        any |= next < 0.99f * fit->tolerance[i];
        fit->tolerance[i] = fminf(next, fit->tolerance[i]);
    }
    return any;
}

static bool check_samples(Check *check, ReflectionMisses *misses, Error *err)
{
    ReflectionFit *fit = check->fit;
    const void    *blob = fit->out->tree;
    if (!tree_open(blob, tree_size(blob), fit->geodesic, &check->tree, err))
        return error_prefix(err, "reflection");
    int chunks = check->first[fit->tables];
    memset(check->part, 0, sizeof *check->part * (size_t)chunks);
    parallel_for(fit->options->threads, chunks, check_chunk, check);
    *misses = (ReflectionMisses){0};
    for (int c = 0; c < chunks; c++) {
        misses->samples += check->part[c].samples;
        misses->misses += check->part[c].misses;
        misses->worst = fmax(misses->worst, check->part[c].worst);
    }
    return true;
}

bool reflect_code(ReflectionFit *fit, ReflectionMisses *misses, Error *err)
{
    Check *check = ARENA_NEW(fit->arena, Check, 1);
    size_t count = (size_t)fit->places * (size_t)fit->tables;
    check->fit = fit;
    start_chunks(check, fit->arena);
    start_tolerances(fit);
    for (int round = 0;; round++) {
        if (!build_tree(fit, err) || !check_samples(check, misses, err)) return false;
        bool is_hopeless = !fit->is_last && misses->misses > misses->samples / HOPELESS;
        if (!misses->misses || round == ROUNDS || fit->is_trial || is_hopeless ||
            fit->options->basis != FIT_VERTEX)
            return true;
        Arena  scratch = *fit->arena;
        float *wanted = ARENA_NEW(&scratch, float, count);
        mark_misses(check, wanted);
        if (!shrink(fit, wanted)) return true;
    }
}
