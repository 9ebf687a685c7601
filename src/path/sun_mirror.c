/* SPDX-License-Identifier: Apache-2.0 */
#include "path/sun_mirror.h"

/* Squared: a normal that was bent towards the eye has moved by more. */
#define UNBENT2 1e-8f

/* Is the mirror's normal the interpolated one, and light in front of it in air? */
static bool is_plain(const Scene *scene, const Surface *mirror, Vec3 wo)
{
    Vec3 ns = mirror->point.ns, z = mirror->frame.z;
    Vec3 apart = vec3_sub(z, vec3_dot(ns, z) < 0 ? vec3_neg(ns) : ns);
    bool is_outside = !scene->materials[mirror->material_id].is_solid ||
                      vec3_dot(wo, mirror->ng) > 0;
    return is_outside && vec3_dot(apart, apart) < UNBENT2;
}

bool sun_mirror_is_known(const Scene *scene, const Mirrors *mirrors, MirrorPair pair,
                         const Surface *mirror, Vec3 wo)
{
    if (mirror->material_id == NO_ID) return false;
    bool may_be = !pair.is_rough ||
                  mirrors_rough_alpha(&scene->materials[mirror->material_id]) > 0;
    return may_be && mirrors_have(mirrors, pair) && is_plain(scene, mirror, wo);
}

/* Light that leaves the solid angle dw around wo reached it from dw / spread around the sun's
 * direction: radiance is kept but for what the mirror takes, and the density of directions is
 * that of the sun's divided by the spread. Facets of a rough mirror send f cos of the light on,
 * and their directions have the density of their slopes divided by the spread. */
bool sun_mirror_at(const SunMirrorQuestion *question, const Hit *mirror, float spread,
                   SunMirror *out)
{
    const Scene       *scene = question->scene;
    const LightSample *sun = &question->sun;
    TrianglePoint      place = triangle_point(scene, mirror->triangle, mirror->u, mirror->v);
    Vec3     to = vec3_sub(place.position, question->from);
    float    distance = vec3_length(to);
    Vec3     wi = vec3_scale(to, 1 / distance), wo = vec3_neg(wi);
    Hit      hit = {distance, mirror->u, mirror->v, mirror->triangle};
    Surface *surface = &out->surface;
    if (!(distance > 0)) return false;
    surface_at(scene, question->tables, &hit, wo, question->wavelengths, surface);
    Vec3 local_wo = surface->local_wo;
    if (!(surface->alpha > 0) || !is_plain(scene, surface, wo) || !(local_wo.z > 0) ||
        !(vec3_dot(sun->wi, surface->frame.z) > 0) ||
        !(vec3_dot(wo, surface->ng) * vec3_dot(sun->wi, surface->ng) > 0))
        return false;
    Vec3 local_sun = frame_to_local(&surface->frame, sun->wi);
    out->radiance = question->is_rough
                        ? bsdf_glint(&surface->bsdf, local_wo, local_sun) *
                              spectrum_all(local_sun.z)
                        : bsdf_mirror(&surface->bsdf, local_wo);
    out->radiance *= question->radiance *
                     spectrum_all(surface->alpha * spread / sun->pdf);
    out->light = (LightSample){.wi = wi, .distance = distance, .pdf = 1, .is_emitter = true,
                               .triangle = mirror->triangle, .ng = surface->ng};
    return !spectrum_is_zero(out->radiance);
}

Spectrum sun_mirror_left(const Bsdf *mirror, Vec3 local_wo, Vec3 local_wi, Spectrum f)
{
    return spectrum_max(f - bsdf_glint(mirror, local_wo, local_wi), spectrum_all(0));
}

Spectrum sun_mirror_share(const Bsdf *mirror, Vec3 local_wo, const BsdfSample *next)
{
    float pdf;
    if (next->is_delta) return spectrum_all(0);
    Spectrum f = bsdf_eval(mirror, local_wo, next->wi, &pdf);
    return sun_mirror_left(mirror, local_wo, next->wi, f) /
           spectrum_max(f, spectrum_all(1e-30f));
}
