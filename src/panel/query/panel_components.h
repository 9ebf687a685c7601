/* SPDX-License-Identifier: Apache-2.0 */
/* panel_components.h -- the components of an emission at a direction: the tree's and the
 * spline's; and the light that they make. Private to src/panel.
 *
 * Threads  pure functions of a constant Panel. HOT: no allocation, no libm.
 */
#pragma once
#include "panel/query/panel_opened.h"
#include "spectrum/wavelengths.h"

typedef float PanelFloat4 __attribute__((vector_size(16), aligned(4), may_alias));

/* The components at a direction (PANEL_COMPONENTS_MAX floats, zero behind the last one);
 * returns cosine_power ln cos theta. */
float panel_components(const Panel *panel, Vec3 direction, float *components);

/* Adds the spline's components to out (stride floats). log_cos: ln of the direction's z,
 * held at PANEL_LEAST_COS. */
void panel_components_add_spline(const PanelSpline *spline, Vec3 direction, float log_cos,
                                 float *out);
#define PANEL_LEAST_COS 1e-4f

/* ---- the four sources of a panel's light: red, green, blue and black --------------------- */

#define PANEL_DARK (-1e4f) /* a logarithm of nothing */

/* ln X, Y, Z of each in a direction above the surface; a primary at code 0 is PANEL_DARK. */
void panel_source_logs(const Panel *panel, Vec3 direction, const float rgb[3], PanelFloat4 logs[4]);

/* Their sum, never negative; and as a spectral radiance (panel_emission.h: units). */
void panel_sources_xyz(const PanelFloat4 logs[4], float xyz[3]);
Spectrum panel_sources_spectrum(const Panel *panel, const PanelFloat4 logs[4],
                                const Wavelengths *wavelengths);

/* Within the measured cone? */
bool panel_sources_are_measured(const Panel *panel, Vec3 direction);
