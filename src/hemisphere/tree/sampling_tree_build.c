/* SPDX-License-Identifier: Apache-2.0 */
#include "hemisphere/tree/sampling_tree_build.h"

#include <math.h>
#include <string.h>

#include "base/units.h"
#include "hemisphere/tree/sampling_code.h"

_Static_assert(sizeof(SamplingHeader) == 16, "the blob's layout");

/* A triangle that may become a cell or be split. */
typedef struct GainCell {
    double gain; /* what splitting takes off the variance, over all functions */
    int level;
    uint32_t id;
} GainCell;

typedef struct Build {
    const SamplingOptions *options;
    float *mass[GEODESIC_MAX_LEVEL + 1];  /* [triangle][function]: integral of f */
    float *root[GEODESIC_MAX_LEVEL + 1];  /* of sqrt f, taken constant in leaves */
    double *area[GEODESIC_MAX_LEVEL + 1]; /* octant 0 only */
    bool *split[GEODESIC_MAX_LEVEL + 1];
    GainCell *heap; /* largest gain first */
    int heap_count, cells, splits;
    double *variance; /* of each function's weights with the cells so far */
    uint8_t *step;    /* [function][node][3], nodes as a walk in depth meets them */
    uint32_t next_node;
    SamplingBits bits;
} Build;

static uint32_t triangles(const Build *build, int level) {
    return (uint32_t)build->options->octants << 2 * level;
}

static double area_of(const Build *build, int level, uint32_t id) {
    return build->area[level][id & ((1u << 2 * level) - 1)];
}

/* ---- which triangles are split ----------------------------------------------------------- */

static void fill_leaves(Build *build, const float *integrals, int function) {
    int level = build->options->level, functions = build->options->functions;
    uint32_t count = triangles(build, level);
    double total = 0, share = (double)build->options->uniform_share;
    double all_area = build->options->octants * 0.5 * PI;
    for (uint32_t i = 0; i < count; i++) total += (double)integrals[i];
    for (uint32_t i = 0; i < count; i++) {
        double area = area_of(build, level, i);
        double part = (1 - share) * (double)integrals[i] / total + share * area / all_area;
        size_t at = (size_t)i * (size_t)functions + (size_t)function;
        build->mass[level][at] = (float)part;
        build->root[level][at] = (float)sqrt(part * area);
    }
}

static void fill_pyramid(Build *build, const float *integrals, Arena *arena) {
    size_t width = (size_t)build->options->functions;
    for (int level = build->options->level; level >= 0; level--) {
        size_t count = triangles(build, level), octant = (size_t)1 << 2 * level;
        build->mass[level] = ARENA_NEW(arena, float, count *width);
        build->root[level] = ARENA_NEW(arena, float, count *width);
        build->area[level] = ARENA_NEW(arena, double, octant);
        build->split[level] = ARENA_NEW(arena, bool, count);
        geodesic_areas(level, build->area[level]);
        if (level == build->options->level) {
            for (int f = 0; f < build->options->functions; f++)
                fill_leaves(build, integrals + (size_t)f * count, f);
            continue;
        }
        for (size_t i = 0; i < 4 * count * width; i++) {
            size_t to = i / (4 * width) * width + i % width;
            build->mass[level][to] += build->mass[level + 1][i];
            build->root[level][to] += build->root[level + 1][i];
        }
    }
}

/* The square integral of sqrt f minus its mean over the triangle, times four: the part of the
 * variance of sampling weights that constant density leaves, to first order. */
static double cell_variance(const Build *build, int level, uint32_t id, int function) {
    if (level == build->options->level) return 0;
    size_t at = (size_t)id * (size_t)build->options->functions + (size_t)function;
    double root = (double)build->root[level][at];
    double left = (double)build->mass[level][at] - root * root / area_of(build, level, id);
    return left > 0 ? 4 * left : 0;
}

static bool comes_first(GainCell a, GainCell b) {
    if (a.gain != b.gain) return a.gain > b.gain;
    return a.level != b.level ? a.level < b.level : a.id < b.id;
}

/* A new cell: into the functions' variances and onto the heap. */
static void add_cell(Build *build, int level, uint32_t id) {
    GainCell cell = {0, level, id};
    for (int f = 0; f < build->options->functions; f++) {
        double variance = cell_variance(build, level, id, f);
        build->variance[f] += variance;
        cell.gain += variance;
    }
    int at = build->heap_count++;
    for (; at > 0 && comes_first(cell, build->heap[(at - 1) / 2]); at = (at - 1) / 2)
        build->heap[at] = build->heap[(at - 1) / 2];
    build->heap[at] = cell;
}

