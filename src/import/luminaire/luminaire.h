/* SPDX-License-Identifier: Apache-2.0 */
/* luminaire.h -- luminous intensities of a luminaire file as luminances of a flat panel.
 *
 * L(theta, phi) = I(theta, phi) / (A cos theta): the luminous area A is taken as a flat opening
 * that looks along gamma = 0 (CIE 121, type C photometry), in types A and B along (0, 0).
 * C-planes are counted counter-clockwise in the plan, that is from behind: a viewer in front of
 * the panel sees them run clockwise from the right, phi = -C, unless an option says otherwise.
 * In types A and B the viewer's up, phi = 90, is V = 90.
 *
 * Angles are those of spectrum/intensity_web.h: of types A and B c_deg is the longitude, and
 * gamma_deg the latitude plus 90.
 *
 * Units    degrees, candela, square metres, lumens.
 * Memory   the arena's. Threads: no shared state.
 */
#pragma once
#include "base/file.h"
#include "import/set/import.h"
#include "spectrum/intensity_web.h"
#include "spectrum/luminous_opening.h"

#define LUMINAIRE_ANGLES_MAX 4096
#define LUMINAIRE_DOUBTS_MAX 12

/* Factors on the lamps' light when they are tilted (LM-63). */
typedef struct LuminaireTilt {
    const char *file; /* TILT=FILE: where the rest stands, as the luminaire's file writes it;
                         NULL: here, or nowhere */
    int geometry;     /* how the lamps lie: 1 vertical, 2 along C = 0, 3 along C = 90; 0: no
                         factors */
    int count;
    double *angle_deg; /* rising, 0 to 180 */
    double *factor;
} LuminaireTilt;

typedef struct Luminaire {
    const char *file, *name; /* name may be NULL */
    WebType type;
    int planes, gammas;
    double *c_deg, *gamma_deg; /* rising; of types A and B c_deg goes from -90 to 90 at most */
    double *intensity_cd;      /* planes x gammas */
    bool is_round;             /* one plane that serves every azimuth */
    double mirror_deg[2];      /* planes about which the rest is mirrored; < 0: none */
    LuminousOpening opening;   /* a point where the file has none */
    double area_m2;            /* that it shows to the front; 0: not in the file */
    double stated_lm;          /* light of the luminaire that the file states; 0: none */
    const char *stated_as;     /* "lamp flux x light output ratio" */
    double cct_k;              /* colour temperature; 0: the file states no clear one */
    const char *cct_text;      /* the file's text about colour; "": none */
    LuminaireTilt tilt;
    const char *doubt[LUMINAIRE_DOUBTS_MAX]; /* what cannot be as the file has it, and what is
                                                assumed: for the user */
    int doubts;
} Luminaire;

/* Adds a doubt; beyond LUMINAIRE_DOUBTS_MAX it is left out. */
void luminaire_doubt(Luminaire *luminaire, Arena *arena, const char *format, ...)
    __attribute__((format(printf, 3, 4)));

/* Share of the intensities that are left where `down`, a unit vector, is vertical in the
 * luminaire's frame: the factor at the angle between each lamp's own axis and where that is in
 * a luminaire that is not tilted, linear between the file's angles. Factors up to 90 degrees
 * count for both ends of a lamp. *angle_deg: that angle. 1 without factors. */
double luminaire_tilt_factor(const LuminaireTilt *tilt, WebType type, Vec3 down, double *angle_deg);

/* Light in all directions, lm. */
double luminaire_flux(const Luminaire *luminaire, Arena scratch);

/* All directions. Refuses a luminaire that sends out nothing. */
bool luminaire_web(const Luminaire *luminaire, Arena *arena, IntensityWeb *out, Error *err);

/* Adds the luminaire as a white table, with notes on its flux. */
bool luminaire_add(const Luminaire *luminaire, const ImportOptions *options, ImportSet *set,
                   Error *err);
