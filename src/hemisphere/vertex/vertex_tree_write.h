/* SPDX-License-Identifier: Apache-2.0 */
/* vertex_tree_write.h -- the integers of a vertex tree as the bytes of its blob.
 *
 * Memory   the arena's. Threads: pure functions. Fails: never.
 */
#pragma once
#include "hemisphere/vertex/vertex_code.h"

/* The blob; its bytes are in *size. */
const void *vertex_code_write(const VertexCode *code, Arena *arena, size_t *size);
