/* SPDX-License-Identifier: Apache-2.0 */
/* thin_film.h -- what a stack of thin layers between two media reflects and lets through.
 *
 * All waves between the boundaries are added up with their phases, for light polarised across
 * (s) and along (p) the plane of incidence. Layers are even and coherent; what lies in front
 * and behind is endless.
 * Units    wavelengths and thicknesses in nm; indices n + ik of a field e^(ikx - iwt), so that
 *          k >= 0 absorbs. Shares of the light are in [0, 1]; what neither reflects nor passes
 *          stays in the stack.
 * Source   Born and Wolf, "Principles of Optics", 1.6 (matrix of a stratified medium) and
 *          14.4 (films that absorb), in Parratt's recursion (Phys. Rev. 95, 1954): no layer is
 *          so thick that it overflows.
 * Threads  pure functions.  Fails  never.
 */
#pragma once
#include "spectrum/curve.h"

#define THIN_LAYERS_MAX 64

/* n and k over wavelength: n >= 0, k >= 0, never both 0. */
typedef struct OpticalConstants {
    Curve n, k;
} OpticalConstants;

typedef struct ThinLayer {
    OpticalConstants index;
    double thickness_nm; /* >= 0 */
} ThinLayer;

/* Which faces of a sheet carry a coating; the front is where the surface's normal points. */
typedef enum CoatedFaces { COATED_BOTH, COATED_FRONT, COATED_BACK } CoatedFaces;

/* A coating, from where the light comes inwards. */
typedef struct LayerStack {
    double outside; /* index of the medium in front, which absorbs nothing, > 0 */
    const ThinLayer *layers;
    int count;         /* 0 .. THIN_LAYERS_MAX */
    CoatedFaces faces; /* of sheets */
} LayerStack;

/* A layer or medium at one wavelength. */
typedef struct ThinMedium {
    double n, k, thickness_nm;
} ThinMedium;

/* A stack at one wavelength. The media in front and behind have no thickness. */
typedef struct ThinMedia {
    double nm;                              /* wavelength in vacuum */
    ThinMedium medium[THIN_LAYERS_MAX + 2]; /* in front (k = 0), layers, behind */
    int count;                              /* at least 2 */
} ThinMedia;

/* reflect_along + i reflect_turned is a_s times the conjugate of a_p, a the amplitudes of the
 * reflected waves over those of the coming one, each across its own way: a_p = way cross s. */
typedef struct ThinShares {
    double reflect_s, reflect_p, through_s, through_p;
    double reflect_along, reflect_turned;
} ThinShares;

/* The stack on a body of index n + ik at one wavelength, 360 to 830 nm; stack NULL: bare, in
 * air. */
void thin_film_media(const LayerStack *stack, ThinMedium body, int nm, ThinMedia *out);

/* The same seen from the other side; what is then in front must not absorb. */
void thin_film_reverse(ThinMedia *media);

/* cosine: of the angle of incidence in the medium in front, [0, 1]. */
ThinShares thin_film_at(const ThinMedia *media, double cosine);
