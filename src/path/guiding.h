/* SPDX-License-Identifier: Apache-2.0 */
/* guiding.h -- how a vertex of a path looks for light: by its surface, by a guide, or by both.
 *
 * Where the surface scatters widely and there is a guide, a direction is the guide's choice
 * with the probability `mix`, else the surface's own: one-sample multiple importance sampling
 * (Veach 1997, 9.2.4). The guide's cell then decides how often each set of lights is sampled,
 * too, and where the cell sees the sky: with the probability `sky_mix` a direction to the sky
 * is the guide's choice, else the sky's own.
 *
 * Threads  plain values; the context must outlive them.
 */
#pragma once
#include "path/path_context.h"

_Static_assert(PUNCTUAL_KNOWN_MAX == GUIDE_LAMPS, "a cell's lamps are what is known");
_Static_assert(LIGHT_CHOICES == GUIDE_LIGHTS, "cells of a guide know all there is to sample");

/* From this bounce on lights are sampled less often: what they add is dim by then. */
#define DEEP_BOUNCE 2
#define DEEP_SHARE 0.4f

typedef struct Guiding {
    float mix;
    bool is_wide;       /* the surface scatters widely, and there is a guide */
    const float *asked; /* probability of sampling each set of lights, times this: */
    float often;
    float sky_mix;
    PunctualKnown lamps; /* that light the place; count 0: not known */
    GuideView view;      /* unset where both mixes are 0 */
} Guiding;

/* wo: unit, world. bounce: scattering vertices before this one. */
void guiding_at(const PathContext *context, const Surface *surface, Vec3 wo, int bounce,
                Guiding *guiding);

/* Guiding without a guide: lights are always sampled. */
void guiding_none(const PathContext *context, Guiding *guiding);

/* Guiding at a white surface that faces ns, in a cell of the context's guide. */
void guiding_of_white(const PathContext *context, uint32_t cell, Vec3 ns, Guiding *guiding);

/* HOT. As lights_sample, but the guide chooses directions to the sky and lamps, and the
 * sample's pdf is right only after guiding_weigh_light: samples in shadow do not need it. */
bool guiding_choose_light(const Guiding *guiding, const Lights *lights, LightSet set,
                          LitPoint point, const float u[3], LightSample *sample);
void guiding_weigh_light(const Guiding *guiding, const Lights *lights, LitPoint point,
                         LightSample *sample);

/* HOT. Density with which guiding_choose_light chooses a direction to the sky that the sky's
 * own samples find with `own`, sr^-1. */
float guiding_sky_pdf(const Guiding *guiding, Vec3 wi, float own);

/* HOT. Density of choosing wi (world) where the surface alone would with bsdf_pdf, sr^-1. */
float guiding_pdf(const Guiding *guiding, Vec3 wi, float bsdf_pdf);

/* HOT. A direction in the surface's frame; u in [0, 1)^3. False: absorbed. */
bool guiding_sample(const Guiding *guiding, const Surface *surface, const float u[3],
                    BsdfSample *next);
