/* SPDX-License-Identifier: Apache-2.0 */
/* mirrors_build.h -- the mirrors' trees over boxes and bounds of normals.
 *
 * Memory   from the arena.  Threads  one caller, `threads` at work.  Fails  never.
 */
#pragma once
#include "mirror/mirrors.h"

/* pairs: in mirrors_compare_pairs' order, each once; NULL for none of them. The same for any
 * number of threads. */
const Mirrors *mirrors_build(const Scene *scene, const MirrorPair *pairs, uint32_t count,
                             int threads, Arena *arena);
