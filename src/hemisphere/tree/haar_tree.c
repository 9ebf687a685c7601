/* SPDX-License-Identifier: Apache-2.0 */
#include "hemisphere/tree/haar_tree.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* A detail row that may stay. */
typedef struct HaarDetail {
    float size;     /* sqrt of the sum over components of (component_scale * d)^2 */
    float worth;    /* that times the norm of its place: the error that its absence leaves */
    uint32_t place; /* leaf place, haar.h's layout */
} HaarDetail;

typedef struct Choice {
    const HaarTreeOptions *options;
    const float *source;
    float *coefficients;    /* haar_forward of the source */
    HaarDetail *candidates; /* by worth; the first kept_count stay */
    uint32_t candidate_count, kept_count, leaf_count;
    float *scales;  /* level x components */
    int byte_level; /* rows of fathers from this level on have 8 bits; 0: none */
    bool *kept;     /* per place */
    bool *alive[GEODESIC_MAX_LEVEL + 1]; /* triangles with a kept detail below */
} Choice;

/* ---- which details stay, and how precisely ----------------------------------------------- */

/* The child of a detail is as many levels above the leaves as its place has trailing zero
 * digits. Octant means have no father: -1. */
static int father_level(const HaarShape *shape, uint32_t place) {
    uint32_t in_octant = place & ((1u << 2 * shape->level) - 1);
    return in_octant == 0 ? -1 : shape->level - 1 - __builtin_ctz(in_octant) / 2;
}

static const float *row_at(const Choice *choice, uint32_t place) {
    return choice->coefficients + place * (size_t)choice->options->shape.components;
}

static float worth_of(const Choice *choice, int component) {
    const float *scale = choice->options->component_scale;
    return scale ? scale[component] : 1;
}

static int by_worth(const void *a, const void *b) {
    const HaarDetail *x = a, *y = b;
    if (x->worth != y->worth) return x->worth > y->worth ? -1 : 1;
    return (x->place > y->place) - (x->place < y->place);
}

static void list_candidates(Choice *choice, Arena *arena) {
    const HaarShape *shape = &choice->options->shape;
    float *norms = ARENA_NEW(arena, float, choice->leaf_count);
    haar_norms(shape, norms, *arena);
    choice->candidates = ARENA_NEW(arena, HaarDetail, choice->leaf_count);
    for (uint32_t place = 0; place < choice->leaf_count; place++) {
        double sum = 0;
        for (int c = 0; c < shape->components; c++) {
            double d = (double)(row_at(choice, place)[c] * worth_of(choice, c));
            sum += d * d;
        }
        if (father_level(shape, place) < 0 || !(sum > 0)) continue;
        float size = (float)sqrt(sum);
        choice->candidates[choice->candidate_count++] =
            (HaarDetail){size, size * norms[place], place};
    }
    qsort(choice->candidates, choice->candidate_count, sizeof(HaarDetail), by_worth);
}

static void keep_best(Choice *choice, Arena *arena) {
    double stored = floor((double)choice->options->keep_share * choice->leaf_count + 0.5);
    double details = fmax(stored - choice->options->shape.octants, 0);
    choice->kept_count = (uint32_t)fmin(details, choice->candidate_count);
    choice->kept = ARENA_NEW(arena, bool, choice->leaf_count);
    for (uint32_t i = 0; i < choice->kept_count; i++)
        choice->kept[choice->candidates[i].place] = true;
}

/* May the level's details be rounded to 8 bits? By no more than 1/16 of the largest detail
 * that is left out. */
static bool bytes_suffice(const Choice *choice, int level) {
    int components = choice->options->shape.components;
    float limit = 0;
    for (uint32_t i = choice->kept_count; i < choice->candidate_count; i++)
        limit = fmaxf(limit, choice->candidates[i].size / 16);
    for (int c = 0; c < components; c++)
        if (worth_of(choice, c) * choice->scales[level * components + c] * (0.5f / 127) > limit)
            return false;
    return true;
}

/* The largest kept detail of a level and component is 32767 steps, or 127 on the finest levels,
 * as far up as that suffices. Level 0 always has 16 bits. */
static void choose_scales(Choice *choice, Arena *arena) {
    const HaarShape *shape = &choice->options->shape;
    int bytes_from = shape->level;
    choice->scales = ARENA_NEW(arena, float, shape->level * shape->components);
    for (uint32_t i = 0; i < choice->kept_count; i++) {
        uint32_t place = choice->candidates[i].place;
        float *scale = choice->scales + father_level(shape, place) * shape->components;
        for (int c = 0; c < shape->components; c++)
            scale[c] = fmaxf(scale[c], fabsf(row_at(choice, place)[c]));
    }
    while (bytes_from > 1 && bytes_suffice(choice, bytes_from - 1)) bytes_from--;
    if (bytes_from < shape->level) choice->byte_level = bytes_from;
    for (int i = 0; i < shape->level * shape->components; i++)
        choice->scales[i] /= i / shape->components >= bytes_from ? 127 : 32767;
}

