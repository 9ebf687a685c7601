/* SPDX-License-Identifier: Apache-2.0 */
#include "panel/query/panel_info.h"

#include <string.h>

#include "base/mathd.h"
#include "base/units.h"
#include "panel/query/panel_opened.h"

int panel_info_wavelengths(const Panel *panel, float nm[PANEL_INFO_WAVELENGTHS_MAX]) {
    if (!panel->reflection) return 0;
    memcpy(nm, panel->reflection->wavelength_nm, sizeof *nm * panel->reflection->wavelengths);
    return (int)panel->reflection->wavelengths;
}

int panel_info_incidences(const Panel *panel, double theta[PANEL_INFO_INCIDENCES_MAX]) {
    const PanelReflection *r = panel->reflection;
    int count = 0;
    for (uint32_t i = 0; r && i < r->steps; i++)
        if (!r->step[i].is_turned) theta[count++] = (double)r->step[i].theta;
    return count;
}

_Static_assert(PANEL_INFO_AZIMUTHS_MAX >= PANEL_AZIMUTHS_MAX, "room for every azimuth");
_Static_assert(PANEL_INFO_INCIDENCES_MAX >= PANEL_INCIDENCES_MAX, "and every incidence");

int panel_info_azimuths(const Panel *panel, double phi[PANEL_INFO_AZIMUTHS_MAX]) {
    const PanelReflection *r = panel->reflection;
    phi[0] = PI;
    if (!r || r->azimuths < 2) return r ? 1 : 0;
    for (uint32_t i = 0; i < r->azimuths; i++) phi[i] = (double)r->azimuth[i];
    return (int)r->azimuths;
}

double panel_info_reflection_cone(const Panel *panel) {
    return panel->reflection ? acos_d((double)panel->reflection->cone_cos) : 0;
}

/* ---- emission -------------------------------------------------------------------------- */

bool panel_info_emits(const Panel *panel) {
    return panel->emission != NULL;
}

int panel_info_levels(const Panel *panel, int primary, double code[PANEL_INFO_LEVELS_MAX]) {
    const PanelEmission *e = panel->emission;
    for (int i = 0; e && i < (int)e->level_count[primary]; i++)
        code[i] = (double)e->level[primary][i];
    return e ? (int)e->level_count[primary] : 0;
}

double panel_info_emission_cone(const Panel *panel) {
    return panel->emission ? acos_d((double)panel->emission->cone_cos) : 0;
}

_Static_assert(PANEL_EVENNESS_SPOTS >= SPOT_GROUND_MAX, "room for every spot");

int panel_spots(const Panel *panel, float place[PANEL_EVENNESS_SPOTS][2], int map[2]) {
    const PanelPlaces *places = panel->places;
    map[0] = map[1] = 0;
    if (!places) return 0;
    for (int i = 0; i < places->spots; i++) memcpy(place[i], places->ground.at[i], sizeof place[i]);
    if (places->map) map[0] = places->map->width, map[1] = places->map->height;
    return places->spots;
}
