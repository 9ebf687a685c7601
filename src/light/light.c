/* SPDX-License-Identifier: Apache-2.0 */
#include "light/light.h"

#include "base/mathf.h"
#include "scene/point/coverage.h"
#include "light/emitters_build.h"
#include "light/punctual_build.h"
#include "scene/point/ray_ends.h"
#include "light/sky.h"

/* How often an emitter is chosen changes the noise alone: displays that become up to so many
 * times as bright are still chosen nearly as often as they should be. */
#define LEVEL_CHANGE 4.0f

struct Lights {
    const Scene *scene;
    Sky sky;
    Emitters emitters;
    PunctualLights punctual;
    const float *levels; /* of the scene's displays, when emitters were built */
};

static const float *levels_of(const Scene *scene, Arena *arena) {
    float *levels = ARENA_NEW(arena, float, scene->display_count);
    for (int i = 0; i < scene->display_count; i++) levels[i] = scene->displays[i].level;
    return levels;
}

/* Is no display much brighter, or darker, than when emitters were built? */
static bool fits_levels(const Lights *lights) {
    const Scene *scene = lights->scene;
    for (int i = 0; i < scene->display_count; i++) {
        float now = scene->displays[i].level, then = lights->levels[i];
        if (!(now <= LEVEL_CHANGE * then && then <= LEVEL_CHANGE * now)) return false;
    }
    return true;
}

bool lights_build(const Scene *scene, Arena *arena, Lights **out, Error *err) {
    Sky sky;
    if (!sky_build(&scene->environment, arena, &sky, err)) return false;
    Lights *lights = ARENA_NEW(arena, Lights, 1);
    *lights = (Lights){.scene = scene,
                       .sky = sky,
                       .emitters = emitters_build(scene, arena),
                       .punctual = punctual_build(scene, arena),
                       .levels = levels_of(scene, arena)};
    *out = lights;
    return true;
}

const Lights *lights_with_levels(const Lights *before, Arena *arena) {
    if (fits_levels(before)) return before;
    Lights *lights = ARENA_NEW(arena, Lights, 1);
    *lights = *before;
    lights->emitters = emitters_build(before->scene, arena);
    lights->levels = levels_of(before->scene, arena);
    return lights;
}

bool lights_has(const Lights *lights, LightSet set) {
    switch (set) {
    case LIGHTS_SUN: return lights->sky.has_sun;
    case LIGHTS_SKY: return lights->sky.kind != ENVIRONMENT_NONE;
    case LIGHTS_EMITTERS: return lights->emitters.count > 0;
    case LIGHTS_PUNCTUAL: return lights->punctual.count > 0;
    case LIGHT_SETS: break;
    }
    return false;
}

bool lights_sun_is_moon(const Lights *lights) {
    return lights->sky.is_moon;
}

Vec3 lights_sun_direction(const Lights *lights) {
    return lights->sky.sun_direction;
}

int lights_lamp_count(const Lights *lights) {
    return lights->punctual.count;
}

int lights_lamp_id(const Lights *lights, int which) {
    return lights->punctual.order[which];
}

/* ---- all sets ---------------------------------------------------------------------------- */

static void take_lamp(const PunctualSample *lamp, LightSample *sample) {
    sample->wi = lamp->wi;
    sample->distance = lamp->distance;
    sample->light_id = lamp->light_id;
    sample->scale = lamp->scale;
    sample->pdf = 1;
    sample->is_delta = true;
}

static bool sample_punctual(const Lights *lights, const PunctualKnown *known, const LitPoint *point,
                            const float u[3], LightSample *sample) {
    PunctualSample lamp;
    if (!punctual_sample(&lights->punctual, known, point, u, &lamp)) return false;
    take_lamp(&lamp, sample);
    return true;
}

static Spectrum punctual_radiance(const PunctualLight *light, float scale,
                                  const Wavelengths *wavelengths) {
    Spectrum white = light->white ? curve_lookup(light->white, wavelengths) : wavelengths->d65;
    return spectrum_from_rgb(wavelengths, light->intensity) * white * spectrum_all(scale);
}

