/* SPDX-License-Identifier: Apache-2.0 */
/* HOT: no allocation, no lock, no libm. */
#include "path/unfollowed.h"

#include "base/units.h"

#define BLUR 0.1f /* radians, half the disc */
#define BLUR_SR (PI_F * BLUR * BLUR)
#define TIMES 4          /* the edge of a mirror hides half a disc; few paths meet it */
#define COMPACT_SR 1e-3f /* larger ones chance finds */
#define NEARBY 1.001f    /* a lamp may stand in a surface */

static double luminance(const PathState *path, Spectrum radiance) {
    float xyz[3] = {0};
    spectrum_add_xyz(path->wavelengths, radiance, xyz);
    return isfinite(xyz[1]) ? (double)xyz[1] : 0;
}

static bool is_in_disc(const PathState *path, const LightSample *light, float until) {
    return light->distance <= until &&
           vec3_dot(path->ray.direction, light->wi) >= 1 - 0.5f * BLUR * BLUR;
}

/* irradiance: on what faces the lamp at the last boundary. */
static double blurred(const PathState *path, Spectrum irradiance) {
    return luminance(path, path->throughput * irradiance * spectrum_all(TIMES / BLUR_SR));
}

static void add_lamps(PathState *path, Vec3 from, float until) {
    const Lights *lights = path->context->lights;
    static const float MIDDLE[4] = {0.5f, 0.5f, 0.5f, 0.5f};
    for (int i = 0; i < lights_lamp_count(lights); i++) {
        PunctualPoint lamp = lights_lamp_point(lights, lights_lamp_id(lights, i), MIDDLE);
        LightSample light;
        if (lights_lamp_towards(lights, &lamp, from, &light) && is_in_disc(path, &light, until))
            path->statistics->lost +=
                blurred(path, lights_radiance(lights, &light, path->wavelengths));
    }
}

static void add_emitters(PathState *path, Vec3 from, float until) {
    const PathContext *context = path->context;
    const CompactEmitters *emitters = &context->beams[BEAMS_OF_EMITTERS].emitters;
    static const float MIDDLE[3] = {0.5f, 0.5f, 0.5f};
    for (int i = 0; i < emitters->count; i++) {
        CompactPoint at = compact_emitter_point(context->scene, &emitters->list[i], MIDDLE);
        LightSample light;
        float m2, sr;
        if (!compact_emitter_towards(context->scene, &emitters->list[i], &at, from, &light, &m2) ||
            !is_in_disc(path, &light, until))
            continue;
        sr = m2 / (light.distance * light.distance);
        if (sr < COMPACT_SR)
            path->statistics->rare +=
                blurred(path, lights_radiance(context->lights, &light, path->wavelengths) *
                                  spectrum_all(sr));
    }
}

void unfollowed_add(PathState *path, float until) {
    Vec3 from = vec3_along(path->ray.origin, path->ray.direction, -path->straight);
    if (path->context->is_of_frame || path->manner.is_dark) return;
    if (unfollowed_lamps(path) && lights_has(path->context->lights, LIGHTS_PUNCTUAL))
        add_lamps(path, from, until * NEARBY);
    add_emitters(path, from, until * NEARBY);
}

void unfollowed_found(PathState *path, int part_id, Spectrum radiance) {
    const CompactEmitters *emitters = &path->context->beams[BEAMS_OF_EMITTERS].emitters;
    if (emitters->of_part && emitters->of_part[part_id] != NO_ID)
        path->statistics->rare -= TIMES * luminance(path, radiance);
}
