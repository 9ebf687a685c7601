/* SPDX-License-Identifier: Apache-2.0 */
/* pixel_ray.h -- the footprint of a pixel along a frame's ray (path/footprint.h), until that
 * scatters: for displays with sub-pixels.
 *
 * Threads  one thread's, like the path.
 */
#pragma once
#include "path/path_collector.h"

typedef struct PixelRay {
    PathCollector base;
    RayFootprint  footprint;
    bool          is_known;
} PixelRay;

/* Do the context's rays need a footprint? */
bool pixel_ray_is_wanted(const PathContext *context);

PixelRay pixel_ray(PathCollector *next);