static bool sample_emitters(const Lights *lights, const LitPoint *from, const float u[3],
                            LightSample *sample) {
    EmitterDensity density;
    EmitterPoint at = emitters_sample(&lights->emitters, lights->scene, from, u, &density);
    sample->point = triangle_point(lights->scene, at.triangle, at.u, at.v);
    Vec3 to_light = vec3_sub(sample->point.position, from->position);
    float d2 = vec3_dot(to_light, to_light);
    sample->wi = vec3_normalize(to_light);
    sample->distance = sqrtf(d2);
    float cosine = fabsf(vec3_dot(sample->point.ng, sample->wi));
    if (!(d2 > 0) || !(cosine > 1e-6f)) return false;
    sample->pdf = density.on_area * d2 / cosine + density.on_sphere;
    sample->is_emitter = true;
    sample->triangle = at.triangle;
    sample->u = at.u;
    sample->v = at.v;
    return sample->pdf > 0 &&
           triangle_emits_to(lights->scene, at.triangle, &sample->point, vec3_neg(sample->wi));
}

#define BEFORE_LAMP 1e-4f      /* of the distance */
#define LAMP_ROUNDING 0x1p-20f /* of a lamp's largest coordinate */

static float before_lamp(Vec3 lamp, float distance) {
    float size = max_f(max_f(fabsf(lamp.x), fabsf(lamp.y)), fabsf(lamp.z));
    return max_f(distance * (1 - BEFORE_LAMP) - LAMP_ROUNDING * size, 0);
}

Ray lights_ray(Vec3 from, const LightSample *sample) {
    if (sample->is_emitter) return ray_to(from, &sample->point, vec3_neg(sample->wi));
    Ray ray = {from, sample->wi, 0, sample->distance};
    if (isfinite(sample->distance))
        ray.t_max = before_lamp(vec3_along(from, sample->wi, sample->distance), sample->distance);
    return ray;
}

static Spectrum emitter_radiance(const Scene *scene, const LightSample *sample,
                                 const Wavelengths *wavelengths) {
    Hit hit = {0, sample->u, sample->v, sample->triangle};
    return triangle_emission(scene, sample->triangle, &sample->point, vec3_neg(sample->wi),
                             wavelengths) *
           spectrum_all(coverage_at(scene, &hit, &sample->point));
}

static bool sample_sun(const Lights *lights, const float u[3], LightSample *sample) {
    sample->wi = sun_sample(&lights->sky, u[0], u[1]);
    sample->pdf = sun_pdf(&lights->sky, sample->wi);
    return sample->pdf > 0;
}

static void take_sky(const SkySample *sky, LightSample *sample) {
    sample->wi = sky->direction;
    sample->pdf = sky->pdf;
    sample->at = sky->at;
}

static bool sample_sky(const Lights *lights, Vec3 ns, const float u[3], LightSample *sample) {
    SkySample sky;
    if (!sky_choose(&lights->sky, ns, u, &sky)) return false;
    take_sky(&sky, sample);
    return true;
}

static void sample_of(LightSet set, LightSample *sample) {
    sample->set = set;
    sample->distance = INFINITY;
    sample->is_delta = sample->is_emitter = false;
}

bool lights_sample(const Lights *lights, LightSet set, LitPoint point, const float u[3],
                   LightSample *sample) {
    sample_of(set, sample);
    switch (set) {
    case LIGHTS_SUN: return sample_sun(lights, u, sample);
    case LIGHTS_SKY: return sample_sky(lights, point.ns, u, sample);
    case LIGHTS_EMITTERS: return sample_emitters(lights, &point, u, sample);
    case LIGHTS_PUNCTUAL: return sample_punctual(lights, NULL, &point, u, sample);
    case LIGHT_SETS: break;
    }
    return false;
}

