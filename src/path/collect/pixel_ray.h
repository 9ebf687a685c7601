/* SPDX-License-Identifier: Apache-2.0 */
/* pixel_ray.h -- what a pixel covers along a frame's ray (path/footprint.h), until it scatters:
 * displays with sub-pixels want to know.
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

/* Does the context's frame have rays of which that is to be known? */
bool pixel_ray_is_wanted(const PathContext *context);

PixelRay pixel_ray(PathCollector *next);
