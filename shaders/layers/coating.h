/* SPDX-License-Identifier: Apache-2.0 */
/* coating.h -- what a coated boundary reflects and lets through, interpolated.
 *
 * Shares of light (unpolarised, but for panes and sheets) in [0, 1] over angle and wavelength
 * (360 to 830 nm, 1 nm), made of a stack of layers by coating_tables.h. Within 3e-4 of the
 * stack's own shares for coatings of some layers; where a stack of microns has a step of a few
 * nm, within 2e-2.
 *
 * Memory   120 KiB a table of some layers, at most 2 MiB; energies 3.7 MiB, at most 30.
 * Threads  const once built.
 */
#pragma once
#include "shaders/facets/energy.h"
#include "spectrum/curve.h"

typedef struct CoatingTable {
    int count; /* rows, spaced evenly in sqrt(cosine), 0..1; the thicker a stack, the
                  more: 65 to COATING_COSINES_MAX */
    const Curve *row;
} CoatingTable;

#define COATING_COSINES_MAX 1025
#define COATING_ENERGY_COSINES_MAX 513

#define COATING_PER_OCTAVE 3 /* rows of alpha; octaves are energy.h's */
#define COATING_ALPHAS (ENERGY_OCTAVES * COATING_PER_OCTAVE + 1)

/* Energies that a rough boundary of that reflectance sends back, as energy.h's tables. */
typedef struct CoatingEnergy {
    int count;                /* of cosines, as of the table; COATING_ENERGY_COSINES_MAX most */
    const Curve *directional; /* COATING_ALPHAS times count */
    Curve average[COATING_ALPHAS];
} CoatingEnergy;

/* Tables of a boundary between two media, over the cosine in the one of the smaller index; of
 * a pane's face, over the cosine outside. */
typedef struct CoatingTables {
    const CoatingTable *front;   /* reflectance, seen from outside */
    const CoatingTable *back;    /* seen from inside; NULL: a metal's */
    const CoatingTable *through; /* transmittance, the same both ways; NULL: a metal's */
    const CoatingTable *total;   /* reflectance beyond the critical angle, over
                                    k / (k + n cosine) with k^2 = (n sine)^2 - 1, n the ratio
                                    of the indices */
    const CoatingEnergy *energy; /* of front; NULL: not requested */
    Curve front_mean, back_mean, through_mean; /* over the hemisphere, weighted by the cosine */
} CoatingTables;

/* The two faces of a pane or thin sheet, of which one at least is coated: front is what each
 * reflects from outside, back from the glass, over the cosine outside. */
typedef struct PaneCoating {
    float ior;                       /* of the body over the medium outside */
    const CoatingTables *face[2][2]; /* the front's, the back's; of light s and p */
} PaneCoating;

/* A boundary's reflectance for light s and p, seen from outside, and the effect on its phases
 * (Waves of polarisation.h). */
typedef struct CoatingWaves {
    const CoatingTable *s, *p, *along, *turned;
} CoatingWaves;

/* The coating of each share of a material; NULL: that share is bare, or is none. */
typedef struct SurfaceCoating {
    const CoatingTables *metal, *face;             /* face: of opaque plastic and glass */
    const CoatingTables *solid;                    /* the boundary of a closed solid */
    const CoatingTables *cover;                    /* of a display */
    const PaneCoating *sheet, *pane;               /* of a thin sheet, of a laminated one */
    const CoatingWaves *metal_waves, *glass_waves; /* of metal; of face or cover; NULL:
                                                      polarisation is not requested */
} SurfaceCoating;

/* cosine in [0, 1]. */
Spectrum coating_at(const CoatingTable *table, const Wavelengths *wavelengths, float cosine);

/* cosine and alpha in [0, 1]. */
Spectrum coating_energy_at(const CoatingEnergy *energy, const Wavelengths *wavelengths,
                           float cosine, float alpha);
Spectrum coating_energy_average(const CoatingEnergy *energy, const Wavelengths *wavelengths,
                                float alpha);
