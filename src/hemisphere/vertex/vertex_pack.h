/* SPDX-License-Identifier: Apache-2.0 */
/* vertex_pack.h -- a vertex tree's blob in fewer bytes, for files of few samples.
 *
 * Packed    VertexHeader (magic VERTEX_PACKED, its size that of the packed bytes, level_count
 *           exponents, all behind that 0 but the base's exponent) | scale, float32, one a
 *           component | exponent, int8, one a level of details | coded bits, zeros to a
 *           multiple of 8.
 * Bits      of an arithmetic coder, each with a probability that follows the bits before it in
 *           the same context (vertex_pack.c): the base's integers less those before them, row
 *           by row; then for every edge of every level whether it has a detail, and its
 *           integers.
 *
 * Memory    the arena's. Threads: pure functions. The same bytes on every machine.
 */
#pragma once
#include "base/error.h"
#include "hemisphere/vertex/vertex_tree.h"

#define VERTEX_PACKED 0x50545256u /* "VRTP" */
#define VERTEX_PACKED_LEVEL 8     /* at most */
#define VERTEX_PACKED_COMPONENTS 32

static inline bool vertex_is_packed(const void *bytes, size_t size) {
    return size >= sizeof(VertexHeader) && *(const uint32_t *)bytes == VERTEX_PACKED;
}

/* Of a tree of either basis. */
static inline bool vertex_can_pack(const void *blob) {
    const VertexHeader *h = blob;
    return h->magic == VERTEX_MAGIC && h->level >= 1 && h->level <= VERTEX_PACKED_LEVEL &&
           h->components <= VERTEX_PACKED_COMPONENTS;
}

/* blob: a vertex tree's, opened before, within the limits above. Its size is in *size. */
const void *vertex_pack(const void *blob, Arena *arena, size_t *size);

/* The blob that was packed, byte by byte; NULL (ERROR_INPUT): these are no such bytes. What
 * comes of damaged bits is for tree_open to check. */
const void *vertex_unpack_blob(const void *bytes, size_t size, Arena *arena, size_t *blob_size,
                               Error *err);
