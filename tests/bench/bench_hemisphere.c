/* SPDX-License-Identifier: Apache-2.0 */
/* bench_hemisphere.c -- size and error of compressed hemispheres, and nanoseconds per query.
 *
 * Signals are functions with known values everywhere: a display's luminance over angle, the
 * haze of an anti-glare surface around a mirror direction (fixed frame and specular-following
 * frame), and a peak half a degree wide. The error of leaves compares the tree with its source;
 * the errors of directions compare leaf values and interpolation with the function itself,
 * cosine-weighted, at directions that no leaf centre coincides with.
 * Times: processor time of one thread, fixed seed, median and spread (least to most) of RUNS
 * runs.
 */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/mathf.h"
#include "base/sampler.h"
#include "base/units.h"
#include "hemisphere/sampling/sampling_tree.h"
#include "hemisphere/sampling/sampling_tree_build.h"
#include "hemisphere/specular_frame.h"
#include "hemisphere/haar/haar_tree.h"
#include "hemisphere/tree/tree_open.h"
#include "hemisphere/tree/tree_query.h"
#include "hemisphere/vertex/vertex_tree.h"
#include "hemisphere/vertex/vertex_tree_build.h"
#include "bench_timing.h"
#include "hemisphere_signals.h"
#include "tests/unit/vertex_bound.h"

#define RUNS 25
#define DIRECTIONS 4096
#define MAX_LEVEL 7

/* Function `function` alone. */
static SamplingMix sampling_only(int function)
{
    return (SamplingMix){.count = 1, .function = {function}, .weight = {1}};
}

/* The leaf's value, which its centre keeps. */
static void tree_value(const Tree *tree, Vec3 direction, float *out)
{
    uint32_t id = geodesic_find(tree->geodesic, tree->level, direction).id;
    tree_interpolate(tree, geodesic_center(tree->level, id), out);
}

/* ---- size and error -------------------------------------------------------------------- */

static float *leaf_values(Signal signal, int level, int octants, Arena *arena)
{
    uint32_t count = (uint32_t)octants << 2 * level;
    float   *leaves = ARENA_NEW(arena, float, count);
    for (uint32_t i = 0; i < count; i++) leaves[i] = (float)signal(geodesic_center(level, i));
    return leaves;
}

static Vec3 direction_of(uint32_t i)
{
    float z = (float)((i + 0.5) / DIRECTIONS), across = sqrtf(1 - z * z), sine, cosine;
    sincos_turns(unit_float(hash_u32(i)), &sine, &cosine);
    return vec3(across * cosine, across * sine, z);
}

/* Relative L2 errors of the leaf's value and of the interpolant, per cent. */
static void direction_errors(const Tree *tree, Signal signal, double percent[2])
{
    double error[2] = {0, 0}, sum = 0;
    for (uint32_t i = 0; i < DIRECTIONS; i++) {
        Vec3   d = direction_of(i);
        double truth = signal(d);
        float  leaf, smooth;
        tree_value(tree, d, &leaf);
        tree_interpolate(tree, d, &smooth);
        error[0] += (double)d.z * ((double)leaf - truth) * ((double)leaf - truth);
        error[1] += (double)d.z * ((double)smooth - truth) * ((double)smooth - truth);
        sum += (double)d.z * truth * truth;
    }
    for (int i = 0; i < 2; i++) percent[i] = 100 * sqrt(error[i] / sum);
}

static void print_size_row(const SignalRow *row, HaarTreeOptions options, const float *leaves,
                           const Geodesic *geodesic, Arena scratch)
{
    const void *blob;
    TreeReport  report;
    Tree        tree;
    Error       err;
    double      percent[2];
    if (!haar_tree_build(&options, leaves, &scratch, &blob, &report, &err) ||
        !tree_open(blob, report.bytes, geodesic, &tree, &err)) {
        printf("%s\n", err.text);
        exit(1);
    }
    float largest = 0;
    for (uint32_t i = 0; i < report.leaves; i++) largest = fmaxf(largest, leaves[i]);
    direction_errors(&tree, row->value, percent);
    printf("%-23s %5d  %-5s %-6s %8.2f %8u %8u %9zu %8.1f %9.3f %9.3f %9.3f %9.3f\n", row->name,
           options.shape.level, options.shape.weights == HAAR_AREA ? "area" : "equal",
           options.rows == TREE_ROWS_INT16 ? "int16" : "float",
           100 * (double)options.keep_share, report.stored_rows, report.nodes, report.bytes,
           (double)report.source_bytes / (double)report.bytes,
           100 * (double)report.max_error / (double)largest, 100 * (double)report.relative_l2,
           percent[0], percent[1]);
}

