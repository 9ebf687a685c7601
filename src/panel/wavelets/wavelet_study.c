/* SPDX-License-Identifier: Apache-2.0 */
#include "panel/wavelets/wavelet_study.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

#include "base/sampler.h"
#include "base/units.h"
#include "hemisphere/haar/haar_tree.h"
#include "hemisphere/tree/tree_open.h"
#include "hemisphere/tree/tree_query.h"
#include "hemisphere/wavelet1d.h"
#include "panel/fit/common/direction_grid.h"
#include "panel/fit/common/table_rows.h"
#include "panel/set/measurement.h"

/* ---- the spectrum ----------------------------------------------------------------------- */

/* A spectrum thresholded in three wavelets (wavelet1d.h): white's where a
 * set has its primaries' spectra, else the mean one of a reflection table. */

static const double SHARES[WAVELET_SPECTRUM_SIZES] = {0.02, 0.05, 0.1, 0.2, 0.5};

static int spectrum_of(const Measurement *set, const AngleTable *table, float *out)
{
    if (set->has_spectra) {
        for (int i = 0; i < SPECTRAL_COUNT; i++)
            out[i] = set->spectrum[0][i] + set->spectrum[1][i] + set->spectrum[2][i];
        return SPECTRAL_COUNT;
    }
    if (table->channels < 4) return 0;
    for (int i = 0; i < table->rows; i++)
        for (int c = 0; c < table->channels; c++)
            out[c] += table->value[i * table->channels + c] / (float)table->rows;
    return table->channels;
}

typedef struct WaveletTerm {
    float worth;
    int   place;
} WaveletTerm;

static int by_worth(const void *a, const void *b)
{
    float x = ((const WaveletTerm *)a)->worth, y = ((const WaveletTerm *)b)->worth;
    return (x < y) - (x > y);
}

/* The relative error of the spectrum from its most significant coefficients. */
static double error_with(WaveletKind kind, const float *spectrum, int count, int kept)
{
    float       values[WAVELET_MAX_COUNT], norms[WAVELET_MAX_COUNT];
    WaveletTerm order[WAVELET_MAX_COUNT];
    double      error = 0, sum = 0;
    memcpy(values, spectrum, sizeof *values * (size_t)count);
    wavelet1d_forward(kind, values, count);
    wavelet1d_norms(kind, count, norms);
    for (int i = 0; i < count; i++) order[i] = (WaveletTerm){fabsf(values[i]) * norms[i], i};
    qsort(order, (size_t)count, sizeof *order, by_worth);
    for (int i = kept; i < count; i++) values[order[i].place] = 0;
    wavelet1d_inverse(kind, values, count);
    for (int i = 0; i < count; i++) {
        double e = (double)(values[i] - spectrum[i]), s = (double)spectrum[i];
        error += e * e;
        sum += s * s;
    }
    return sum > 0 ? sqrt(error / sum) : 0;
}

static WaveletSpectrum wavelet_spectrum(const Measurement *set, const AngleTable *table,
                                        Arena scratch)
{
    float          *spectrum = ARENA_NEW(&scratch, float, WAVELET_MAX_COUNT);
    WaveletSpectrum out = {.count = spectrum_of(set, table, spectrum)};
    for (int i = 0; i < WAVELET_SPECTRUM_SIZES && out.count; i++) {
        int kept = (int)fmax(1, round(SHARES[i] * out.count));
        out.share[i] = (double)kept / out.count;
        for (int k = 0; k < 3; k++)
            out.rms[k][i] = error_with((WaveletKind)k, spectrum, out.count, kept);
    }
    return out;
}

/* ---- the table --------------------------------------------------------------------------- */

static double brightness(const AngleTable *table)
{
    double most = 0;
    for (int i = 0; i < table->rows; i++)
        most = fmax(most, (double)table->value[i * table->channels + table->channels / 2]);
    return most;
}

static void take(const AngleTable *table, const char *name, const AngleTable **best)
{
    if (name ? !strcmp(table->name, name) : !*best || brightness(table) > brightness(*best))
        *best = table;
}

/* Emission before reflection; of a white-only set the white itself. */
static const AngleTable *find_table(const Measurement *set, const char *name)
{
    const AngleTable *best = NULL;
    if (set->is_white_only) take(&set->white, name, &best);
    for (int p = 0; p < 3 && !set->is_white_only; p++)
        for (int i = 0; i < set->primary[p].level_count; i++)
            take(&set->primary[p].table[i], name, &best);
    if (set->has_black && (name || !best)) take(&set->black, name, &best);
    for (int i = 0; i < set->incidence_count * set->azimuth_count && (name || !best); i++)
        take(&set->brdf[i], name, &best);
    return best;
}

