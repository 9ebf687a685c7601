/* SPDX-License-Identifier: Apache-2.0 */
#include "cli/panel/panel_facts.h"

#include <math.h>
#include <stdbool.h>

#include "print/print.h"
#include "base/count.h"
#include "base/units.h"
#include "cli/options/answer.h"
#include "cli/panel/panel_question.h"
#include "panel/query/panel_emission.h"
#include "panel/query/panel_info.h"
#include "panel/query/panel_place.h"
#include "panel/query/panel_reflection.h"
#include "panel/set/dimming_keys.h"
#include "panel/set/display_traits.h"
#include "panel/set/halo_square.h"
#include "spectrum/gamut.h"
#include "spectrum/photometry.h"

static const float WHITE[3] = {255, 255, 255}, BLACK[3] = {0, 0, 0};

static double luminance(const Panel *panel, const float rgb[3], double theta, double phi) {
    float xyz[3];
    panel_emission_xyz(panel, panel_direction(theta, phi), rgb, xyz);
    return (double)xyz[1];
}

static void put(json_t *out, const char *key, double value) {
    json_object_set_new(out, key, json_real(value));
}

/* ---- gamut ------------------------------------------------------------------------------- */

static void add_gamut(const Panel *panel, json_t *out) {
    GamutTriangle own, srgb = gamut_triangle(GAMUT_SRGB), p3 = gamut_triangle(GAMUT_DCI_P3);
    json_t *list = json_array();
    for (int p = 0; p < 3; p++) {
        float rgb[3] = {0, 0, 0}, xyz[3], xy[2];
        rgb[p] = 255;
        panel_emission_xyz(panel, vec3(0, 0, 1), rgb, xyz);
        xy_from_xyz(xyz, xy);
        for (int c = 0; c < 2; c++) own.at[p][c] = (double)xy[c];
        json_array_append_new(list, json_pack("[f, f]", own.at[p][0], own.at[p][1]));
    }
    json_object_set_new(out, "primaries_xy", list);
    put(out, "srgb_coverage", gamut_coverage(&own, &srgb));
    put(out, "dci_p3_coverage", gamut_coverage(&own, &p3));
}

/* ---- emission ---------------------------------------------------------------------------- */

/* Exponent of the power law through full drive, least squares of the logarithms over the
 * measured levels, black subtracted; null: one level. */
static json_t *gamma_of(const Panel *panel, int primary) {
    double code[PANEL_INFO_LEVELS_MAX], xx = 0, xy = 0, black = luminance(panel, BLACK, 0, 0);
    float rgb[3] = {0, 0, 0};
    int count = panel_info_levels(panel, primary, code);
    rgb[primary] = 255;
    double full = luminance(panel, rgb, 0, 0) - black;
    for (int i = 0; i < count; i++) {
        rgb[primary] = (float)code[i];
        double light = (luminance(panel, rgb, 0, 0) - black) / full, x = log(code[i] / 255);
        if (!(light > 0) || x == 0) continue;
        xx += x * x, xy += x * log(light);
    }
    return count > 1 && xx > 0 ? json_real(xy / xx) : json_null();
}

typedef struct ConeQuestion {
    bool is_contrast;
    double least; /* of white's luminance, or contrast */
} ConeQuestion;

/* The first theta, in tenths of a degree inside the measured cone, that has less; null: none.
 * */
static json_t *cone_to(const Panel *panel, ConeQuestion question, double phi) {
    double normal = luminance(panel, WHITE, 0, 0);
    double cone = degrees_from_radians(panel_info_emission_cone(panel));
    for (double theta = 0; theta <= cone + 1e-6; theta += 0.1) {
        double white = luminance(panel, WHITE, theta, phi);
        double over = question.is_contrast ? luminance(panel, BLACK, theta, phi) : normal;
        if (white < question.least * over) return json_real(round(10 * theta) / 10);
    }
    return json_null();
}

static json_t *cones(const Panel *panel, ConeQuestion question) {
    json_t *list = json_array();
    for (int i = 0; i < 4; i++) json_array_append_new(list, cone_to(panel, question, 90.0 * i));
    return list;
}

/* Absent: unpolarised, or nobody said. */
static void add_polarisation(const Panel *panel, json_t *out) {
    PanelPolarisation p = panel_polarisation(panel);
    double degree = round((double)p.degree * 1e6) / 1e6;
    double azimuth = round(degrees_from_radians((double)p.azimuth) * 1e4) / 1e4;
    if (p.degree > 0)
        json_object_set_new(out, "polarisation",
                            json_pack("{s:f, s:f}", "degree", degree, "azimuth_deg", azimuth));
}