static void print_sizes(const Geodesic *geodesic, Arena scratch)
{
    static const float shares[] = {0.0025f, 0.01f, 0.05f, 0.2f, 1};
    printf("size and error against the kept share (errors in %%; max relative to the largest "
           "value)\n%-23s %5s  %-5s %-6s %8s %8s %8s %9s %8s %9s %9s %9s %9s\n", "signal",
           "level", "means", "rows", "kept %", "stored", "nodes", "bytes", "ratio", "leaf max",
           "leaf L2", "value L2", "interp L2");
    for (size_t s = 0; s < sizeof SIGNALS / sizeof *SIGNALS; s++)
        for (int level = 5; level <= MAX_LEVEL; level++) {
            Arena       inner = scratch;
            HaarShape   shape = {level, SIGNALS[s].octants, 1, HAAR_AREA};
            const float *leaves = leaf_values(SIGNALS[s].value, level, shape.octants, &inner);
            for (size_t i = 0; i < sizeof shares / sizeof *shares; i++)
                print_size_row(&SIGNALS[s],
                               (HaarTreeOptions){.shape = shape, .keep_share = shares[i],
                                             .rows = TREE_ROWS_INT16},
                               leaves, geodesic, inner);
            print_size_row(&SIGNALS[s], (HaarTreeOptions){.shape = shape, .keep_share = 0.01f},
                           leaves, geodesic, inner);
            shape.weights = HAAR_EQUAL;
            print_size_row(&SIGNALS[s], (HaarTreeOptions){.shape = shape, .keep_share = 0.01f},
                           leaves, geodesic, inner);
        }
}

/* ---- the two bases -------------------------------------------------------------------- */

/* Component c is the signal times 1 + c/10 of the components: they differ as spectra do. */
static float *vertex_values(Signal signal, VertexLattice lattice, int components, Arena *arena)
{
    uint32_t count = vertex_count(lattice);
    Vec3    *d = ARENA_NEW(arena, Vec3, count);
    float   *values = ARENA_NEW(arena, float, count * (uint32_t)components);
    vertex_directions(lattice, d);
    for (uint32_t i = 0; i < count; i++)
        for (int c = 0; c < components; c++)
            values[i * (uint32_t)components + (uint32_t)c] =
                (float)signal(d[i]) * (1 + 0.1f * (float)c / (float)components);
    return values;
}

static Tree build_vertex_tree(const Bound *bound, VertexLattice lattice,
                              const Geodesic *geodesic, Arena *arena, TreeReport *report)
{
    VertexTreeOptions options = {.lattice = lattice,
                                 .components = bound->components,
                                 .accepts = within_bound,
                                 .context = bound};
    const void       *blob;
    Tree              tree;
    Error             err;
    if (!vertex_tree_build(&options, bound->values, arena, &blob, report, &err) ||
        !tree_open(blob, report->bytes, geodesic, &tree, &err)) {
        printf("%s\n", err.text);
        exit(1);
    }
    return tree;
}

/* The finest bound, in steps of 7 %, with which no more than `stored` vertices are stored. */
static float bound_for(Signal signal, VertexLattice lattice, uint32_t stored,
                       const Geodesic *geodesic, Arena scratch)
{
    Bound bound = {vertex_values(signal, lattice, 1, &scratch), 1, 0};
    float best = 0;
    for (uint32_t i = 0; i < vertex_count(lattice); i++)
        bound.tolerance = fmaxf(bound.tolerance, 0.1f * bound.values[i]);
    for (uint32_t rows = 0; rows < stored + stored / 4; bound.tolerance *= 0.93f) {
        Arena      inner = scratch;
        TreeReport report;
        build_vertex_tree(&bound, lattice, geodesic, &inner, &report);
        rows = report.stored_rows;
        if (rows <= stored) best = bound.tolerance;
    }
    return best;
}

