/* SPDX-License-Identifier: Apache-2.0 */
/* display.h -- light that a measured display reflects: its mirror, haze, lambertian part.
 *
 * The user page is on top of display.c. Frame: the display's own (panel.h). Units: bsdf.h.
 */
#pragma once
#include "panel/query/panel_place.h"
#include "panel/query/panel_reflection.h"
#include "shaders/bsdf_model.h"
#include "shaders/layers/coating.h"
#include "spectrum/wavelengths.h"

typedef struct DisplaySurface {
    const Panel *panel;
    PanelLanes lanes;          /* its reflection at the path's wavelengths */
    PanelMix mix;              /* several panels instead of the one, whose lanes are not used then;
                                  count 0: none */
    float matte;               /* share of its mirror that a modelled finish scatters; 0: none */
    float matte_alpha;         /* by facets of that GGX alpha, at least SMOOTH_ALPHA */
    const CoatingTable *cover; /* factor of its mirror (coating_of_cover); NULL: 1 */
    const CoatingWaves *waves; /* of the coated cover; NULL: as bare glass */
    const Wavelengths *wavelengths; /* NULL where cover is, and without a mix */
} DisplaySurface;

extern const BsdfModel display_model;
