/* panel_info.h -- what commands and reports want to know of an opened panel.
 *
 * Units    radians, nm. Threads: any number. Fails: never.
 */
#pragma once
#include "panel/panel.h"

#define PANEL_INFO_WAVELENGTHS_MAX 256

/* The measured wavelengths of the reflection, rising; returns how many (0: none). */
int panel_info_wavelengths(const Panel *panel, float nm[PANEL_INFO_WAVELENGTHS_MAX]);

/* Within the measured incidences (the mirrored range below the first included) and the cone
 * of measured leaving directions? */
bool panel_info_brdf_is_measured(const Panel *panel, double incidence, double theta);
