/* SPDX-License-Identifier: Apache-2.0 */
/* solid_pane.h -- two parallel faces of a clear solid, taken together: a pane that is thick.
 *
 * The user page is on top of solid_pane.c. Frame and units: bsdf.h.
 */
#pragma once
#include "shaders/layers/pane.h"
#include "shaders/solid_facet.h"

/* As light meets it from one direction: it answers for that alone. */
typedef struct SolidPane {
    Spectrum passed; /* share of the light that goes through, */
    Spectrum first;  /* that the near face reflects, */
    Spectrum ghosts; /* and that comes back by turns inside, */
    float along;     /* so far along the pane, m (BsdfSample) */
    float turn;      /* share of what is inside that goes to and fro once more, on the average */
    float ior;       /* for how light is polarised, */
    Spectrum body;   /* and what the body lets through once on this way */
    bool shows_itself;
} SolidPane;

typedef struct SolidPlate {
    const Dielectric *face; /* smooth, of an index above 0; the other one is like it */
    float cosine;           /* outside, (0, 1] */
    float depths;           /* thickness over the distance after which there is */
    Spectrum left;          /* so much left of the light */
    float sideways;         /* m along the plate, by which light comes once through it */
} SolidPlate;

void solid_pane_set(const SolidPlate *plate, SolidPane *out);

/* The index by which the plate bends the mean of the lanes. */
float solid_pane_index(const Dielectric *face);

extern const BsdfModel solid_pane_model;
