/* SPDX-License-Identifier: Apache-2.0 */
/* punctual.h -- lamps without a surface that a ray could hit: chosen by what they give a point.
 *
 * A few lamps are all evaluated. Many lie in a tree whose nodes have up to 16
 * branches: a branch is chosen by about what its lamps give together (their intensity in that
 * direction over the squared distance, times the cosine), down to a few that are evaluated.
 * Where it is known which lamps light a place, most choices are among these, each weighed by
 * the share of its light that arrives. The rest are chosen as if nothing were known; known
 * lamps that they find count nothing, so every lamp is found in one way only.
 *
 * Threads  const after punctual_build (punctual_build.h).
 */
#pragma once
#include "light/lit_point.h"
#include "light/opening.h"
#include "scene/scene.h"
#include "spectrum/spectrum.h"

#define PUNCTUAL_PROFILE_SIDE 17
#define PUNCTUAL_FEW 8 /* lamps that are all evaluated */

/* Intensity of a branch's lamps over all directions (world), relative to the largest of each,
 * added. Nodes over the octahedral map of the sphere. */
typedef struct PunctualProfile {
    float value[PUNCTUAL_PROFILE_SIDE * PUNCTUAL_PROFILE_SIDE];
} PunctualProfile;

#define PUNCTUAL_BRANCHES SPECTRUM_LANES
typedef struct PunctualNode PunctualNode;
struct PunctualNode {
    int count;
    Spectrum centre[3];      /* of the lamps, by intensity; m, scene */
    Spectrum spread2;        /* mean square distance of the lamps from it, m^2 */
    Spectrum radius;         /* m: none reaches farther from it */
    Spectrum power;          /* sum of the largest intensities, cd; 0 in lanes not used */
    Spectrum mean;           /* of the profile over all directions */
    Spectrum lux;            /* of directional lights, which have their own branch; else 0 */
    SpectrumMask is_distant; /* that branch */
    const PunctualProfile *profile[PUNCTUAL_BRANCHES]; /* NULL: alike in all directions */
    int first[PUNCTUAL_BRANCHES];                      /* of its lamps in the order, */
    int lamp_count[PUNCTUAL_BRANCHES];
    PunctualNode *child[PUNCTUAL_BRANCHES]; /* NULL: all are evaluated */
};

typedef struct PunctualLights {
    const PunctualLight *lights;
    int count;          /* 0: none gives any light */
    int *order;         /* light ids in the tree's order */
    PunctualNode *root; /* NULL: few */
} PunctualLights;

/* The lamps that are known to light a place, and how much of each one's light arrives. */
#define PUNCTUAL_KNOWN_MAX 8
typedef struct PunctualKnown {
    int count;                         /* 0: nothing is known */
    int id[PUNCTUAL_KNOWN_MAX];        /* of lights, each once */
    float arrives[PUNCTUAL_KNOWN_MAX]; /* share of its light, in (0, 1] */
    float others; /* share of the choices that go to all other lamps, in [0, 1); 0: there are
                     none */
} PunctualKnown;

/* One lamp as it was chosen. */
typedef struct PunctualSample {
    int light_id;
    Vec3 wi;        /* unit, towards it or a point of its opening */
    float distance; /* m; INFINITY of directional lights */
    float scale;    /* lx on a plane that faces it per unit of its colour's intensity, over the
                       choice's probability */
} PunctualSample;

/* known: the lamps that most choices are among; may be NULL. u in [0,1)^3. False: nothing
 * comes from there. */
bool punctual_sample(const PunctualLights *lights, const PunctualKnown *known,
                     const LitPoint *point, const float u[3], PunctualSample *sample);

/* Relative intensity towards a unit direction. Of a luminaire its web. Of a spot
 * KHR_lights_punctual's recommended cone: 1 inside the inner angle, 0 outside the outer, the
 * square of the linear ramp of the cosine between. */
float punctual_falloff(const PunctualLight *light, Vec3 from_light);

/* How far its opening reaches from its position, m; 0 of a point. */
float punctual_radius(const PunctualLight *light);

/* A place where a lamp's light starts, whoever it lights. */
typedef struct PunctualPoint {
    int light_id;
    bool is_distant;
    Vec3 at;              /* m, scene; is_distant: unit, towards it */
    OpeningPoint opening; /* in the luminaire's frame, from its position */
} PunctualPoint;

/* u in [0,1)^4 */
PunctualPoint punctual_point(const PunctualLight *light, int light_id, const float u[4]);

/* How it lights a place; over u the samples' mean is all of the lamp's light. False: nothing
 * goes there. */
bool punctual_towards(const PunctualLight *light, const PunctualPoint *point, Vec3 place,
                      PunctualSample *sample);
