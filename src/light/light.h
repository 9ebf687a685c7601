/* SPDX-License-Identifier: Apache-2.0 */
/* light.h -- everything that emits: chooses a point of light, with its pdf.
 *
 * Lights come in four sets, each sampled by its own rule: the sun (its disc), the environment
 * (constant or HDRI), emitters (emissive triangles and displays), and punctual lights, both
 * by about what they give the point. Which sets a hit samples is the path's business
 * (path/direct.c).
 *
 * Units    radiance in W m^-2 sr^-1 nm^-1 per lane; for delta lights it is the
 *          irradiance on a plane that faces the light. pdf in sr^-1.
 * Memory   lights_build takes everything from the arena.
 * Threads  const after lights_build.
 */
#pragma once
#include "base/sampler.h"
#include "bvh/ray.h"
#include "light/emission.h"
#include "light/lit_point.h"
#include "light/punctual.h"
#include "scene/scene.h"
#include "spectrum/wavelengths.h"

typedef enum LightSet {
    LIGHTS_SUN,
    LIGHTS_SKY,
    LIGHTS_EMITTERS,
    LIGHTS_PUNCTUAL,
    LIGHT_SETS
} LightSet;

/* What a vertex may sample: the sets, and surfaces that the sun lights (path/sunlit.h). */
#define LIGHTS_SUNLIT LIGHT_SETS
#define LIGHT_CHOICES (LIGHT_SETS + 1)

typedef struct Lights Lights;

/* The scene must outlive the lights. Fails on an environment that cannot be lit yet. */
bool lights_build(const Scene *scene, Arena *arena, Lights **out, Error *err);

/* The same lights after displays of the scene changed their levels; what is not theirs is
 * shared with `before`. Returns `before` itself while all levels are within a quarter and four
 * times those that emitters were sorted by: then only the noise is a little higher. */
const Lights *lights_with_levels(const Lights *before, Arena *arena);

/* Has this set anything that emits? */
bool lights_has(const Lights *lights, LightSet set);

/* Does the moon take the place of LIGHTS_SUN? */
bool lights_sun_is_moon(const Lights *lights);

/* The middle of the disc of LIGHTS_SUN, unit, world, whether it is up or set; where there is
 * one. */
Vec3 lights_sun_direction(const Lights *lights);

/* Number of punctual lights that give any light. */
int lights_lamp_count(const Lights *lights);

/* The scene's id of the lamp `which`, in [0, lights_lamp_count). */
int lights_lamp_id(const Lights *lights, int which);

typedef struct LightSample {
    LightSet set;
    Vec3 wi;         /* unit, from the surface to the light */
    float distance;  /* m, to the light; INFINITY for sun, sky and directional lights */
    float pdf;       /* sr^-1; 1 for delta lights */
    bool is_delta;   /* a BSDF sample can never hit it */
    bool is_emitter; /* of a triangle; else triangle .. point are unset */
    uint32_t triangle;
    float u, v;          /* barycentric weights of the triangle's vertices 1 and 2 */
    TrianglePoint point; /* the geometry at u, v */
    Vec2 at;             /* of the sky: where in its picture */
    int light_id;        /* of a punctual light: which */
    float scale;         /* of a punctual light: lx per unit of its intensity, over its prob */
} LightSample;

/* The ray that shows whether a sample arrives at a place where a ray may start (ray_ends.h). It
 * ends just before a triangle; before a lamp without a body, which may stand in a surface, by a
 * ten thousandth of its distance. */
Ray lights_ray(Vec3 from, const LightSample *sample);

/* One sample of one set as seen from `point`. u in [0,1)^3. False: nothing comes from there. */
bool lights_sample(const Lights *lights, LightSet set, LitPoint point, const float u[3],
                   LightSample *sample);

/* The same of LIGHTS_PUNCTUAL, where it is known which of them light the point. */
bool lights_sample_known(const Lights *lights, const PunctualKnown *known, LitPoint point,
                         const float u[3], LightSample *sample);

/* A place where the light of a lamp of LIGHTS_PUNCTUAL starts, u in [0,1)^4; and how it lights a
 * place, as if the sample had been chosen with certainty (punctual.h). False: not at all. */
PunctualPoint lights_lamp_point(const Lights *lights, int light_id, const float u[4]);
bool lights_lamp_towards(const Lights *lights, const PunctualPoint *point, Vec3 place,
                         LightSample *sample);

/* As if LIGHTS_SKY's sample had chosen this direction, where there is a sky; its pdf may be
 * 0. */
void lights_sky_towards(const Lights *lights, Vec3 direction, Vec3 ns, LightSample *sample);

/* Radiance of a sample, to be evaluated once it is known to arrive: most are in shadow. */
Spectrum lights_radiance(const Lights *lights, const LightSample *sample,
                         const Wavelengths *wavelengths);

/* Illuminance, lx, by a sample that arrives; u in [0, 1) chooses the wavelengths. */
double lights_sample_lx(const Lights *lights, LitPoint point, const LightSample *light, float u);

/* Radiance of sun plus sky from a direction, and each one's sampling pdf as above.
 * radiance[0] the sun's, radiance[1] the sky's; likewise pdf. */
void lights_distant(const Lights *lights, Vec3 direction, Vec3 ns, const Wavelengths *wavelengths,
                    Spectrum radiance[2], float pdf[2]);

/* Is the sky's light from a direction polarised? *degree: in [0, 1]; *axis: unit, along which
 * the field oscillates: across the plane of the direction and the sun (daylight.h). */
bool lights_sky_polarisation(const Lights *lights, Vec3 direction, const Wavelengths *wavelengths,
                             Vec3 *axis, Spectrum *degree);

/* pdf, sr^-1, with which LIGHTS_EMITTERS chooses the point that a ray in `direction` from the
 * lit point `from` hit, at distance hit->t from there; ng: the triangle's normal. */
float lights_emitter_pdf(const Lights *lights, const LitPoint *from, const Hit *hit, Vec3 direction,
                         Vec3 ng);