static GainCell heap_pop(Build *build) {
    GainCell first = build->heap[0], last = build->heap[--build->heap_count];
    int at = 0;
    for (int child = 1; child < build->heap_count; child = 2 * at + 1) {
        if (child + 1 < build->heap_count &&
            comes_first(build->heap[child + 1], build->heap[child]))
            child++;
        if (!comes_first(build->heap[child], last)) break;
        build->heap[at] = build->heap[child];
        at = child;
    }
    build->heap[at] = last;
    return first;
}

static bool is_fine_enough(const Build *build) {
    if (!(build->options->variance > 0)) return false;
    for (int f = 0; f < build->options->functions; f++)
        if (build->variance[f] > (double)build->options->variance) return false;
    return true;
}

static void split_cells(Build *build, Arena *arena) {
    const SamplingOptions *o = build->options;
    build->heap = ARENA_NEW(arena, GainCell, o->cells + 4);
    build->variance = ARENA_NEW(arena, double, o->functions);
    build->cells = o->octants;
    for (int q = 0; q < o->octants; q++) add_cell(build, 0, (uint32_t)q);
    while (build->cells + 3 <= o->cells && !is_fine_enough(build)) {
        GainCell cell = heap_pop(build);
        if (!(cell.gain > 1e-7)) return; /* constant inside, to rounding; all masses sum to 1 */
        for (int f = 0; f < o->functions; f++)
            build->variance[f] -= cell_variance(build, cell.level, cell.id, f);
        build->split[cell.level][cell.id] = true;
        build->cells += 3;
        build->splits++;
        for (uint32_t i = 0; i < 4; i++) add_cell(build, cell.level + 1, 4 * cell.id + i);
    }
}

/* ---- probabilities ----------------------------------------------------------------------- */

/* The step whose probability is nearest to first / (first + second); neither 0 nor 1 when both
 * are above 0. */
static uint8_t step_of(double first, double second) {
    uint32_t low = 0, high = SAMPLING_STEPS;
    if (!(second > 0)) return SAMPLING_STEPS;
    if (!(first > 0)) return 0;
    double share = first / (first + second);
    while (high - low > 1) {
        uint32_t middle = (low + high) / 2;
        *((double)sampling_probability(middle) <= share ? &low : &high) = middle;
    }
    bool is_low =
        share - (double)sampling_probability(low) < (double)sampling_probability(high) - share;
    uint32_t step = is_low ? low : high;
    return (uint8_t)(step < 1 ? 1 : step > SAMPLING_STEPS - 1 ? SAMPLING_STEPS - 1 : step);
}

/* mass: of four triangles, `width` floats apart. */
static void choose_steps(const float *mass, size_t width, uint8_t step[3]) {
    double m[4];
    for (size_t i = 0; i < 4; i++) m[i] = (double)mass[i * width];
    step[0] = step_of(m[0] + m[1], m[2] + m[3]);
    step[1] = step_of(m[0], m[1]);
    step[2] = step_of(m[2], m[3]);
}

static uint8_t *steps_at(const Build *build, int function, uint32_t node) {
    return build->step + 3 * ((size_t)function * (size_t)(build->splits + 1) + node);
}

static void walk_triangle(Build *build, int level, uint32_t id) {
    size_t width = (size_t)build->options->functions;
    if (!build->split[level][id]) return;
    uint32_t node = build->next_node++;
    for (size_t f = 0; f < width; f++)
        choose_steps(build->mass[level + 1] + 4 * (size_t)id * width + f, width,
                     steps_at(build, (int)f, node));
    for (uint32_t i = 0; i < 4; i++)
        sampling_put(&build->bits, build->split[level + 1][4 * id + i], 1);
    for (uint32_t i = 0; i < 4; i++) walk_triangle(build, level + 1, 4 * id + i);
}

static void walk_octants(Build *build) {
    int octants = build->options->octants, width = build->options->functions;
    for (int f = 0; f < width; f++) {
        const float *mass = build->mass[0] + f;
        if (octants == 2) *steps_at(build, f, 0) = step_of((double)mass[0], (double)mass[width]);
        else choose_steps(mass, (size_t)width, steps_at(build, f, 0));
    }
    build->next_node = 1;
    for (int q = 0; q < octants; q++) sampling_put(&build->bits, build->split[0][q], 1);
    for (int q = 0; q < octants; q++) walk_triangle(build, 0, (uint32_t)q);
}

