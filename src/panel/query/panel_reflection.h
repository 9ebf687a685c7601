/* SPDX-License-Identifier: Apache-2.0 */
/* panel_reflection.h -- what a panel reflects at any angles (panel.h: frame and units). HOT.
 *
 * Threads  any number. Fails: never; a panel without reflection data is black.
 */
#pragma once
#include <stdbool.h>

#include "base/vec.h"
#include "panel/query/panel.h"
#include "spectrum/wavelengths.h"

/* Has reflection data? Without them a panel reflects nothing. */
bool panel_reflects(const Panel *panel);

/* The same at all wavelengths: one is measured, or all are alike (or it reflects nothing). */
bool panel_reflects_grey(const Panel *panel);

/* A panel's reflection at the wavelengths of a path: made once, evaluated any number of times.
 * It is worth a query and a half. */
#define PANEL_LANES_COEFFICIENTS 32
#define PANEL_LANES_TABLES 12 /* more of them are mixed in every query */
typedef struct PanelLanes {
    SpectrumMask interval; /* of measured wavelengths, that holds the lane */
    Spectrum t;            /* in it, 0 to 1: outside, the end value holds */
    bool has_one;          /* a single wavelength is measured */
    int second;            /* of at most 32 numbers: where a row's last 16 start; or -1 */
    bool has_means;
    Spectrum last_gloss; /* of the surface, at the last measured incidence */
    Spectrum basis[PANEL_LANES_COEFFICIENTS], mean[PANEL_LANES_TABLES];
} PanelLanes;

void panel_lanes(const Panel *panel, const Wavelengths *wavelengths, PanelLanes *out);

/* panel_brdf and panel_mirror at lanes that are made already. */
Spectrum panel_brdf_at(const Panel *panel, Vec3 wo, Vec3 wi, const PanelLanes *lanes);
Spectrum panel_mirror_at(const Panel *panel, float cos_theta, const PanelLanes *lanes);

/* The lambertian part of a BRDF that panel_brdf_at returned for light from wi, sr^-1 per
 * lane, 0 to brdf; the rest is haze. It is the floor that the panel file keeps for each
 * incidence of the light: nearly the least that was measured within 60 degrees of the normal
 * (src/panel/fit). One for all wo, and thus not reciprocal by itself; beyond the last
 * measured incidence it stays. */
Spectrum panel_lambertian_at(const Panel *panel, Spectrum brdf, Vec3 wi, const PanelLanes *lanes);

/* BRDF without the mirror part, sr^-1 per lane. wo: to the eye, wi: to the light. 0 when
 * either is below the surface. */
Spectrum panel_brdf(const Panel *panel, Vec3 wo, Vec3 wi, const Wavelengths *wavelengths);

/* Is that BRDF measured: are the light within the measured incidences (the mirrored range below
 * the first included) and wo in the hull of the samples there, or the two exchanged? All else
 * is extrapolated: outside the hull the value on its edge is held; beyond the last incidence,
 * where the two exchanged were not measured either, the haze moves on and the lambertian part
 * stays. Between two incidences both hulls have to hold wo. */
bool panel_brdf_is_measured(const Panel *panel, Vec3 wo, Vec3 wi);

/* Mirror reflectance (delta part), per lane, for a direction at cos_theta to the normal. */
Spectrum panel_mirror(const Panel *panel, float cos_theta, const Wavelengths *wavelengths);

/* Directional-hemispherical reflectance without the mirror part, mean over the lanes'
 * luminous weight: the probability of haze against mirror. */
float panel_haze_albedo(const Panel *panel, float cos_theta);
