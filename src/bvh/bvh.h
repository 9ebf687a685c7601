/* SPDX-License-Identifier: Apache-2.0 */
/* bvh.h -- where a ray hits: the only wrapper of Embree (3 or 4).
 *
 * Memory   owns Embree's device and scene; positions and triangles stay the Scene's, which must
 *          outlive the Bvh. bvh_destroy(NULL) is fine. Embree's own tree takes some 100 bytes a
 *          triangle while it is made, 70 afterwards (tests/bench/README.md).
 * Threads  const after bvh_create: any number of threads may query it.
 * Rays     a ray that is not finite, comes from beyond 1.8e18, or has no direction, hits
 *          nothing and is counted by the caller as a lost sample; it never reaches Embree
 *          (whose Debian build would abort).
 */
#pragma once
#include "base/error.h"
#include "base/progress.h"
#include "bvh/ray.h"
#include "scene/scene.h"

typedef struct Bvh Bvh;

/* threads: for building, at least 1. isa: NULL (the best there is), "sse2", "sse4.2", "avx",
 * "avx2" or "avx512". */
bool bvh_create(const Scene *scene, int threads, const char *isa, Bvh **out, Error *err);
/* The same with a progress line until it is done. */
bool bvh_build(const Scene *scene, int threads, const char *isa, ProgressMode progress, Bvh **out,
               Error *err);
void bvh_destroy(Bvh *bvh);

/* Number of threads that it was built with: other work before the first path may use them. */
int bvh_threads(const Bvh *bvh);

/* The nearest hit in [t_min, t_max]; false: none. Both sides of a triangle are hit. Of
 * triangles that lie at one depth it is any. sheets_from, where bvh_has_sheets: triangles that
 * may let light through are left out before this t. */
bool bvh_intersect(const Bvh *bvh, Ray ray, float sheets_from, Hit *hit);

/* Called for every triangle that may let light through (Scene.triangles from opaque_count on)
 * that a shadow ray meets, in no order. True: go on behind it. */
typedef bool BvhPasses(void *user, const Hit *hit);

/* Is there anything in (t_min, t_max) that stops the light? */
bool bvh_occluded(const Bvh *bvh, Ray ray, BvhPasses *passes, void *user);

/* Has the scene sheets, that is triangles whose material may have holes (MASK, BLEND)? Two of
 * them, or one and what it lies on, may lie at one depth; bvh_find_sheets is for that case, and
 * may only be called then. */
bool bvh_has_sheets(const Bvh *bvh);

/* Calls `asked` for every triangle in [t_min, t_max] that may let light through, past opaque
 * ones too, until it returns false. */
void bvh_find_sheets(const Bvh *bvh, Ray ray, BvhPasses *asked, void *user);

/* For measuring: every ray traced from now on is kept until the recorder is full, with whether
 * it was a shadow ray. One thread only. NULL: stop. */
typedef struct BvhRecorder {
    Ray *rays;
    bool *is_shadow;
    size_t count, capacity;
} BvhRecorder;
void bvh_record(Bvh *bvh, BvhRecorder *recorder);

/* The name and version of the library in use, e.g. "Embree 3.13.5". */
const char *bvh_library(void);