/* One function's steps with Rice's parameter k. */
static void put_steps(Build *build, SamplingBits *bits, int function, int k) {
    for (uint32_t node = 0; node <= (uint32_t)build->splits; node++) {
        const uint8_t *step = steps_at(build, function, node);
        for (uint32_t i = 0; i < sampling_steps_of(build->options->octants, node); i++) {
            int before =
                function ? steps_at(build, function - 1, node)[i] : (SAMPLING_STEPS + 1) / 2;
            sampling_put_rice(bits, sampling_zigzag(step[i] - before), k);
        }
    }
}

static void put_functions(Build *build) {
    for (int f = 0; f < build->options->functions; f++) {
        size_t least = SIZE_MAX;
        int best = 0;
        for (int k = 0; k < 1 << SAMPLING_RICE_BITS; k++) {
            SamplingBits tried = {NULL, 0, 0};
            put_steps(build, &tried, f, k);
            if (tried.at < least) best = k;
            if (tried.at < least) least = tried.at;
        }
        sampling_put(&build->bits, (uint32_t)best, SAMPLING_RICE_BITS);
        put_steps(build, &build->bits, f, best);
    }
}

/* ---- all of it --------------------------------------------------------------------------- */

static bool check_options(const SamplingOptions *o, Error *err) {
    if (o->level < 0 || o->level > GEODESIC_MAX_LEVEL)
        return error_set(err, ERROR_INPUT, "level is %d, required: 0 to %d", o->level,
                         GEODESIC_MAX_LEVEL);
    if (o->octants != 2 && o->octants != 4)
        return error_set(err, ERROR_INPUT, "octants are %d, required: 2 or 4", o->octants);
    if (o->functions < 1 || o->functions > SAMPLING_FUNCTIONS_MAX)
        return error_set(err, ERROR_INPUT, "functions are %d, required: 1 to %d", o->functions,
                         SAMPLING_FUNCTIONS_MAX);
    if (o->cells < o->octants || o->cells > SAMPLING_CELLS_MAX)
        return error_set(err, ERROR_INPUT, "cells are %d, required: %d to %d", o->cells, o->octants,
                         SAMPLING_CELLS_MAX);
    if (!(o->uniform_share >= 0 && o->uniform_share <= 1))
        return error_set(err, ERROR_INPUT, "uniform share is %g, required: 0 to 1",
                         (double)o->uniform_share);
    return true;
}

static bool check_integrals(const SamplingOptions *options, const float *integrals, Error *err) {
    uint32_t count = (uint32_t)options->octants << 2 * options->level;
    double sum = 0;
    for (uint32_t i = 0; i < count; i++) {
        if (!(integrals[i] >= 0 && isfinite(integrals[i])))
            return error_set(err, ERROR_INPUT,
                             "the integral over leaf %u is %g, required: a finite value of at "
                             "least 0",
                             i, (double)integrals[i]);
        sum += (double)integrals[i];
    }
    if (!(sum > 0)) return error_set(err, ERROR_INPUT, "a function that is 0 cannot be sampled");
    return true;
}

/* Bits enough for any tree of so many splits. */
static size_t most_bits(const SamplingOptions *options, int splits) {
    size_t steps = 3 * (size_t)(splits + 1);
    return 8 * sizeof(SamplingHeader) + 4 * (size_t)(splits + 1) +
           (size_t)options->functions * (SAMPLING_RICE_BITS + 9 * steps);
}

/* The blob is written behind the scratch, then moved to where the scratch began. */
bool sampling_tree_build(const SamplingOptions *options, const float *integrals, Arena *arena,
                         const void **blob, Error *err) {
    if (!check_options(options, err)) return false;
    size_t leaves = (size_t)options->octants << 2 * options->level;
    for (int f = 0; f < options->functions; f++)
        if (!check_integrals(options, integrals + (size_t)f * leaves, err)) return false;
    Arena scratch = *arena;
    Build build = {.options = options};
    fill_pyramid(&build, integrals, &scratch);
    split_cells(&build, &scratch);
    size_t bits = most_bits(options, build.splits);
    build.step = ARENA_NEW(&scratch, uint8_t, 3 * options->functions * (build.splits + 1));
    build.bits = (SamplingBits){ARENA_NEW(&scratch, uint8_t, bits / 8 + 1),
                                8 * sizeof(SamplingHeader), bits};
    walk_octants(&build);
    put_functions(&build);
    SamplingHeader header = {SAMPLING_MAGIC,
                             SAMPLING_VERSION,
                             (uint8_t)options->level,
                             (uint8_t)options->octants,
                             0,
                             (uint16_t)options->functions,
                             (uint16_t)build.splits,
                             (uint32_t)((build.bits.at + 7) / 8)};
    memcpy(build.bits.bytes, &header, sizeof header);
    *blob = arena_keep(arena, build.bits.bytes, header.size, 16);
    return true;
}