static const double HALO_MM[] = {10, 20, 40}; /* from the square's middle */

/* Absent: the backlight is one, always full. */
static void add_zones(const Panel *panel, json_t *out) {
    if (!panel_zones(panel)) return;
    Arena arena = arena_reserve((size_t)1 << 32);
    HaloSquare halo = halo_square_make(panel, &arena);
    json_t *zones = dimming_keys_json(panel_zones(panel)), *beside = json_array();
    for (int i = 0; i < COUNT_OF(HALO_MM); i++)
        json_array_append_new(beside,
                              json_pack("{s:f, s:f, s:f}", "mm", HALO_MM[i], "backlight",
                                        halo_square_backlight(&halo, HALO_MM[i]), "black_cd_m2",
                                        halo_square_black(&halo, HALO_MM[i], vec3(0, 0, 1))));
    json_object_set_new(zones, "mean_drive_black", json_real(halo.black_drive));
    json_object_set_new(zones, "halo",
                        json_pack("{s:f, s:f, s:o}", "square_mm", halo.side_mm, "mean_drive",
                                  halo.backlight->mean_drive, "beside", beside));
    json_object_set_new(out, "local_dimming", zones);
    arena_release(&arena);
}

static void add_emission(const Panel *panel, const json_t *report, json_t *out) {
    const json_t *emission = json_object_get(report, "emission");
    bool is_white_only = json_is_true(json_object_get(emission, "white_only"));
    double white = luminance(panel, WHITE, 0, 0), black = luminance(panel, BLACK, 0, 0);
    float xyz[3], xy[2];
    panel_emission_xyz(panel, vec3(0, 0, 1), WHITE, xyz);
    xy_from_xyz(xyz, xy);
    put(out, "white_cd_m2", white);
    json_object_set_new(out, "white_xy", json_pack("[f, f]", (double)xy[0], (double)xy[1]));
    json_object_set_new(out, "black_cd_m2", black > 0 ? json_real(black) : json_null());
    json_object_set_new(out, "contrast", black > 0 ? json_real(white / black) : json_null());
    if (!is_white_only) {
        add_gamut(panel, out);
        json_object_set_new(
            out, "gamma",
            json_pack("[o, o, o]", gamma_of(panel, 0), gamma_of(panel, 1), gamma_of(panel, 2)));
    }
    add_polarisation(panel, out);
    add_zones(panel, out);
    json_object_set_new(out, "half_luminance_deg", cones(panel, (ConeQuestion){false, 0.5}));
    if (black > 0)
        json_object_set_new(out, "contrast_10_deg", cones(panel, (ConeQuestion){true, 10}));
}

/* ---- reflection -------------------------------------------------------------------------- */

#define LIGHT_DEG 8.0 /* from the normal: the usual geometry of reflectance (CIE 15: 8:d) */

static double luminous(Spectrum s, const Wavelengths *w) {
    return (double)(spectrum_sum(s * w->xyz[1]) / spectrum_sum(w->xyz[1]));
}

static double haze_at(const Panel *panel, const Wavelengths *w, double theta) {
    Vec3 wi = panel_direction(LIGHT_DEG, 180);
    return luminous(panel_brdf(panel, panel_direction(theta, 0), wi, w), w);
}

/* The width of the BRDF at half of its height in the plane of incidence, above what is left 60
 * degrees away; the mirror part not included. */
static void add_haze(const Panel *panel, const Wavelengths *w, json_t *out) {
    double peak = haze_at(panel, w, LIGHT_DEG), floor = haze_at(panel, w, LIGHT_DEG + 60);
    double up = 0, down = 0, half = floor + 0.5 * (peak - floor);
    put(out, "haze_peak_sr", peak);
    if (!(peak > 1.2 * floor)) return; /* no peak: the same all round */
    while (up < 60 && haze_at(panel, w, LIGHT_DEG + up) > half) up += 0.05;
    while (down < 60 && haze_at(panel, w, LIGHT_DEG - down) > half) down += 0.05;
    put(out, "haze_fwhm_deg", up + down);
}

static void add_reflection(const Panel *panel, json_t *out) {
    Wavelengths w;
    float cosine = (float)cos(radians_from_degrees(LIGHT_DEG));
    wavelengths_sample(0.5f, &w);
    put(out, "reflectance_incidence_deg", LIGHT_DEG);
    put(out, "mirror_reflectance", luminous(panel_mirror(panel, cosine, &w), &w));
    put(out, "diffuse_reflectance", (double)panel_haze_albedo(panel, cosine));
    add_haze(panel, &w, out);
}

/* ---- places ------------------------------------------------------------------------------ */

