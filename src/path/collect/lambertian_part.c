/* SPDX-License-Identifier: Apache-2.0 */
/* HOT: no allocation, no lock, no libm. */
#include "path/collect/lambertian_part.h"

/* Is this the first surface, and has it a Lambertian part? */
static bool is_asked(const PathState *path, const Surface *surface)
{
    return path->first.is_awaited && bsdf_has_lambertian(&surface->bsdf);
}

/* Share of the Lambertian part in what a display scatters from local_wi, per lane. */
static Spectrum share_of(const Surface *surface, Vec3 local_wi)
{
    return bsdf_lambertian_share(&surface->bsdf, surface->local_wo, local_wi);
}

/* Light samples of that surface. */
static void on_light(PathCollector *c, PathState *path, const PathFound *found)
{
    LambertianPart *part = (LambertianPart *)c;
    if (found->by && is_asked(path, found->by))
        part->found.radiance += found->radiance * share_of(found->by, found->local_wi);
}

/* The path goes on from there. */
static void turn(PathCollector *c, PathState *path, const Surface *surface, Vec3 wo,
                 const BsdfSample *next)
{
    (void)wo;
    LambertianPart *part = (LambertianPart *)c;
    if (!is_asked(path, surface)) return;
    part->before = path->gathered;
    part->share = next->is_delta ? spectrum_all(0) : share_of(surface, next->wi);
}

/* Measured XYZ come only by displays on which nothing depends on wavelength: the share of one
 * lane is that of all. */
static void finish(PathCollector *c, PathState *path)
{
    const LambertianPart *part = (const LambertianPart *)c;
    PathLight light = path->gathered;
    path_light_take(&light, &part->before);
    light.radiance *= part->share;
    for (int i = 0; i < 3; i++) light.xyz[i] *= part->share[0];
    path_light_add(&light, &part->found);
    path_light_to_xyz(&light, path->wavelengths, part->xyz);
}

LambertianPart lambertian_part(float xyz[3], PathCollector *next)
{
    static const CollectorKind kind = {.size = sizeof(LambertianPart), .turn = turn,
                                       .on_light = on_light, .finish = finish};
    return (LambertianPart){.base = {&kind, next}, .share = spectrum_all(0), .xyz = xyz};
}