bool lights_sample_known(const Lights *lights, const PunctualKnown *known, LitPoint point,
                         const float u[3], LightSample *sample) {
    sample_of(LIGHTS_PUNCTUAL, sample);
    return sample_punctual(lights, known, &point, u, sample);
}

PunctualPoint lights_lamp_point(const Lights *lights, int light_id, const float u[4]) {
    return punctual_point(&lights->scene->lights[light_id], light_id, u);
}

bool lights_lamp_towards(const Lights *lights, const PunctualPoint *point, Vec3 place,
                         LightSample *sample) {
    PunctualSample lamp;
    const PunctualLight *light = &lights->scene->lights[point->light_id];
    if (!punctual_towards(light, point, place, &lamp)) return false;
    sample_of(LIGHTS_PUNCTUAL, sample);
    take_lamp(&lamp, sample);
    return true;
}

void lights_sky_towards(const Lights *lights, Vec3 direction, Vec3 ns, LightSample *sample) {
    SkySample sky;
    sample_of(LIGHTS_SKY, sample);
    sky_towards(&lights->sky, direction, ns, &sky);
    take_sky(&sky, sample);
}

bool lights_sky_polarisation(const Lights *lights, Vec3 direction, const Wavelengths *wavelengths,
                             Vec3 *axis, Spectrum *degree) {
    const Sky *sky = &lights->sky;
    if (!sky->model || !sky->model->is_polarised) return false;
    Vec3 across = vec3_cross(direction, sky->model->sun);
    if (!(vec3_dot(across, across) > 1e-10f)) return false;
    *axis = vec3_normalize(across);
    *degree = sky_model_polarisation(sky->model, direction, wavelengths);
    return true;
}

Spectrum lights_radiance(const Lights *lights, const LightSample *sample,
                         const Wavelengths *wavelengths) {
    const Scene *scene = lights->scene;
    SkySample sky = {.direction = sample->wi, .at = sample->at};
    switch (sample->set) {
    case LIGHTS_SUN: return sun_radiance(&lights->sky, sample->wi, wavelengths);
    case LIGHTS_SKY: return sky_radiance(&lights->sky, &sky, wavelengths);
    case LIGHTS_EMITTERS: return emitter_radiance(scene, sample, wavelengths);
    case LIGHTS_PUNCTUAL:
        return punctual_radiance(&scene->lights[sample->light_id], sample->scale, wavelengths);
    case LIGHT_SETS: break;
    }
    return spectrum_all(0);
}

double lights_sample_lx(const Lights *lights, LitPoint point, const LightSample *light, float u) {
    Wavelengths wavelengths;
    float xyz[3] = {0};
    float cosine = vec3_dot(point.ns, light->wi);
    wavelengths_sample(u, &wavelengths);
    spectrum_add_xyz(
        &wavelengths,
        lights_radiance(lights, light, &wavelengths) * spectrum_all(cosine / light->pdf), xyz);
    return isfinite(xyz[1]) ? (double)xyz[1] : 0;
}

void lights_distant(const Lights *lights, Vec3 direction, Vec3 ns, const Wavelengths *wavelengths,
                    Spectrum radiance[2], float pdf[2]) {
    SkySample seen = sky_seen(&lights->sky, direction, ns, wavelengths);
    radiance[LIGHTS_SUN] = sun_radiance(&lights->sky, direction, wavelengths);
    radiance[LIGHTS_SKY] = seen.radiance;
    pdf[LIGHTS_SUN] = sun_pdf(&lights->sky, direction);
    pdf[LIGHTS_SKY] = seen.pdf;
}

float lights_emitter_pdf(const Lights *lights, const LitPoint *from, const Hit *hit, Vec3 direction,
                         Vec3 ng) {
    float cosine = fabsf(vec3_dot(ng, direction));
    EmitterDensity density = emitters_density(&lights->emitters, lights->scene, from,
                                              (EmitterPoint){hit->triangle, hit->u, hit->v});
    return cosine > 1e-6f ? density.on_area * hit->t * hit->t / cosine + density.on_sphere : 0;
}
