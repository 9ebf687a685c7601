/* SPDX-License-Identifier: Apache-2.0 */
/* HOT: no allocation, no lock, no libm. */
#include "path/direct.h"

#include "base/mathf.h"
#include "scene/point/ray_ends.h"
#include "path/emitted.h"
#include "path/mirror_share.h"
#include "surface/plates.h"

/* ---- solids ------------------------------------------------------------------------------ */

void direct_absorb(const Scene *scene, const Wavelengths *wavelengths, int medium_id,
                   float distance, Spectrum *light) {
    const Material *m = &scene->materials[medium_id];
    if (!isfinite(m->attenuation_distance_m)) return;
    Spectrum left = spectrum_from_rgb(wavelengths, m->attenuation_color);
    for (int i = 0; i < SPECTRUM_LANES; i++)
        (*light)[i] *= pow_f(left[i], distance / m->attenuation_distance_m);
}

/* A translucent solid absorbs part of what a lamp inside sends to its boundary. */
static void absorb_sample(const PathState *path, const Surface *surface, const LightSample *light,
                          Spectrum *passed) {
    if (!isfinite(light->distance) || !bsdf_sends_across(&surface->bsdf)) return;
    const Material *m = &path->context->scene->materials[surface->material_id];
    if (material_is_translucent_solid(m) && vec3_dot(light->wi, surface->ng) < 0)
        direct_absorb(path->context->scene, path->wavelengths, surface->material_id,
                      light->distance, passed);
}

/* ---- shadow rays ------------------------------------------------------------------------- */

/* A ray through the edge that two triangles share meets both: that is one sheet, not two. */
static bool was_met(ShadowRay *ray, const Hit *met) {
    const Scene *scene = ray->path->context->scene;
    Hit own = *met, *hit = &own;
    own.t += ray->plates.from;
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
    to_light.t_max = max_f(2 * ray->end - to_light.t_min, to_light.t_min);
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
    ray->hit_count = ray->plates.count = 0;
    ray->plates.from = 0;
    path->statistics->shadow_rays++;
    if (bvh_occluded(bvh, to_light, passes, ray)) return spectrum_all(0);
    if (light->is_emitter && bvh_has_sheets(bvh)) find_sheets_at_emitter(bvh, to_light, ray);
    return ray->passed;
}

/* The share of light that comes along a ray which something stops, through plates. */
static Spectrum passed_by_plates(PathState *path, Ray to_light, ShadowRay *ray) {
    ray->plates.view = plate_view(path->context, path->wavelengths);
    ray->plates.passes = passes;
    ray->plates.user = ray;
    ray->passed = spectrum_all(1);
    ray->hit_count = 0;
    if (!plates_follow(&ray->plates, to_light)) return spectrum_all(0);
    ray->passed *= ray->plates.passed;
    return ray->passed;
}

Spectrum direct_arrival(PathState *path, const Surface *surface, const LightSample *light,
                        ShadowRay *ray) {
    Spectrum passed = direct_visibility(path, surface, light, ray);
    if (!path->context->plates.count || isfinite(light->distance) || !spectrum_is_zero(passed))
        return passed;
    Ray to_light = {ray_start(&surface->point, light->wi), light->wi, 0, INFINITY};
    return passed_by_plates(path, to_light, ray);
}

bool direct_sides_agree(const Surface *surface, Vec3 local_wi, Vec3 wi, Vec3 wo) {
    return (local_wi.z * surface->local_wo.z > 0) ==
           (vec3_dot(wi, surface->ng) * vec3_dot(wo, surface->ng) > 0);
}

/* ---- light samples ----------------------------------------------------------------------- */

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
static void add_arrived(PathState *path, const Surface *surface, Vec3 wo, const Guiding *guiding,
                        TakenLight *taken, const ShadowRay *ray) {
    const PathContext *context = path->context;
    LightSample *light = &taken->light;
    Vec3 local_wo = surface->local_wo, local_wi = taken->local_wi;
    float prob = taken->prob;
    Spectrum passed = ray->passed;
    path->statistics->sky_finds += light->set == LIGHTS_SKY;
    absorb_sample(path, surface, light, &passed);
    guiding_weigh_light(guiding, context->lights, emitted_lit_point(path, surface), light);
    float bsdf_pdf;
    Spectrum f = bsdf_eval(&surface->bsdf, local_wo, local_wi, &bsdf_pdf);
    if (!ray->plates.count || !isfinite(light->distance))
        f = mirrored_left(path, surface, wo, light, local_wi, f);
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
    find_sample(path, surface, wo, taken, ray, share * passed);
}

/* Can the surface send light of the sample to wo? Sets its local direction. */
static bool can_take(const Surface *surface, Vec3 wo, TakenLight *taken) {
    taken->local_wi = frame_to_local(&surface->frame, taken->light.wi);
    return direct_sides_agree(surface, taken->local_wi, taken->light.wi, wo) &&
           bsdf_reaches(&surface->bsdf, surface->local_wo, taken->local_wi);
}

