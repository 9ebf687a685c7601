/* SPDX-License-Identifier: Apache-2.0 */
/* HOT: no allocation, no lock, no libm. */
#include "path/direct.h"

#include "scene/point/ray_ends.h"
#include "path/emitted.h"

/* ---- solids ------------------------------------------------------------------------------ */

void direct_absorb(const PathState *path, int medium_id, float distance, Spectrum *light) {
    const Material *m = &path->context->scene->materials[medium_id];
    if (!isfinite(m->attenuation_distance_m)) return;
    Spectrum left = spectrum_from_rgb(path->wavelengths, m->attenuation_color);
    for (int i = 0; i < SPECTRUM_LANES; i++)
        (*light)[i] *= pow_f(left[i], distance / m->attenuation_distance_m);
}

/* A translucent solid absorbs part of what a lamp inside sends to its boundary. */
static void absorb_sample(const PathState *path, const Surface *surface, const LightSample *light,
                          Spectrum *passed) {
    if (!isfinite(light->distance) || !bsdf_sends_across(&surface->bsdf)) return;
    const Material *m = &path->context->scene->materials[surface->material_id];
    if (material_is_translucent_solid(m) && vec3_dot(light->wi, surface->ng) < 0)
        direct_absorb(path, surface->material_id, light->distance, passed);
}

/* ---- shadow rays ------------------------------------------------------------------------- */

/* A ray through the edge that two triangles share meets both: that is one sheet, not two. */
static bool was_met(ShadowRay *ray, const Hit *hit) {
    const Scene *scene = ray->path->context->scene;
    for (int i = 0; i < ray->hit_count && i < SHADOW_HITS; i++)
        if (fabsf(hit->t - ray->recent[i].t) <= 2e-6f * hit->t + ray->step &&
            sheets_are_one(scene, hit->triangle, ray->recent[i].triangle))
            return true;
    ray->recent[ray->hit_count++ % SHADOW_HITS] = *hit;
    return false;
}

static bool passes(void *user, const Hit *hit) {
    ShadowRay *ray = user;
    const PathContext *context = ray->path->context;
    if (was_met(ray, hit)) return true;
    ray->passed *=
        surface_pass(context->scene, context->tables, hit, ray->light->wi, ray->path->wavelengths);
    return !spectrum_is_zero(ray->passed);
}

/* Sheets in the emitter's plane absorb light only where they lie over it. */
static bool passes_before_emitter(void *user, const Hit *hit) {
    const ShadowRay *ray = user;
    const LightSample *light = ray->light;
    float behind = (hit->t - ray->end) * fabsf(vec3_dot(light->wi, light->point.ng));
    bool is_over =
        behind < -ray->rounding || (behind <= ray->rounding && hit->triangle > light->triangle);
    return !is_over || passes(user, hit);
}

/* Sheets in the last bit of the way, by which the shadow ray ended before the emitter, and as
 * far behind. */
static void find_sheets_at_emitter(const Bvh *bvh, Ray to_light, ShadowRay *ray) {
    const TrianglePoint *at = &ray->light->point;
    float cosine = vec3_dot(to_light.direction, at->ng);
    ray->end = vec3_dot(vec3_sub(at->inside, to_light.origin), at->ng) / cosine;
    ray->rounding = at->rounding + at->slant * ray->light->distance;
    to_light.t_min = to_light.t_max;
    to_light.t_max = fmaxf(2 * ray->end - to_light.t_min, to_light.t_min);
    bvh_find_sheets(bvh, to_light, passes_before_emitter, ray);
}

Spectrum direct_visibility(PathState *path, const Surface *surface, const LightSample *light,
                           ShadowRay *ray) {
    const Bvh *bvh = path->context->bvh;
    Ray to_light = lights_ray(ray_start(&surface->point, light->wi), light);
    ray->path = path; /* most rays meet no sheet: room for hits is left as it is */
    ray->light = light;
    ray->passed = spectrum_all(1);
    ray->step = ray_step(&surface->point);
    ray->hit_count = 0;
    path->statistics->shadow_rays++;
    if (bvh_occluded(bvh, to_light, passes, ray)) return spectrum_all(0);
    if (light->is_emitter && bvh_has_sheets(bvh)) find_sheets_at_emitter(bvh, to_light, ray);
    return ray->passed;
}

