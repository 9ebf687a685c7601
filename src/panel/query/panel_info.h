/* SPDX-License-Identifier: Apache-2.0 */
/* panel_info.h -- what commands and reports report of an opened panel.
 *
 * Units    radians, nm. Threads: any number. Fails: never.
 */
#pragma once
#include <stdbool.h>

#include "panel/query/panel.h"

#define PANEL_INFO_WAVELENGTHS_MAX 256

/* The measured wavelengths of the reflection, rising; returns how many (0: none). */
int panel_info_wavelengths(const Panel *panel, float nm[PANEL_INFO_WAVELENGTHS_MAX]);

/* Incidences of the light that were measured, radians, rising; returns how many. */
#define PANEL_INFO_INCIDENCES_MAX 64
int panel_info_incidences(const Panel *panel, double theta[PANEL_INFO_INCIDENCES_MAX]);

/* Azimuths of the light at each of them, radians; 1 (pi): the same from all sides. */
#define PANEL_INFO_AZIMUTHS_MAX 72
int panel_info_azimuths(const Panel *panel, double phi[PANEL_INFO_AZIMUTHS_MAX]);

/* The last measured theta of leaving directions, of all tables; some may be measured to there
 * on one side only (panel_brdf_is_measured). */
double panel_info_reflection_cone(const Panel *panel);

/* ---- emission -------------------------------------------------------------------------- */

/* Something was measured that it emits? */
bool panel_info_emits(const Panel *panel);

/* The measured codes of primary 0..2, rising, without 0; returns how many. */
#define PANEL_INFO_LEVELS_MAX 64
int panel_info_levels(const Panel *panel, int primary, double code[PANEL_INFO_LEVELS_MAX]);

/* The last measured theta. */
double panel_info_emission_cone(const Panel *panel);

/* ---- places ---------------------------------------------------------------------------- */

/* Places of the spots that were measured, at most PANEL_EVENNESS_SPOTS; and the map's pixels,
 * 0 x 0 without one. Returns how many spots. */
#define PANEL_EVENNESS_SPOTS 49
int panel_spots(const Panel *panel, float place[PANEL_EVENNESS_SPOTS][2], int map[2]);
