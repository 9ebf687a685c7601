/* SPDX-License-Identifier: Apache-2.0 */
/* glazing.h -- a laminated pane: two mirror images, light straight through, dirt.
 *
 * The user page is on top of glazing.c. Frame and units: bsdf.h.
 */
#pragma once
#include "shaders/bsdf_model.h"
#include "shaders/layers/coating.h"
#include "spectrum/glazing.h"

typedef struct GlazedWindow {
    const Glazing *pane;
    Spectrum absorbance;        /* the pane's, of the path's wavelengths */
    float slope[2];             /* the wedge's: growth of the thickness along x and y */
    float bend[2][2];           /* 1/m, of a curved pane: by how much the unit normal +z grows along
                                 * x and y for a step along x, and for one along y; all 0: flat */
    bool front_is_up;           /* +z is the front's side */
    bool shows_itself;          /* bsdf_sample leaves out what passes: that is followed by itself */
    const PaneCoating *coating; /* of its faces; NULL: both are bare */
    const Wavelengths *wavelengths; /* NULL where they are bare */
} GlazedWindow;

extern const BsdfModel glazed_window_model;