static int quantised(float value, float scale) {
    return scale > 0 ? (int)lrintf(value / scale) : 0;
}

static void find_alive(Choice *choice, Arena *arena) {
    const HaarShape *shape = &choice->options->shape;
    for (int level = shape->level; level >= 0; level--) {
        uint32_t count = (uint32_t)shape->octants << 2 * level;
        bool *here = choice->alive[level] = ARENA_NEW(arena, bool, count);
        int shift = 2 * (shape->level - level - 1); /* of a child's place */
        for (uint32_t n = 0; n < count; n++) {
            here[n] = level == 0; /* octants always have a node */
            for (uint32_t i = 0; i < 4 && level < shape->level; i++)
                here[n] |= (i > 0 && choice->kept[(4 * n + i) << shift]) ||
                           choice->alive[level + 1][4 * n + i];
        }
    }
}

/* ---- the blob ---------------------------------------------------------------------------- */

static size_t number_bytes(const Choice *choice, int level) {
    if (choice->options->rows == TREE_ROWS_FLOAT) return 4;
    return choice->byte_level > 0 && level >= choice->byte_level ? 1 : 2;
}

static TreeHeader plan_blob(const Choice *choice) {
    const HaarShape *shape = &choice->options->shape;
    bool is_float = choice->options->rows == TREE_ROWS_FLOAT;
    size_t row = sizeof(float) * (size_t)shape->components, bytes = 0;
    uint32_t nodes = 0;
    for (int level = 0; level <= shape->level; level++)
        for (uint32_t n = 0; n < (uint32_t)shape->octants << 2 * level; n++)
            nodes += choice->alive[level][n];
    for (uint32_t i = 0; i < choice->kept_count; i++)
        bytes += number_bytes(choice, father_level(shape, choice->candidates[i].place)) *
                 (size_t)shape->components;
    size_t scales = sizeof(TreeHeader) + (size_t)shape->octants * row;
    size_t node_start = (scales + (is_float ? 0 : (size_t)shape->level * row) + 7) / 8 * 8;
    size_t row_start = node_start + nodes * sizeof(TreeNode);
    return (TreeHeader){.magic = TREE_MAGIC,
                        .version = TREE_VERSION,
                        .size = (row_start + bytes + 7) / 8 * 8,
                        .level = (uint8_t)shape->level,
                        .octants = (uint8_t)shape->octants,
                        .weights = (uint8_t)shape->weights,
                        .rows = (uint8_t)choice->options->rows,
                        .components = (uint32_t)shape->components,
                        .node_count = nodes,
                        .row_count = choice->kept_count,
                        .means_offset = (uint32_t)sizeof(TreeHeader),
                        .scales_offset = (uint32_t)scales,
                        .nodes_offset = (uint32_t)node_start,
                        .byte_level = is_float ? 0 : (uint32_t)choice->byte_level,
                        .rows_offset = row_start};
}

/* Returns where the next row goes. */
static char *write_row(const Choice *choice, char *to, uint32_t place) {
    const HaarShape *shape = &choice->options->shape;
    int level = father_level(shape, place);
    size_t bytes = number_bytes(choice, level);
    const float *from = row_at(choice, place);
    const float *scale = choice->scales + level * shape->components;
    for (int c = 0; c < shape->components; c++, to += bytes) {
        int16_t wide = (int16_t)quantised(from[c], scale[c]);
        int8_t narrow = (int8_t)wide;
        memcpy(to,
               bytes == 4   ? (const void *)&from[c]
               : bytes == 2 ? (const void *)&wide
                            : (const void *)&narrow,
               bytes);
    }
    return to;
}

/* Nodes level by level; children of one node follow each other, as do rows. */
static void write_nodes(const Choice *choice, char *blob, const TreeHeader *header) {
    TreeNode *node = (TreeNode *)(void *)(blob + header->nodes_offset);
    uint32_t next_node = header->octants, next_row = 0;
    char *rows = blob + header->rows_offset;
    for (int level = 0; level <= header->level; level++)
        for (uint32_t n = 0; n < (uint32_t)header->octants << 2 * level; n++) {
            if (!choice->alive[level][n]) continue;
            *node = (TreeNode){next_node << 4, next_row << 3};
            for (uint32_t i = 0; i < 4 && level < header->level; i++) {
                uint32_t place = (4 * n + i) << 2 * (header->level - level - 1);
                if (choice->alive[level + 1][4 * n + i]) node->children |= 1u << i, next_node++;
                if (i == 0 || !choice->kept[place]) continue;
                node->rows |= 1u << (i - 1);
                next_row++;
                rows = write_row(choice, rows, place);
            }
            node++;
        }
}

static char *write_blob(const Choice *choice, Arena *arena) {
    TreeHeader header = plan_blob(choice);
    size_t row = sizeof(float) * header.components;
    char *blob = arena_alloc(arena, 1, 16, header.size);
    memcpy(blob, &header, sizeof header);
    for (uint32_t q = 0; q < header.octants; q++)
        memcpy(blob + header.means_offset + q * row, row_at(choice, q << 2 * header.level), row);
    if (header.rows != TREE_ROWS_FLOAT)
        memcpy(blob + header.scales_offset, choice->scales, header.level * row);
    write_nodes(choice, blob, &header);
    return blob;
}