static double interpolation_ns(const Tree *tree);

/* Relative L2 (cosine-weighted) and largest error over the largest value of the interpolation,
 * at directions that no vertex or leaf centre coincides with. */
static void print_basis(const char *name, const char *basis, const Tree *tree,
                        const TreeReport *report, Signal signal)
{
    double error = 0, sum = 0, most = 0, largest = 0;
    for (uint32_t i = 0; i < DIRECTIONS; i++) {
        Vec3   d = direction_of(i);
        double truth = signal(d);
        float  value;
        tree_interpolate(tree, d, &value);
        double e = fabs((double)value - truth);
        error += (double)d.z * e * e;
        sum += (double)d.z * truth * truth;
        most = fmax(most, e);
        largest = fmax(largest, truth);
    }
    printf("%-23s %-7s %8u %9zu %9.3f %9.3f %9.1f\n", name, basis, report->stored_rows,
           report->bytes, 100 * sqrt(error / sum), 100 * most / largest,
           interpolation_ns(tree));
}

/* Both bases at level 7 with 1 % of the leaves' number stored. */
static void print_bases(const Geodesic *geodesic, Arena scratch)
{
    printf("\nvertex and Haar basis, level %d, 1 %% stored: errors in %%, of directions "
           "between the vertices\n%-23s %-7s %8s %9s %9s %9s %9s\n",
           MAX_LEVEL, "signal", "basis",
           "stored", "bytes", "L2", "max", "ns");
    for (size_t s = 0; s < sizeof SIGNALS / sizeof *SIGNALS; s++) {
        const SignalRow *row = &SIGNALS[s];
        Arena            inner = scratch;
        VertexLattice    lattice = {MAX_LEVEL, row->octants};
        HaarShape        shape = {MAX_LEVEL, row->octants, 1, HAAR_AREA};
        HaarTreeOptions      options = {.shape = shape, .keep_share = 0.01f,
                                    .rows = TREE_ROWS_INT16};
        uint32_t         stored = haar_leaf_count(&shape) / 100;
        const void      *blob;
        TreeReport       report;
        Tree             tree;
        Error            err;
        Bound bound = {vertex_values(row->value, lattice, 1, &inner), 1,
                       bound_for(row->value, lattice, stored, geodesic, inner)};
        tree = build_vertex_tree(&bound, lattice, geodesic, &inner, &report);
        print_basis(row->name, "vertex", &tree, &report, row->value);
        if (!haar_tree_build(&options, leaf_values(row->value, MAX_LEVEL, row->octants, &inner),
                        &inner, &blob, &report, &err) ||
            !tree_open(blob, report.bytes, geodesic, &tree, &err))
            exit(1);
        print_basis(row->name, "haar", &tree, &report, row->value);
    }
}

/* ---- time ------------------------------------------------------------------------------ */

/* What the timed works share. */
typedef struct Input {
    Vec3         directions[DIRECTIONS];
    Tree         tree;
    SamplingTree sampler;
    SpecularFrame frame;
    float         sink; /* keeps results alive */
} Input;

typedef struct Bench {
    const char *name;
    void (*work)(Input *input); /* DIRECTIONS queries */
} Bench;

static void work_find(Input *in)
{
    for (int i = 0; i < DIRECTIONS; i++)
        in->sink += geodesic_find(in->tree.geodesic, MAX_LEVEL, in->directions[i]).weight[0];
}

static void work_walk(Input *in)
{
    TreeTaps taps;
    for (int i = 0; i < DIRECTIONS; i++) {
        tree_walk_interpolated(&in->tree, in->directions[i], &taps);
        in->sink += taps.mean_weight[0] + (float)taps.count;
    }
}

