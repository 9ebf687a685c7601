/* SPDX-License-Identifier: Apache-2.0 */
#include "panel/query/panel_info.h"

#include <math.h>
#include <string.h>

#include "base/mathd.h"
#include "base/units.h"
#include "panel/query/panel_opened.h"

int panel_info_wavelengths(const Panel *panel, float nm[PANEL_INFO_WAVELENGTHS_MAX])
{
    if (!panel->reflection) return 0;
    memcpy(nm, panel->reflection->wavelength_nm, sizeof *nm * panel->reflection->wavelengths);
    return (int)panel->reflection->wavelengths;
}

bool panel_info_brdf_is_measured(const Panel *panel, double incidence, double theta)
{
    const PanelReflection *r = panel->reflection;
    return r && incidence <= (double)r->last_theta + 1e-6 &&
           cos_d(theta) >= (double)r->cone_cos - 1e-6;
}

int panel_info_incidences(const Panel *panel, double theta[PANEL_INFO_INCIDENCES_MAX])
{
    const PanelReflection *r = panel->reflection;
    int count = 0;
    for (uint32_t i = 0; r && i < r->steps; i++)
        if (!r->step[i].is_turned) theta[count++] = (double)r->step[i].theta;
    return count;
}

_Static_assert(PANEL_INFO_AZIMUTHS_MAX >= PANEL_AZIMUTHS_MAX, "room for every azimuth");
_Static_assert(PANEL_INFO_INCIDENCES_MAX >= PANEL_INCIDENCES_MAX, "and every incidence");

int panel_info_azimuths(const Panel *panel, double phi[PANEL_INFO_AZIMUTHS_MAX])
{
    const PanelReflection *r = panel->reflection;
    phi[0] = PI;
    if (!r || r->azimuths < 2) return r ? 1 : 0;
    for (uint32_t i = 0; i < r->azimuths; i++) phi[i] = (double)r->azimuth[i];
    return (int)r->azimuths;
}

double panel_info_reflection_cone(const Panel *panel)
{
    return panel->reflection ? acos_d((double)panel->reflection->cone_cos) : 0;
}

/* ---- emission -------------------------------------------------------------------------- */

bool panel_info_emits(const Panel *panel)
{
    return panel->emission != NULL;
}

int panel_info_levels(const Panel *panel, int primary, double code[PANEL_INFO_LEVELS_MAX])
{
    const PanelEmission *e = panel->emission;
    for (int i = 0; e && i < (int)e->level_count[primary]; i++)
        code[i] = (double)e->level[primary][i];
    return e ? (int)e->level_count[primary] : 0;
}

double panel_info_emission_cone(const Panel *panel)
{
    return panel->emission ? acos_d((double)panel->emission->cone_cos) : 0;
}

const float *panel_info_spectrum(const Panel *panel, int primary)
{
    return panel->primaries ? panel->primaries->spectrum[primary] : NULL;
}
