/* SPDX-License-Identifier: Apache-2.0 */
/* metallic_view.h -- metallic_roughness as one eye sees it.
 *
 * What eval, sample and lobes need of wo alone. One vertex of a path asks them several times:
 * bsdf_look (bsdf.h) keeps it for all of them.
 */
#pragma once
#include "shaders/layers/covered_lobe.h"
#include "shaders/metallic/metallic_surface.h"
#include "shaders/layers/sheen.h"

/* The non-metal's reflectance is f0 + rise * shape(angle). */
typedef struct MetallicFace {
    Spectrum f0, rise;
} MetallicFace;

/* Probabilities of the choices for one wo; they sum to one unless all are 0. */
typedef struct MetallicChoices {
    float coat, mirror, diffuse, through, across, sheen;
} MetallicChoices;

/* The coat's effect on light along one direction. */
typedef struct ThroughCoat {
    float     open; /* share that its boundary lets pass */
    CoatShare share;
} ThroughCoat;

/* Light that neither fibres nor facets of a white base send out through the coat: the Lambert
 * base's or, of a metal, the rebound's. */
typedef struct CoveredRest {
    Spectrum base;
    float    metal;
} CoveredRest;

/* A coat over what coat.h's tables do not know. */
typedef struct CoveredBase {
    Cover       cover;
    Spectrum    face[LOBE_FACETS]; /* of the non-metal, at facet_cosine */
    CoveredRest rest, mean;        /* towards wo; over the hemisphere */
} CoveredBase;

/* Layers that a surface does not have leave their members undefined. */
typedef struct MetallicView {
    const MetallicRoughness *m;
    Vec3            wo;
    MetallicFace    boundary;
    MetallicChoices choices;
    Energy          energy; /* of the base towards wo */
    float           coat;   /* the coat's albedo towards wo, times its share */
    ThroughCoat     through; /* the coat, and of it all: */
    CoatMean        coat_mean;
    Spectrum        lambert; /* the factor of the Lambert base's light that depends on wo */
    Spectrum        coated;  /* what a coated or filmed face sends back towards wo */
    Spectrum        film[LOBE_FACETS]; /* filmed faces' reflectance at facet_cosine */
    SheenShare      sheen, sheen_mean; /* towards wo; over the hemisphere */
    CoveredBase     covered;
} MetallicView;
