/* SPDX-License-Identifier: Apache-2.0 */
/* HOT: no allocation, no lock, no libm. */
#include "path/emitted.h"

#include "path/mirror_share.h"
#include "path/path_collector.h"
#include "path/unfollowed.h"
#include "sunlit/sunlit_way.h"

/* MIS weight of emitted light that the last vertex met by chance: the rest belongs to its
 * light samples, which find the same light with density light_pdf. */
static float emission_weight(const PathState *path, LightSet set, float light_pdf) {
    const PathContext *context = path->context;
    if (path->last.is_delta || context->strategy == PATH_BSDF_ONLY ||
        (set == LIGHTS_EMITTERS && path->by_plates))
        return 1;
    if (context->strategy == PATH_LIGHTS_ONLY) return 0;
    float prob = path->guiding->asked[set] * path->guiding->often;
    if (set == LIGHTS_SKY)
        light_pdf = guiding_sky_pdf(path->guiding, path->ray.direction, light_pdf);
    return mis_weight(path->last.pdf, prob * light_pdf);
}

LitPoint emitted_lit_point(const PathState *path, const Surface *surface) {
    const Material *m = surface->material_id == NO_ID
                            ? NULL
                            : &path->context->scene->materials[surface->material_id];
    return (LitPoint){surface->position, surface->frame.z,
                      m && (m->is_solid || material_sends_through(m))};
}

/* ---- sunlit surfaces --------------------------------------------------------------------- */

SunlitPair emitted_pair(const PathState *path, const Surface *surface) {
    const PathContext *context = path->context;
    const Scene *scene = context->scene;
    SunlitPair pair = {.prob = 0};
    if (!path->last.samples_map || path->by_plates || path->medium_id != NO_ID ||
        surface->part_id == NO_ID || surface->triangle >= scene->opaque_count)
        return pair;
    float cosine = fabsf(vec3_dot(surface->ng, path->ray.direction));
    pair.prob = path->guiding->asked[LIGHTS_SUNLIT] * path->guiding->often;
    pair.from = path->last.at;
    pair.at = surface->position;
    pair.ng = surface->ng;
    pair.own = path->last.pdf;
    pair.sr = sunlit_way_at_x(1, 1, cosine, path->straight * path->straight);
    return pair;
}

float emitted_chance(const PathContext *context, const SunlitPair *pair, Vec3 sun) {
    const SunlitMap *map = &context->sunlit;
    if (!(pair->prob > 0)) return 1;
    float density = sunlit_map_density(map, &pair->from, pair->at, sun);
    if (!(density > 0)) return 1;
    float slope = fabsf(vec3_dot(pair->ng, sun)) / vec3_dot(map->frame.z, sun);
    return mis_weight(pair->own, pair->prob * density * slope * pair->sr);
}

/* ---- sun and sky ------------------------------------------------------------------------- */

static void find_distant(PathState *path, LightSet set, Spectrum radiance) {
    if (!path->collector) {
        path->gathered.radiance += radiance;
        return;
    }
    Vec3 towards = path->ray.direction;
    PathFound found = {.set = set,
                       .from = towards,
                       .is_distant = true,
                       .way = vec3_neg(towards),
                       .radiance = radiance};
    path_gather(path, &found);
}

void emitted_distant(PathState *path) {
    if (collect_escape(path)) return;
    Spectrum radiance[2];
    float pdf[2];
    lights_distant(path->context->lights, path->ray.direction, path->last.at.ns, path->wavelengths,
                   radiance, pdf);
    radiance[LIGHTS_SUN] *= path->last.sun_share;
    if (path->context->without_mirrored_sun && path->first.by_mirror && path->bounce == 1)
        radiance[LIGHTS_SUN] = spectrum_all(0);
    if (path->bounce && !spectrum_is_zero(radiance[LIGHTS_SKY])) path->statistics->sky_finds++;
    collect_sky(path, &radiance[LIGHTS_SKY]);
    if (path->last.before.prob > 0 && !spectrum_is_zero(radiance[LIGHTS_SUN]))
        radiance[LIGHTS_SUN] *=
            spectrum_all(emitted_chance(path->context, &path->last.before, path->ray.direction));
    for (int set = LIGHTS_SUN; set <= LIGHTS_SKY; set++) {
        float weight = emission_weight(path, (LightSet)set, pdf[set]);
        find_distant(path, (LightSet)set, path->throughput * radiance[set] * spectrum_all(weight));
    }
}

