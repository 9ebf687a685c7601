#include "light/light.h"

#include "base/alias.h"
#include "base/units.h"
#include "light/coverage.h"
#include "light/emitters_build.h"
#include "light/opening.h"
#include "light/sky.h"
#include "spectrum/photometry.h"

/* Of many punctual lights this many are drawn by intensity, and one of them is then chosen by
 * what it gives at the point (resampled importance sampling, Talbot et al. 2005). */
#define PUNCTUAL_CANDIDATES 8

/* Share of its largest intensity with which a lamp that has an opening stays in the choice
 * where its middle sends nothing: its rim may. */
#define LEAST_OF_OPENING 0.1f

struct Lights {
    const Scene *scene;
    Sky          sky;
    Emitters     emitters;
    AliasTable   punctual; /* by intensity; count 0: none */
};

/* A far light's lux and a near light's candela meet at the scene's own size. */
static AliasTable weigh_punctual(const Scene *scene, Arena *arena)
{
    double *weights = ARENA_NEW(arena, double, scene->light_count + 1), total = 0;
    Vec3    size = vec3_sub(scene->bounds_max, scene->bounds_min);
    double  radius2 = fmax(0.25 * (double)vec3_dot(size, size), 1e-12);
    for (int i = 0; i < scene->light_count; i++) {
        const PunctualLight *light = &scene->lights[i];
        weights[i] = (double)luminance_from_rgb(light->intensity) *
                     (light->kind == LIGHT_DIRECTIONAL ? radius2 : 1.0);
        total += weights[i];
    }
    return total > 0 ? alias_build(weights, scene->light_count, arena) : (AliasTable){0};
}

bool lights_build(const Scene *scene, Arena *arena, Lights **out, Error *err)
{
    Sky sky;
    if (!sky_build(&scene->environment, arena, &sky, err)) return false;
    Lights *lights = ARENA_NEW(arena, Lights, 1);
    *lights = (Lights){.scene = scene, .sky = sky, .emitters = emitters_build(scene, arena),
                       .punctual = weigh_punctual(scene, arena)};
    *out = lights;
    return true;
}

bool lights_has(const Lights *lights, LightSet set)
{
    switch (set) {
    case LIGHTS_SUN: return lights->sky.has_sun;
    case LIGHTS_SKY: return lights->sky.kind != ENVIRONMENT_NONE;
    case LIGHTS_EMITTERS: return lights->emitters.count > 0;
    case LIGHTS_PUNCTUAL: return lights->punctual.count > 0;
    case LIGHT_SETS: break;
    }
    return false;
}

/* ---- punctual lights --------------------------------------------------------------------- */

/* Directions between the world and the luminaire's frame. */
static Vec3 lamp_from_world(const PunctualLight *light, Vec3 v)
{
    return vec3(vec3_dot(light->axis_x, v), vec3_dot(light->axis_y, v),
                vec3_dot(light->axis_z, v));
}

static Vec3 world_from_lamp(const PunctualLight *light, Vec3 v)
{
    return vec3_along(vec3_along(vec3_scale(light->axis_x, v.x), light->axis_y, v.y),
                      light->axis_z, v.z);
}

/* Relative intensity towards a unit direction. Of a luminaire its web. Of a spot
 * KHR_lights_punctual's recommended cone: 1 inside the inner angle, 0 outside the outer, the
 * square of the linear ramp of the cosine between. */
static float falloff(const PunctualLight *light, Vec3 from_light)
{
    if (light->kind == LIGHT_LUMINAIRE)
        return intensity_web_at(light->web, lamp_from_world(light, from_light));
    if (light->kind != LIGHT_SPOT) return 1;
    float range = fmaxf(light->cos_inner - light->cos_outer, 1e-6f);
    float ramp =
        clampf((vec3_dot(light->direction, from_light) - light->cos_outer) / range, 0, 1);
    return ramp * ramp;
}

/* Where the light, or the middle of its opening, is as seen from position, and its illuminance
 * (lx per unit of its colour's intensity) on a plane that faces it. */