static void work_interpolate(Input *in)
{
    float out[TREE_MAX_COMPONENTS];
    for (int i = 0; i < DIRECTIONS; i++) {
        tree_interpolate(&in->tree, in->directions[i], out);
        in->sink += out[0];
    }
}

static void work_sample(Input *in)
{
    SamplingMix only = sampling_only(0);
    for (uint32_t i = 0; i < DIRECTIONS; i++) {
        float u[3] = {unit_float(hash_u32(2 * i)), unit_float(hash_u32(2 * i + 1))};
        in->sink += sampling_tree_sample(&in->sampler, &only, u).pdf;
    }
}

static void work_pdf(Input *in)
{
    SamplingMix only = sampling_only(0);
    for (int i = 0; i < DIRECTIONS; i++)
        in->sink += sampling_tree_pdf(&in->sampler, &only, in->directions[i]);
}

static void work_stored(Input *in)
{
    for (int i = 0; i < DIRECTIONS; i++)
        in->sink += specular_frame_stored(&in->frame, in->directions[i]).x;
}

static void work_outer(Input *in)
{
    for (int i = 0; i < DIRECTIONS; i++)
        in->sink += specular_frame_outer(&in->frame, in->directions[i]).x;
}

static void work_jacobian(Input *in)
{
    for (int i = 0; i < DIRECTIONS; i++)
        in->sink += specular_frame_jacobian(&in->frame, in->directions[i]);
}

static void work_both(Input *in)
{
    float jacobian;
    for (int i = 0; i < DIRECTIONS; i++) {
        in->sink += specular_frame_stored_jacobian(&in->frame, in->directions[i], &jacobian).x;
        in->sink += jacobian;
    }
}

static const Bench TREE_WORKS[] = {
    {"walk for interpolation", work_walk},
    {"interpolated value", work_interpolate},
};

static const Bench OTHER_WORKS[] = {
    {"find the leaf", work_find},           {"sample a direction", work_sample},
    {"pdf of a direction", work_pdf},       {"specular frame, stored", work_stored},
    {"specular frame, outer", work_outer},  {"specular frame, Jacobian", work_jacobian},
    {"specular frame, both", work_both},
};

static void time_work(const Bench *bench, const char *what, Input *input)
{
    double ns[RUNS];
    for (int run = -1; run < RUNS; run++) { /* the first warms up */
        double start = thread_seconds();
        for (int i = 0; i < 4; i++) bench->work(input);
        if (run >= 0) ns[run] = (thread_seconds() - start) * 1e9 / (4.0 * DIRECTIONS);
    }
    double median = median_of(ns, RUNS);
    printf("%-26s %-34s %8.1f ns   (%.1f to %.1f)\n", bench->name, what, median, ns[0],
           ns[RUNS - 1]);
}

/* Median processor time of an interpolated value in random directions, ns. */
static double interpolation_ns(const Tree *tree)
{
    static Vec3 directions[DIRECTIONS];
    double      ns[RUNS], sink = 0;
    float       out[TREE_MAX_COMPONENTS];
    for (uint32_t i = 0; i < DIRECTIONS; i++)
        directions[i] = direction_of(hash_u32(i) % DIRECTIONS);
    for (int run = -1; run < RUNS; run++) {
        double start = thread_seconds();
        for (int i = 0; i < DIRECTIONS; i++) {
            tree_interpolate(tree, directions[i], out);
            sink += (double)out[0];
        }
        if (run >= 0) ns[run] = (thread_seconds() - start) * 1e9 / DIRECTIONS;
    }
    double median = median_of(ns, RUNS);
    return sink == 0.5 ? 0 : median;
}

