#include "hemisphere/sampling_tree.h"

#include <math.h>
#include <string.h>

#include "base/units.h"

_Static_assert(sizeof(SamplingHeader) == 40 && sizeof(SamplingNode) == 28, "the blob's layout");

/* ---- build ------------------------------------------------------------------------------- */

/* A triangle that may become a cell or be split. */
typedef struct Cell {
    double   error; /* what splitting can gain */
    int      level;
    uint32_t id;
} Cell;

typedef struct Build {
    const SamplingOptions *options;
    double *mass[GEODESIC_MAX_LEVEL + 1];  /* integral of f over each triangle */
    double *root[GEODESIC_MAX_LEVEL + 1];  /* integral of sqrt f, taken constant in leaves */
    double *area[GEODESIC_MAX_LEVEL + 1];  /* octant 0 only */
    bool   *split[GEODESIC_MAX_LEVEL + 1];
    Cell   *heap; /* largest error first */
    int     heap_count;
    int     cells, nodes;
    SamplingNode *node; /* output */
    float        *density;
    uint32_t      next_node, next_cell;
} Build;

static uint32_t triangles(const Build *build, int level)
{
    return (uint32_t)build->options->octants << 2 * level;
}

static double area_of(const Build *build, int level, uint32_t id)
{
    return build->area[level][id & ((1u << 2 * level) - 1)];
}

static void fill_leaves(Build *build, const float *integrals)
{
    int      level = build->options->level;
    uint32_t count = triangles(build, level);
    double   total = 0, share = (double)build->options->uniform_share;
    double   all_area = build->options->octants * 0.5 * PI;
    for (uint32_t i = 0; i < count; i++) total += (double)integrals[i];
    for (uint32_t i = 0; i < count; i++) {
        double area = area_of(build, level, i);
        double part = (1 - share) * (double)integrals[i] / total + share * area / all_area;
        build->mass[level][i] = part;
        build->root[level][i] = sqrt(part * area);
    }
}

static void fill_pyramid(Build *build, const float *integrals, Arena *arena)
{
    for (int level = build->options->level; level >= 0; level--) {
        uint32_t count = triangles(build, level), octant = 1u << 2 * level;
        build->mass[level] = ARENA_NEW(arena, double, count);
        build->root[level] = ARENA_NEW(arena, double, count);
        build->area[level] = ARENA_NEW(arena, double, octant);
        build->split[level] = ARENA_NEW(arena, bool, count);
        if (level == build->options->level) {
            geodesic_areas(level, build->area[level]);
            fill_leaves(build, integrals);
            continue;
        }
        for (uint32_t i = 0; i < 4 * count; i++) {
            build->mass[level][i / 4] += build->mass[level + 1][i];
            build->root[level][i / 4] += build->root[level + 1][i];
            if (i < 4 * octant) build->area[level][i / 4] += build->area[level + 1][i];
        }
    }
}

/* The square integral of sqrt f minus its mean over the triangle: the part of the variance of
 * sampling weights that constant density leaves, to first order. */
static double split_gain(const Build *build, int level, uint32_t id)
{
    if (level == build->options->level) return 0;
    double root = build->root[level][id];
    return build->mass[level][id] - root * root / area_of(build, level, id);
}

static bool comes_first(Cell a, Cell b)
{
    if (a.error != b.error) return a.error > b.error;
    return a.level != b.level ? a.level < b.level : a.id < b.id;
}

static void heap_push(Build *build, int level, uint32_t id)
{
    Cell cell = {split_gain(build, level, id), level, id};
    int  at = build->heap_count++;
    for (; at > 0 && comes_first(cell, build->heap[(at - 1) / 2]); at = (at - 1) / 2)
        build->heap[at] = build->heap[(at - 1) / 2];
    build->heap[at] = cell;
}

