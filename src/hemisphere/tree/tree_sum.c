/* SPDX-License-Identifier: Apache-2.0 */
#include "hemisphere/tree/tree_sum.h"

#include <string.h>

#include "hemisphere/rows.h"
#include "hemisphere/tree/vertex_open.h"
#include "hemisphere/tree/vertex_query.h"

/* sum += weight * 4 * blocks details from `from` on, 8 bits each; blocks is 1 or 4. */
static inline void add_bytes(const char *from, Float4 weight, int blocks, Float4 *sum) {
    Byte16 value = {0};
    memcpy(&value, from, 4 * (size_t)blocks);
    sum[0] += weight * lower_shorts(lower_bytes(value), 24);
    if (blocks == 1) return;
    sum[1] += weight * upper_shorts(lower_bytes(value), 24);
    sum[2] += weight * lower_shorts(upper_bytes(value), 24);
    sum[3] += weight * upper_shorts(upper_bytes(value), 24);
}

/* The same with 16 bits each. */
static inline void add_shorts(const char *from, Float4 weight, int blocks, Float4 *sum) {
    for (int b = 0; b < blocks; b += 2, from += sizeof(Short8)) {
        Short8 value = {0};
        memcpy(&value, from, blocks == 1 ? sizeof(Short8) / 2 : sizeof(Short8));
        sum[b] += weight * lower_shorts(value, 16);
        if (blocks > 1) sum[b + 1] += weight * upper_shorts(value, 16);
    }
}

/* The taps from `tap` on that have the same level: their integer rows, times their weights, are
 * summed up before the level's scales apply. Returns the next tap. */
static inline int add_level(const Tree *tree, const TreeTaps *taps, int tap, int first, int blocks,
                            Float4 *sum) {
    Float4 part[4] = {{0}};
    int level = taps->level[tap];
    const float *scale = tree->scales + level * tree->components + first;
    for (; tap < taps->count && taps->level[tap] == level; tap++) {
        uint32_t row = taps->row[tap];
        const char *from = (const char *)tree->rows + tree_row_offset(tree, row);
        Float4 weight = all_lanes(taps->weight[tap]);
        if (row < tree->byte_row) add_shorts(from + 2 * first, weight, blocks, part);
        else add_bytes(from + first, weight, blocks, part);
    }
    for (int b = 0; b < blocks; b++) sum[b] += load_floats(scale + 4 * b) * part[b];
    return tap;
}

static inline void add_float_rows(const Tree *tree, const TreeTaps *taps, int first, int blocks,
                                  Float4 *sum) {
    for (int t = 0; t < taps->count; t++) {
        size_t offset = taps->row[t] * (size_t)tree->components + (size_t)first;
        const float *row = (const float *)tree->rows + offset;
        for (int b = 0; b < blocks; b++)
            sum[b] += all_lanes(taps->weight[t]) * load_floats(row + 4 * b);
    }
}

/* 4 * blocks components from `first` on; `blocks` is a constant (1 or 4) where this is inlined,
 * so that the sums stay in registers. */
static inline void sum_blocks(const Tree *tree, const TreeTaps *taps, int first, int blocks,
                              float *out) {
    Float4 sum[4] = {{0}};
    for (int q = 0; q < tree->octants; q++) {
        const float *mean = tree->means + q * tree->components + first;
        for (int b = 0; b < blocks; b++)
            sum[b] += all_lanes(taps->mean_weight[q]) * load_floats(mean + 4 * b);
    }
    if (tree->format == TREE_ROWS_FLOAT) add_float_rows(tree, taps, first, blocks, sum);
    else
        for (int t = 0; t < taps->count;) t = add_level(tree, taps, t, first, blocks, sum);
    memcpy(out, sum, sizeof(Float4) * (size_t)blocks);
}

/* A detail, of integer rows without its scale. */
static float row_component(const Tree *tree, uint32_t row, int component) {
    if (tree->format == TREE_ROWS_FLOAT)
        return ((const float *)tree->rows)[row * (size_t)tree->components + (size_t)component];
    const char *from = (const char *)tree->rows + tree_row_offset(tree, row);
    return row < tree->byte_row ? ((const int16_t *)(const void *)from)[component]
                                : ((const int8_t *)(const void *)from)[component];
}

/* One component, by the same operations in the same order as in a block. */
static float sum_one(const Tree *tree, const TreeTaps *taps, int component) {
    float sum = 0;
    for (int q = 0; q < tree->octants; q++)
        sum += taps->mean_weight[q] * tree->means[q * tree->components + component];
    for (int t = 0; t < taps->count;) {
        float part = 0;
        int level = taps->level[t];
        for (; t < taps->count && taps->level[t] == level; t++)
            part += taps->weight[t] * row_component(tree, taps->row[t], component);
        sum += tree->format == TREE_ROWS_FLOAT
                   ? part
                   : tree->scales[level * tree->components + component] * part;
    }
    return sum;
}

/* The last one to three components, as part of the four that end with them or go beyond. */
static void sum_tail(const Tree *tree, const TreeTaps *taps, int first, int count, float *out) {
    float four[4];
    int start = first + 4 <= tree->components ? first : tree->components - 4;
    sum_blocks(tree, taps, start, 1, four);
    memcpy(out, four + (first - start), (size_t)count * sizeof *out);
}

static void sum_rows(const Tree *tree, const TreeTaps *taps, int first, int count, float *out) {
    int i = 0;
    for (; i + 16 <= count; i += 16) sum_blocks(tree, taps, first + i, 4, out + i);
    for (; i + 4 <= count; i += 4) sum_blocks(tree, taps, first + i, 1, out + i);
    if (i < count && tree->components >= 4) {
        sum_tail(tree, taps, first + i, count - i, out + i);
        return;
    }
    for (; i < count; i++) out[i] = sum_one(tree, taps, first + i);
}

void tree_sum(const Tree *tree, const TreeTaps *taps, int first, int count, float *out) {
    if (count <= 0) return;
    if (tree->basis == TREE_VERTEX) vertex_tree_sum(tree, taps, first, count, out);
    else sum_rows(tree, taps, first, count, out);
}
