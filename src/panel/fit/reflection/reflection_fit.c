/* SPDX-License-Identifier: Apache-2.0 */
#include "panel/fit/reflection/reflection_fit.h"

#include <math.h>
#include <string.h>

#include "base/mathd.h"
#include "base/parallel.h"
#include "base/units.h"
#include "hemisphere/tree/haar_tree.h"
#include "hemisphere/tree/tree_open.h"
#include "hemisphere/tree/tree_query.h"
#include "hemisphere/tree/vertex.h"
#include "hemisphere/tree/vertex_tree_build.h"
#include "panel/fit/common/table_rows.h"
#include "panel/fit/reflection/peak_window.h"
#include "panel/fit/reflection/reflection_model.h"
#include "panel/fit/reflection/reflection_read.h"
#include "panel/fit/reflection/reflection_spectra.h"
#include "panel/query/panel_reach.h"

/* ---- the tree --------------------------------------------------------------------------- */

/* The reflection's tree, and whether it is good enough at every place and
 * measured sample. */

typedef struct ReflectionMisses {
    int samples, misses; /* samples beyond their bound */
    double worst;        /* largest error over its bound */
} ReflectionMisses;

#define PLACE_SHARE 0.8  /* of the bound, for places: the rest is for what lies between */
#define PEAK_SHARE 0.35  /* of that where a grid is within 1/e of its largest value */
#define GUIDED_SHARE 0.6 /* of tables between whose rows no sample checks the tree */
#define HELD_FROM 0.05f  /* radians behind their edge: triangles reach across it */
#define HELD_ROOM 3.0    /* times the bound, for what is held outside of the samples */
#define TIGHTEST 0.2     /* of the bound, beyond what the components leave out: rounding */
#define ATTEMPTS 8
#define LOOSER 1.3f
#define CHUNK 256

static void place_logs(const ReflectionModel *model, int place, int table, float *logs) {
    reflection_spectra_logs(model, table, model->score + (size_t)place * (size_t)model->components,
                            logs);
}

static float largest_difference(const float *a, const float *b, int count) {
    float most = 0;
    for (int w = 0; w < count; w++) {
        float difference = fabsf(a[w] - b[w]);
        most = difference > most ? difference : most;
    }
    return most;
}

/* ---- what a place may miss by ------------------------------------------------------------ */