static Cell heap_pop(Build *build)
{
    Cell first = build->heap[0], last = build->heap[--build->heap_count];
    int  at = 0;
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

static void split_cells(Build *build, Arena *arena)
{
    build->heap = ARENA_NEW(arena, Cell, build->options->cells + 4);
    build->cells = build->options->octants;
    for (int q = 0; q < build->options->octants; q++) heap_push(build, 0, (uint32_t)q);
    while (build->cells + 3 <= build->options->cells) {
        Cell cell = heap_pop(build);
        if (!(cell.error > 1e-15))
            return; /* constant inside, to rounding; all masses sum to 1 */
        build->split[cell.level][cell.id] = true;
        build->cells += 3;
        build->nodes++;
        for (uint32_t i = 0; i < 4; i++) heap_push(build, cell.level + 1, 4 * cell.id + i);
    }
}

/* first / (first + second) as a float that is neither 0 nor 1 when both are above 0. */
static float share_of(double first, double second)
{
    if (!(second > 0)) return 1;
    if (!(first > 0)) return 0;
    float share = (float)(first / (first + second));
    return fminf(fmaxf(share, 0x1p-24f), 1 - 0x1p-24f);
}

static SamplingNode node_of(const double mass[4])
{
    return (SamplingNode){.pair = share_of(mass[0] + mass[1], mass[2] + mass[3]),
                          .inside = {share_of(mass[0], mass[1]), share_of(mass[2], mass[3])}};
}

/* The probability of a child under the very floats that sampling compares with. */
static double child_probability(const SamplingNode *node, uint32_t child)
{
    double pair = (double)node->pair, inside = (double)node->inside[child / 2];
    return (child < 2 ? pair : 1 - pair) * (child % 2 == 0 ? inside : 1 - inside);
}

static uint32_t write_triangle(Build *build, int level, uint32_t id, double probability)
{
    if (!build->split[level][id]) {
        build->density[build->next_cell] = (float)(probability / area_of(build, level, id));
        return SAMPLING_CELL | build->next_cell++;
    }
    uint32_t      index = build->next_node++;
    SamplingNode *node = &build->node[index];
    *node = node_of(&build->mass[level + 1][4 * id]);
    for (uint32_t i = 0; i < 4; i++)
        node->child[i] = write_triangle(build, level + 1, 4 * id + i,
                                        probability * child_probability(node, i));
    return index;
}

static void write_octants(Build *build)
{
    uint32_t octants = (uint32_t)build->options->octants;
    double   mass[4];
    for (uint32_t q = 0; q < 4; q++) mass[q] = build->mass[0][q % octants];
    SamplingNode *node = &build->node[build->next_node++];
    *node = node_of(mass);
    for (uint32_t q = 0; q < 4; q++)
        node->child[q] = q < octants ? write_triangle(build, 0, q, child_probability(node, q))
                                     : node->child[q - octants];
}

static SamplingHeader plan_blob(const SamplingOptions *options, uint32_t nodes, uint32_t cells)
{
    size_t nodes_offset = sizeof(SamplingHeader);
    size_t cells_offset = nodes_offset + nodes * sizeof(SamplingNode);
    return (SamplingHeader){.magic = SAMPLING_MAGIC,
                            .version = SAMPLING_VERSION,
                            .size = (cells_offset + cells * sizeof(float) + 7) / 8 * 8,
                            .level = (uint8_t)options->level,
                            .octants = (uint8_t)options->octants,
                            .node_count = nodes,
                            .cell_count = cells,
                            .nodes_offset = (uint32_t)nodes_offset,
                            .cells_offset = (uint32_t)cells_offset};
}

static bool check_options(const SamplingOptions *o, Error *err)
{
    if (o->level < 0 || o->level > GEODESIC_MAX_LEVEL)
        return error_set(err, ERROR_INPUT, "sampling tree level is %d, wanted 0 to %d",
                         o->level, GEODESIC_MAX_LEVEL);
    if (o->octants != 2 && o->octants != 4)
        return error_set(err, ERROR_INPUT, "octants are %d, wanted 2 or 4", o->octants);
    if (o->cells < o->octants || o->cells > (int)geodesic_count(GEODESIC_MAX_LEVEL))
        return error_set(err, ERROR_INPUT, "cells are %d, wanted %d to %u", o->cells,
                         o->octants, geodesic_count(GEODESIC_MAX_LEVEL));
    if (!(o->uniform_share >= 0 && o->uniform_share <= 1))
        return error_set(err, ERROR_INPUT, "uniform share is %g, wanted 0 to 1",
                         (double)o->uniform_share);
    return true;
}

static bool check_integrals(const SamplingOptions *options, const float *integrals, Error *err)
{
    uint32_t count = (uint32_t)options->octants << 2 * options->level;
    double   sum = 0;
    for (uint32_t i = 0; i < count; i++) {
        if (!(integrals[i] >= 0 && isfinite(integrals[i])))
            return error_set(err, ERROR_INPUT,
                             "the integral over leaf %u is %g, wanted a finite "
                             "value of at least 0",
                             i, (double)integrals[i]);
        sum += (double)integrals[i];
    }
    if (!(sum > 0))
        return error_set(err, ERROR_INPUT, "a function that is 0 cannot be sampled");
    return true;
}

/* The blob is written behind the scratch, then moved to where the scratch began. */
bool sampling_tree_build(const SamplingOptions *options, const float *integrals, Arena *arena,
                         const void **blob, Error *err)
{
    if (!check_options(options, err) || !check_integrals(options, integrals, err)) return false;
    Arena scratch = *arena;
    Build build = {.options = options, .nodes = 1};
    fill_pyramid(&build, integrals, &scratch);
    split_cells(&build, &scratch);
    SamplingHeader header = plan_blob(options, (uint32_t)build.nodes, (uint32_t)build.cells);
    char          *made = arena_alloc(&scratch, 1, 16, header.size);
    memcpy(made, &header, sizeof header);
    build.node = (SamplingNode *)(void *)(made + header.nodes_offset);
    build.density = (float *)(void *)(made + header.cells_offset);
    write_octants(&build);
    char *final = arena->next + (size_t)(-(uintptr_t)arena->next & 15);
    memmove(final, made, header.size);
    arena->next = final + header.size;
    *blob = final;
    return true;
}

size_t sampling_tree_size(const void *blob)
{
    return ((const SamplingHeader *)blob)->size;
}

/* ---- open -------------------------------------------------------------------------------- */

static bool refuse(Error *err, const char *what, double found, double wanted)
{
    return error_set(err, ERROR_INPUT, "sampling tree: %s is %.9g, wanted %.9g", what, found,
                     wanted);
}

static bool check_header(const SamplingHeader *h, size_t size, Error *err)
{
    if (h->magic != SAMPLING_MAGIC)
        return refuse(err, "magic number", h->magic, SAMPLING_MAGIC);
    if (h->version != SAMPLING_VERSION)
        return refuse(err, "version", h->version, SAMPLING_VERSION);
    if (h->level > GEODESIC_MAX_LEVEL)
        return refuse(err, "level", h->level, GEODESIC_MAX_LEVEL);
    if (h->octants != 2 && h->octants != 4) return refuse(err, "octant count", h->octants, 4);
    uint64_t most = 2ull * geodesic_count(GEODESIC_MAX_LEVEL);
    if (h->node_count < 1 || h->node_count > most)
        return refuse(err, "node count", h->node_count, 1);
    if (h->cell_count < 1 || h->cell_count > most)
        return refuse(err, "cell count", h->cell_count, 1);
    SamplingOptions options = {.level = h->level, .octants = h->octants};
    SamplingHeader  wanted = plan_blob(&options, h->node_count, h->cell_count);
    if (memcmp(h, &wanted, sizeof wanted) != 0)
        return error_set(err, ERROR_INPUT, "sampling tree: size or offsets do not fit %u nodes "
                         "and %u cells", h->node_count, h->cell_count);
    if (h->size > size) return refuse(err, "number of bytes", (double)size, (double)h->size);
    return true;
}

/* What a walk in depth expects to meet next. */
typedef struct Check {
    const SamplingTree *tree;
    uint32_t            next_node, next_cell;
    Error              *err;
} Check;

static bool check_probabilities(const Check *check, const SamplingNode *node, uint32_t index)
{
    const float p[3] = {node->pair, node->inside[0], node->inside[1]};
    for (int i = 0; i < 3; i++)
        if (!(p[i] >= 0 && p[i] <= 1))
            return error_set(check->err, ERROR_INPUT, "sampling tree: a probability of node %u "
                             "is %g, wanted 0 to 1", index, (double)p[i]);
    return true;
}

static bool check_cell(Check *check, uint32_t cell, int level, uint32_t place,
                       double probability)
{
    if (cell != check->next_cell || cell >= check->tree->cell_count)
        return refuse(check->err, "cell index", cell, check->next_cell);
    double density = (double)check->tree->density[check->next_cell++];
    double wanted = probability / (double)check->tree->geodesic->areas[level][place];
    if (!(fabs(density - wanted) <= 1e-5 * wanted))
        return refuse(check->err, "density of a cell", density, wanted);
    return true;
}

static bool check_triangle(Check *check, uint32_t at, int level, uint32_t place,
                           double probability)
{
    const SamplingTree *tree = check->tree;
    if (at & SAMPLING_CELL)
        return check_cell(check, at & ~SAMPLING_CELL, level, place, probability);
    if (at != check->next_node || at >= tree->node_count)
        return refuse(check->err, "node index", at, check->next_node);
    if (level >= tree->level)
        return refuse(check->err, "depth", level + 1, tree->level);
    check->next_node++;
    const SamplingNode *node = &tree->nodes[at];
    if (!check_probabilities(check, node, at)) return false;
    for (uint32_t i = 0; i < 4; i++)
        if (!check_triangle(check, node->child[i], level + 1, 4 * place + i,
                            probability * child_probability(node, i)))
            return false;
    return true;
}

static bool check_tree(const SamplingTree *tree, Error *err)
{
    Check               check = {.tree = tree, .next_node = 1, .err = err};
    const SamplingNode *node = &tree->nodes[0];
    if (!check_probabilities(&check, node, 0)) return false;
    for (uint32_t q = 0; q < 4; q++) {
        uint32_t stored = q % (uint32_t)tree->octants;
        double   probability = child_probability(node, q);
        if (q == stored && !check_triangle(&check, node->child[q], 0, 0, probability))
            return false;
        if (node->child[q] != node->child[stored] ||
            probability != child_probability(node, stored))
            return error_set(err, ERROR_INPUT,
                             "sampling tree: octant %u differs from its mirror "
                             "image %u",
                             q, stored);
    }
    if (check.next_node != tree->node_count)
        return refuse(err, "node count", tree->node_count, check.next_node);
    if (check.next_cell != tree->cell_count)
        return refuse(err, "cell count", tree->cell_count, check.next_cell);
    return true;
}

bool sampling_tree_open(const void *blob, size_t size, const Geodesic *geodesic,
                        SamplingTree *out, Error *err)
{
    if ((uintptr_t)blob % 8 != 0)
        return error_set(err, ERROR_INPUT, "sampling tree: stands at an address that is no "
                         "multiple of 8");
    if (size < sizeof(SamplingHeader))
        return refuse(err, "number of bytes", (double)size, sizeof(SamplingHeader));
    const SamplingHeader *h = blob;
    const char           *bytes = blob;
    if (!check_header(h, size, err)) return false;
    if (geodesic->level < h->level)
        return refuse(err, "level of the geodesic", geodesic->level, h->level);
    SamplingTree tree = {.geodesic = geodesic,
                         .nodes = (const SamplingNode *)(const void *)(bytes + h->nodes_offset),
                         .density = (const float *)(const void *)(bytes + h->cells_offset),
                         .level = h->level,
                         .octants = h->octants,
                         .node_count = h->node_count,
                         .cell_count = h->cell_count};
    if (!check_tree(&tree, err)) return false;
    *out = tree;
    return true;
}
