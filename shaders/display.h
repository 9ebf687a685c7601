/* display.h -- light that a measured display reflects: its mirror, its haze and its floor.
 *
 * The user page is on top of display.c. Frame: the display's own (panel.h). Units: bsdf.h.
 */
#pragma once
#include "panel/query/panel.h"
#include "shaders/bsdf_sample.h"

typedef struct DisplaySurface {
    const Panel       *panel;
    const Wavelengths *wavelengths; /* of this path; outlives the surface */
} DisplaySurface;

Spectrum display_eval(const DisplaySurface *display, Vec3 wo, Vec3 wi, float *pdf);
bool     display_sample(const DisplaySurface *display, Vec3 wo, const float u[3],
                        BsdfSample *sample);
bool     display_scatters(const DisplaySurface *display);
Spectrum display_albedo(const DisplaySurface *display, Vec3 wo);