static float punctual_geometry(const PunctualLight *light, Vec3 position, Vec3 *wi,
                               float *distance)
{
    if (light->kind == LIGHT_DIRECTIONAL) {
        *wi = vec3_neg(light->direction);
        *distance = INFINITY;
        return 1;
    }
    Vec3  to_light = vec3_sub(light->position, position);
    float d2 = vec3_dot(to_light, to_light);
    *distance = sqrtf(d2);
    *wi = vec3_normalize(to_light);
    return d2 > 0 ? falloff(light, vec3_neg(*wi)) / d2 : 0;
}

static bool has_opening(const PunctualLight *light)
{
    return light->kind == LIGHT_LUMINAIRE && light->opening.shape != OPENING_POINT;
}

/* By what a light is chosen at position: above 0 wherever it may light, finite inside it. */
static float punctual_target(const PunctualLight *light, Vec3 position)
{
    Vec3  wi;
    float distance, candela = luminance_from_rgb(light->intensity);
    if (!has_opening(light))
        return candela * punctual_geometry(light, position, &wi, &distance);
    Vec3  away = vec3_sub(position, light->position);
    float radius = opening_radius(&light->opening), d2 = vec3_dot(away, away);
    float relative = d2 > 0 ? falloff(light, vec3_normalize(away)) : 0;
    return candela * fmaxf(relative, LEAST_OF_OPENING) / (d2 + radius * radius);
}

/* As punctual_geometry, of a point of its opening. */
static float opening_geometry(const PunctualLight *light, Vec3 position, const float u[2],
                              Vec3 *wi, float *distance)
{
    float weight;
    Vec3  from = lamp_from_world(light, vec3_sub(position, light->position));
    Vec3  at = opening_sample(&light->opening, from, u, &weight), away = vec3_sub(from, at);
    float d2 = vec3_dot(away, away);
    *distance = sqrtf(d2);
    *wi = vec3_normalize(vec3_neg(world_from_lamp(light, away)));
    return d2 > 0 && weight > 0
               ? weight * intensity_web_at(light->web, vec3_normalize(away)) / d2 : 0;
}

/* Chooses one light; *prob_inverse makes the estimate unbiased. All are candidates when there
 * are few; each candidate then counts once and prob is its share of the sum. *pick is a random
 * number that is used up and left uniform. */
static int choose_punctual(const Lights *lights, Vec3 position, float *pick, float shift,
                           float *prob_inverse)
{
    int   total = lights->punctual.count, chosen = NO_ID;
    bool  all = total <= PUNCTUAL_CANDIDATES;
    int   candidates = all ? total : PUNCTUAL_CANDIDATES;
    float sum = 0, chosen_weight = 0;
    for (int i = 0; i < candidates; i++) {
        float shifted = shift + (float)i / (float)candidates;
        int   id = all ? i : alias_sample(&lights->punctual, shifted - floorf(shifted));
        float target = punctual_target(&lights->scene->lights[id], position);
        float weight = all ? target : target / (lights->punctual.prob[id] * (float)candidates);
        if (!(weight > 0)) continue;
        sum += weight;
        if (*pick * sum < weight) { /* takes the newcomer with probability weight / sum */
            *pick = *pick * sum / weight;
            chosen = id;
            chosen_weight = target;
        } else {
            *pick = (*pick * sum - weight) / (sum - weight);
        }
        *pick = clampf(*pick, 0, 0x1.fffffep-1f);
    }
    *prob_inverse = chosen == NO_ID ? 0 : sum / chosen_weight;
    return chosen;
}

/* u[1] chooses only where there are many lights; u[2] then takes its place on an opening. */
static bool sample_punctual(const Lights *lights, Vec3 position, const float u[3],
                            LightSample *sample)
{
    float prob_inverse, pick = u[0];
    int   id = choose_punctual(lights, position, &pick, u[1], &prob_inverse);
    if (id == NO_ID) return false;
    const PunctualLight *light = &lights->scene->lights[id];
    const float on_opening[2] = {
        pick, lights->punctual.count <= PUNCTUAL_CANDIDATES ? u[1] : u[2]};
    float lux = has_opening(light)
                    ? opening_geometry(light, position, on_opening, &sample->wi,
                                       &sample->distance)
                    : punctual_geometry(light, position, &sample->wi, &sample->distance);
    sample->light_id = id;
    sample->scale = lux * prob_inverse;
    sample->pdf = 1;
    sample->is_delta = true;
    return true;
}