static json_t *evenness_json(const Panel *panel, const float rgb[3]) {
    PanelEvenness e = panel_evenness(panel, rgb);
    json_t *nine = json_array();
    for (int i = 0; i < PANEL_NINE; i++) json_array_append_new(nine, json_real(e.nine[i]));
    return json_pack("{s:o, s:f, s:f, s:f, s:f, s:f, s:f, s:f, s:f}", "nine_cd_m2", nine,
                     "nine_least", e.nine_least, "nine_most", e.nine_most, "nine_mean", e.nine_mean,
                     "nine_non_uniformity", panel_non_uniformity(e.nine_least, e.nine_most),
                     "least", e.least, "most", e.most, "mean", e.mean, "non_uniformity",
                     panel_non_uniformity(e.least, e.most));
}

static void add_places(const Panel *panel, json_t *out) {
    float place[PANEL_EVENNESS_SPOTS][2];
    int map[2], spots = panel_spots(panel, place, map);
    json_t *list = json_array();
    for (int i = 0; i < spots; i++)
        json_array_append_new(list, json_pack("[f, f]", (double)place[i][0], (double)place[i][1]));
    json_t *places = json_pack("{s:o}", "spots", list);
    if (map[0]) json_object_set_new(places, "map", json_pack("[i, i]", map[0], map[1]));
    if (panel_info_emits(panel)) {
        json_object_set_new(places, "white", evenness_json(panel, WHITE));
        if (luminance(panel, BLACK, 0, 0) > 0)
            json_object_set_new(places, "black", evenness_json(panel, BLACK));
    }
    json_object_set_new(out, "places", places);
}

void panel_facts_add(const Panel *panel, json_t *report) {
    json_t *out = json_object();
    if (panel_varies(panel)) add_places(panel, out);
    if (panel_info_emits(panel)) add_emission(panel, report, out);
    if (panel_reflects(panel)) add_reflection(panel, out);
    json_object_set_new(report, "display", out);
}

/* ---- as text ----------------------------------------------------------------------------- */

static double number(const json_t *facts, const char *key) {
    return json_number_value(json_object_get(facts, key));
}

static double item(const json_t *list, size_t i) {
    return json_number_value(json_array_get(list, i));
}

static void print_cone(const json_t *facts, const char *key, const char *label) {
    static const char *const side[] = {"right", "up", "left", "down"};
    const json_t *list = json_object_get(facts, key);
    if (!list) return;
    print("%s", label);
    for (size_t i = 0; i < 4; i++) {
        print("%s %s ", i ? "," : "", side[i]);
        if (json_is_null(json_array_get(list, i))) print("beyond what was measured");
        else print("%.1f", item(list, i));
    }
    print(" degrees\n");
}

static void print_gamut(const json_t *facts) {
    const json_t *xy = json_object_get(facts, "primaries_xy"), *gamma;
    if (!xy) return;
    print("gamut      red %.3f %.3f, green %.3f %.3f, blue %.3f %.3f (xy); covers %.1f %% of "
          "sRGB, %.1f %% of DCI-P3 by area in xy\n",
          item(json_array_get(xy, 0), 0), item(json_array_get(xy, 0), 1),
          item(json_array_get(xy, 1), 0), item(json_array_get(xy, 1), 1),
          item(json_array_get(xy, 2), 0), item(json_array_get(xy, 2), 1),
          100 * number(facts, "srgb_coverage"), 100 * number(facts, "dci_p3_coverage"));
    gamma = json_object_get(facts, "gamma");
    if (json_is_number(json_array_get(gamma, 0)))
        print("gamma      red %.2f, green %.2f, blue %.2f\n", item(gamma, 0), item(gamma, 1),
              item(gamma, 2));
}

static void print_polarisation(const json_t *polarisation) {
    if (!polarisation) return;
    print("polarised  %.4g %%, linearly, along azimuth %.6g degrees\n",
          100 * number(polarisation, "degree"), number(polarisation, "azimuth_deg"));
}

static void print_spread(const json_t *spread) {
    const json_t *radius = json_object_get(spread, "radius_mm");
    if (!radius) {
        print("Gaussian of sigma %.4g mm", number(spread, "sigma_mm"));
        return;
    }
    print("a table to %.4g mm", item(radius, json_array_size(radius) - 1));
}

