/* SPDX-License-Identifier: Apache-2.0 */
#include "panel/set/synthetic_panel.h"

#include <math.h>

#include "base/mathd.h"
#include "base/units.h"
#include "text/json_view.h"
#include "spectrum/spectral_table.h"

#define COUNT(list) ((int)(sizeof(list) / sizeof *(list)))

static void default_levels(SyntheticEmission *emission)
{
    static const double levels[] = {31, 63, 95, 127, 159, 191, 223, 255};
    emission->level_count = COUNT(levels);
    for (int i = 0; i < COUNT(levels); i++) emission->level[i] = levels[i];
}

static SyntheticPanel synthetic_panel_defaults(void)
{
    SyntheticPanel panel = {.name = "synthetic panel", .note = "synthetic",
                            .pixels = {1920, 720}, .size_mm = {292, 109.5},
                            .refractive_index = 1.5};
    panel.emission.gamma = 2.2;
    panel.emission.cosine_power[0] = panel.emission.cosine_power[1] = 1;
    panel.emission.lobe_width = radians_from_degrees(10);
    default_levels(&panel.emission);
    panel.reflection.coating = 1;
    panel.reflection.haze_width = 0.05;
    panel.reflection.haze_power = 1.5;
    for (int i = 0; i < 6; i++) panel.reflection.incidence_deg[i] = 10 * (i + 1);
    for (int i = 0; i < 31; i++) panel.reflection.wavelength_nm[i] = 400 + 10 * i;
    panel.reflection.incidence_count = 6;
    panel.reflection.wavelength_count = 31;
    panel.instrument = (SyntheticInstrument){.theta_max_deg = 88, .theta_step_deg = 1,
        .phi_step_deg = 2, .fwhm_deg = 2, .seed = 1};
    return panel;
}

double synthetic_panel_spectrum(const SyntheticPrimary *primary, double nm)
{
    double sum = 0;
    for (int i = 0; i < primary->peak_count; i++) {
        double d = (nm - primary->peak_nm[i]) / primary->fwhm_nm[i];
        sum += primary->weight[i] * exp_d(-4 * log_d(2) * d * d);
    }
    return sum;
}

/* W_p: the spectrum as the CIE 1931 observer sees it, scaled to the primary's luminance. */
static void find_white_point(SyntheticPrimary *primary)
{
    double xyz[3] = {0, 0, 0};
    for (int i = 0; i < SPECTRAL_COUNT; i++) {
        double value = synthetic_panel_spectrum(primary, SPECTRAL_FIRST_NM + i);
        xyz[0] += value * (double)spectral_table[i].x;
        xyz[1] += value * (double)spectral_table[i].y;
        xyz[2] += value * (double)spectral_table[i].z;
    }
    for (int j = 0; j < 3; j++)
        primary->white_xyz[j] = primary->luminance_cd_m2 * xyz[j] / xyz[1];
}

static bool same_length(const JsonView *view, const int counts[3], Error *err)
{
    if (counts[0] == counts[1] && counts[0] == counts[2]) return true;
    return error_at(err, ERROR_INPUT, view->file, view->path,
                    "peaks_nm, fwhm_nm and weights have %d, %d and %d values, wanted equal",
                    counts[0], counts[1], counts[2]);
}

