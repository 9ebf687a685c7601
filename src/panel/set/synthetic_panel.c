/* SPDX-License-Identifier: Apache-2.0 */
#include "panel/set/synthetic_panel.h"

#include <math.h>
#include <string.h>

#include "base/count.h"
#include "base/mathd.h"
#include "base/units.h"
#include "spectrum/fresnel.h"
#include "spectrum/spectral_table.h"
#include "text/json_view.h"

static void default_levels(SyntheticEmission *emission)
{
    static const double levels[] = {31, 63, 95, 127, 159, 191, 223, 255};
    emission->level_count = COUNT_OF(levels);
    for (int i = 0; i < COUNT_OF(levels); i++) emission->level[i] = levels[i];
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
        !json_view_check_keys(&view, keys, COUNT_OF(keys), err) ||
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
        !json_view_check_keys(&view, keys, COUNT_OF(keys), err) ||
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
           json_view_check_keys(&view, keys, COUNT_OF(keys), err) &&
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
    return json_view_check_keys(&view, keys, COUNT_OF(keys), err) &&
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
        json_view_check_keys(&view, keys, COUNT_OF(keys), err) &&
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
    bool ok = json_view_check_keys(&view, keys, COUNT_OF(keys), err) &&
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
    return json_view_check_keys(root, keys, COUNT_OF(keys), err) &&
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
    panel.file = arena_string(arena, file, strlen(file));
    if (ok) *out = panel;
    return ok;
}

/* ---- the exact values -------------------------------------------------------------------- */

/* F of the cover, held where rounding leaves the range of a cosine. */
static double cover_fresnel(const SyntheticPanel *panel, double cosine)
{
    return fresnel_unpolarised_d(fmin(1, fabs(cosine)), panel->refractive_index);
}

/* Angle between two directions, exact also when it is small. */
static double angle_between(const double a[2], const double b[2])
{
    double dt = sin_d(0.5 * (a[0] - b[0])), dp = sin_d(0.5 * (a[1] - b[1]));
    double h = dt * dt + sin_d(a[0]) * sin_d(b[0]) * dp * dp;
    return 2 * asin_d(sqrt(h > 1 ? 1 : h));
}

/* A of synthetic_panel.h. */
static double angular_falloff(const SyntheticPanel *panel, const double angles[2])
{
    const SyntheticEmission *e = &panel->emission;
    double c = cos_d(angles[0]), cp = cos_d(angles[1]);
    double power = e->cosine_power[0] * cp * cp + e->cosine_power[1] * (1 - cp * cp);
    double through = (1 - cover_fresnel(panel, c)) / (1 - cover_fresnel(panel, 1));
    double lobe = 0;
    if (e->lobe_gain > 0) {
        double d = angle_between(angles, (double[2]){e->lobe_theta, e->lobe_phi});
        lobe = e->lobe_gain * exp_d(-0.5 * d * d / (e->lobe_width * e->lobe_width));
    }
    return pow_d(c > 0 ? c : 0, power) * through * (1 + lobe);
}

SyntheticPanel closed_form_at(const SyntheticPanel *panel, const double place[2])
{
    const SyntheticPlaces *p = &panel->places;
    SyntheticPanel out = *panel;
    double x = place[0] - 0.5, y = place[1] - 0.5;
    double wave = cos_d(2 * PI * p->mura_cycles[0] * x) * cos_d(2 * PI * p->mura_cycles[1] * y);
    double even = (1 + p->slope[0] * x + p->slope[1] * y) * (1 + p->mura * wave);
    double tint[3] = {1 + p->tint * x, 1, 1 - p->tint * x};
    for (int k = 0; k < 3; k++)
        for (int j = 0; j < 3; j++) out.emission.primary[k].white_xyz[j] *= even * tint[j];
    out.emission.black_cd_m2 *= even * (1 + p->clouding * 16 * x * x * y * y);
    out.emission.lobe_gain *= 1 + p->lobe_slope * x;
    out.reflection.haze_share *= 1 + p->haze_slope * x;
    return out;
}

void closed_form_emission_xyz(const SyntheticPanel *panel, int primary, double code,
                              const double angles[2], double xyz[3])
{
    const SyntheticEmission *e = &panel->emission;
    const SyntheticPrimary  *p = &e->primary[primary];
    double s = sin_d(angles[0]) * sin_d(angles[0]);
    double level = code > 0 ? pow_d(code / 255, e->gamma - e->gamma_drop * s) : 0;
    double a = angular_falloff(panel, angles);
    for (int j = 0; j < 3; j++) xyz[j] = p->white_xyz[j] * level * a * exp_d(p->shift[j] * s);
}