static double gauss(uint32_t i)
{
    double u = ((double)hash_u32(2 * i + 1) + 0.5) / 4294967296.0;
    double v = ((double)hash_u32(2 * i + 2) + 0.5) / 4294967296.0;
    return sqrt(-2 * log(u)) * cos(2 * PI * v);
}

static AngleTable with_noise(const AngleTable *table, double noise, Arena *arena)
{
    AngleTable out = *table;
    size_t     count = (size_t)table->rows * (size_t)table->channels;
    float     *value = ARENA_NEW(arena, float, count);
    for (size_t i = 0; i < count; i++)
        value[i] = table->value[i] * (float)(1 + noise * gauss((uint32_t)i));
    out.value = value;
    return out;
}

/* ---- trees ------------------------------------------------------------------------------- */

/* Triangles that hold samples take their mean. */
static void take_samples(const WaveletStudy *study, int level, float *leaves, Arena scratch)
{
    const AngleTable *table = study->source;
    size_t            n = (size_t)table->channels;
    int              *count = ARENA_NEW(&scratch, int, geodesic_count(level));
    for (int i = 0; i < table->rows; i++) {
        Vec3     d = table_row_direction(table, i);
        uint32_t id = geodesic_find(study->geodesic, level, d).id;
        float   *leaf = leaves + id * n;
        count[id]++;
        for (size_t c = 0; c < n; c++) {
            float v = table->value[(size_t)i * n + c];
            leaf[c] = count[id] == 1 ? v : leaf[c] + (v - leaf[c]) / (float)count[id];
        }
    }
}

/* The values of a level's triangles: the others' are read between the samples around. */
static float *leaves_of(const WaveletStudy *study, int level, Arena *arena)
{
    const AngleTable *table = study->source;
    size_t            n = (size_t)table->channels;
    float            *leaves = ARENA_NEW(arena, float, geodesic_count(level) * n);
    Arena             scratch = *arena;
    DirectionGrid     grid;
    direction_grid_build(table, false, &scratch, &grid);
    const float *cells = direction_grid_cells(&grid, table->value, table->channels, &scratch);
    for (uint32_t i = 0; i < geodesic_count(level); i++) {
        Vec3     d = geodesic_center(level, i);
        GridTaps taps;
        direction_grid_taps(&grid, atan2f(hypotf(d.x, d.y), d.z), atan2f(d.y, d.x), &taps);
        direction_grid_read(&taps, cells, table->channels, leaves + i * n);
    }
    take_samples(study, level, leaves, scratch);
    return leaves;
}

/* What tree is made of leaves. */
typedef struct TreeWish {
    int    level;
    double share;    /* of rows over leaves */
    bool   is_float;
} TreeWish;

static bool make_tree(const WaveletStudy *study, const float *leaves, TreeWish wish,
                      Arena *arena, Tree *out, TreeReport *report)
{
    HaarTreeOptions options = {.shape = {wish.level, 4, study->source->channels, HAAR_AREA},
                               .keep_share = (float)fmin(1, wish.share),
                               .rows = wish.is_float ? TREE_ROWS_FLOAT : TREE_ROWS_INT16};
    const void *blob;
    Error       unheard; /* a finite table cannot fail */
    return haar_tree_build(&options, leaves, arena, &blob, report, &unheard) &&
           tree_open(blob, tree_size(blob), study->geodesic, out, &unheard);
}

/* The means of a tree's triangles of a level, as a tree that ends there. */
static bool cut_tree(const WaveletStudy *study, const Tree *tree, int level, Arena *arena,
                     Tree *out)
{
    size_t n = (size_t)tree->components;
    float *means = ARENA_NEW(arena, float, geodesic_count(level) * n);
    for (uint32_t i = 0; i < geodesic_count(level); i++)
        tree_mean(tree, level, geodesic_center(level, i), means + i * n);
    return make_tree(study, means, (TreeWish){level, 1, true}, arena, out, NULL);
}

/* ---- errors ------------------------------------------------------------------------------ */

static double weight_of(const AngleTable *table, int row)
{
    return fmax(sin((double)table->theta[row]), 1e-3);
}

/* Of a table, or of its difference from another one. */
static double rms_of(const AngleTable *table, const AngleTable *less)
{
    double sum = 0, weights = 0;
    for (int i = 0; i < table->rows; i++)
        for (int c = 0; c < table->channels; c++) {
            int    at = i * table->channels + c;
            double v = (double)(table->value[at] - (less ? less->value[at] : 0));
            sum += weight_of(table, i) * v * v;
            weights += weight_of(table, i);
        }
    return sqrt(sum / weights);
}

