/* SPDX-License-Identifier: Apache-2.0 */
#include "hemisphere/sampling/sampling_tree_open.h"

#include <string.h>

#include "hemisphere/sampling/sampling_code.h"

#define CHOICES_MAX (1u << 22) /* of all functions: what an opened tree may expand to */

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
    if (h->functions < 1 || h->functions > SAMPLING_FUNCTIONS_MAX)
        return refuse(err, "number of functions", h->functions, SAMPLING_FUNCTIONS_MAX);
    uint32_t most = (SAMPLING_CELLS_MAX - h->octants) / 3u;
    if (h->splits > most) return refuse(err, "number of splits", h->splits, most);
    if ((h->splits + 1u) * h->functions > CHOICES_MAX)
        return error_set(err, ERROR_INPUT, "sampling tree: %u splits for %u functions are more "
                         "than can be used", h->splits, h->functions);
    if (h->reserved) return refuse(err, "a reserved byte", h->reserved, 0);
    if (h->size < sizeof *h || h->size > size)
        return refuse(err, "number of bytes", (double)size, (double)h->size);
    return true;
}

/* State of the depth-first walk that expands the structure. */
typedef struct Expand {
    const SamplingHeader *header;
    const Geodesic       *geodesic;
    SamplingBits          bits;
    SamplingNode         *nodes;
    GeodesicSampler      *cells;
    uint32_t             *cell_level, *cell_place;
    uint32_t              next_node, next_cell;
    Error                *err;
} Expand;

static bool get_flags(Expand *expand, int count, bool *flags)
{
    uint32_t bits;
    if (!sampling_get(&expand->bits, count, &bits))
        return error_set(expand->err, ERROR_INPUT, "sampling tree: ends inside its structure");
    for (int i = 0; i < count; i++) flags[i] = bits >> i & 1;
    return true;
}

static void expand_cell(Expand *expand, int level, uint32_t id, uint32_t *child)
{
    uint32_t         place = id & ((1u << 2 * level) - 1), cell = expand->next_cell++;
    GeodesicTriangle triangle = geodesic_triangle(level, id);
    expand->cells[cell] = geodesic_sampler(&triangle, expand->geodesic->areas[level][place]);
    expand->cell_level[cell] = (uint32_t)level;
    expand->cell_place[cell] = place;
    *child = SAMPLING_CELL | cell;
}

static bool expand_triangle(Expand *expand, int level, uint32_t id, bool is_split,
                            uint32_t *child)
{
    bool flags[4];
    if (!is_split) {
        expand_cell(expand, level, id, child);
        return true;
    }
    if (level >= expand->header->level)
        return refuse(expand->err, "depth", level + 1, expand->header->level);
    if (expand->next_node > expand->header->splits)
        return refuse(expand->err, "number of splits", expand->next_node,
                      expand->header->splits);
    uint32_t node = *child = expand->next_node++;
    if (!get_flags(expand, 4, flags)) return false;
    for (uint32_t i = 0; i < 4; i++)
        if (!expand_triangle(expand, level + 1, 4 * id + i, flags[i],
                             &expand->nodes[node].child[i]))
            return false;
    return true;
}

static bool expand_structure(Expand *expand)
{
    bool     flags[4];
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

/* ---- probabilities ----------------------------------------------------------------------- */

static bool get_step(SamplingBits *bits, uint32_t k, uint8_t *step)
{
    uint32_t n;
    if (!sampling_get_rice(bits, (int)k, &n)) return false;
    int value = *step + (n & 1 ? -(int)(n / 2) - 1 : (int)(n / 2));
    if (value < 0 || value > SAMPLING_STEPS) return false;
    *step = (uint8_t)value;
    return true;
}

/* steps: those of the function before, which this one's replace. */
static bool get_function(Expand *expand, uint8_t *steps, SamplingChoice *choices)
{
    const SamplingHeader *h = expand->header;
    uint32_t k;
    bool     is_there = sampling_get(&expand->bits, SAMPLING_RICE_BITS, &k);
    for (uint32_t node = 0; is_there && node <= h->splits; node++) {
        uint8_t *step = steps + 3 * node;
        for (uint32_t i = 0; is_there && i < sampling_steps_of(h->octants, node); i++)
            is_there = get_step(&expand->bits, k, &step[i]);
        choices[node] = sampling_choice(h->octants, node, step);
    }
    return is_there || error_set(expand->err, ERROR_INPUT, "sampling tree: a probability is "
                                 "missing or out of range");
}

static void fill_density(const SamplingTree *tree, const Expand *expand, int function,
                         const SamplingNode *node, double probability, float *density)
{
    const SamplingChoice *choice = tree->choices + (size_t)function * tree->node_count +
                                   (node - tree->nodes);
    uint32_t children = node == tree->nodes ? (uint32_t)tree->octants : 4;
    for (uint32_t i = 0; i < children; i++) {
        uint32_t child = node->child[i];
        double   part = probability * sampling_child_probability(choice, i);
        if (!(child & SAMPLING_CELL)) {
            fill_density(tree, expand, function, &tree->nodes[child], part, density);
            continue;
        }
        child &= ~SAMPLING_CELL;
        double area = (double)
            tree->geodesic->areas[expand->cell_level[child]][expand->cell_place[child]];
        density[(size_t)child * (size_t)tree->functions + (size_t)function] =
            (float)(part / area);
    }
}

static bool expand_functions(Expand *expand, SamplingTree *tree, Arena *arena)
{
    size_t nodes = tree->node_count, functions = (size_t)tree->functions;
    SamplingChoice *choices = ARENA_NEW(arena, SamplingChoice, functions * nodes);
    float   *density = ARENA_NEW(arena, float, tree->cell_count * functions);
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
                        SamplingTree *out, Error *err)
{
    SamplingHeader header;
    if (size < sizeof header)
        return refuse(err, "number of bytes", (double)size, sizeof header);
    memcpy(&header, blob, sizeof header);
    if (!check_header(&header, size, err)) return false;
    if (geodesic->level < header.level)
        return refuse(err, "level of the geodesic", geodesic->level, header.level);
    uint32_t nodes = header.splits + 1u, cells = header.octants + 3u * header.splits;
    Expand   expand = {
          .header = &header, .geodesic = geodesic, .err = err,
          .bits = {(uint8_t *)(uintptr_t)blob, 8 * sizeof header, 8 * (size_t)header.size},
          .nodes = ARENA_NEW(arena, SamplingNode, nodes),
          .cells = ARENA_NEW(arena, GeodesicSampler, cells),
          .cell_level = ARENA_NEW(arena, uint32_t, cells),
          .cell_place = ARENA_NEW(arena, uint32_t, cells)};
    if (!expand_structure(&expand)) return false;
    SamplingTree tree = {.geodesic = geodesic, .nodes = expand.nodes, .cells = expand.cells,
                         .level = header.level, .octants = header.octants,
                         .functions = header.functions, .node_count = nodes,
                         .cell_count = cells};
    if (!expand_functions(&expand, &tree, arena)) return false;
    *out = tree;
    return true;
}