static bool read_primary(const JsonView *emission, const char *name, SyntheticPrimary *out,
                         Error *err)
{
    static const char *const keys[] = {"luminance_cd_m2", "peaks_nm", "fwhm_nm", "weights",
                                       "shift"};
    JsonView view;
    int      counts[3] = {0, 0, 0}, shifts = 3;
    out->luminance_cd_m2 = 100;
    if (!json_view_child(emission, name, true, &view, err) ||
        !json_view_check_keys(&view, keys, COUNT(keys), err) ||
        !json_view_number(&view, "luminance_cd_m2", 1e-3, 1e5, &out->luminance_cd_m2, err) ||
        !json_view_numbers(&view, "peaks_nm", (JsonRange){360, 830, SYNTHETIC_PEAKS_MAX},
                           out->peak_nm, &counts[0], err) ||
        !json_view_numbers(&view, "fwhm_nm", (JsonRange){2, 400, SYNTHETIC_PEAKS_MAX},
                           out->fwhm_nm, &counts[1], err) ||
        !json_view_numbers(&view, "weights", (JsonRange){1e-6, 1e6, SYNTHETIC_PEAKS_MAX},
                           out->weight, &counts[2], err) ||
        !json_view_numbers(&view, "shift", (JsonRange){-5, 5, 3},
                           out->shift, &shifts, err))
        return false;
    if (!same_length(&view, counts, err)) return false;
    if (!counts[0])
        return error_at(err, ERROR_INPUT, view.file, view.path, "key 'peaks_nm' is missing");
    out->peak_count = counts[0];
    find_white_point(out);
    return true;
}

static bool read_lobe(const JsonView *emission, SyntheticEmission *out, Error *err)
{
    static const char *const keys[] = {"theta_deg", "phi_deg", "width_deg", "gain"};
    JsonView view;
    double   theta = 40, phi = 90, width = 10;
    if (!json_view_child(emission, "lobe", false, &view, err) ||
        !json_view_check_keys(&view, keys, COUNT(keys), err) ||
        !json_view_number(&view, "theta_deg", 0, 90, &theta, err) ||
        !json_view_number(&view, "phi_deg", -360, 360, &phi, err) ||
        !json_view_number(&view, "width_deg", 0.5, 90, &width, err) ||
        !json_view_number(&view, "gain", 0, 1000, &out->lobe_gain, err))
        return false;
    out->lobe_theta = radians_from_degrees(theta);
    out->lobe_phi = radians_from_degrees(phi);
    out->lobe_width = radians_from_degrees(width);
    return true;
}

static bool read_levels(const JsonView *view, SyntheticEmission *out, Error *err)
{
    if (!json_view_numbers(view, "levels", (JsonRange){1, 255, SYNTHETIC_LEVELS_MAX},
                           out->level, &out->level_count, err))
        return false;
    for (int i = 1; i < out->level_count; i++)
        if (!(out->level[i] > out->level[i - 1]))
            return error_at(err, ERROR_INPUT, view->file, json_view_path(view, "levels"),
                            "%g follows %g, wanted rising levels", out->level[i],
                            out->level[i - 1]);
    return true;
}

static bool read_emission(const JsonView *root, SyntheticEmission *out, Error *err)
{
    static const char *const keys[] = {"red", "green", "blue", "gamma", "gamma_drop",
                                       "cosine_power", "black_cd_m2", "leak", "lobe", "levels"};
    JsonView view;
    int      powers = 2;
    return json_view_child(root, "emission", true, &view, err) &&
           json_view_check_keys(&view, keys, COUNT(keys), err) &&
           read_primary(&view, "red", &out->primary[0], err) &&
           read_primary(&view, "green", &out->primary[1], err) &&
           read_primary(&view, "blue", &out->primary[2], err) &&
           json_view_number(&view, "gamma", 0.3, 5, &out->gamma, err) &&
           json_view_number(&view, "gamma_drop", -1, 1, &out->gamma_drop, err) &&
           json_view_numbers(&view, "cosine_power", (JsonRange){0, 20, 2},
                           out->cosine_power, &powers, err) &&
           json_view_number(&view, "black_cd_m2", 0, 1000, &out->black_cd_m2, err) &&
           json_view_number(&view, "leak", 0, 1000, &out->leak, err) &&
           read_lobe(&view, out, err) && read_levels(&view, out, err);
}

