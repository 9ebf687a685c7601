#include "path/sun_mirror.h"

/* A normal that was bent towards the eye moved by more than its square. */
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

bool sun_mirror_is_known(const Scene *scene, const Mirrors *mirrors, int part_id,
                         const Surface *mirror, Vec3 wo)
{
    return mirrors_have(mirrors, (MirrorPair){part_id, mirror->triangle}) &&
           is_plain(scene, mirror, wo);
}

/* Light that leaves the solid angle dw around wo reached it from dw / spread around the sun's
 * direction: radiance is kept but for what the mirror takes, and the density of directions is
 * that of the sun's divided by the spread. */
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
    Vec3 local_wo = frame_to_local(&surface->frame, wo);
    if (!(surface->alpha > 0) || !is_plain(scene, surface, wo) || !(local_wo.z > 0) ||
        !(vec3_dot(sun->wi, surface->frame.z) > 0) ||
        !(vec3_dot(wo, surface->ng) * vec3_dot(sun->wi, surface->ng) > 0))
        return false;
    out->radiance = question->radiance * bsdf_mirror(&surface->bsdf, local_wo) *
                    spectrum_all(surface->alpha * spread / sun->pdf);
    out->light = (LightSample){.wi = wi, .distance = distance, .pdf = 1, .is_emitter = true,
                               .triangle = mirror->triangle, .ng = surface->ng};
    return !spectrum_is_zero(out->radiance);
}