static void print_zones(const json_t *zones) {
    const json_t *count = json_object_get(zones, "zones"), *one;
    const json_t *drive = json_object_get(zones, "drive"), *halo = json_object_get(zones, "halo");
    size_t i;
    if (!zones) return;
    print("zones      %.0f x %.0f, light spread by ", item(count, 0), item(count, 1));
    print_spread(json_object_get(zones, "spread"));
    print("; driven by the %s%s, black %.3g %%; pixels %s\n",
          json_string_value(json_object_get(drive, "rule")),
          json_object_get(drive, "codes") ? " through a table" : "",
          100 * number(zones, "mean_drive_black"),
          json_is_true(json_object_get(zones, "compensates")) ? "keep their light"
                                                              : "fall with their backlight");
    print("halo       of a white square of %.4g mm on black: black is ", number(halo, "square_mm"));
    json_array_foreach(json_object_get(halo, "beside"), i, one) print(
        "%s%.3g cd/m2 at %.4g mm", i ? ", " : "", number(one, "black_cd_m2"), number(one, "mm"));
    print("; mean drive %.3g %%\n", 100 * number(halo, "mean_drive"));
}

static void print_reflection(const json_t *facts) {
    if (!json_object_get(facts, "mirror_reflectance")) return;
    print("reflects   %.3g %% like a mirror, %.3g %% diffusely (haze and floor, into the "
          "hemisphere), light from %g degrees\n",
          100 * number(facts, "mirror_reflectance"), 100 * number(facts, "diffuse_reflectance"),
          number(facts, "reflectance_incidence_deg"));
    print("haze       %.4g sr^-1 in the mirror direction", number(facts, "haze_peak_sr"));
    if (json_object_get(facts, "haze_fwhm_deg"))
        print(", %.3g degrees wide at half of it", number(facts, "haze_fwhm_deg"));
    print("\n");
}

static void print_evenness(const char *label, const json_t *e) {
    if (!e) return;
    print("%-10s nine points %.4g to %.4g cd/m2, mean %.4g, non-uniformity %.3g %%; anywhere "
          "%.4g to %.4g, mean %.4g\n",
          label, number(e, "nine_least"), number(e, "nine_most"), number(e, "nine_mean"),
          100 * number(e, "nine_non_uniformity"), number(e, "least"), number(e, "most"),
          number(e, "mean"));
}

static void print_places(const json_t *facts, const json_t *report) {
    const json_t *places = json_object_get(facts, "places"), *spot;
    const json_t *spots = json_object_get(places, "spots");
    const json_t *map = json_object_get(places, "map");
    size_t i;
    if (!places) return;
    if (map) print("uniformity map of %.0f x %.0f pixels\n", item(map, 0), item(map, 1));
    json_array_foreach((json_t *)spots, i, spot)
        print("%s%.4g,%.4g", i ? "; " : "spots at   ", item(spot, 0), item(spot, 1));
    if (json_array_size(spots)) print(" (right, down; of the active area)\n");
    print_evenness("white", json_object_get(places, "white"));
    print_evenness("black", json_object_get(places, "black"));
    json_array_foreach(json_object_get(report, "spots"), i, spot) {
        const json_t *at = json_object_get(spot, "position");
        print("spot       %.4g,%.4g: %.0f bytes, largest error %.2g%%, %s\n", item(at, 0),
              item(at, 1), number(spot, "bytes"), 100 * number(spot, "max_error"),
              json_string_value(json_object_get(spot, "verdict")));
    }
}

static void print_facts(const json_t *report) {
    const json_t *facts = json_object_get(report, "display");
    const json_t *xy = json_object_get(facts, "white_xy");
    if (xy) {
        print("white      %.4g cd/m2, xy %.4f %.4f; ", number(facts, "white_cd_m2"), item(xy, 0),
              item(xy, 1));
        if (json_is_null(json_object_get(facts, "contrast"))) print("black not measured\n");
        else print("contrast %.4g : 1\n", number(facts, "contrast"));
    }
    print_gamut(facts);
    print_polarisation(json_object_get(facts, "polarisation"));
    print_zones(json_object_get(facts, "local_dimming"));
    print_cone(facts, "half_luminance_deg", "half white");
    print_cone(facts, "contrast_10_deg", "10 : 1    ");
    print_reflection(facts);
    print_places(facts, report);
}

/* ---- the report -------------------------------------------------------------------------- */

static void print_table(const json_t *table) {
    print("%-16s %10.0f %12.0f %9.0f %8.1f %8.3g%% %8.2g%% %8.2g%% %8.2g%% %6.2f%%\n",
          json_string_value(json_object_get(table, "name")),
          json_number_value(json_object_get(table, "source_bytes_text")),
          json_number_value(json_object_get(table, "stored_values")),
          json_number_value(json_object_get(table, "bytes")),
          json_number_value(json_object_get(table, "ratio")),
          100 * json_number_value(json_object_get(table, "max_error")),
          100 * json_number_value(json_object_get(table, "rms_error")),
          100 * json_number_value(json_object_get(table, "integral_error")),
          100 * json_number_value(json_object_get(table, "noise")),
          100 * json_number_value(json_object_get(table, "extrapolated_share")));
}

