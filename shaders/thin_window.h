/* SPDX-License-Identifier: Apache-2.0 */
/* thin_window.h -- clear glass: a sheet without thickness.
 *
 * The user page is on top of thin_window.c. Frame and units: bsdf.h.
 */
#pragma once
#include "shaders/bsdf_model.h"
#include "shaders/layers/pane.h"

/* A smooth sheet with two parallel faces: a mirror image, and light straight through. */
typedef struct ThinWindow {
    Spectrum tint;              /* [0, 1]: what the sheet's body lets through along its normal */
    float ior;                  /* over that of the medium about it */
    const PaneCoating *coating; /* NULL: bare */
    const Wavelengths *wavelengths; /* NULL where it is bare */
    bool front_is_met;              /* of a coated one: on wo's side */
} ThinWindow;

Spectrum thin_window_reflectance(const ThinWindow *window, float cosine);
Spectrum thin_window_transmittance(const ThinWindow *window, float cosine); /* tint included */
extern const BsdfModel thin_window_model;