static bool read_reflection(const JsonView *root, SyntheticReflection *out, Error *err)
{
    static const char *const keys[] = {"coating", "coating_blue", "haze_share", "haze_width",
        "haze_power", "floor_albedo", "incidence_deg", "wavelengths_nm"};
    JsonView view;
    if (!json_view_child(root, "reflection", false, &view, err)) return false;
    out->exists = view.object != NULL;
    return json_view_check_keys(&view, keys, COUNT(keys), err) &&
           json_view_number(&view, "coating", 0.01, 1, &out->coating, err) &&
           json_view_number(&view, "coating_blue", 0, 1, &out->coating_blue, err) &&
           json_view_number(&view, "haze_share", 0, 1, &out->haze_share, err) &&
           json_view_number(&view, "haze_width", 1e-3, 1, &out->haze_width, err) &&
           json_view_number(&view, "haze_power", 1.1, 10, &out->haze_power, err) &&
           json_view_number(&view, "floor_albedo", 0, 0.5, &out->lambertian_albedo, err) &&
           json_view_numbers(&view, "incidence_deg",
                             (JsonRange){0, 85, SYNTHETIC_INCIDENCES_MAX},
                           out->incidence_deg, &out->incidence_count, err) &&
           json_view_numbers(&view, "wavelengths_nm",
                             (JsonRange){360, 830, SYNTHETIC_WAVELENGTHS_MAX},
                             out->wavelength_nm, &out->wavelength_count, err);
}

static bool read_instrument(const JsonView *root, SyntheticInstrument *out, Error *err)
{
    static const char *const keys[] = {"theta_max_deg", "theta_step_deg", "phi_step_deg",
        "brdf_theta_step_deg", "brdf_phi_step_deg", "fwhm_deg", "noise_relative",
        "noise_cd_m2", "noise_brdf_sr", "seed"};
    JsonView view;
    bool ok = json_view_child(root, "instrument", false, &view, err) &&
        json_view_check_keys(&view, keys, COUNT(keys), err) &&
        json_view_number(&view, "theta_max_deg", 10, 89.5, &out->theta_max_deg, err) &&
        json_view_number(&view, "theta_step_deg", 0.05, 10, &out->theta_step_deg, err) &&
        json_view_number(&view, "phi_step_deg", 0.05, 30, &out->phi_step_deg, err);
    if (!ok) return false;
    out->brdf_theta_step_deg = out->theta_step_deg;
    out->brdf_phi_step_deg = out->phi_step_deg;
    return
        json_view_number(&view, "brdf_theta_step_deg", 0.05, 10, &out->brdf_theta_step_deg,
                         err) &&
        json_view_number(&view, "brdf_phi_step_deg", 0.05, 30, &out->brdf_phi_step_deg, err) &&
        json_view_number(&view, "fwhm_deg", 0.05, 10, &out->fwhm_deg, err) &&
        json_view_number(&view, "noise_relative", 0, 0.5, &out->noise_relative, err) &&
        json_view_number(&view, "noise_cd_m2", 0, 10, &out->noise_cd_m2, err) &&
        json_view_number(&view, "noise_brdf_sr", 0, 10, &out->noise_brdf_sr, err) &&
        json_view_number(&view, "seed", 0, 4294967295.0, &out->seed, err);
}

static bool read_spots(const JsonView *view, SyntheticPlaces *out, Error *err)
{
    JsonRange range = {0, 1, SYNTHETIC_SPOTS_MAX};
    int       rows = 0;
    if (!json_view_numbers(view, "u", range, out->u, &out->spots, err) ||
        !json_view_numbers(view, "v", range, out->v, &rows, err))
        return false;
    if (rows != out->spots)
        return error_at(err, ERROR_INPUT, view->file, view->path, "u and v have %d and %d "
                        "values, wanted equal: one pair a spot", out->spots, rows);
    for (int i = 0; i < rows; i++)
        for (int k = 0; k < i; k++)
            if (out->u[i] == out->u[k] && out->v[i] == out->v[k])
                return error_at(err, ERROR_INPUT, view->file, view->path,
                                "spots %d and %d are at one place", k, i);
    return true;
}

