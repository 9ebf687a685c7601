/* SPDX-License-Identifier: Apache-2.0 */
/* HOT: no allocation, no lock, no libm. */
#include "path/collect/pixel_ray.h"

static void start(PathCollector *c, PathState *path)
{
    PixelRay *ray = (PixelRay *)c;
    ray->footprint = footprint_of_cone(path->context->cone, path->ray.direction);
    ray->is_known = true;
}

static void turn(PathCollector *c, PathState *path, const Surface *surface, Vec3 wo,
                 const BsdfSample *next)
{
    PixelRay *ray = (PixelRay *)c;
    ray->is_known = ray->is_known && footprint_turn(&ray->footprint, path->context->scene,
                                                    surface, wo, next, path->straight);
}

static const RayFootprint *footprint(const PathCollector *c)
{
    const PixelRay *ray = (const PixelRay *)c;
    return ray->is_known ? &ray->footprint : NULL;
}

bool pixel_ray_is_wanted(const PathContext *context)
{
    return context->has_subpixels && context->cone.width + context->cone.spread > 0;
}

PixelRay pixel_ray(PathCollector *next)
{
    static const CollectorKind kind = {.size = sizeof(PixelRay), .start = start, .turn = turn,
                                       .footprint = footprint};
    return (PixelRay){.base = {&kind, next}};
}