/* ---- errors ------------------------------------------------------------------------------ */

/* The leaves that means and kept rows give back. */
static const float *reconstructed(const Choice *choice, Arena *arena) {
    const HaarShape *shape = &choice->options->shape;
    size_t n = (size_t)shape->components;
    float *leaves = ARENA_NEW(arena, float, choice->leaf_count *n);
    for (uint32_t place = 0; place < choice->leaf_count; place++) {
        int level = father_level(shape, place);
        const float *from = row_at(choice, place);
        if (level >= 0 && !choice->kept[place]) continue;
        for (size_t c = 0; c < n; c++) {
            float scale = level < 0 ? 0 : choice->scales[(size_t)level * n + c];
            leaves[place * n + c] = level < 0 || choice->options->rows == TREE_ROWS_FLOAT
                                        ? from[c]
                                        : scale * (float)quantised(from[c], scale);
        }
    }
    haar_inverse(shape, leaves, *arena);
    return leaves;
}

static TreeReport report_of(const Choice *choice, const TreeHeader *header, Arena scratch) {
    const HaarShape *shape = &choice->options->shape;
    size_t n = (size_t)shape->components;
    double *areas = ARENA_NEW(&scratch, double, (size_t)1 << 2 * shape->level);
    const float *leaves = reconstructed(choice, &scratch);
    double max = 0, error = 0, area = 0;
    geodesic_areas(shape->level, areas);
    for (size_t i = 0; i < choice->leaf_count * n; i++) {
        double weight = areas[i / n & ((1u << 2 * shape->level) - 1)];
        double scale = (double)worth_of(choice, (int)(i % n));
        double s = scale * (double)choice->source[i], e = scale * (double)leaves[i] - s;
        max = fmax(max, fabs(e));
        error += weight * e * e;
        area += weight;
    }
    return (TreeReport){.leaves = choice->leaf_count,
                        .stored_rows = header->row_count + header->octants,
                        .stored_values = (header->row_count + header->octants) * n,
                        .nodes = header->node_count,
                        .bytes = header->size,
                        .max_error = (float)max,
                        .rms_error = (float)sqrt(error / area)};
}

/* ---- build ------------------------------------------------------------------------------- */

static bool check_options(const HaarTreeOptions *options, const float *leaves, Error *err) {
    const HaarShape *shape = &options->shape;
    if (shape->level < 0 || shape->level > GEODESIC_MAX_LEVEL)
        return error_set(err, ERROR_INPUT, "tree level is %d, required: 0 to %d", shape->level,
                         GEODESIC_MAX_LEVEL);
    if (shape->octants != 2 && shape->octants != 4)
        return error_set(err, ERROR_INPUT, "octants are %d, required: 2 or 4", shape->octants);
    if (shape->components < 1 || shape->components > TREE_MAX_COMPONENTS)
        return error_set(err, ERROR_INPUT, "components are %d, required: 1 to %d",
                         shape->components, TREE_MAX_COMPONENTS);
    if (!(options->keep_share > 0 && options->keep_share <= 1))
        return error_set(err, ERROR_INPUT, "keep share is %g, required: above 0 to 1",
                         (double)options->keep_share);
    size_t count = (size_t)haar_leaf_count(shape) * (size_t)shape->components;
    for (size_t i = 0; i < count; i++)
        if (!isfinite(leaves[i]))
            return error_set(err, ERROR_INPUT,
                             "leaf %zu, component %zu is %g, required: a "
                             "finite value",
                             i / (size_t)shape->components, i % (size_t)shape->components,
                             (double)leaves[i]);
    return true;
}

/* The blob is written behind the scratch, then moved to where the scratch began. */
bool haar_tree_build(const HaarTreeOptions *options, const float *leaves, Arena *arena,
                     const void **blob, TreeReport *report, Error *err) {
    if (!check_options(options, leaves, err)) return false;
    Arena scratch = *arena;
    Choice choice = {
        .options = options, .source = leaves, .leaf_count = haar_leaf_count(&options->shape)};
    size_t values = choice.leaf_count * (size_t)options->shape.components;
    choice.coefficients = ARENA_NEW(&scratch, float, values);
    memcpy(choice.coefficients, leaves, values * sizeof(float));
    haar_forward(&options->shape, choice.coefficients, scratch);
    list_candidates(&choice, &scratch);
    keep_best(&choice, &scratch);
    choose_scales(&choice, &scratch);
    find_alive(&choice, &scratch);
    const char *made = write_blob(&choice, &scratch);
    const TreeHeader *header = (const TreeHeader *)(const void *)made;
    if (report) *report = report_of(&choice, header, scratch);
    *blob = arena_keep(arena, made, header->size, 16);
    return true;
}