/* Vertex trees of more components: emission and haze within 0.3 % of their largest value. */
static void print_vertex_times(const Geodesic *geodesic, Arena scratch)
{
    static const int components[] = {1, 4, 8, 12, 16, 32};
    printf("\nvertex trees, level %d, bound 0.3 %% of the largest value: median ns of an "
           "interpolated value\n%-23s %10s %8s %9s %9s\n", MAX_LEVEL, "signal", "components",
           "stored", "bytes", "ns");
    for (size_t s = 0; s < 3; s++)
        for (size_t c = 0; c < sizeof components / sizeof *components; c++) {
            Arena         inner = scratch;
            VertexLattice lattice = {MAX_LEVEL, SIGNALS[s].octants};
            TreeReport    report;
            Bound bound = {vertex_values(SIGNALS[s].value, lattice, components[c], &inner),
                           components[c], 0};
            uint32_t count = vertex_count(lattice) * (uint32_t)components[c];
            for (uint32_t i = 0; i < count; i++)
                bound.tolerance = fmaxf(bound.tolerance, 0.003f * bound.values[i]);
            Tree tree = build_vertex_tree(&bound, lattice, geodesic, &inner, &report);
            printf("%-23s %10d %8u %9zu %9.1f\n", SIGNALS[s].name, components[c],
                   report.stored_rows, report.bytes, interpolation_ns(&tree));
        }
}

/* The haze with components that differ a little, as spectra do. */
static void fill_tree(Input *in, int components, float share, TreeRowFormat rows,
                      const Geodesic *geodesic, Arena *arena)
{
    HaarShape   shape = {MAX_LEVEL, 2, components, HAAR_AREA};
    HaarTreeOptions options = {.shape = shape, .keep_share = share, .rows = rows};
    Arena       behind = *arena;
    uint32_t    count = haar_leaf_count(&shape);
    const void *blob;
    Error       err;
    arena_alloc(&behind, 1, 16,
                (size_t)32 << 20); /* the blob's room, in front of the scratch */
    float *leaves = ARENA_NEW(&behind, float, count * (uint32_t)components);
    for (uint32_t i = 0; i < count; i++) {
        float value = (float)haze_in_specular_frame(geodesic_center(MAX_LEVEL, i));
        for (int c = 0; c < components; c++)
            leaves[i * (uint32_t)components + (uint32_t)c] =
                value * (1 + 0.1f * (float)c / (float)components);
    }
    if (!haar_tree_build(&options, leaves, &behind, &blob, NULL, &err) ||
        !tree_open(blob, tree_size(blob), geodesic, &in->tree, &err)) {
        printf("%s\n", err.text);
        exit(1);
    }
    *arena = behind;
}

/* What a sample in the stored frame is drawn for: f cos J. */
static double haze_cos_jacobian(Vec3 stored)
{
    SpecularFrame frame = specular_frame(30 * PI_F / 180, 2);
    double        f = haze_in_specular_frame(stored);
    return f * (double)(specular_frame_outer(&frame, stored).z *
                        specular_frame_jacobian(&frame, stored));
}

static SamplingTree make_sampler(int cells, const Geodesic *geodesic, Arena *arena,
                                 size_t *bytes)
{
    SamplingOptions options = {.level = MAX_LEVEL, .octants = 2, .functions = 1,
                               .cells = cells};
    uint32_t        count = 2u << 2 * MAX_LEVEL;
    float          *integrals = leaf_values(haze_cos_jacobian, MAX_LEVEL, 2, arena);
    const void     *blob;
    SamplingTree    tree;
    Error           err;
    for (uint32_t i = 0; i < count; i++)
        integrals[i] *= geodesic->areas[MAX_LEVEL][i & ((1u << 2 * MAX_LEVEL) - 1)];
    if (!sampling_tree_build(&options, integrals, arena, &blob, &err) ||
        !sampling_tree_open(blob, sampling_tree_size(blob), geodesic, arena, &tree,
                            &err)) {
        printf("%s\n", err.text);
        exit(1);
    }
    *bytes = sampling_tree_size(blob);
    return tree;
}

/* Variance of sampling weights over their squared mean. */
static double relative_variance(double sum, double squares, double count)
{
    return squares / count / (sum / count * (sum / count)) - 1;
}

