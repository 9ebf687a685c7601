/* SPDX-License-Identifier: Apache-2.0 */
/* HOT: no allocation, no lock, no libm. */
#include "path/mirror_share.h"
#include "base/mathf.h"

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
           (set == BEAMS_OF_EMITTERS ||
            lights_has(context->lights, set == BEAMS_OF_SUN ? LIGHTS_SUN : LIGHTS_PUNCTUAL));
}

float mirrored_rarity(const PathState *path, BeamSet set) {
    const PathContext *context = path->context;
    float share = 1;
    if (!mirrors_are_sampled(context, set) || path->medium_id != NO_ID ||
        path->bounce + 1 >= context->max_bounces)
        return 0;
    bool is_read = set == BEAMS_OF_SUN && !context->is_of_frame;
    for (int i = 0; i < path->bounce && i < DEEP_BOUNCE && !is_read; i++) share *= DEEP_SHARE;
    return share;
}

/* Of a reading's first vertices, of near lights: where no beam landed by chance, light would be
 * found by one path in 500, five hundred times as bright, and few paths take it for none. */
#define LEAST_OF_FIRST 0.05f

float mirrored_least(const PathState *path, const Surface *surface, BeamSet set) {
    bool is_first = set != BEAMS_OF_SUN && surface->part_id != NO_ID && !path->bounce;
    return is_first && !path->context->is_of_frame ? LEAST_OF_FIRST : 0;
}

float mirrored_prob(const PathState *path, const Surface *surface, Vec3 wo, BeamSet set) {
    float rarity = mirrored_rarity(path, set), prob;
    if (!(rarity > 0)) return 0;
    prob = rarity * mirror_beams_prob(&path->context->beams[set], surface->part_id,
                                      vec3_dot(wo, surface->ng) < 0, surface->position);
    return prob > 0 ? max_f(prob, mirrored_least(path, surface, set)) : 0;
}

bool mirrored_is_left(const PathState *path, const Surface *surface, Vec3 wo, BeamSet set,
                      float u) {
    float most = mirror_beams_most(&path->context->beams[set], surface->part_id,
                                   vec3_dot(wo, surface->ng) < 0);
    return u >= max_f(mirrored_rarity(path, set) * most, mirrored_least(path, surface, set));
}

/* Did the vertex before, to which wo leads, sample the set's lights in this mirror, smooth or
 * rough? */
static bool was_sampled(const PathState *path, const Surface *mirror, Vec3 wo, BeamSet set,
                        bool is_rough) {
    const PathContext *context = path->context;
    const Scene *scene = context->scene;
    MirrorPair pair = {path->last.part_id, is_rough, mirror->triangle};
    if (!mirrors_are_sampled(context, set) || path->last.is_delta || path->by_plates ||
        path->medium_id != NO_ID || mirror->material_id == NO_ID)
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

/* ---- compact emitters -------------------------------------------------------------------- */

MirrorWay mirrored_way(const PathState *path, const Surface *surface, Vec3 wo,
                       const BsdfSample *next) {
    const PathContext *context = path->context;
    const PathVertex *last = &path->last;
    const Mirrors *mirrors = context->beams[BEAMS_OF_EMITTERS].mirrors;
    MirrorWay way = {.prob = 0};
    bool is_eye = !path->bounce && last->is_delta;
    if (is_eye && !mirrors) mirrors = context->beams[BEAMS_OF_LAMPS].mirrors; /* the same ones */
    MirrorPair pair = {is_eye ? NO_ID : last->part_id, false, surface->triangle};
    if (!mirrors || !next->is_delta || !(next->wi.z > 0) || next->along != 0 ||
        (!is_eye && (last->is_delta || !(last->mirrors > 0))) || path->medium_id != NO_ID ||
        !mirrors_have(mirrors, pair) || !mirror_is_plain(context->scene, surface, wo))
        return way;
    float prob =
        is_eye ? 0
               : last->mirrors * mirror_beams_prob(&context->beams[BEAMS_OF_EMITTERS],
                                                   last->part_id, last->is_back, last->at.position);
    if (prob > 0) prob = max_f(prob, last->mirrors_least);
    way = (MirrorWay){.pdf =
                          last->pdf * spectrum_mean(bsdf_mirror(&surface->bsdf, surface->local_wo)),
                      .prob = prob,
                      .is_of_eye = is_eye,
                      .is_back = last->is_back,
                      .part_id = last->part_id,
                      .from = last->at.position,
                      .triangle = surface->triangle,
                      .at = surface->position};
    return way;
}

MirrorDensity mirrored_density(const PathState *path, int part_id, Vec3 point, float cosine) {
    const MirrorWay *way = &path->way;
    const PathContext *context = path->context;
    const MirrorBeams *beams = &context->beams[BEAMS_OF_EMITTERS];
    MirrorDensity out = {0, 0};
    if (!(way->prob > 0) || context->strategy == PATH_BSDF_ONLY) return out;
    int which = beams->emitters.of_part[part_id];
    if (which == NO_ID) return out;
    float spread = mirror_spread_at(context->scene, way->triangle, way->from, point, way->at);
    out.chance = way->pdf * spread * cosine;
    out.sampled = way->prob / beams->emitters.list[which].area_m2 *
                  mirror_beams_source_prob(beams, way->part_id, way->is_back, which);
    return out;
}
