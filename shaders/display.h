/* display.h -- light that a measured display reflects: its mirror, haze, lambertian part.
 *
 * The user page is on top of display.c. Frame: the display's own (panel.h). Units: bsdf.h.
 */
#pragma once
#include "panel/query/panel_reflection.h"
#include "shaders/bsdf_model.h"
#include "spectrum/wavelengths.h"

typedef struct DisplaySurface {
    const Panel *panel;
    PanelLanes   lanes; /* its reflection at the path's wavelengths */
} DisplaySurface;

extern const BsdfModel display_model;
