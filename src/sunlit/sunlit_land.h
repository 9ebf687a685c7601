/* SPDX-License-Identifier: Apache-2.0 */
/* sunlit_land.h -- where a ray of the sun ends. HOT. */
#pragma once
#include "bvh/bvh.h"
#include "light/light.h"
#include "scene/point/ray_ends.h"

typedef struct SunlitTools {
    const Scene *scene;
    const Bvh *bvh;
    const Lights *lights;
} SunlitTools;

#define SUNLIT_SHEETS 16 /* that a ray passes */

/* The first surface that lets nothing through by holes or as a window. */
static inline bool sunlit_land(const Scene *scene, const Bvh *bvh, Ray ray, Hit *hit) {
    for (int i = 0; i < SUNLIT_SHEETS && bvh_intersect(bvh, ray, 0, hit); i++) {
        if (hit->triangle < scene->opaque_count) return true;
        ray = ray_behind(scene, ray, hit);
    }
    return false;
}
