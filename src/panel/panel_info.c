#include "panel/panel_info.h"

#include <math.h>
#include <string.h>

#include "panel/panel_file.h"

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
           cos(theta) >= (double)r->cone_cos - 1e-6;
}