bool direct_sides_agree(const Surface *surface, Vec3 local_wi, Vec3 wi, Vec3 wo) {
    return (local_wi.z * surface->local_wo.z > 0) ==
           (vec3_dot(wi, surface->ng) * vec3_dot(wo, surface->ng) > 0);
}

/* ---- mirrors ----------------------------------------------------------------------------
 *
 * BSDF samples find light that goes sun, mirror (src/mirror), scattering surface only where
 * they hit the sun's image: rare and very bright samples. Here all points of mirrors that turn
 * one direction of the sun's disc to the surface count as lights of that direction; BSDF
 * samples then leave the sun in these mirrors out (mirror_is_known).
 *
 * Not known: what passes a second mirror on its way or is refracted, mirrors seen from within
 * a solid, mirrors bent by a normal map, rough ones above GLINT_ALPHA. */

/* A lit position in air, and one direction of the sun. */
typedef struct SunMirrorQuery {
    const Scene *scene;
    const SurfaceTables *tables;
    const Wavelengths *wavelengths;
    Vec3 from; /* m, world */
    LightSample sun;
    Spectrum radiance; /* of the sun there */
    bool is_rough;     /* by facets of rough mirrors; else by smooth ones */
} SunMirrorQuery;

/* Squared: a normal that was bent towards the eye has moved by more. */
#define UNBENT2 1e-8f

/* Is the mirror's normal the interpolated one, and light in front of it in air? */
static bool is_plain(const Scene *scene, const Surface *mirror, Vec3 wo) {
    Vec3 ns = mirror->point.ns, z = mirror->frame.z;
    Vec3 apart = vec3_sub(z, vec3_dot(ns, z) < 0 ? vec3_neg(ns) : ns);
    bool is_outside =
        !scene->materials[mirror->material_id].is_solid || vec3_dot(wo, mirror->ng) > 0;
    return is_outside && vec3_dot(apart, apart) < UNBENT2;
}

/* Did the pair's part sample the sun that a ray in air, which came along -wo, finds behind
 * this mirror? The pair's triangle is the mirror's. */
static bool mirror_is_known(const Scene *scene, const Mirrors *mirrors, MirrorPair pair,
                            const Surface *mirror, Vec3 wo) {
    if (mirror->material_id == NO_ID) return false;
    bool may_be = !pair.is_rough || mirrors_rough_alpha(&scene->materials[mirror->material_id]) > 0;
    return may_be && mirrors_have(mirrors, pair) && is_plain(scene, mirror, wo);
}

/* Sunlight by a point that mirrors_find reported; mirror->t is not used. False: none comes by
 * it. Occlusion is not tested.
 *
 * Light that leaves the solid angle dw around wo reached it from dw / spread around the sun's
 * direction: radiance is kept but for what the mirror takes, and the density of directions is
 * that of the sun's divided by the spread. Facets of a rough mirror send f cos of the light on,
 * and their directions have the density of their slopes divided by the spread. */
static bool mirror_at(const SunMirrorQuery *query, const Hit *mirror, float spread,
                      SunMirror *out) {
    const Scene *scene = query->scene;
    const LightSample *sun = &query->sun;
    TrianglePoint place = triangle_point(scene, mirror->triangle, mirror->u, mirror->v);
    Vec3 to = vec3_sub(place.position, query->from);
    float distance = vec3_length(to);
    Vec3 wi = vec3_scale(to, 1 / distance), wo = vec3_neg(wi);
    Hit hit = {distance, mirror->u, mirror->v, mirror->triangle};
    Surface *surface = &out->surface;
    if (!(distance > 0)) return false;
    surface_at(scene, query->tables, &hit, wo, query->wavelengths, surface);
    Vec3 local_wo = surface->local_wo;
    if (!(surface->alpha > 0) || !is_plain(scene, surface, wo) || !(local_wo.z > 0) ||
        !(vec3_dot(sun->wi, surface->frame.z) > 0) ||
        !(vec3_dot(wo, surface->ng) * vec3_dot(sun->wi, surface->ng) > 0))
        return false;
    Vec3 local_sun = frame_to_local(&surface->frame, sun->wi);
    out->radiance = query->is_rough ? bsdf_glint(&surface->bsdf, local_wo, local_sun) *
                                          spectrum_all(local_sun.z)
                                    : bsdf_mirror(&surface->bsdf, local_wo);
    out->radiance *= query->radiance * spectrum_all(surface->alpha * spread / sun->pdf);
    out->light = (LightSample){.wi = wi,
                               .distance = distance,
                               .pdf = 1,
                               .is_emitter = true,
                               .triangle = mirror->triangle,
                               .point = place};
    return !spectrum_is_zero(out->radiance);
}