static void print_sampling(const Geodesic *geodesic, Arena scratch)
{
    static const int cells[] = {2, 20, 80, 200, 655, 2000, 8000};
    const uint32_t   count = 200000;
    SamplingMix      only = sampling_only(0);
    printf(
        "\nsampling the haze (frame of 30 degrees, k = 2): relative variance of the weights\n"
        "%8s %9s %12s\n",
        "cells", "bytes", "variance");
    for (size_t c = 0; c < sizeof cells / sizeof *cells; c++) {
        Arena        inner = scratch;
        size_t       bytes;
        SamplingTree tree = make_sampler(cells[c], geodesic, &inner, &bytes);
        double       sum = 0, squares = 0;
        for (uint32_t i = 0; i < count; i++) {
            float u[3] = {unit_float(hash_u32(2 * i)), unit_float(hash_u32(2 * i + 1))};
            SamplingResult r = sampling_tree_sample(&tree, &only, u);
            double         weight = haze_cos_jacobian(r.direction) / (double)r.pdf;
            sum += weight;
            squares += weight * weight;
        }
        printf("%8u %9zu %12.4f\n", tree.cell_count, bytes,
               relative_variance(sum, squares, count));
    }
    double sum = 0, squares = 0;
    for (uint32_t i = 0; i < count; i++) { /* cosine sampling: weight pi f */
        float z2 = unit_float(hash_u32(2 * i)), across = sqrtf(1 - z2), sine, cosine;
        sincos_turns(unit_float(hash_u32(2 * i + 1)), &sine, &cosine);
        double weight = haze(vec3(across * cosine, across * sine, sqrtf(z2)));
        sum += weight;
        squares += weight * weight;
    }
    printf("%8s %9s %12.4f\n", "cosine", "-", relative_variance(sum, squares, count));
}

static void print_times(const Geodesic *geodesic, Arena scratch)
{
    static const int   components[] = {1, 3, 16, 32};
    static const float shares[] = {0.01f, 0.05f};
    static const char *const formats[] = {"float", "int16", "blocks"};
    Input             *in = ARENA_NEW(&scratch, Input, 1);
    for (uint32_t i = 0; i < DIRECTIONS; i++)
        in->directions[i] = direction_of(hash_u32(i) % DIRECTIONS);
    in->frame = specular_frame(30 * PI_F / 180, 2);
    printf(
        "\ntime per query, random directions, haze at level %d; median (least to most) of %d "
        "runs, 1 thread\n",
        MAX_LEVEL, RUNS);
    for (size_t s = 0; s < 2; s++)
        for (size_t c = 0; c < 4; c++)
            for (int rows = 0; rows < (components[c] < 16 ? 2 : 3); rows++) {
                Arena inner = scratch;
                char  what[64];
                fill_tree(in, components[c], shares[s], (TreeRowFormat)rows, geodesic, &inner);
                snprintf(what, sizeof what, "%2d components, %g%% kept, %s", components[c],
                         100 * (double)shares[s], formats[rows]);
                for (size_t w = 0; w < sizeof TREE_WORKS / sizeof *TREE_WORKS; w++)
                    time_work(&TREE_WORKS[w], what, in);
            }
    size_t bytes;
    in->sampler = make_sampler(655, geodesic, &scratch, &bytes);
    for (size_t w = 0; w < sizeof OTHER_WORKS / sizeof *OTHER_WORKS; w++)
        time_work(&OTHER_WORKS[w], "", in);
}

/* bench_hemisphere [size|bases|time]: one part only. */
int main(int argc, char **argv)
{
    Arena           arena = arena_reserve((size_t)2 << 30);
    const Geodesic *geodesic = geodesic_create(MAX_LEVEL, &arena);
    const char     *part = argc > 1 ? argv[1] : "";
    bool all = !part[0], size = !strcmp(part, "size"), time = !strcmp(part, "time");
    if (all || size) {
        print_sizes(geodesic, arena);
        print_sampling(geodesic, arena);
    }
    if (all || !strcmp(part, "bases")) {
        print_bases(geodesic, arena);
        print_vertex_times(geodesic, arena);
    }
    if (all || time) print_times(geodesic, arena);
    arena_release(&arena);
    return 0;
}
