/* SPDX-License-Identifier: Apache-2.0 */
/* mirrors_build.h -- the mirrors' trees over boxes and bounds of normals.
 *
 * Memory   from the arena.  Threads  one caller.  Fails  never.
 */
#pragma once
#include "mirror/mirrors.h"

/* pairs: in mirrors_compare_pairs' order, each once; NULL for none of them. */
const Mirrors *mirrors_build(const Scene *scene, const MirrorPair *pairs, uint32_t count,
                             Arena *arena);
