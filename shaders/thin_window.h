/* SPDX-License-Identifier: Apache-2.0 */
/* thin_window.h -- clear glass: a sheet without thickness.
 *
 * The user page is on top of thin_window.c. Frame and units: bsdf.h.
 */
#pragma once
#include "shaders/bsdf_model.h"
#include "shaders/layers/coating.h"

/* A smooth sheet with two parallel faces: a mirror image, and light straight through. */
typedef struct ThinWindow {
    Spectrum tint; /* [0, 1]: what the sheet's body lets through, at this angle */
    float    ior;  /* 1 or more */
    /* Tables of a coated sheet, seen from wo's side; NULL: bare. The tint multiplies. */
    const CoatingTable *reflectance, *transmittance;
    const Wavelengths  *wavelengths; /* NULL where it is bare */
} ThinWindow;

Spectrum thin_window_reflectance(const ThinWindow *window, float cosine);
Spectrum thin_window_transmittance(const ThinWindow *window, float cosine); /* tint included */
extern const BsdfModel thin_window_model;