size_t sampling_tree_size(const void *blob) {
    SamplingHeader header;
    memcpy(&header, blob, sizeof header);
    return header.size;
}

/* ---- opening ----------------------------------------------------------------------------- */

#define CHOICES_MAX (1u << 22) /* of all functions: what an opened tree may expand to */

static bool refuse(Error *err, const char *what, double found, double wanted) {
    return error_set(err, ERROR_INPUT, "sampling tree: %s is %.9g, required: %.9g", what, found,
                     wanted);
}

static bool check_header(const SamplingHeader *h, size_t size, Error *err) {
    if (h->magic != SAMPLING_MAGIC) return refuse(err, "magic number", h->magic, SAMPLING_MAGIC);
    if (h->version != SAMPLING_VERSION) return refuse(err, "version", h->version, SAMPLING_VERSION);
    if (h->level > GEODESIC_MAX_LEVEL) return refuse(err, "level", h->level, GEODESIC_MAX_LEVEL);
    if (h->octants != 2 && h->octants != 4) return refuse(err, "octant count", h->octants, 4);
    if (h->functions < 1 || h->functions > SAMPLING_FUNCTIONS_MAX)
        return refuse(err, "number of functions", h->functions, SAMPLING_FUNCTIONS_MAX);
    uint32_t most = (SAMPLING_CELLS_MAX - h->octants) / 3u;
    if (h->splits > most) return refuse(err, "number of splits", h->splits, most);
    if ((h->splits + 1u) * h->functions > CHOICES_MAX)
        return error_set(err, ERROR_INPUT,
                         "sampling tree: %u splits for %u functions are more "
                         "than can be used",
                         h->splits, h->functions);
    if (h->reserved) return refuse(err, "a reserved byte", h->reserved, 0);
    if (h->size < sizeof *h || h->size > size)
        return refuse(err, "number of bytes", (double)size, (double)h->size);
    return true;
}

/* State of the depth-first walk that expands the structure. */
typedef struct Expand {
    const SamplingHeader *header;
    const Geodesic *geodesic;
    SamplingBits bits;
    SamplingNode *nodes;
    GeodesicSampler *cells;
    uint32_t *cell_level, *cell_place;
    uint32_t next_node, next_cell;
    Error *err;
} Expand;

static bool get_flags(Expand *expand, int count, bool *flags) {
    uint32_t bits;
    if (!sampling_get(&expand->bits, count, &bits))
        return error_set(expand->err, ERROR_INPUT, "sampling tree: ends inside its structure");
    for (int i = 0; i < count; i++) flags[i] = bits >> i & 1;
    return true;
}

static void expand_cell(Expand *expand, int level, uint32_t id, uint32_t *child) {
    uint32_t place = id & ((1u << 2 * level) - 1), cell = expand->next_cell++;
    GeodesicTriangle triangle = geodesic_triangle(level, id);
    expand->cells[cell] = geodesic_sampler(&triangle, expand->geodesic->areas[level][place]);
    expand->cell_level[cell] = (uint32_t)level;
    expand->cell_place[cell] = place;
    *child = SAMPLING_CELL | cell;
}

static bool expand_triangle(Expand *expand, int level, uint32_t id, bool is_split,
                            uint32_t *child) {
    bool flags[4];
    if (!is_split) {
        expand_cell(expand, level, id, child);
        return true;
    }
    if (level >= expand->header->level)
        return refuse(expand->err, "depth", level + 1, expand->header->level);
    if (expand->next_node > expand->header->splits)
        return refuse(expand->err, "number of splits", expand->next_node, expand->header->splits);
    uint32_t node = *child = expand->next_node++;
    if (!get_flags(expand, 4, flags)) return false;
    for (uint32_t i = 0; i < 4; i++)
        if (!expand_triangle(expand, level + 1, 4 * id + i, flags[i],
                             &expand->nodes[node].child[i]))
            return false;
    return true;
}

static bool expand_structure(Expand *expand) {
    bool flags[4];
    uint32_t octants = expand->header->octants, *child = expand->nodes[0].child;
    expand->next_node = 1;
    if (!get_flags(expand, (int)octants, flags)) return false;
    for (uint32_t q = 0; q < octants; q++)
        if (!expand_triangle(expand, 0, q, flags[q], &child[q])) return false;
    if (octants == 2) memcpy(child + 2, child, 2 * sizeof *child);
    if (expand->next_node != expand->header->splits + 1u)
        return refuse(expand->err, "number of splits", expand->next_node - 1,
                      expand->header->splits);
    return true;
}

/* ---- probabilities of a stored tree ------------------------------------------------------ */

