/* luminaire.h -- luminous intensities of a luminaire file as luminances of a flat panel.
 *
 * L(theta, phi) = I(gamma, C) / (A cos theta), theta = gamma: the luminous area A is taken as a
 * flat opening that looks along gamma = 0 (CIE 121, type C photometry). C-planes are counted
 * counter-clockwise in the plan, that is from behind: a viewer in front of the panel sees
 * them run clockwise from the right, phi = -C, unless an option says otherwise.
 *
 * Units    degrees, candela, square metres, lumens.
 * Memory   the arena's. Threads: no shared state.
 */
#pragma once
#include "base/file.h"
#include "import/set/import.h"
#include "spectrum/intensity_web.h"

#define LUMINAIRE_ANGLES_MAX 4096

typedef struct Luminaire {
    const char *file, *name; /* name may be NULL */
    int     planes, gammas;
    double *c_deg, *gamma_deg; /* rising */
    double *intensity_cd;      /* planes x gammas */
    bool    is_round;          /* one plane that serves every azimuth */
    double  mirror_deg[2];     /* planes about which the rest is mirrored; < 0: none */
    double  area_m2;           /* 0: the file does not say */
    double  stated_lm;         /* light of the luminaire that the file states; 0: none */
    const char *stated_as;     /* "lamp flux x light output ratio" */
    double  cct_k;             /* colour temperature; 0: the file does not plainly say */
    bool    has_tilt;          /* factors for a tilted lamp, which are not applied */
} Luminaire;

/* All directions, negative intensities as 0. Refuses a luminaire that sends out nothing. */
bool luminaire_web(const Luminaire *luminaire, Arena *arena, IntensityWeb *out, Error *err);

/* Adds the luminaire as a white table, with notes on its flux. */
bool luminaire_add(const Luminaire *luminaire, const ImportOptions *options, ImportSet *set,
                   Error *err);
