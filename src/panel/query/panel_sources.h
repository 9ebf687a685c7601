/* SPDX-License-Identifier: Apache-2.0 */
/* panel_sources.h -- the four sources of a panel's light: red, green, blue and black. Private
 * to src/panel.
 *
 * Threads  pure functions of a constant Panel. HOT: no allocation, no libm.
 */
#pragma once
#include "panel/query/panel_components.h"
#include "spectrum/wavelengths.h"

#define PANEL_DARK (-1e4f) /* a logarithm of nothing */

/* ln X, Y, Z of each in a direction above the surface; a primary at code 0 is PANEL_DARK. */
void panel_source_logs(const Panel *panel, Vec3 direction, const float rgb[3],
                       PanelFloat4 logs[4]);

/* Their sum, never negative; and as a spectral radiance (panel_emission.h: units). */
void     panel_sources_xyz(const PanelFloat4 logs[4], float xyz[3]);
Spectrum panel_sources_spectrum(const Panel *panel, const PanelFloat4 logs[4],
                                const Wavelengths *wavelengths);

/* Within the measured cone? */
bool panel_sources_are_measured(const Panel *panel, Vec3 direction);
