/* SPDX-License-Identifier: Apache-2.0 */
/* solid_facet.h -- the boundary of a solid, what one facet of it reflects and lets through, and
 * what rough facets pass to one another.
 *
 * For dielectric.c, whose user page gives the parameters. Bare, coated, filmed. Frame: bsdf.h.
 * Threads: pure functions.
 */
#pragma once
#include "shaders/bsdf_model.h"
#include "shaders/layers/clear_film.h"
#include "shaders/layers/coating.h"
#include "shaders/facets/solid_energy.h"

/* Where a solid ends. The frame's +z is the outside: wo.z < 0 is an eye inside the solid. */
typedef struct Dielectric {
    Spectrum tint;     /* [0, 1]: of transmitted light, at each crossing */
    float ior;         /* of the solid against its surroundings, > 0; 0: reflects everything */
    float alpha;       /* GGX, [0, 1]; below SMOOTH_ALPHA smooth */
    float alpha_along; /* brushed: GGX along the frame's x, in [SMOOTH_ALPHA, 1]; then alpha
                          is that along y, in the same range. 0: alpha */
    ThinFilm film;     /* in air, without a coating; share 0: none */
    const CoatingTables *coating;   /* of that boundary; NULL: bare */
    const Wavelengths *wavelengths; /* NULL where there is no coating, film or index */
    const Curve *index;             /* by wavelength, 1 or more, in place of ior; NULL: it is
                                       the same for all. Without a coating */
    /* Light that rough facets pass to one another, by tables for that ior; where the index
     * differs by wavelength, for its least and its greatest; brushed facets need
     * energy->brushed. NULL: it is lost; a smooth boundary has none. */
    const SolidEnergy *energy, *energy_most;
    const Spectrum *light; /* of a dispersive path: what its lanes still count, >= 0;
                              chance follows it. NULL: all alike */
} Dielectric;

extern const BsdfModel dielectric_model;

/* Directions as seen from wo's side: z > 0 is that side; eta is the other side's index over
 * this side's. */
typedef struct SolidRay {
    Vec3 wo, wi;
    float eta;
    bool turned;
} SolidRay;

static inline SolidRay solid_ray(const Dielectric *d, Vec3 wo, Vec3 wi) {
    if (wo.z > 0) return (SolidRay){wo, wi, d->ior, false};
    float eta = d->ior > 0 ? 1 / d->ior : 0; /* index 0 reflects everything (glTF) */
    return (SolidRay){vec3(wo.x, wo.y, -wo.z), vec3(wi.x, wi.y, -wi.z), eta, true};
}

static inline bool solid_is_brushed(const Dielectric *d) {
    return d->alpha_along > 0;
}

/* The alphas along x and y. */
static inline Vec2 solid_alphas(const Dielectric *d) {
    return (Vec2){solid_is_brushed(d) ? d->alpha_along : d->alpha, d->alpha};
}

static inline bool solid_has_film(const Dielectric *d) {
    return d->film.share > 0;
}

/* A facet as light from wo finds it. */
typedef struct FacetShares {
    Spectrum reflected, through; /* the tint left out */
    float prob;                  /* of choosing to reflect: its share of the mean light */
    float behind;                /* cosine of the refracted direction, 0: there is none */
} FacetShares;

static inline float reflect_prob(float reflected, float through) {
    return reflected + through > 0 ? reflected / (reflected + through) : 0;
}

/* cosine: to the facet on wo's side. */
FacetShares solid_facet(const Dielectric *d, const SolidRay *s, float cosine);

/* Reflectance of a filmed facet for one lane, at that lane's s->eta. */
float solid_filmed_lane(const Dielectric *d, const SolidRay *s, int lane, float cosine);

/* ---- what rough facets pass to one another, coming out at last ---------------------------
 *
 * By the tables of facets/solid_energy.h, which d->energy must hold (where facets are brushed
 * its `brushed` as well): both sides get lost(wo) lost(wi) / mean of it. Coated and filmed
 * facets as well, and dispersive glass. */

/* Adds this light to what single facets send, and to the density. */
void solid_loss_add(const Dielectric *d, const SolidRay *s, Spectrum *value, float *pdf);

/* Chooses s->wi for it if u[2] falls on its share; else false, and u[2] is uniform again. */
bool solid_loss_sample(const Dielectric *d, SolidRay *s, float u[3]);