static bool read_places(const JsonView *root, SyntheticPlaces *out, Error *err)
{
    static const char *const keys[] = {"u", "v", "map", "slope", "mura", "mura_cycles", "tint",
        "clouding", "lobe_slope", "haze_slope", "bend_deg"};
    JsonView view;
    int      two = 2;
    double   map[2] = {0, 0}, bend = 0;
    if (!json_view_child(root, "places", false, &view, err)) return false;
    if (!view.object) return true;
    bool ok = json_view_check_keys(&view, keys, COUNT(keys), err) &&
        read_spots(&view, out, err) &&
        json_view_pair(&view, "map", 1, 2048, map, err) &&
        json_view_numbers(&view, "slope", (JsonRange){-0.9, 0.9, 2}, out->slope, &two, err) &&
        json_view_number(&view, "mura", -0.5, 0.5, &out->mura, err) &&
        json_view_numbers(&view, "mura_cycles", (JsonRange){0, 100, 2}, out->mura_cycles, &two,
                          err) &&
        json_view_number(&view, "tint", -0.5, 0.5, &out->tint, err) &&
        json_view_number(&view, "clouding", 0, 100, &out->clouding, err) &&
        json_view_number(&view, "lobe_slope", -1.9, 1.9, &out->lobe_slope, err) &&
        json_view_number(&view, "haze_slope", -1.9, 1.9, &out->haze_slope, err) &&
        json_view_number(&view, "bend_deg", -150, 150, &bend, err);
    if (!ok) return false;
    if (!(map[0] > 0) && !out->spots)
        return error_at(err, ERROR_INPUT, view.file, view.path,
                        "has neither spots ('u' and 'v') nor a 'map'");
    for (int k = 0; k < 2; k++) {
        out->map[k] = (int)map[k];
        if ((double)out->map[k] != map[k])
            return error_at(err, ERROR_INPUT, view.file, json_view_path(&view, "map"),
                            "is %g, wanted whole pixels", map[k]);
    }
    out->bend = radians_from_degrees(bend);
    return true;
}

/* At the edges the haze has the most: no more than all of what is reflected. */
static bool check_haze(const JsonView *root, const SyntheticPanel *panel, Error *err)
{
    double most = panel->reflection.haze_share * (1 + 0.5 * fabs(panel->places.haze_slope));
    if (!panel->reflection.exists || most <= 1) return true;
    return error_at(err, ERROR_INPUT, root->file, "/places/haze_slope", "is %g: at an edge "
                    "haze_share %g would be %g, wanted at most 1", panel->places.haze_slope,
                    panel->reflection.haze_share, most);
}

static bool read_members(const JsonView *root, SyntheticPanel *out, Error *err)
{
    static const char *const keys[] = {"panel", "note", "pixels", "size_mm",
        "refractive_index", "emission", "reflection", "instrument", "places",
        "polarisation", "subpixels"};
    return json_view_check_keys(root, keys, COUNT(keys), err) &&
           json_view_text(root, "panel", &out->name, err) &&
           json_view_text(root, "note", &out->note, err) &&
           json_view_pair(root, "pixels", 1, 65536, out->pixels, err) &&
           json_view_pair(root, "size_mm", 1, 1e5, out->size_mm, err) &&
           json_view_number(root, "refractive_index", 1, 3, &out->refractive_index, err) &&
           read_emission(root, &out->emission, err) &&
           read_reflection(root, &out->reflection, err) &&
           read_instrument(root, &out->instrument, err) &&
           read_places(root, &out->places, err) && check_haze(root, out, err) &&
           display_traits_read(root, out->pixels, &out->traits, err);
}

bool synthetic_panel_read(const char *file, Arena *arena, SyntheticPanel *out, Error *err)
{
    JsonView       root;
    SyntheticPanel panel = synthetic_panel_defaults();
    if (!json_view_open(file, arena, &root, err)) return false;
    bool ok = read_members(&root, &panel, err);
    json_view_close(&root);
    if (ok) *out = panel;
    return ok;
}