/* What no error of a table counts. */
static void print_left_out(const json_t *table) {
    double outliers = json_number_value(json_object_get(table, "outliers"));
    if (outliers > 0)
        print("left out   %s: %.0f outliers, up to %.3g %%\n",
              json_string_value(json_object_get(table, "name")), outliers,
              100 * json_number_value(json_object_get(table, "outliers_max_error")));
}

static void print_numbers(const char *key, const json_t *list) {
    size_t i;
    json_t *value;
    if (!json_is_number(json_array_get(list, 0))) return;
    print(" %s", key);
    json_array_foreach((json_t *)list, i, value)
        print("%s%.6g", i ? "," : " ", json_number_value(value));
    print(";");
}

/* "a name": its text or numbers behind the line's label, for everything a fit has chosen. */
static void print_choices(const char *label, const json_t *choices) {
    const char *key;
    json_t *value;
    if (!choices) return;
    print("%-10s", label);
    json_object_foreach((json_t *)choices, key, value) {
        if (json_is_string(value)) print(" %s %s;", key, json_string_value(value));
        if (json_is_number(value)) print(" %s %.4g;", key, json_number_value(value));
        if (json_is_boolean(value)) print(" %s %s;", key, json_is_true(value) ? "yes" : "no");
        print_numbers(key, value);
    }
    print("\n");
}

/* Samples that stand out, and directions that are missing: of a fit, not of a file. */
static void print_flags(const char *label, const json_t *flags) {
    size_t i;
    json_t *flag, *value;
    json_array_foreach((json_t *)flags, i, flag) {
        print("%-10s %s, theta %.6g, phi %.6g", label,
              json_string_value(json_object_get(flag, "table")),
              json_number_value(json_object_get(flag, "theta_deg")),
              json_number_value(json_object_get(flag, "phi_deg")));
        if ((value = json_object_get(flag, "value")))
            print(": %.5g cd/m2, expected %.5g", json_number_value(value),
                  json_number_value(json_object_get(flag, "expected")));
        print("\n");
    }
}

/* The verdict and why; files from before verdicts have none. */
static void print_verdict(const json_t *report) {
    size_t i;
    json_t *reason;
    const char *verdict = json_string_value(json_object_get(report, "verdict"));
    print("verdict    %s\n", verdict ? verdict : "none in this file: fit the set again");
    json_array_foreach(json_object_get(report, "reasons"), i, reason)
        print("reason     %s\n", json_string_value(reason));
}

static void print_text(const json_t *report) {
    size_t i;
    json_t *value;
    print("panel      %s\nsource     %s (%s)\n",
          json_string_value(json_object_get(report, "panel")),
          json_string_value(json_object_get(report, "source")),
          json_string_value(json_object_get(report, "instrument")));
    print_verdict(report);
    print_facts(report);
    print_choices("emission", json_object_get(report, "emission"));
    print_choices("reflection", json_object_get(report, "reflection"));
    json_array_foreach(json_object_get(report, "notes"), i, value)
        print("note       %s\n", json_string_value(value));
    print_flags("outlier", json_object_get(report, "outliers"));
    print_flags("hole", json_object_get(report, "holes"));
    print("each table: bytes of its text; numbers and bytes that the panel keeps of it (an "
          "even share of what all share); how many times smaller than 32-bit numbers that "
          "is;\nerrors of the samples that the fit follows, relative to the measured values: "
          "the largest, the root of the mean "
          "square, that of the hemispherical integral; the table's own noise; share of the "
          "hemisphere that was not measured\n%-16s %10s %12s %9s %8s %9s %9s %9s %9s %7s\n",
          "table", "text", "values", "bytes", "ratio", "max err", "rms err", "integral", "noise",
          "extrap.");
    json_array_foreach(json_object_get(report, "tables"), i, value) print_table(value);
    print_table(json_object_get(report, "total"));
    json_array_foreach(json_object_get(report, "tables"), i, value) print_left_out(value);
    print_left_out(json_object_get(report, "total"));
    if ((value = json_object_get(report, "peak_memory_bytes")))
        print("took       %.1f s of processor time, %.0f MB at most\n",
              json_number_value(json_object_get(report, "cpu_seconds")),
              1e-6 * json_number_value(value));
}

bool panel_print_report(json_t *report, bool as_json, Error *err) {
    if (as_json) return cli_print_json(report, err);
    print_text(report);
    json_decref(report);
    return true;
}