/* Relative to the rms of the table's values. */
static WaveletErrors errors_of(const WaveletStudy *study, const Tree *tree,
                               const AngleTable *table)
{
    double sum[2] = {0, 0}, max[2] = {0, 0}, weights = 0;
    float  value[2][TREE_MAX_COMPONENTS];
    for (int i = 0; i < table->rows; i++) {
        Vec3   d = table_row_direction(table, i);
        double w = weight_of(table, i);
        tree_mean(tree, tree->level, d, value[0]);
        tree_interpolate(tree, d, value[1]);
        for (int c = 0; c < table->channels; c++, weights += w)
            for (int k = 0; k < 2; k++) {
                double e = (double)(value[k][c] - table->value[i * table->channels + c]);
                sum[k] += w * e * e;
                max[k] = fmax(max[k], fabs(e));
            }
    }
    double rms = study->sample_rms;
    return (WaveletErrors){sqrt(sum[0] / weights) / rms, max[0] / rms,
                           sqrt(sum[1] / weights) / rms, max[1] / rms};
}

/* Fathers beside the means of their children, by area, over all levels. */
static double mean_miss_of(const Tree *tree, double rms)
{
    double worst = 0;
    float  father[TREE_MAX_COMPONENTS], child[TREE_MAX_COMPONENTS];
    for (int level = 0; level < tree->level; level++)
        for (uint32_t i = 0; i < geodesic_count(level); i++) {
            double sum[TREE_MAX_COMPONENTS] = {0}, area = 0;
            for (uint32_t k = 4 * i; k < 4 * i + 4; k++) {
                double a = geodesic_area(level + 1, k);
                tree_mean(tree, level + 1, geodesic_center(level + 1, k), child);
                for (int c = 0; c < tree->components; c++) sum[c] += a * (double)child[c];
                area += a;
            }
            tree_mean(tree, level, geodesic_center(level, i), father);
            for (int c = 0; c < tree->components; c++)
                worst = fmax(worst, fabs((double)father[c] - sum[c] / area) / rms);
        }
    return worst;
}

/* ---- the study --------------------------------------------------------------------------- */

/* A size: what so large a share of the table's numbers gives. */
static bool measure_size(const WaveletStudy *study, const float *leaves, TreeWish wish,
                         Arena *arena, Tree *tree, WaveletSize *out)
{
    TreeReport report;
    if (!make_tree(study, leaves, wish, arena, tree, &report)) return false;
    double numbers = (double)study->source_bytes / sizeof(float);
    *out = (WaveletSize){.share = (double)report.stored_values / numbers,
                         .rows = report.stored_rows,
                         .bytes = report.bytes,
                         .leaf_rms = (double)report.relative_l2,
                         .leaf_max = (double)report.max_error / study->sample_rms,
                         .errors = errors_of(study, tree, study->source)};
    return true;
}

static double rows_share(const WaveletStudy *study, double share)
{
    return share * study->source->rows / geodesic_count(study->level);
}

static void find_sizes(WaveletStudy *study, const float *leaves, const AngleTable *truth,
                       Arena scratch)
{
    static const double shares[WAVELET_SIZES_MAX] = {0.0005, 0.001, 0.002, 0.005,
                                                     0.01, 0.02, 0.05, 0.1};
    for (int i = 0; i < WAVELET_SIZES_MAX; i++) {
        Arena        arena = scratch;
        Tree         tree;
        WaveletSize *size = &study->sizes[study->size_count];
        TreeWish     wish = {study->level, rows_share(study, shares[i]), false};
        if (shares[i] * study->source->rows < 4) continue; /* less than the octants' means */
        if (!measure_size(study, leaves, wish, &arena, &tree, size)) continue;
        size->truth_rms = errors_of(study, &tree, truth).smooth_rms;
        study->size_count++;
    }
}

#define QUERIES 20000
#define TIMINGS 3

static double seconds(void)
{
    struct timespec now;
    clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &now);
    return (double)now.tv_sec + 1e-9 * (double)now.tv_nsec;
}

/* Of the fastest of a few runs, ns. */
static double time_queries(const Tree *tree, const Vec3 *direction, bool is_smooth)
{
    float  value[TREE_MAX_COMPONENTS];
    double best = INFINITY;
    for (int run = 0; run < TIMINGS; run++) {
        double start = seconds();
        for (int i = 0; i < QUERIES; i++)
            if (is_smooth) tree_interpolate(tree, direction[i], value);
            else tree_mean(tree, tree->level, direction[i], value);
        best = fmin(best, seconds() - start);
    }
    return 1e9 * best / QUERIES;
}