/* The rest of f = bsdf_eval at a rough mirror that was sampled: left to sun samples and
 * chance. */
static Spectrum mirror_left(const Bsdf *mirror, Vec3 local_wo, Vec3 local_wi, Spectrum f) {
    return spectrum_max(f - bsdf_glint(mirror, local_wo, local_wi), spectrum_all(0));
}

/* The same as a share of what a BSDF sample there carries; 0 by the smooth boundary. */
static Spectrum mirror_share(const Bsdf *mirror, Vec3 local_wo, const BsdfSample *next) {
    float pdf;
    if (next->is_delta) return spectrum_all(0);
    Spectrum f = bsdf_eval(mirror, local_wo, next->wi, &pdf);
    return mirror_left(mirror, local_wo, next->wi, f) / spectrum_max(f, spectrum_all(1e-30f));
}

/* ---- light samples ----------------------------------------------------------------------- */

static bool samples_mirrors(const PathContext *context) {
    return context->beams.mirrors && context->strategy != PATH_BSDF_ONLY &&
           lights_has(context->lights, LIGHTS_SUN);
}

/* Did the vertex before sample the sun in this mirror, smooth or rough? */
static bool mirror_was_sampled(const PathState *path, const Surface *surface, Vec3 wo,
                               bool is_rough) {
    MirrorPair pair = {path->last.part_id, is_rough, surface->triangle};
    return samples_mirrors(path->context) && !path->last.is_delta && path->medium_id == NO_ID &&
           mirror_is_known(path->context->scene, path->context->beams.mirrors, pair, surface, wo);
}

Spectrum direct_sun_share(const PathState *path, const Surface *surface, Vec3 wo,
                          const BsdfSample *next) {
    if (!(next->wi.z > 0) || !mirror_was_sampled(path, surface, wo, !next->is_delta))
        return spectrum_all(1);
    return mirror_share(&surface->bsdf, surface->local_wo, next);
}

static int source_of(const PathState *path, const LightSample *light) {
    const Scene *scene = path->context->scene;
    if (light->set == LIGHTS_EMITTERS) return (int)scene->triangles[light->triangle].part_id;
    return light->set == LIGHTS_PUNCTUAL ? light->light_id : 0;
}

/* A light sample that a surface takes with probability `prob`. */
typedef struct TakenLight {
    LightSample light;
    Vec3 local_wi;
    float prob;
} TakenLight;

/* Adds a sample's light as the surface scatters it. */
static void find_sample(PathState *path, const Surface *surface, Vec3 wo, const TakenLight *taken,
                        const ShadowRay *ray, Spectrum radiance) {
    const LightSample *light = &taken->light;
    if (!collect_takes_sample(path)) {
        path->gathered.radiance += radiance;
        return;
    }
    bool is_distant = !isfinite(light->distance);
    PathFound found = {
        .set = light->set,
        .source_id = source_of(path, light),
        .is_distant = is_distant,
        .from = is_distant ? light->wi : vec3_along(surface->position, light->wi, light->distance),
        .way = vec3_neg(light->wi),
        .radiance = radiance,
        .triangle = light->triangle,
        .point = light->set == LIGHTS_EMITTERS ? &light->point : NULL,
        .by = surface,
        .wo = wo,
        .local_wi = taken->local_wi,
        .shadow = ray};
    path_gather(path, &found);
}

