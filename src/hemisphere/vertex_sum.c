#include "hemisphere/rows.h"
#include "hemisphere/vertex_view.h"

/* sum += weight * 4 * quads integers from `from` on. quads: 1..4, a constant where inlined. */
static inline void add_bytes(const uint8_t *from, Float4 weight, int quads, Float4 *sum)
{
    Byte16 value = {0};
    memcpy(&value, from, 4 * (size_t)quads);
    Short8 low = lower_bytes(value), high = upper_bytes(value);
    sum[0] += weight * lower_shorts(low, 24);
    if (quads > 1) sum[1] += weight * upper_shorts(low, 24);
    if (quads > 2) sum[2] += weight * lower_shorts(high, 24);
    if (quads > 3) sum[3] += weight * upper_shorts(high, 24);
}

static inline void add_shorts(const uint8_t *from, Float4 weight, int quads, Float4 *sum)
{
    for (int q = 0; q < quads; q++) {
        Short8 value = {0};
        memcpy(&value, from + 8 * q, 8);
        sum[q] += weight * lower_shorts(value, 16);
    }
}

static inline void add_row(const uint8_t *from, bool is_wide, Float4 weight, int quads,
                           Float4 *sum)
{
    if (is_wide)
        add_shorts(from, weight, quads, sum);
    else
        add_bytes(from, weight, quads, sum);
}

/* A detail whose row may end before the last quad. */
static inline void add_part(const uint8_t *from, bool is_wide, Float4 weight, int quads,
                            Float4 *sum)
{
    for (int q = 0; q < quads; q++)
        add_row(from + (is_wide ? 8 : 4) * q, is_wide, weight, 1, sum + q);
}

/* The components 4 * start .. 4 * (start + quads) - 1. */
static inline void sum_quads(const Tree *tree, const TreeTaps *taps, int start, int quads,
                             Float4 *sum)
{
    const uint8_t *base = (const uint8_t *)tree->base + 8 * start;
    for (int q = 0; q < quads; q++) sum[q] = all_lanes(0);
    for (int t = 0; t < 3; t++)
        add_shorts(base + 2 * (size_t)tree->components * taps->row[t],
                   all_lanes(taps->weight[t]), quads, sum);
    for (int t = 3; t < taps->count; t++) {
        const VertexLevel *level = &tree->levels[taps->level[t]];
        const uint8_t     *from = tree->details + taps->row[t];
        Float4             weight = all_lanes(taps->weight[t]);
        int                there = (level->kept + 3) / 4 - start;
        from += (level->is_wide ? 8 : 4) * start;
        if (there >= quads)
            add_row(from, level->is_wide, weight, quads, sum);
        else
            add_part(from, level->is_wide, weight, there, sum);
    }
    for (int q = 0; q < quads; q++) {
        Float4 scale;
        memcpy(&scale, tree->scale + 4 * (start + q), sizeof scale);
        sum[q] *= scale;
    }
}

void vertex_tree_sum(const Tree *tree, const TreeTaps *taps, int first, int count, float *out)
{
    Float4 sum[TREE_MAX_COMPONENTS / 4];
    int    start = first / 4, end = (first + count + 3) / 4, q = start;
    for (; q + 4 <= end; q += 4) sum_quads(tree, taps, q, 4, sum + (q - start));
    if (q + 2 <= end) {
        sum_quads(tree, taps, q, 2, sum + (q - start));
        q += 2;
    }
    if (q < end) sum_quads(tree, taps, q, 1, sum + (q - start));
    memcpy(out, (const float *)(const void *)sum + (first - 4 * start),
           (size_t)count * sizeof *out);
}
