/* SPDX-License-Identifier: Apache-2.0 */
#include "hemisphere/tree/tree_build.h"

#include "hemisphere/tree.h"
#include "hemisphere/tree/tree_choose.h"

#include <math.h>
#include <string.h>

/* alive[level][node]: the triangle has a kept detail at or below it. */
typedef struct Alive {
    bool *level[GEODESIC_MAX_LEVEL + 1];
} Alive;

static uint32_t child_place(int tree_level, int level, uint32_t node, uint32_t child)
{
    return (4 * node + child) << 2 * (tree_level - level - 1);
}

static Alive find_alive(const TreeChoice *choice, Arena *arena)
{
    const HaarShape *shape = &choice->options->shape;
    Alive            alive = {{0}};
    for (int level = shape->level; level >= 0; level--) {
        uint32_t count = (uint32_t)shape->octants << 2 * level;
        bool    *here = alive.level[level] = ARENA_NEW(arena, bool, count);
        for (uint32_t n = 0; n < count; n++) {
            here[n] = level == 0; /* octants always have a node */
            for (uint32_t i = 0; i < 4 && level < shape->level; i++) {
                bool row = i > 0 && choice->kept[child_place(shape->level, level, n, i)];
                if (row || alive.level[level + 1][4 * n + i]) here[n] = true;
            }
        }
    }
    return alive;
}

static size_t align_up(size_t bytes, size_t to)
{
    return (bytes + to - 1) / to * to;
}

static size_t number_bytes(const TreeChoice *choice, int level)
{
    if (choice->options->rows == TREE_ROWS_FLOAT) return 4;
    return choice->byte_level > 0 && level >= choice->byte_level ? 1 : 2;
}

/* Numbers that are stored of a block: with TREE_ROWS_BLOCKS also the padding of the last. */
static size_t block_numbers(const TreeChoice *choice)
{
    return choice->options->rows == TREE_ROWS_BLOCKS
               ? TREE_BLOCK
               : (size_t)choice->options->shape.components;
}

static size_t rows_bytes(const TreeChoice *choice)
{
    size_t bytes = 0;
    for (uint32_t i = 0; i < choice->kept_count; i++) {
        int level = tree_father_level(&choice->options->shape, choice->candidates[i].place);
        bytes += number_bytes(choice, level) * block_numbers(choice);
    }
    return bytes;
}

static TreeHeader plan_blob(const TreeChoice *choice, uint32_t nodes, uint32_t rows)
{
    const HaarShape *shape = &choice->options->shape;
    TreeRowFormat    format = choice->options->rows;
    size_t           stride = (size_t)tree_stride(format, shape->components);
    size_t           means = sizeof(TreeHeader);
    size_t           scales = means + sizeof(float) * (size_t)shape->octants * stride;
    size_t scale_bytes = format == TREE_ROWS_FLOAT ? 0 : 4 * (size_t)shape->level * stride;
    size_t node_start = align_up(scales + scale_bytes, 8);
    size_t row_start = node_start + nodes * sizeof(TreeNode);
    if (format == TREE_ROWS_BLOCKS) row_start += rows * sizeof(TreeRow);
    return (TreeHeader){
        .magic = TREE_MAGIC,
        .version = TREE_VERSION,
        .size = align_up(row_start + rows_bytes(choice), 8),
        .level = (uint8_t)shape->level,
        .octants = (uint8_t)shape->octants,
        .weights = (uint8_t)shape->weights,
        .rows = (uint8_t)format,
        .components = (uint32_t)shape->components,
        .node_count = nodes,
        .row_count = rows,
        .means_offset = (uint32_t)means,
        .scales_offset = (uint32_t)scales,
        .nodes_offset = (uint32_t)node_start,
        .byte_level = format == TREE_ROWS_FLOAT ? 0 : (uint32_t)choice->byte_level,
        .rows_offset = row_start};
}

/* Writes a block of a row and returns where the next one goes. */
static char *write_block(const TreeChoice *choice, char *to, uint32_t place, uint32_t block)
{
    const HaarShape *shape = &choice->options->shape;
    const float     *from = choice->coefficients + place * (size_t)shape->components;
    int              level = tree_father_level(shape, place), first = tree_block_first(block);
    size_t           bytes = number_bytes(choice, level);
    const float     *scale = choice->scales + level * shape->components;
    for (int c = first; c < first + tree_block_count(choice, block); c++) {
        char   *at = to + (size_t)(c - first) * bytes;
        int16_t wide = (int16_t)tree_quantised(from[c], scale[c]);
        int8_t  narrow = (int8_t)wide;
        if (bytes == 4) memcpy(at, &from[c], bytes);
        if (bytes == 2) memcpy(at, &wide, bytes);
        if (bytes == 1) memcpy(at, &narrow, bytes);
    }
    return to + bytes * block_numbers(choice);
}

/* Where the next row goes. */
typedef struct RowWriter {
    char     *to, *rows;
    TreeRow  *table; /* blocks only */
    uint32_t  count;
} RowWriter;

static void write_row(const TreeChoice *choice, RowWriter *writer, uint32_t place)
{
    TreeRow row = {choice->kept[place], (uint32_t)(writer->to - writer->rows)};
    if (choice->options->rows == TREE_ROWS_BLOCKS) writer->table[writer->count] = row;
    writer->count++;
    for (uint32_t rest = choice->kept[place]; rest; rest &= rest - 1)
        writer->to = write_block(choice, writer->to, place, (uint32_t)__builtin_ctz(rest));
}