void closed_form_black_xyz(const SyntheticPanel *panel, const double angles[2], double xyz[3])
{
    const SyntheticEmission *e = &panel->emission;
    double white[3] = {0, 0, 0};
    double s = sin_d(angles[0]) * sin_d(angles[0]), diagonal = sin_d(2 * angles[1]);
    double value = e->black_cd_m2 * angular_falloff(panel, angles) *
                   (1 + e->leak * s * s * diagonal * diagonal);
    for (int p = 0; p < 3; p++)
        for (int j = 0; j < 3; j++) white[j] += e->primary[p].white_xyz[j];
    for (int j = 0; j < 3; j++) xyz[j] = value * white[j] / white[1];
}

/* R of synthetic_panel.h. */
static double coated_reflectance(const SyntheticPanel *panel, double cos_theta, double nm)
{
    double f = cover_fresnel(panel, cos_theta);
    double d = (nm - 550) / 150;
    double c = panel->reflection.coating + panel->reflection.coating_blue * d * d;
    if (c > 1) c = 1;
    return f * (c + (1 - c) * f);
}

double closed_form_mirror(const SyntheticPanel *panel, double theta, double nm)
{
    return (1 - panel->reflection.haze_share) * coated_reflectance(panel, cos_d(theta), nm);
}

double closed_form_brdf(const SyntheticPanel *panel, double theta_i, double theta_o, double phi,
                        double nm)
{
    const SyntheticReflection *r = &panel->reflection;
    double ci = cos_d(theta_i), co = cos_d(theta_o);
    if (ci <= 0 || co <= 0) return 0;
    double si = sin_d(theta_i), so = sin_d(theta_o), w2 = r->haze_width * r->haze_width;
    double sp = sin_d(0.5 * phi);
    double b2 = (so - si) * (so - si) + 4 * so * si * sp * sp;
    double k = (r->haze_power - 1) / (PI * w2) * pow_d(1 + b2 / w2, -r->haze_power);
    double gloss = sqrt(coated_reflectance(panel, ci, nm) *
                        coated_reflectance(panel, co, nm));
    double under = (1 - cover_fresnel(panel, ci)) * (1 - cover_fresnel(panel, co));
    return r->haze_share * gloss * k + r->lambertian_albedo / PI * under;
}

double closed_form_instrument_brdf(const SyntheticPanel *panel, double theta_i, double theta_o,
                                   double phi, double nm)
{
    double sigma = radians_from_degrees(panel->instrument.fwhm_deg) / sqrt(8 * log_d(2));
    double d = angle_between((double[2]){theta_o, phi}, (double[2]){theta_i, 0});
    double image = exp_d(-0.5 * d * d / (sigma * sigma)) / (2 * PI * sigma * sigma);
    return closed_form_brdf(panel, theta_i, theta_o, phi, nm) +
           closed_form_mirror(panel, theta_i, nm) * image / cos_d(theta_i);
}

#define APERTURE_RINGS 32
#define APERTURE_SECTORS 24

/* BRDF times cosine in a direction at a distance from the mirror direction, turned about it. */
static double towards_aperture(const SyntheticPanel *panel, double theta, double distance,
                               double turn, double nm)
{
    double s = sin_d(distance), x = s * cos_d(turn), y = s * sin_d(turn), z = cos_d(distance);
    double across = cos_d(theta) * x + sin_d(theta) * z;
    double cosine = cos_d(theta) * z - sin_d(theta) * x;
    if (!(cosine > 0)) return 0;
    return cosine * closed_form_brdf(panel, theta, acos_d(fmin(1, cosine)), atan2_d(y, across),
                                     nm);
}

/* Rings are closer where a narrow haze is: their radii go with a square. */
double closed_form_specular(const SyntheticPanel *panel, double theta, double aperture,
                            double nm)
{
    double sum = 0;
    for (int i = 0; i < APERTURE_RINGS; i++) {
        double x = (i + 0.5) / APERTURE_RINGS, radius = 0.5 * aperture * x * x;
        double area = sin_d(radius) * aperture * x / APERTURE_RINGS;
        for (int k = 0; k < APERTURE_SECTORS; k++)
            sum += area * (2 * PI / APERTURE_SECTORS) *
                   towards_aperture(panel, theta, radius, 2 * PI * k / APERTURE_SECTORS, nm);
    }
    return closed_form_mirror(panel, theta, nm) + sum;
}