/* Most samples end in shadow: radiance and BSDF are evaluated once the ray has arrived. */
static void add_arriving(PathState *path, const Surface *surface, Vec3 wo, const Guiding *guiding,
                         TakenLight *taken) {
    const PathContext *context = path->context;
    LightSample *light = &taken->light;
    ShadowRay ray;
    Vec3 local_wo = surface->local_wo, local_wi = taken->local_wi;
    float prob = taken->prob;
    Spectrum passed = direct_visibility(path, surface, light, &ray);
    if (spectrum_is_zero(passed)) return;
    path->statistics->sky_finds += light->set == LIGHTS_SKY;
    absorb_sample(path, surface, light, &passed);
    guiding_weigh_light(guiding, context->lights, emitted_lit_point(path, surface), light);
    float bsdf_pdf;
    Spectrum f = bsdf_eval(&surface->bsdf, local_wo, local_wi, &bsdf_pdf);
    if (light->set == LIGHTS_SUN && mirror_was_sampled(path, surface, wo, true))
        f = mirror_left(&surface->bsdf, local_wo, local_wi, f);
    Spectrum share = path->throughput * f *
                     lights_radiance(context->lights, light, path->wavelengths) *
                     spectrum_all(fabsf(local_wi.z) / (light->pdf * prob));
    if (!light->is_delta && context->strategy == PATH_MIS)
        share *=
            spectrum_all(mis_weight(light->pdf * prob, guiding_pdf(guiding, light->wi, bsdf_pdf)));
    if (light->set == LIGHTS_SUN && path->last.samples_map) {
        SunlitPair pair = emitted_pair(path, surface);
        share *= spectrum_all(emitted_chance(context, &pair, light->wi));
    }
    find_sample(path, surface, wo, taken, &ray, share * passed);
}

void direct_add_sun(PathState *path, const Surface *surface, Vec3 wo, const LightSample *sun) {
    const PathContext *context = path->context;
    TakenLight taken = {*sun, frame_to_local(&surface->frame, sun->wi), 1};
    ShadowRay ray;
    float bsdf_pdf;
    if (!direct_sides_agree(surface, taken.local_wi, sun->wi, wo) ||
        !bsdf_reaches(&surface->bsdf, surface->local_wo, taken.local_wi))
        return;
    Spectrum passed = direct_visibility(path, surface, &taken.light, &ray);
    if (spectrum_is_zero(passed)) return;
    Spectrum f = bsdf_eval(&surface->bsdf, surface->local_wo, taken.local_wi, &bsdf_pdf);
    if (mirror_was_sampled(path, surface, wo, true))
        f = mirror_left(&surface->bsdf, surface->local_wo, taken.local_wi, f);
    find_sample(path, surface, wo, &taken, &ray,
                path->throughput * f * passed *
                    lights_radiance(context->lights, sun, path->wavelengths) *
                    spectrum_all(fabsf(taken.local_wi.z) / sun->pdf));
}

static void add_light_sample(PathState *path, const Surface *surface, Vec3 wo,
                             const Guiding *guiding, LightSet set) {
    const PathContext *context = path->context;
    TakenLight taken;
    LightSample *light = &taken.light;
    float u[4];
    taken.prob = guiding->asked[set] * guiding->often;
    numbers_for(path, NUMBERS_LIGHTS + 2 * (int)set);
    sampler_4d(path->sampler, u);
    if (!unit_choose(&u[0], taken.prob)) return;
    LitPoint point = emitted_lit_point(path, surface);
    if (!guiding_choose_light(guiding, context->lights, set, point, u, light)) return;
    if (!light->is_delta && context->strategy == PATH_BSDF_ONLY) return;
    taken.local_wi = frame_to_local(&surface->frame, light->wi);
    if (!direct_sides_agree(surface, taken.local_wi, light->wi, wo)) return;
    if (!bsdf_reaches(&surface->bsdf, surface->local_wo, taken.local_wi)) return;
    add_arriving(path, surface, wo, guiding, &taken);
}

/* ---- the sun via one mirror -------------------------------------------------------------- */

/* A lit surface that samples its mirrors one by one. */
typedef struct MirrorWalk {
    PathState *path;
    const Surface *surface;
    Vec3 wo;
    SunMirrorQuery mirror_query;
} MirrorWalk;

/* The two shadow rays of light via a mirror. */
typedef struct MirrorRays {
    ShadowRay to_mirror, to_sun;
} MirrorRays;