/* Nodes level by level; children of one node follow each other, as do rows. */
static void write_nodes(const TreeChoice *choice, char *blob, const TreeHeader *header,
                        const Alive *alive)
{
    TreeNode *node = (TreeNode *)(void *)(blob + header->nodes_offset);
    uint32_t  next_node = header->octants;
    char     *rows = blob + header->rows_offset;
    RowWriter writer = {rows, rows,
                        (TreeRow *)(void *)(rows - header->row_count * sizeof(TreeRow)), 0};
    for (int level = 0; level <= header->level; level++)
        for (uint32_t n = 0; n < (uint32_t)header->octants << 2 * level; n++) {
            if (!alive->level[level][n]) continue;
            *node = (TreeNode){next_node << 4, writer.count << 3};
            for (uint32_t i = 0; i < 4 && level < header->level; i++) {
                uint32_t place = child_place(header->level, level, n, i);
                if (alive->level[level + 1][4 * n + i]) node->children |= 1u << i, next_node++;
                if (i == 0 || !choice->kept[place]) continue;
                node->rows |= 1u << (i - 1);
                write_row(choice, &writer, place);
            }
            node++;
        }
}

/* Octant means, and scales, with their padding. */
static void write_tables(const TreeChoice *choice, char *blob, const TreeHeader *header)
{
    const HaarShape *shape = &choice->options->shape;
    size_t components = header->components, bytes = sizeof(float) * components;
    size_t stride =
        sizeof(float) * (size_t)tree_stride(choice->options->rows, shape->components);
    for (size_t q = 0; q < header->octants; q++)
        memcpy(blob + header->means_offset + q * stride,
               choice->coefficients + (q << 2 * shape->level) * components, bytes);
    for (size_t i = 0; header->rows != TREE_ROWS_FLOAT && i < header->level; i++)
        memcpy(blob + header->scales_offset + i * stride, choice->scales + i * components,
               bytes);
}

static char *write_blob(const TreeChoice *choice, Arena *arena)
{
    const HaarShape *shape = &choice->options->shape;
    Alive            alive = find_alive(choice, arena);
    uint32_t         nodes = 0, rows = 0;
    for (int level = 0; level <= shape->level; level++)
        for (uint32_t n = 0; n < (uint32_t)shape->octants << 2 * level; n++)
            nodes += alive.level[level][n];
    for (uint32_t place = 0; place < choice->leaf_count; place++)
        rows += choice->kept[place] != 0;
    TreeHeader header = plan_blob(choice, nodes, rows);
    char      *blob = arena_alloc(arena, 1, 16, header.size);
    memcpy(blob, &header, sizeof header);
    write_tables(choice, blob, &header);
    write_nodes(choice, blob, &header, &alive);
    return blob;
}

static bool check_options(const TreeOptions *options, const float *leaves, Error *err)
{
    const HaarShape *shape = &options->shape;
    if (shape->level < 0 || shape->level > GEODESIC_MAX_LEVEL)
        return error_set(err, ERROR_INPUT, "tree level is %d, wanted 0 to %d", shape->level,
                         GEODESIC_MAX_LEVEL);
    if (shape->octants != 2 && shape->octants != 4)
        return error_set(err, ERROR_INPUT, "octants are %d, wanted 2 or 4", shape->octants);
    if (shape->components < 1 || shape->components > TREE_MAX_COMPONENTS)
        return error_set(err, ERROR_INPUT, "components are %d, wanted 1 to %d",
                         shape->components, TREE_MAX_COMPONENTS);
    if (options->rows != TREE_ROWS_FLOAT && options->rows != TREE_ROWS_INT16 &&
        options->rows != TREE_ROWS_BLOCKS)
        return error_set(err, ERROR_INPUT, "row format is %d, wanted 0 to 2", options->rows);
    if ((options->keep_share > 0) == (options->max_error > 0) || options->keep_share > 1)
        return error_set(err, ERROR_INPUT, "keep share is %g and error bound %g, wanted one of "
                         "them above 0 and the share at most 1", (double)options->keep_share,
                         (double)options->max_error);
    size_t count = (size_t)haar_leaf_count(shape) * (size_t)shape->components;
    for (size_t i = 0; i < count; i++)
        if (!isfinite(leaves[i]))
            return error_set(err, ERROR_INPUT, "leaf %zu, component %zu is %g, wanted a finite "
                             "value", i / (size_t)shape->components,
                             i % (size_t)shape->components, (double)leaves[i]);
    return true;
}

static TreeReport report_of(const TreeChoice *choice, const TreeHeader *header)
{
    TreeDeviation error = tree_deviation(choice);
    size_t        means = (size_t)header->octants * header->components;
    return (TreeReport){
        .leaves = choice->leaf_count,
        .stored_rows = header->row_count + header->octants,
        .stored_values = means + choice->kept_count * block_numbers(choice),
        .nodes = header->node_count,
        .bytes = header->size,
        .source_bytes = (size_t)choice->leaf_count * header->components * sizeof(float),
        .max_error = error.max,
        .rms_error = error.rms,
        .relative_l2 = error.source_rms > 0 ? error.rms / error.source_rms : 0};
}

/* The blob is written behind the scratch, then moved to where the scratch began. */
bool tree_build(const TreeOptions *options, const float *leaves, Arena *arena,
                const void **blob, TreeReport *report, Error *err)
{
    if (!check_options(options, leaves, err)) return false;
    Arena      scratch = *arena;
    TreeChoice choice;
    if (!tree_choose(options, leaves, &scratch, &choice, err)) return false;
    const char       *made = write_blob(&choice, &scratch);
    const TreeHeader *header = (const TreeHeader *)(const void *)made;
    size_t            size = header->size;
    if (report) *report = report_of(&choice, header);
    *blob = arena_keep(arena, made, size, 16);
    return true;
}