static bool get_step(SamplingBits *bits, uint32_t k, uint8_t *step) {
    uint32_t n;
    if (!sampling_get_rice(bits, (int)k, &n)) return false;
    int value = *step + (n & 1 ? -(int)(n / 2) - 1 : (int)(n / 2));
    if (value < 0 || value > SAMPLING_STEPS) return false;
    *step = (uint8_t)value;
    return true;
}

/* steps: those of the function before, which this one's replace. */
static bool get_function(Expand *expand, uint8_t *steps, SamplingChoice *choices) {
    const SamplingHeader *h = expand->header;
    uint32_t k;
    bool is_there = sampling_get(&expand->bits, SAMPLING_RICE_BITS, &k);
    for (uint32_t node = 0; is_there && node <= h->splits; node++) {
        uint8_t *step = steps + 3 * node;
        for (uint32_t i = 0; is_there && i < sampling_steps_of(h->octants, node); i++)
            is_there = get_step(&expand->bits, k, &step[i]);
        choices[node] = sampling_choice(h->octants, node, step);
    }
    return is_there || error_set(expand->err, ERROR_INPUT,
                                 "sampling tree: a probability is "
                                 "missing or out of range");
}

static void fill_density(const SamplingTree *tree, const Expand *expand, int function,
                         const SamplingNode *node, double probability, float *density) {
    const SamplingChoice *choice =
        tree->choices + (size_t)function * tree->node_count + (node - tree->nodes);
    uint32_t children = node == tree->nodes ? (uint32_t)tree->octants : 4;
    for (uint32_t i = 0; i < children; i++) {
        uint32_t child = node->child[i];
        double part = probability * sampling_child_probability(choice, i);
        if (!(child & SAMPLING_CELL)) {
            fill_density(tree, expand, function, &tree->nodes[child], part, density);
            continue;
        }
        child &= ~SAMPLING_CELL;
        double area =
            (double)tree->geodesic->areas[expand->cell_level[child]][expand->cell_place[child]];
        density[(size_t)child * (size_t)tree->functions + (size_t)function] = (float)(part / area);
    }
}

static bool expand_functions(Expand *expand, SamplingTree *tree, Arena *arena) {
    size_t nodes = tree->node_count, functions = (size_t)tree->functions;
    SamplingChoice *choices = ARENA_NEW(arena, SamplingChoice, functions * nodes);
    float *density = ARENA_NEW(arena, float, tree->cell_count *functions);
    uint8_t *steps = ARENA_NEW(arena, uint8_t, 3 * nodes);
    memset(steps, (SAMPLING_STEPS + 1) / 2, 3 * nodes);
    tree->choices = choices;
    tree->density = density;
    for (int f = 0; f < tree->functions; f++) {
        if (!get_function(expand, steps, choices + (size_t)f * nodes)) return false;
        fill_density(tree, expand, f, tree->nodes, 1, density);
    }
    size_t bytes = (expand->bits.at + 7) / 8;
    return bytes == expand->header->size ||
           refuse(expand->err, "number of bytes", (double)expand->header->size, (double)bytes);
}

bool sampling_tree_open(const void *blob, size_t size, const Geodesic *geodesic, Arena *arena,
                        SamplingTree *out, Error *err) {
    SamplingHeader header;
    if (size < sizeof header) return refuse(err, "number of bytes", (double)size, sizeof header);
    memcpy(&header, blob, sizeof header);
    if (!check_header(&header, size, err)) return false;
    if (geodesic->level < header.level)
        return refuse(err, "level of the geodesic", geodesic->level, header.level);
    uint32_t nodes = header.splits + 1u, cells = header.octants + 3u * header.splits;
    Expand expand = {
        .header = &header,
        .geodesic = geodesic,
        .err = err,
        .bits = {(uint8_t *)(uintptr_t)blob, 8 * sizeof header, 8 * (size_t)header.size},
        .nodes = ARENA_NEW(arena, SamplingNode, nodes),
        .cells = ARENA_NEW(arena, GeodesicSampler, cells),
        .cell_level = ARENA_NEW(arena, uint32_t, cells),
        .cell_place = ARENA_NEW(arena, uint32_t, cells)};
    if (!expand_structure(&expand)) return false;
    SamplingTree tree = {.geodesic = geodesic,
                         .nodes = expand.nodes,
                         .cells = expand.cells,
                         .level = header.level,
                         .octants = header.octants,
                         .functions = header.functions,
                         .node_count = nodes,
                         .cell_count = cells};
    if (!expand_functions(&expand, &tree, arena)) return false;
    *out = tree;
    return true;
}
