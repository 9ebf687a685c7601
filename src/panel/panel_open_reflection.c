/* Opening a panel file: what it reflects. */
#include <math.h>

#include "panel/panel_open.h"

static bool check_reflection(const PanelBytes *at, const PanelReflection *r)
{
    if (r->slices < 1 || r->slices > PANEL_SLICES_MAX || r->coefficients < 1 ||
        r->coefficients > PANEL_COEFFICIENTS_MAX || r->wavelengths < 1 ||
        r->wavelengths > PANEL_WAVELENGTHS_MAX ||
        r->padded_wavelengths != (r->wavelengths + 15) / 16 * 16 || r->is_cubic > 1 ||
        r->harmonics > PANEL_HARMONICS_MAX)
        return panel_refuse(at, "reflection", "a count is out of range");
    if (!(r->frame_exponent >= 1 && r->frame_exponent <= 4) ||
        !(r->refractive_index >= 1 && r->refractive_index <= 4) ||
        !(r->cone_cos >= 0 && r->cone_cos <= 1))
        return panel_refuse(at, "reflection", "frame, refractive index or cone out of range");
    if (!panel_rising(r->slice_theta, r->slices) ||
        !panel_rising(r->wavelength_nm, r->wavelengths) ||
        !panel_all_finite(r->slice_theta, r->slices) ||
        !panel_all_finite(r->wavelength_nm, r->wavelengths) ||
        !panel_all_finite(r->haze_albedo, PANEL_ANGLES) ||
        !(r->slice_theta[r->slices - 1] >= 0))
        return panel_refuse(at, "reflection", "incidences or wavelengths do not rise");
    if (!panel_all_finite(&r->first_theta, 2))
        return panel_refuse(at, "reflection", "holds a number that is not finite");
    return true;
}

/* For every whole nm the interval of measured wavelengths that holds it. */
static void index_wavelengths(Panel *panel)
{
    const PanelReflection *r = panel->reflection;
    int last = 0, intervals = (int)r->wavelengths - 1;
    for (int i = 0; i < SPECTRAL_COUNT; i++) {
        while (last + 1 < intervals &&
               r->wavelength_nm[last + 1] <= (float)(SPECTRAL_FIRST_NM + i))
            last++;
        panel->wavelength_index[i] = (int16_t)last;
    }
    for (int i = 0; i < intervals; i++)
        panel->wavelength_scale[i] = 1 / (r->wavelength_nm[i + 1] - r->wavelength_nm[i]);
}

bool panel_open_reflection(const PanelBytes *bytes, const Geodesic *geodesic, Arena *arena,
                           Panel *panel)
{
    PanelBytes at, tree;
    bool  found;
    if (!panel_find_section(bytes, PANEL_REFLECTION, 0, &at, &found)) return false;
    if (!found) return true;
    if (!panel_need_section(bytes, PANEL_REFLECTION_TREE, 0, &tree)) return false;
    const PanelReflection *r = (const PanelReflection *)at.data;
    if (at.size < sizeof *r) return panel_refuse(&at, "reflection", "is too short");
    if (!check_reflection(&at, r)) return false;
    size_t floats = (size_t)r->padded_wavelengths * (r->coefficients + PANEL_ANGLES) +
                    (size_t)PANEL_ANGLES * r->slices * r->coefficients * (1 + r->harmonics);
    if (at.size != sizeof *r + floats * sizeof(float))
        return panel_refuse(&at, "reflection", "has another size than its counts say");
    panel->reflection = r;
    panel->basis = (const float *)(at.data + sizeof *r);
    panel->mirror = panel->basis + (size_t)r->padded_wavelengths * r->coefficients;
    panel->reflection_profile =
        (PanelProfile){panel->mirror + (size_t)r->padded_wavelengths * PANEL_ANGLES,
                       (int)(r->slices * r->coefficients), (int)r->harmonics, false};
    if (!panel_all_finite(panel->basis, floats))
        return panel_refuse(&at, "reflection", "holds a number that is not finite");
    if (!tree_open(tree.data, tree.size, geodesic, &panel->reflection_tree, bytes->err))
        return error_prefix(bytes->err, "reflection tree") ||
               error_in_file(bytes->err, bytes->name);
    if (panel->reflection_tree.components != (int)(r->slices * r->coefficients))
        return panel_refuse(&at, "reflection", "does not fit its tree");
    index_wavelengths(panel);
    return panel_open_sampling(bytes, geodesic, arena, &panel->sampling);
}
