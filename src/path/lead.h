/* lead.h -- how a vertex of a path looks for light: by its surface, by a guide, or by both.
 *
 * Where the surface scatters widely and there is a guide, a direction is the guide's choice
 * with the probability `mix`, else the surface's own: one-sample multiple importance sampling
 * (Veach 1997, 9.2.4). The guide's cell then tells how often each set of lights is asked, too.
 *
 * Threads  plain values; the context must outlive them.
 */
#pragma once
#include "path/path_context.h"

_Static_assert(LIGHT_SETS == GUIDE_LIGHTS, "cells of a guide know all sets of lights");

/* From this bounce on lights are sampled less often: what they add is dim by then. */
#define DEEP_BOUNCE 2
#define DEEP_SHARE 0.4f

typedef struct Lead {
    float        mix;
    bool         is_wide; /* the surface scatters widely, and there is a guide */
    const float *asked;   /* how often each set of lights is sampled, times this: */
    float        often;
    GuideView    view;    /* unless mix is 0 */
} Lead;

/* wo: unit, world. bounce: scattering vertices before this one. */
void lead_at(const PathContext *context, const Surface *surface, Vec3 wo, int bounce,
             Lead *lead);

/* HOT. Density of choosing wi (world) where the surface alone would with bsdf_pdf, sr^-1. */
float lead_pdf(const Lead *lead, Vec3 wi, float bsdf_pdf);

/* HOT. A direction, local as local_wo; u in [0, 1)^3. False: absorbed. */
bool lead_sample(const Lead *lead, const Surface *surface, Vec3 local_wo, const float u[3],
                 BsdfSample *next);
