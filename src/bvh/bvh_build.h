/* SPDX-License-Identifier: Apache-2.0 */
/* bvh_build.h -- Embree's tree over the triangles of a scene, and how far its making has come.
 *
 * Memory   Embree reads positions and triangles where the Scene has them; its own tree takes
 *          some 100 bytes a triangle while it is made, 70 afterwards (tests/bench/README.md).
 * Threads  starts threads of its own; progress is shown by one of them at a time.
 */
#pragma once
#include "base/progress.h"
#include "bvh/bvh.h"

/* As bvh_create, and shows how far it is, until it is done. */
bool bvh_build(const Scene *scene, int threads, const char *isa, ProgressMode progress,
               Bvh **out, Error *err);

/* How many threads it was built with: what else is made before the first path may have them. */
int bvh_threads(const Bvh *bvh);