/* Trees without loss, of ever more triangles. */
static void time_levels(WaveletStudy *study, Arena scratch)
{
    Vec3 *direction = ARENA_NEW(&scratch, Vec3, QUERIES);
    for (uint32_t i = 0; i < QUERIES; i++) {
        double z = ((double)hash_u32(2 * i) + 0.5) / 4294967296.0, across = sqrt(1 - z * z);
        double phi = 2 * PI * (double)hash_u32(2 * i + 1) / 4294967296.0;
        direction[i] = vec3((float)(across * cos(phi)), (float)(across * sin(phi)), (float)z);
    }
    for (int level = 0; level <= WAVELET_TIMED_LEVEL; level++) {
        Arena  arena = scratch;
        Tree   tree;
        float *leaves = leaves_of(study, level, &arena);
        TreeWish wish = {level, 1, true};
        if (!make_tree(study, leaves, wish, &arena, &tree, NULL)) continue;
        study->query_ns[level] = time_queries(&tree, direction, false);
        study->smooth_ns[level] = time_queries(&tree, direction, true);
    }
}

/* As many triangles as samples would be over the whole hemisphere. */
static int level_for(const AngleTable *table)
{
    double wanted = table->rows / (1 - cos(fmin((double)table->theta_max, PI / 2)));
    int    level = 1;
    while (level < WAVELET_LEVEL_MAX - 1 && geodesic_count(level) < wanted) level++;
    return level;
}

static bool start(const Measurement *set, const WaveletOptions *options, Arena *arena,
                  WaveletStudy *study, Error *err)
{
    const AngleTable *table = find_table(set, options->table);
    if (!table && options->table)
        return error_set(err, ERROR_USAGE, "--table is '%s', which the set lacks: required is "
                         "a table's name, such as 'red 255', 'black' or 'brdf 30 deg'",
                         options->table);
    if (!table) return error_set(err, ERROR_INPUT, "%s: has no table", set->file);
    if (table->channels > TREE_MAX_COMPONENTS)
        return error_set(err, ERROR_INPUT, "%s: table %s has %d wavelengths, required: at most "
                         "%d", set->file, table->name, table->channels, TREE_MAX_COMPONENTS);
    AngleTable *source = ARENA_NEW(arena, AngleTable, 1);
    *source = options->noise > 0 ? with_noise(table, options->noise, arena) : *table;
    *study = (WaveletStudy){.file = set->file, .source = source, .noise = options->noise};
    study->level = options->level >= 0 ? options->level : level_for(table);
    study->sample_rms = rms_of(table, NULL);
    if (!(study->sample_rms > 0))
        return error_set(err, ERROR_INPUT, "%s: table %s is dark, required: some light",
                         set->file, table->name);
    study->source_bytes =
        sizeof(float) * (size_t)table->rows * (size_t)table->channels;
    study->geodesic = geodesic_create(WAVELET_LEVEL_MAX, arena);
    return true;
}

bool wavelet_study(const Measurement *set, const WaveletOptions *options, Arena *arena,
                   WaveletStudy *out, Error *err)
{
    if (!start(set, options, arena, out, err)) return false;
    const AngleTable *truth = find_table(set, options->table);
    const float      *leaves = leaves_of(out, out->level, arena);
    double            least = fmin(1, 4.0 / out->source->rows);
    double keep = options->keep > 0 ? options->keep : fmax(WAVELET_KEEP, least);
    TreeWish wish = {out->level, options->is_lossless ? 1 : rows_share(out, keep),
                     options->is_lossless};
    if (keep < least)
        return error_set(err, ERROR_USAGE, "--keep is %g, required: at least %.3g: the means "
                         "of the four octants", keep, least);
    if (!measure_size(out, leaves, wish, arena, &out->tree, &out->kept))
        return error_set(err, ERROR_INPUT, "%s: table %s holds a number that is not finite",
                         set->file, truth->name);
    out->kept.truth_rms = errors_of(out, &out->tree, truth).smooth_rms;
    out->mean_miss = mean_miss_of(&out->tree, out->sample_rms);
    for (int level = 0; level <= out->level; level++) {
        uint32_t count = geodesic_count(level);
        if (!cut_tree(out, &out->tree, level, arena, &out->level_tree[level])) continue;
        out->levels[level] =
            (WaveletLevel){count, degrees_from_radians(sqrt(2 * PI / count)),
                           errors_of(out, &out->level_tree[level], out->source)};
    }
    find_sizes(out, leaves, truth, *arena);
    if (out->noise > 0) out->noise_rms = rms_of(out->source, truth) / out->sample_rms;
    out->spectrum = wavelet_spectrum(set, truth, *arena);
    time_levels(out, *arena);
    return true;
}

double wavelet_study_value(const WaveletStudy *study, int level, bool is_smooth, Vec3 direction)
{
    const Tree *tree = &study->level_tree[level];
    float       value[TREE_MAX_COMPONENTS];
    double      sum = 0;
    if (is_smooth) tree_interpolate(tree, direction, value);
    else tree_mean(tree, level, direction, value);
    if (study->source->channels == 3) return (double)value[1];
    for (int c = 0; c < tree->components; c++) sum += (double)value[c];
    return sum / tree->components;
}