static void find_mirrored(const MirrorWalk *walk, const SunMirror *mirror, Vec3 local_wi,
                          const MirrorRays *rays, Spectrum radiance) {
    PathState *path = walk->path;
    Vec3 to_sun = walk->mirror_query.sun.wi;
    if (!collect_takes_sample(path)) {
        path->gathered.radiance += radiance;
        return;
    }
    PathFound found = {.set = LIGHTS_SUN,
                       .from = to_sun,
                       .is_distant = true,
                       .way = vec3_neg(to_sun),
                       .radiance = radiance,
                       .by = walk->surface,
                       .wo = walk->wo,
                       .local_wi = local_wi,
                       .shadow = &rays->to_mirror,
                       .mirror = mirror,
                       .beyond = &rays->to_sun,
                       .by_rough = walk->mirror_query.is_rough};
    path_gather(path, &found);
}

static void add_mirrored_sun(void *user, uint32_t triangle, const ReflectionPoint *point) {
    MirrorWalk *walk = user;
    const Surface *surface = walk->surface;
    PathState *path = walk->path;
    MirrorRays rays;
    SunMirror mirror;
    Hit place = {0, point->u, point->v, triangle};
    float pdf;
    if (!mirror_at(&walk->mirror_query, &place, point->spread, &mirror)) return;
    Vec3 local_wi = frame_to_local(&surface->frame, mirror.light.wi);
    if (!direct_sides_agree(surface, local_wi, mirror.light.wi, walk->wo)) return;
    Spectrum share = path->throughput * mirror.radiance *
                     bsdf_eval(&surface->bsdf, surface->local_wo, local_wi, &pdf) *
                     spectrum_all(fabsf(local_wi.z));
    if (spectrum_is_zero(share)) return;
    share *= direct_visibility(path, &mirror.surface, &walk->mirror_query.sun, &rays.to_sun);
    if (spectrum_is_zero(share)) return;
    share *= direct_visibility(path, surface, &mirror.light, &rays.to_mirror);
    find_mirrored(walk, &mirror, local_wi, &rays, share);
}

/* u: chooses the direction on the sun's disc. */
static void sample_mirrors(PathState *path, const Surface *surface, Vec3 wo, const float u[4],
                           float prob) {
    const PathContext *context = path->context;
    MirrorWalk walk = {path,
                       surface,
                       wo,
                       {.scene = context->scene,
                        .tables = context->tables,
                        .wavelengths = path->wavelengths,
                        .from = surface->position}};
    LitPoint point = {surface->position, surface->frame.z, true}; /* from any side */
    LightSample *sun = &walk.mirror_query.sun;
    if (!lights_sample(context->lights, LIGHTS_SUN, point, u, sun)) return;
    walk.mirror_query.radiance = lights_radiance(context->lights, sun, path->wavelengths);
    sun->pdf *= prob;
    MirrorQuery query = {surface->part_id, false, surface->position, {sun->wi, false}, {0, 0}};
    mirrors_find(context->beams.mirrors, &query, add_mirrored_sun, &walk);
    query.is_rough = walk.mirror_query.is_rough = true;
    query.u = sampler_2d(path->sampler);
    mirrors_find(context->beams.mirrors, &query, add_mirrored_sun, &walk);
}

/* The mirror is one more vertex: none is sampled where the path would end before it. */
static void add_mirrored_suns(PathState *path, const Surface *surface, Vec3 wo) {
    const PathContext *context = path->context;
    if (!samples_mirrors(context) || path->medium_id != NO_ID ||
        path->bounce + 1 >= context->max_bounces)
        return;
    float prob = mirror_beams_prob(&context->beams, surface->part_id, vec3_dot(wo, surface->ng) < 0,
                                   surface->position);
    for (int i = 0; i < path->bounce && i < DEEP_BOUNCE; i++) prob *= DEEP_SHARE;
    if (!(prob > 0)) return;
    float u[4];
    numbers_for(path, NUMBERS_MIRRORS);
    sampler_4d(path->sampler, u);
    if (unit_choose(&u[0], prob)) sample_mirrors(path, surface, wo, u, prob);
}

void direct_add(PathState *path, const Surface *surface, Vec3 wo, const Guiding *guiding) {
    if (!bsdf_scatters(&surface->bsdf)) return;
    for (int set = 0; set < LIGHT_SETS; set++)
        if (lights_has(path->context->lights, (LightSet)set))
            add_light_sample(path, surface, wo, guiding, (LightSet)set);
    add_mirrored_suns(path, surface, wo);
}