/* ---- lamps behind plates ----------------------------------------------------------------- */

/* What a lens may make of light at the place that is looked at. Over all others it adds none. */
#define LENS_MOST 100

/* What may come of the lamp through solids that no way is known through, by what would come if
 * nothing stood there. */
static void count_lost(PathState *path, const Surface *surface, const TakenLight *taken) {
    float pdf, xyz[3] = {0};
    Spectrum light = path->throughput *
                     lights_radiance(path->context->lights, &taken->light, path->wavelengths) *
                     bsdf_eval(&surface->bsdf, surface->local_wo, taken->local_wi, &pdf) *
                     spectrum_all(fabsf(taken->local_wi.z) / (taken->light.pdf * taken->prob));
    spectrum_add_xyz(path->wavelengths, light, xyz);
    if (isfinite(xyz[1])) path->statistics->lost += (path->bounce ? 1 : LENS_MOST) * (double)xyz[1];
}

/* A way of the lamp's light as a sample of its own. */
static LightSample lamp_by_way(const PathContext *context, const LightSample *light,
                               const PlateLampWay *way) {
    const PunctualLight *lamp = &context->scene->lights[light->light_id];
    LightSample by = *light;
    float sent = punctual_falloff(lamp, vec3_neg(light->wi));
    float turned = punctual_falloff(lamp, vec3_neg(way->wi));
    by.wi = way->wi;
    by.scale *= sent > 0 ? turned / sent : 0;
    by.scale *= way->per_d2 * light->distance * light->distance * way->share;
    return by;
}

/* Light of a lamp that stands behind plates, by all ways that it takes: they are free if the
 * first is. */
static void add_by_plates(PathState *path, const Surface *surface, Vec3 wo, const Guiding *guiding,
                          const TakenLight *taken) {
    const PathContext *context = path->context;
    const LightSample *light = &taken->light;
    PlateView view = plate_view(context, path->wavelengths);
    PlateLamp lamp = {.from = surface->position,
                      .lamp = vec3_along(surface->position, light->wi, light->distance)};
    PlateLampWay ways[PLATE_ORDERS];
    ShadowRay ray;
    plate_lamp_look(&view, ray_start(&surface->point, light->wi), &lamp);
    if (lamp.is_lost && !lamp.is_blocked) count_lost(path, surface, taken);
    int count = plate_lamp_ways(&lamp, ways);
    if (!count) return;
    ray.path = path;
    ray.light = light;
    ray.step = ray_step(&surface->point);
    LightSample first = lamp_by_way(context, light, &ways[0]);
    first.distance = ways[0].length;
    Ray to_lamp = lights_ray(ray_start(&surface->point, first.wi), &first);
    if (spectrum_is_zero(passed_by_plates(path, to_lamp, &ray)) || ray.plates.count != lamp.count)
        return;
    for (int i = 0; i < count; i++) {
        TakenLight by = {.light = lamp_by_way(context, light, &ways[i]), .prob = taken->prob};
        if (can_take(surface, wo, &by)) add_arrived(path, surface, wo, guiding, &by, &ray);
    }
}

static void add_arriving(PathState *path, const Surface *surface, Vec3 wo, const Guiding *guiding,
                         TakenLight *taken) {
    const LightSample *light = &taken->light;
    ShadowRay ray;
    Ray straight = {surface->position, light->wi, 0, light->distance};
    if (!spectrum_is_zero(direct_arrival(path, surface, light, &ray)))
        add_arrived(path, surface, wo, guiding, taken, &ray);
    else if (light->set == LIGHTS_PUNCTUAL && isfinite(light->distance) &&
             plate_boxes_meet(&path->context->plates, straight))
        add_by_plates(path, surface, wo, guiding, taken);
}

void direct_add_sun(PathState *path, const Surface *surface, Vec3 wo, const LightSample *sun) {
    const PathContext *context = path->context;
    TakenLight taken = {.light = *sun, .prob = 1};
    ShadowRay ray;
    float bsdf_pdf;
    if (!can_take(surface, wo, &taken)) return;
    Spectrum passed = direct_arrival(path, surface, &taken.light, &ray);
    if (spectrum_is_zero(passed)) return;
    Spectrum f = bsdf_eval(&surface->bsdf, surface->local_wo, taken.local_wi, &bsdf_pdf);
    f = mirrored_left(path, surface, wo, sun, taken.local_wi, f);
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
    if (can_take(surface, wo, &taken)) add_arriving(path, surface, wo, guiding, &taken);
}

void direct_add(PathState *path, const Surface *surface, Vec3 wo, const Guiding *guiding) {
    if (!bsdf_scatters(&surface->bsdf)) return;
    for (int set = 0; set < LIGHT_SETS; set++)
        if (lights_has(path->context->lights, (LightSet)set))
            add_light_sample(path, surface, wo, guiding, (LightSet)set);
}
