/* SPDX-License-Identifier: Apache-2.0 */
/* metallic_surface.h -- what metallic_roughness is made of at one point of a surface.
 *
 * What each of them means to the picture: the user page on top of metallic_roughness.c.
 */
#pragma once
#include "base/vec.h"
#include "shaders/layers/clear_film.h"
#include "shaders/layers/coating.h"
#include "shaders/facets/coat.h"

#define CLEARCOAT_IOR 1.5f /* glTF's */

struct MetallicView; /* metallic_view.h */

/* All members are set by the caller; metallic_roughness_default() is a start. */
typedef struct MetallicRoughness {
    Spectrum base_color;       /* [0, 1]: albedo; of metals, reflectance at normal incidence */
    Spectrum specular_color;   /* >= 0: multiplies the dielectric's F0 */
    float    metallic;         /* [0, 1] */
    float    alpha;            /* GGX, [0, 1]; below SMOOTH_ALPHA a perfect mirror */
    float    alpha_along;      /* brushed: GGX along the frame's x, in [SMOOTH_ALPHA, 1]; then
                                  alpha is that along y, in the same range. 0: alpha */
    float    specular;         /* [0, 1]: strength of the dielectric's reflection */
    float    transmission;     /* [0, 1]: share of the non-metal that is a thin clear sheet */
    float    clearcoat;        /* [0, 1]: share that carries a lacquer of CLEARCOAT_IOR */
    float    clearcoat_alpha;  /* GGX, [0, 1] */
    Vec3     clearcoat_normal; /* unit, local frame; z > 0 */
    const EnergyTable *energy;           /* of the material's index of refraction */
    const EnergyTable *clearcoat_energy; /* of CLEARCOAT_IOR; NULL: clearcoat is 0 */
    const CoatTable   *coat;             /* of both; likewise */
    const SurfaceCoating *coating;       /* what reflects in place of the colours; NULL: none */
    const Wavelengths    *wavelengths;   /* NULL where coating is, without film, across and
                                             sheen */
    const OpticalConstants *film_metal; /* under a film; NULL: by the colour */
    ThinFilm film;        /* where there is no coating; share 0: none */
    bool  seen_from_back;                /* of a coated sheet */
    float across;          /* [0, 1]: share of diffuse light that leaves on the other side */
    float across_color[3]; /* its albedo, linear Rec.709, [0, 1]; wants wavelengths */
    float sheen_color[3];  /* linear Rec.709, [0, 1]; 0: no sheen. Wants wavelengths */
    float sheen_alpha;     /* [SHEEN_LEAST_ALPHA, 1] where there is a sheen */
    const struct MetallicView *seen; /* by bsdf_look; else NULL */
} MetallicRoughness;
