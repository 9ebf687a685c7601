/* SPDX-License-Identifier: Apache-2.0 */
/* HOT: no allocation, no lock, no libm. */
#include "path/mirror_share.h"

/* Squared: a normal that was bent towards the eye has moved by more. */
#define UNBENT2 1e-8f

bool mirror_is_plain(const Scene *scene, const Surface *mirror, Vec3 wo) {
    Vec3 ns = mirror->point.ns, z = mirror->frame.z;
    Vec3 apart = vec3_sub(z, vec3_dot(ns, z) < 0 ? vec3_neg(ns) : ns);
    bool is_outside =
        !scene->materials[mirror->material_id].is_solid || vec3_dot(wo, mirror->ng) > 0;
    return is_outside && vec3_dot(apart, apart) < UNBENT2;
}

bool mirrors_are_sampled(const PathContext *context, BeamSet set) {
    return context->beams[set].mirrors && context->strategy != PATH_BSDF_ONLY &&
           lights_has(context->lights, set == BEAMS_OF_SUN ? LIGHTS_SUN : LIGHTS_PUNCTUAL);
}

/* Did the vertex before, to which wo leads, sample the set's lights in this mirror, smooth or
 * rough? */
static bool was_sampled(const PathState *path, const Surface *mirror, Vec3 wo, BeamSet set,
                        bool is_rough) {
    const PathContext *context = path->context;
    const Scene *scene = context->scene;
    MirrorPair pair = {path->last.part_id, is_rough, mirror->triangle};
    if (!mirrors_are_sampled(context, set) || path->last.is_delta || path->medium_id != NO_ID ||
        mirror->material_id == NO_ID)
        return false;
    bool may_be = !is_rough || mirrors_rough_alpha(&scene->materials[mirror->material_id]) > 0;
    return may_be && mirrors_have(context->beams[set].mirrors, pair) &&
           mirror_is_plain(scene, mirror, wo);
}

static Spectrum left_of(const Bsdf *mirror, Vec3 local_wo, Vec3 local_wi, Spectrum f) {
    return spectrum_max(f - bsdf_glint(mirror, local_wo, local_wi), spectrum_all(0));
}

Spectrum mirrored_left(const PathState *path, const Surface *surface, Vec3 wo,
                       const LightSample *light, Vec3 local_wi, Spectrum f) {
    BeamSet set = light->set == LIGHTS_SUN ? BEAMS_OF_SUN : BEAMS_OF_LAMPS;
    if ((light->set != LIGHTS_SUN && light->set != LIGHTS_PUNCTUAL) ||
        !was_sampled(path, surface, wo, set, true))
        return f;
    return left_of(&surface->bsdf, surface->local_wo, local_wi, f);
}

Spectrum mirrored_sun_share(const PathState *path, const Surface *surface, Vec3 wo,
                            const BsdfSample *next) {
    const Bsdf *bsdf = &surface->bsdf;
    float pdf;
    if (!(next->wi.z > 0) || !was_sampled(path, surface, wo, BEAMS_OF_SUN, !next->is_delta))
        return spectrum_all(1);
    if (next->is_delta) return spectrum_all(0);
    Spectrum f = bsdf_eval(bsdf, surface->local_wo, next->wi, &pdf);
    return left_of(bsdf, surface->local_wo, next->wi, f) / spectrum_max(f, spectrum_all(1e-30f));
}