/* Largest value of a table, mean over its wavelengths. */
static float table_peak(const ReflectionModel *model, int table) {
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
static void start_tolerances(ReflectionModel *model) {
    float logs[MEASUREMENT_WAVELENGTHS_MAX];
    int middle = model->wavelengths / 2;
    for (int t = 0; t < model->tables; t++) {
        float peak = table_peak(model, t);
        ReflectionView view = reflection_view(model, t);
        for (int i = 0; i < model->places; i++) {
            const float *row = reflection_model_row(model, model->value, i, t);
            Vec3 local = specular_frame_outer(&view.frame, model->direction[i]);
            double f = exp_d((double)row[middle]) * view.fresnel;
            double bound =
                fmax(model->bound, 5 * reflection_parts_noise(model->parts, t, f)) * PLACE_SHARE;
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

static bool accepts(const void *context, uint32_t place, const float *reconstructed) {
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

static bool build_vertex(ReflectionModel *model, Error *err) {
    VertexTreeOptions options = {.lattice = model->lattice,
                                 .components = model->components,
                                 .accepts = accepts,
                                 .context = model,
                                 .threads = model->options->threads};
    return vertex_tree_build(&options, model->score, model->arena, &model->tree,
                             &model->tree_report, err);
}

static bool build_haar(ReflectionModel *model, Error *err) {
    float scale[PANEL_REFLECTION_COMPONENTS_MAX] = {0};
    int n = model->components, w_count = model->wavelengths, m = model->coefficients;
    for (int i = 0; i < model->tables * m; i++)
        for (int w = 0; w < w_count; w++)
            for (int c = 0; c < n; c++)
                scale[c] = fmaxf(
                    scale[c], fabsf(model->loading[i * n + c] * model->basis[i % m * w_count + w]));
    double numbers = 0;
    for (int t = 0; t < model->tables; t++) numbers += (double)model->parts->haze[t].rows * w_count;
    HaarTreeOptions options = {
        .shape = {model->lattice.level, model->lattice.octants, n, HAAR_AREA},
        .keep_share = fit_haar_share(model->options, numbers, model->places, n),
        .component_scale = scale,
        .rows = TREE_ROWS_INT16};
    return haar_tree_build(&options, model->score, model->arena, &model->tree, &model->tree_report,
                           err);
}

static void loosen(ReflectionModel *model) {
    size_t count = (size_t)model->places * (size_t)model->tables;
    for (size_t i = 0; i < count; i++) model->tolerance[i] *= LOOSER;
}

/* The coder's steps are as fine as the tightest places need, and may then be too fine for the
 * largest details: less is required of it until it reaches what is required. */
static bool build_tree(ReflectionModel *model, Error *err) {
    bool ok = false;
    for (int attempt = 0; attempt < ATTEMPTS && !ok; attempt++) {
        if (attempt) loosen(model);
        *err = (Error){0};
        ok =
            model->options->basis == FIT_VERTEX ? build_vertex(model, err) : build_haar(model, err);
        if (model->options->basis != FIT_VERTEX) break;
    }
    return ok || error_prefix(err, "reflection");
}

/* ---- all measured samples ---------------------------------------------------------------- */

typedef struct SampleCheck {
    ReflectionModel *model;
    Tree tree;
    int first[PANEL_TABLES_MAX + 1]; /* chunk of each table */
    ReflectionMisses *part;          /* per chunk */
} SampleCheck;

/* Error over bound of one row of a table. */
static double row_error(const SampleCheck *check, int t, int row, const ReflectionView *view) {
    ReflectionModel *model = check->model;
    const AngleTable *haze = &model->parts->haze[t];
    float component[PANEL_REFLECTION_COMPONENTS_MAX], logs[MEASUREMENT_WAVELENGTHS_MAX];
    double worst = 0;
    Vec3 stored = specular_frame_stored(&view->frame, table_row_direction(haze, row));
    tree_interpolate(&check->tree, stored, component);
    reflection_spectra_logs(model, t, component, logs);
    for (int w = 0; w < model->wavelengths; w++) {
        size_t at = (size_t)row * (size_t)model->wavelengths + (size_t)w;
        double f = (double)haze->value[at];
        if (f < model->least_value[t]) continue;
        double error = fabs(exp_d((double)logs[w]) * view->fresnel - f) / f;
        double noise = reflection_parts_noise(model->parts, t, f);
        worst = fmax(worst, error / fmax(model->bound, 5 * noise));
    }
    return worst;
}

static void check_chunk(void *context, int item, int worker) {
    SampleCheck *check = context;
    int t = 0;
    (void)worker;
    while (check->first[t + 1] <= item) t++;
    ReflectionModel *model = check->model;
    const AngleTable *table = &model->parts->haze[t];
    ReflectionView view = reflection_view(model, t);
    int begin = (item - check->first[t]) * CHUNK;
    int end = begin + CHUNK < table->rows ? begin + CHUNK : table->rows;
    ReflectionMisses *part = &check->part[item];
    for (int i = begin; i < end; i++) {
        double error = row_error(check, t, i, &view);
        part->samples++;
        part->worst = fmax(part->worst, error);
        part->misses += error > 1;
    }
}

static void start_chunks(SampleCheck *check, Arena *arena) {
    int count = 0;
    for (int t = 0; t < check->model->tables; t++) {
        check->first[t] = count;
        count += (check->model->parts->haze[t].rows + CHUNK - 1) / CHUNK;
    }
    check->first[check->model->tables] = count;
    check->part = ARENA_NEW(arena, ReflectionMisses, count + 1);
}

static bool check_samples(SampleCheck *check, ReflectionMisses *misses, Error *err) {
    ReflectionModel *model = check->model;
    const void *blob = model->tree;
    if (!tree_open(blob, tree_size(blob), model->geodesic, model->arena, &check->tree, err))
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

static bool reflection_tree_build(ReflectionModel *model, ReflectionMisses *misses, Error *err) {
    SampleCheck *check = ARENA_NEW(model->arena, SampleCheck, 1);
    check->model = model;
    start_chunks(check, model->arena);
    start_tolerances(model);
    return build_tree(model, err) && check_samples(check, misses, err);
}

#define DEFAULT_BOUND 0.02
#define NOISY_BOUND 0.025
#define NOISY 0.0005 /* relative: tables below it count as without noise */
#define FIRST_LEVEL 6
#define LAST_LEVEL 9
#define HELPED 0.8     /* a level that leaves more misses than this share did not help */
#define NARROW_DEG 1.4 /* a peak of a smaller radius is narrow */
#define PLACES_BYTES ((size_t)5 << 29) /* of values at most: memory is bounded */
#define TRIAL_BYTES ((size_t)32 << 30) /* address space; pages cost nothing until touched */

/* The user's bound; else 2 %, and 2.5 % where there is noise. */
static double choose_bound(const FitOptions *options, const ReflectionParts *parts) {
    if (options->bound > 0) return (double)options->bound;
    return reflection_parts_most_noise(parts) > NOISY ? NOISY_BOUND : DEFAULT_BOUND;
}

static ReflectionModel *start_model(const Measurement *set, const FitOptions *options,
                                    ReflectionParts *parts, Arena *arena) {
    ReflectionModel *model = ARENA_NEW(arena, ReflectionModel, 1);
    *model = (ReflectionModel){.set = set,
                               .options = options,
                               .parts = parts,
                               .arena = arena,
                               .tables = parts->tables,
                               .wavelengths = set->wavelength_count,
                               .bound = choose_bound(options, parts)};
    model->lattice.octants = set->azimuth_count > 1 ? 4 : 2;
    return model;
}

/* ---- the frame --------------------------------------------------------------------------- */

/* How far a table's brightest row is from one that is half as bright, radians. */
static double peak_radius(const AngleTable *table) {
    int top = 0;
    float nearest = -1;
    for (int i = 1; i < table->rows; i++)
        if (peak_window_row_mean(table, i) > peak_window_row_mean(table, top)) top = i;
    Vec3 peak = table_row_direction(table, top);
    double half = 0.5 * peak_window_row_mean(table, top);
    for (int i = 0; i < table->rows; i++)
        if (peak_window_row_mean(table, i) < half)
            nearest = fmaxf(nearest, vec3_dot(peak, table_row_direction(table, i)));
    return acos_d((double)nearest);
}

/* Wide haze is smooth as it is; in the frame of a narrow peak vertices stand closer there. */
static void choose_frame(ReflectionModel *model) {
    double least = PI;
    for (int t = 0; t < model->tables; t++)
        least = fmin(least, peak_radius(&model->parts->haze[t]));
    model->k = degrees_from_radians(least) < NARROW_DEG ? 2 : 1;
}

/* ---- the level --------------------------------------------------------------------------- */

static size_t value_bytes(const ReflectionModel *model, int level) {
    size_t side = (size_t)1 << level;
    return 2 * side * side * (size_t)model->lattice.octants / 4 * sizeof(float) *
           (size_t)model->tables * (size_t)model->wavelengths;
}

/* Deeper while samples are missed and the last step helped; one that did not is taken back. */
static bool code_levels(ReflectionModel *model, ReflectionMisses *misses, Error *err) {
    int first = model->options->level > 0 ? model->options->level : FIRST_LEVEL;
    int last = model->options->level > 0 ? first : LAST_LEVEL;
    for (int level = first;; level++) {
        ReflectionMisses now;
        ReflectionModel before = *model;
        reflection_read_places(model, level);
        reflection_spectra_choose(model);
        if (!reflection_tree_build(model, &now, err)) return false;
        if (level > first && now.misses > (int)(HELPED * misses->misses)) {
            *model = before;
            return true;
        }
        *misses = now;
        if (!now.misses || level == last || value_bytes(model, level + 1) > PLACES_BYTES)
            return true;
    }
}

/* The cone that all tables reach. */
static float least_edge(const ReflectionModel *model) {
    float edge = model->parts->haze[0].theta_max;
    for (int t = 1; t < model->tables; t++)
        edge = model->parts->haze[t].theta_max < edge ? model->parts->haze[t].theta_max : edge;
    return edge;
}

static void note_outcome(const ReflectionModel *model, const ReflectionMisses *misses,
                         FitNotes *notes) {
    if (model->masked)
        fit_note(notes,
                 "%d zeros or negative values of reflection were held above a floor "
                 "(1e-6 of their table's largest value); their errors do not count",
                 model->masked);
    if (model->has_reach)
        fit_note(notes,
                 "reflection: at some incidences the samples do not surround all "
                 "directions up to %.4g degrees: outside of them the value on their edge is "
                 "held, and called extrapolated (extrapolated_share says how much)",
                 degrees_from_radians((double)least_edge(model)));
    if (misses->misses)
        fit_note(notes,
                 "reflection: %d of %d samples lie beyond the bound of %.2g %%, the "
                 "worst by a factor of %.2g",
                 misses->misses, misses->samples, 100 * model->bound, misses->worst);
}

/* ---- what was left out ------------------------------------------------------------------- */

typedef struct HeldOutPass {
    const ReflectionModel *model;
    HeldOut *held_out;
} HeldOutPass;

static void hold_out(void *context, int t, int worker) {
    HeldOutPass *pass = context;
    Arena arena = arena_reserve(TRIAL_BYTES);
    (void)worker;
    pass->held_out[t] = reflection_held_out(pass->model, t, arena);
    arena_release(&arena);
}

bool reflection_fit(const Measurement *set, const FitOptions *options, Arena *arena,
                    FitNotes *notes, ReflectionResult *out, Error *err) {
    reflection_parts_separate(set, options, arena, notes, &out->parts);
    ReflectionModel *model = start_model(set, options, &out->parts, arena);
    ReflectionMisses misses = {0};
    reflection_read_tables(model);
    model->bound = choose_bound(options, model->parts); /* scattered tables show noise now */
    HeldOutPass pass = {model, ARENA_NEW(arena, HeldOut, model->tables)};
    parallel_for(options->threads, model->tables, hold_out, &pass);
    reflection_held_out_peaks(model, pass.held_out);
    choose_frame(model);
    if (!code_levels(model, &misses, err)) return false;
    out->held_out = pass.held_out;
    out->model = model;
    out->worst = misses.worst;
    note_outcome(model, &misses, notes);
    return reflection_section_write(model, notes, &out->section, err);
}