/* ---- emitters ---------------------------------------------------------------------------- */

static PathFound found_on(const Surface *surface, const Hit *hit, Vec3 wo, float weight) {
    return (PathFound){.set = LIGHTS_EMITTERS,
                       .source_id = surface->part_id,
                       .from = surface->position,
                       .way = wo,
                       .weight = weight,
                       .triangle = hit->triangle,
                       .point = &surface->point};
}

/* A display seen along a path on which nothing depends on wavelength: its measured XYZ. */
static void add_display_xyz(PathState *path, const Surface *surface, const Hit *hit, Vec3 wo,
                            float weight) {
    const Scene *scene = path->context->scene;
    int display_id = scene->materials[surface->material_id].display_id;
    float xyz[3];
    display_emission_xyz(scene, &scene->displays[display_id], hit->triangle, &surface->point, wo,
                         xyz);
    PathFound found = found_on(surface, hit, wo, weight);
    found.radiance = spectrum_all(0);
    found.xyz = xyz;
    found.share = spectrum_mean(path->throughput) * weight;
    path_gather(path, &found);
}

/* Density of the last vertex's light samples there, sr^-1; 0, unused, behind a mirror. */
static float emitter_pdf(const PathState *path, const Surface *surface, const Hit *hit) {
    Hit seen = {path->straight, hit->u, hit->v, hit->triangle};
    if (path->last.is_delta) return 0;
    return lights_emitter_pdf(path->context->lights, &path->last.at, &seen, path->ray.direction,
                              surface->ng);
}

/* Of a compact emitter in a mirror the vertex before that samples it, too. */
static float weight_in_mirror(const PathState *path, const Surface *surface, Vec3 wo) {
    if (!(path->way.prob > 0)) return 1;
    MirrorDensity by = mirrored_density(path, surface->part_id, surface->position,
                                        fabsf(vec3_dot(surface->ng, wo)));
    if (!(by.sampled > 0)) return 1;
    return path->context->strategy == PATH_LIGHTS_ONLY ? 0 : mis_weight(by.chance, by.sampled);
}

/* Has an eye's pupil sampled it in its mirror? */
static bool is_sampled_by_pupils(const PathState *path, const Surface *surface) {
    const CompactEmitters *compact = &path->context->beams[BEAMS_OF_EMITTERS].emitters;
    return path->way.is_of_eye && compact->of_part[surface->part_id] != NO_ID;
}

void emitted_add(PathState *path, const Surface *surface, const Hit *hit, Vec3 wo) {
    if (!surface->emits) return;
    const Scene *scene = path->context->scene;
    float weight = emission_weight(path, LIGHTS_EMITTERS, emitter_pdf(path, surface, hit)) *
                   weight_in_mirror(path, surface, wo);
    if (!(weight > 0)) return;
    if (surface_is_display(scene, surface) && path->is_grey) {
        add_display_xyz(path, surface, hit, wo, weight);
        return;
    }
    PathFound found = found_on(surface, hit, wo, weight);
    found.is_sampled = is_sampled_by_pupils(path, surface);
    found.radiance =
        path->throughput * spectrum_all(weight) *
        triangle_emission(scene, hit->triangle, &surface->point, wo, path->wavelengths);
    if (unfollowed_emitters(path)) unfollowed_found(path, surface->part_id, found.radiance);
    path_gather(path, &found);
}