static Spectrum punctual_radiance(const PunctualLight *light, float scale,
                                  const Wavelengths *wavelengths)
{
    Spectrum white = light->white ? curve_lookup(light->white, wavelengths) : wavelengths->d65;
    return spectrum_from_rgb(wavelengths, light->intensity) * white * spectrum_all(scale);
}

/* ---- all sets ---------------------------------------------------------------------------- */

static bool sample_emitters(const Lights *lights, const LitPoint *from, const float u[3],
                            LightSample *sample)
{
    EmitterDensity density;
    EmitterPoint at = emitters_sample(&lights->emitters, lights->scene, from, u, &density);
    sample->point = triangle_point(lights->scene, at.triangle, at.u, at.v);
    Vec3  to_light = vec3_sub(sample->point.position, from->position);
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
    sample->ng = sample->point.ng;
    return sample->pdf > 0 && triangle_emits_to(lights->scene, at.triangle, &sample->point,
                                                vec3_neg(sample->wi));
}

static Spectrum emitter_radiance(const Scene *scene, const LightSample *sample,
                                 const Wavelengths *wavelengths)
{
    Hit hit = {0, sample->u, sample->v, sample->triangle};
    return triangle_emission(scene, sample->triangle, &sample->point, vec3_neg(sample->wi),
                             wavelengths) *
           spectrum_all(coverage_at(scene, &hit, &sample->point));
}

static bool sample_sun(const Lights *lights, const float u[3], LightSample *sample)
{
    sample->wi = sun_sample(&lights->sky, u[0], u[1]);
    sample->pdf = sun_pdf(&lights->sky, sample->wi);
    return sample->pdf > 0;
}

static bool sample_sky(const Lights *lights, Vec3 ns, const float u[3], LightSample *sample)
{
    SkySample sky;
    if (!sky_choose(&lights->sky, ns, u, &sky)) return false;
    sample->wi = sky.direction;
    sample->pdf = sky.pdf;
    sample->at = sky.at;
    return true;
}

bool lights_sample(const Lights *lights, LightSet set, LitPoint point, const float u[3],
                   LightSample *sample)
{
    sample->set = set;
    sample->distance = INFINITY;
    sample->is_delta = sample->is_emitter = false;
    switch (set) {
    case LIGHTS_SUN: return sample_sun(lights, u, sample);
    case LIGHTS_SKY: return sample_sky(lights, point.ns, u, sample);
    case LIGHTS_EMITTERS: return sample_emitters(lights, &point, u, sample);
    case LIGHTS_PUNCTUAL: return sample_punctual(lights, point.position, u, sample);
    case LIGHT_SETS: break;
    }
    return false;
}

Spectrum lights_radiance(const Lights *lights, const LightSample *sample,
                         const Wavelengths *wavelengths)
{
    const Scene *scene = lights->scene;
    SkySample    sky = {.direction = sample->wi, .at = sample->at};
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

void lights_distant(const Lights *lights, Vec3 direction, Vec3 ns,
                    const Wavelengths *wavelengths, Spectrum radiance[2], float pdf[2])
{
    SkySample seen = sky_seen(&lights->sky, direction, ns, wavelengths);
    radiance[LIGHTS_SUN] = sun_radiance(&lights->sky, direction, wavelengths);
    radiance[LIGHTS_SKY] = seen.radiance;
    pdf[LIGHTS_SUN] = sun_pdf(&lights->sky, direction);
    pdf[LIGHTS_SKY] = seen.pdf;
}

float lights_emitter_pdf(const Lights *lights, const LitPoint *from, const Hit *hit,
                         Vec3 direction, Vec3 ng)
{
    float cosine = fabsf(vec3_dot(ng, direction));
    EmitterDensity density =
        emitters_density(&lights->emitters, lights->scene, from,
                         (EmitterPoint){hit->triangle, hit->u, hit->v});
    return cosine > 1e-6f ? density.on_area * hit->t * hit->t / cosine + density.on_sphere : 0;
}

long lights_refused_pixels(const Lights *lights)
{
    return lights->sky.picture.refused_pixels;
}
