/* solid_facet.h -- what one facet of a solid's boundary reflects and lets through.
 *
 * For dielectric.c and solid_loss.c. Bare, coated, filmed. Threads: pure functions.
 */
#pragma once
#include "shaders/dielectric.h"

/* Directions as seen from wo's side: z > 0 is that side; eta is the other side's index over
 * this side's. */
typedef struct SolidRay {
    Vec3  wo, wi;
    float eta;
    bool  turned;
} SolidRay;

static inline SolidRay solid_ray(const Dielectric *d, Vec3 wo, Vec3 wi)
{
    if (wo.z > 0) return (SolidRay){wo, wi, d->ior, false};
    float eta = d->ior > 0 ? 1 / d->ior : 0; /* index 0 reflects everything (glTF) */
    return (SolidRay){vec3(wo.x, wo.y, -wo.z), vec3(wi.x, wi.y, -wi.z), eta, true};
}

static inline bool solid_is_brushed(const Dielectric *d)
{
    return d->alpha_along > 0;
}

static inline bool solid_has_film(const Dielectric *d)
{
    return d->film.share > 0;
}

/* A facet as light from wo finds it. */
typedef struct FacetShares {
    Spectrum reflected, through; /* the tint left out */
    float    prob;               /* of choosing to reflect: its share of the mean light */
    float    behind;             /* cosine of the refracted direction, 0: there is none */
} FacetShares;

static inline float reflect_prob(float reflected, float through)
{
    return reflected + through > 0 ? reflected / (reflected + through) : 0;
}

/* cosine: to the facet on wo's side. */
FacetShares solid_facet(const Dielectric *d, const SolidRay *s, float cosine);

/* What a filmed facet reflects of one lane, at that lane's s->eta. */
float solid_filmed_lane(const Dielectric *d, const SolidRay *s, int lane, float cosine);
