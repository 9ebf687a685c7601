/* SPDX-License-Identifier: Apache-2.0 */
/* metallic_view.h -- what metallic_roughness is made of at one point of a surface, and that
 * point as one eye sees it.
 *
 * What each member means to the picture: the user page on top of metallic_roughness.c. The
 * view is what eval, sample and lobes need of wo alone. One vertex of a path evaluates them
 * several times: bsdf_look (bsdf.h) keeps it for all of them.
 */
#pragma once
#include "base/vec.h"
#include "shaders/facets/coat.h"
#include "shaders/layers/clear_film.h"
#include "shaders/layers/coating.h"
#include "shaders/layers/covered_lobe.h"
#include "shaders/layers/overlay.h"
#include "spectrum/fresnel.h"

struct MetallicView;

/* All members are set by the caller; metallic_roughness_default() is a start. */
typedef struct MetallicRoughness {
    Spectrum base_color;       /* [0, 1]: albedo; of metals, reflectance at normal incidence */
    Spectrum specular_color;   /* >= 0: multiplies the dielectric's F0 */
    float metallic;            /* [0, 1] */
    float alpha;               /* GGX, [0, 1]; below SMOOTH_ALPHA a perfect mirror */
    float alpha_along;         /* brushed: GGX along the frame's x, in [SMOOTH_ALPHA, 1]; then
                                  alpha is that along y, in the same range. 0: alpha */
    float specular;            /* [0, 1]: strength of the dielectric's reflection */
    float transmission;        /* [0, 1]: share of the non-metal that is a thin sheet */
    Spectrum tint;             /* [0, 1]: what the sheet's body lets through once along the
                                  normal of a facet */
    float clearcoat;           /* [0, 1]: share that carries a lacquer of CLEARCOAT_IOR */
    float clearcoat_alpha;     /* GGX, [0, 1] */
    Vec3 clearcoat_normal;     /* unit, local frame; z > 0 */
    const EnergyTable *energy; /* of the material's index of refraction */
    const EnergyTable *clearcoat_energy; /* of CLEARCOAT_IOR; NULL: clearcoat is 0 */
    const CoatTable *coat;               /* of both; likewise */
    const SurfaceCoating *coating;       /* what reflects in place of the colours; NULL: none */
    const Wavelengths *wavelengths;      /* NULL where coating is, without film, across and
                                            overlay */
    const OpticalConstants *film_metal;  /* under a film; NULL: by the colour */
    ThinFilm film;                       /* where there is no coating; share 0: none */
    bool seen_from_back;                 /* of a coated sheet */
    float across;          /* [0, 1]: share of diffuse light that leaves on the other side */
    float across_color[3]; /* its albedo, linear Rec.709, [0, 1]; needs wavelengths */
    Overlay overlay;       /* under the coat; needs wavelengths */
    const struct MetallicView *seen; /* by bsdf_look; else NULL */
} MetallicRoughness;

/* The non-metal's reflectance is f0 + rise * shape(angle). */
typedef struct MetallicFace {
    Spectrum f0, rise;
} MetallicFace;

/* Probabilities of the choices for one wo; they sum to one unless all are 0. */
typedef struct MetallicChoices {
    float coat, mirror, diffuse, through, across, overlay;
} MetallicChoices;

/* The coat's effect on light along one direction. */
typedef struct ThroughCoat {
    float open; /* share that its boundary lets pass */
    CoatShare share;
} ThroughCoat;

/* Light that neither overlay nor facets of a white base send out through the coat: the Lambert
 * base's or, of a metal, the rebound's. */
typedef struct CoveredRest {
    Spectrum base;
    float metal;
} CoveredRest;

/* A coat over what coat.h's tables do not know. */
typedef struct CoveredBase {
    Cover cover;
    Spectrum face[LOBE_FACETS]; /* of the non-metal, at facet_cosine */
    CoveredRest rest, mean;     /* towards wo; over the hemisphere */
} CoveredBase;

/* Layers that a surface does not have leave their members undefined. */
typedef struct MetallicView {
    const MetallicRoughness *m;
    Vec3 wo;
    MetallicFace boundary;
    MetallicChoices choices;
    Energy energy;       /* of the base towards wo */
    float coat;          /* the coat's albedo towards wo, times its share */
    ThroughCoat through; /* the coat, and of it all: */
    CoatMean coat_mean;
    Spectrum face_mean; /* of the non-metal over the hemisphere: its share in further turns */
    Spectrum lambert;   /* the factor of the Lambert base's light that depends on wo */
    Spectrum coated;    /* what a coated or filmed face sends back towards wo */
    Spectrum film[LOBE_FACETS];         /* filmed faces' reflectance at facet_cosine */
    OverlayShare overlay, overlay_mean; /* towards wo; over the hemisphere */
    CoveredBase covered;
} MetallicView;
