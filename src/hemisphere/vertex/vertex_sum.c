/* SPDX-License-Identifier: Apache-2.0 */
#include "hemisphere/vertex/vertex_sum.h"

#include "hemisphere/rows.h"

typedef uint16_t UShort8 __attribute__((vector_size(16)));
typedef uint64_t ULong2 __attribute__((vector_size(16)));

/* A load of 8 bytes from KEEP_BYTES + 8 - n keeps n of 8 bytes. */
static const uint8_t KEEP_BYTES[16] = {255, 255, 255, 255, 255, 255, 255, 255};

/* `wanted` (4 or 8) bytes of a plane of `pairs` bytes from byte `skip` on, 0 beyond its end;
 * each holds two components. Returns signed 4 bits in the upper halves of bytes, in order of
 * components. */
static inline Byte16 load_plane(const uint8_t *from, int pairs, int skip, int wanted)
{
    uint64_t bits = 0, keep;
    int      there = pairs > skip + 8 ? 8 : pairs > skip ? pairs - skip : 0;
    memcpy(&bits, from + (there ? skip : 0), (size_t)wanted);
    memcpy(&keep, KEEP_BYTES + 8 - there, 8);
    bits &= keep;
    UShort8 odd = (UShort8)(ULong2){bits, 0}, even = odd << 4;
    Byte16  upper = {-16, -16, -16, -16, -16, -16, -16, -16,
                     -16, -16, -16, -16, -16, -16, -16, -16};
    return (Byte16)__builtin_shufflevector((Byte16)even & upper, (Byte16)odd & upper, 0, 16, 1,
                                           17, 2, 18, 3, 19, 4, 20, 5, 21, 6, 22, 7, 23);
}

/* Adds 16^plane times signed 4 bits, which stand in the upper halves of bytes. */
static inline void add_plane(Byte16 digits, int plane, Short8 *low, Short8 *high)
{
    *low += plane < 3 ? lower_bytes(digits) >> (12 - 4 * plane) : lower_bytes(digits);
    *high += plane < 3 ? upper_bytes(digits) >> (12 - 4 * plane) : upper_bytes(digits);
}

/* sum += weight * the 4 * quads components of a row from byte `skip` of its planes on. quads is
 * 2 or 4, a constant where inlined. */
static inline void add_row(const uint8_t *from, VertexFormat format, int skip, Float4 weight,
                           int quads, Float4 *sum)
{
    Short8 low = {0}, high = {0};
    int    wanted = 2 * quads;
    add_plane(load_plane(from, format.pairs[0], skip, wanted), 0, &low, &high);
    if (format.pairs[1]) {
        from += format.pairs[0];
        add_plane(load_plane(from, format.pairs[1], skip, wanted), 1, &low, &high);
    }
    if (format.pairs[2]) {
        from += format.pairs[1];
        add_plane(load_plane(from, format.pairs[2], skip, wanted), 2, &low, &high);
        from += format.pairs[2];
        add_plane(load_plane(from, format.pairs[3], skip, wanted), 3, &low, &high);
    }
    sum[0] += weight * lower_shorts(low, 16);
    sum[1] += weight * upper_shorts(low, 16);
    if (quads < 4) return;
    sum[2] += weight * lower_shorts(high, 16);
    sum[3] += weight * upper_shorts(high, 16);
}

/* 4 * quads components from 8 * eighth on. */
static inline void sum_quads(const Tree *tree, const TreeTaps *taps, int eighth, int quads,
                             Float4 *sum)
{
    for (int q = 0; q < quads; q++) sum[q] = all_lanes(0);
    for (int t = 0; t < taps->count; t++)
        add_row(tree->details + taps->row[t], tree->formats[taps->level[t]], 4 * eighth,
                all_lanes(taps->weight[t]), quads, sum);
    for (int q = 0; q < quads; q++) {
        Float4 scale;
        memcpy(&scale, tree->scale + 8 * eighth + 4 * q, sizeof scale);
        sum[q] *= scale;
    }
}

void vertex_tree_sum(const Tree *tree, const TreeTaps *taps, int first, int count, float *out)
{
    Float4 sum[TREE_MAX_COMPONENTS / 4 + 4];
    int    start = first / 8, end = (first + count + 7) / 8, at = start;
    for (; at + 2 <= end; at += 2) sum_quads(tree, taps, at, 4, sum + 2 * (at - start));
    if (at < end) sum_quads(tree, taps, at, 2, sum + 2 * (at - start));
    memcpy(out, (const float *)(const void *)sum + (first - 8 * start),
           (size_t)count * sizeof *out);
}
