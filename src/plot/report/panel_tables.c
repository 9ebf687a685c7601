/* SPDX-License-Identifier: Apache-2.0 */
#include "plot/report/panel_tables.h"

#include <math.h>
#include <string.h>

#include "base/count.h"
#include "base/units.h"
#include "panel/query/panel_place.h"
#include "panel/query/panel_stated.h"
#include "spectrum/gamut.h"
#include "table/table.h"

/* panel_tables lists the tables in the order of the page; each report_... adds those of its
 * subject, or says why they are not there. Every figure is one of panel_figure.h: here it only
 * gets its row. */

static void report_viewing(Report *report, const PlotData *data);
static void report_colour(Report *report, const PlotData *data);
static void report_levels(Report *report, const PlotData *data);
static void report_reflection(Report *report, const PlotData *data);
static void report_ambient(Report *report, const PlotData *data, const Ambient *ambient);
static void report_places(Report *report, const PlotData *data);
static void report_errors(Report *report, const PlotData *data);

Report *panel_tables(const PlotData *data, const Ambient *ambient, Arena *arena) {
    Report *report = ARENA_NEW(arena, Report, 1);
    report->arena = arena;
    report_viewing(report, data);
    report_colour(report, data);
    report_levels(report, data);
    report_reflection(report, data);
    report_ambient(report, data, ambient);
    report_places(report, data);
    report_errors(report, data);
    return report;
}

/* ---- azimuths ---------------------------------------------------------------------------- */

/* Eight, from the viewer's right counter-clockwise. What lies between azimuths that were
 * measured more than 45 degrees apart, and more than 22.5 from each, is not stated. */
#define AZIMUTHS 8
#define NOT_MEASURED "not measured"

#define AZIMUTH_COLUMNS(places) \
    COLUMN_FIXED("phi_0", "φ 0° right", NULL, places), \
        COLUMN_FIXED("phi_45", "φ 45°", NULL, places), \
        COLUMN_FIXED("phi_90", "φ 90° up", NULL, places), \
        COLUMN_FIXED("phi_135", "φ 135°", NULL, places), \
        COLUMN_FIXED("phi_180", "φ 180° left", NULL, places), \
        COLUMN_FIXED("phi_225", "φ 225°", NULL, places), \
        COLUMN_FIXED("phi_270", "φ 270° down", NULL, places), \
        COLUMN_FIXED("phi_315", "φ 315°", NULL, places)

bool report_has_azimuth(const json_t *report, int index) {
    const json_t *emission = json_object_get(report, "emission");
    const json_t *list = json_object_get(emission, "azimuths_deg"), *one;
    size_t i;
    json_array_foreach(list, i, one) if (fabs(remainder(json_number_value(one) - 45 * index, 360)) <
                                         22.5 + 1e-6) return true;
    return json_array_size(list) == 0;
}

static bool has_azimuth(const PlotData *data, int index) {
    return report_has_azimuth(data->report, index);
}

/* A figure, or what stands in its place. */
static void add_figure(Table *table, bool is_measured, double value) {
    if (is_measured) table_number(table, value);
    else table_text(table, NOT_MEASURED);
}

/* ---- the list of tables ------------------------------------------------------------------ */

static Table *report_add(Report *report, const TableKind *kind, const char *note) {
    Table *table = report->table[report->count++] = table_new(kind, report->arena);
    table->note = note;
    return table;
}

/* A table that is not there, and why. */
static void report_missing(Report *report, const char *key, const char *words, const char *why) {
    TableKind *kind = ARENA_NEW(report->arena, TableKind, 1);
    *kind = (TableKind){.key = key, .words = words};
    report_add(report, kind, "")->missing = why;
}

/* ---- crossings --------------------------------------------------------------------------- */

static const struct {
    PanelLimit limit;
    const char *key, *text;
} CRITERIA[] = {
    {{PANEL_LEAST_CONTRAST, 100}, "contrast_100", "Contrast ratio ≥ 100 : 1"},
    {{PANEL_LEAST_CONTRAST, 10}, "contrast_10", "Contrast ratio ≥ 10 : 1"},
    {{PANEL_LEAST_LUMINANCE, 0.5}, "half_luminance", "Luminance ≥ half of the normal's"},
    {{PANEL_MOST_SHIFT, 0.01}, "shift_0.01", "Δu′v′ of white ≤ 0.01"},
    {{PANEL_MOST_SHIFT, 0.02}, "shift_0.02", "Δu′v′ of white ≤ 0.02"}};

static void add_crossings(Table *table, const PlotData *s, int criterion) {
    table_row(table);
    table_text(table, CRITERIA[criterion].text);
    bool is_contrast = CRITERIA[criterion].limit.kind == PANEL_LEAST_CONTRAST;
    const char *beyond = arena_format(table->arena, "> %.4g", degrees_from_radians(s->cone));
    for (int i = 0; i < AZIMUTHS; i++) {
        double deg = degrees_from_radians(
            panel_figure_viewing_angle(s->panel, NULL, CRITERIA[criterion].limit, i * PI / 4));
        if (!has_azimuth(s, i)) table_text(table, NOT_MEASURED);
        else if (is_contrast && !s->has_black) table_text(table, "no black");
        else if (is_contrast && s->is_white_only && !(deg <= 0))
            table_text(table, NOT_MEASURED); /* black on the axis alone */
        else if (isnan(deg)) table_text(table, beyond);
        else if (deg <= 0) table_text(table, "not at 0");
        else table_number(table, deg);
    }
}

static void add_viewing_angles(Report *report, const PlotData *s) {
    static const Column COLUMNS[] = {COLUMN_TEXT("limit", "Limit"), AZIMUTH_COLUMNS(2)};
    static const TableKind KIND = TABLE_KIND("viewing_angle", "Viewing angle", COLUMNS);
    const char *note = arena_format(
        report->arena,
        "The polar angle θ in degrees, from the "
        "normal outwards, at which the limit is first crossed; “> %.4g”: it is held as far "
        "as was measured; “not at 0”: not even at the normal. Full white over black in the "
        "dark; Δu′v′ from white at the normal.%s",
        degrees_from_radians(s->cone),
        !s->has_black      ? " Black was not measured, or gives no light: no contrast is stated."
        : s->is_white_only ? " Black was measured at the normal only: no contrast is stated at "
                             "other angles."
                           : "");
    Table *table = report_add(report, &KIND, note);
    for (int i = 0; i < COUNT_OF(CRITERIA); i++) add_crossings(table, s, i);
}

/* ---- colour at 30, 45 and 60 degrees ----------------------------------------------------- */

static const int ANGLES_DEG[] = {30, 45, 60};

static bool is_measured(const PlotData *s, int deg, int azimuth) {
    return radians_from_degrees(deg) <= s->cone + 1e-6 && has_azimuth(s, azimuth);
}

static void add_shifts(Report *report, const PlotData *s) {
    static const Column COLUMNS[] = {COLUMN_TEXT("pattern", "Pattern"),
                                     COLUMN_FIXED("theta_deg", "θ", "°", 0), AZIMUTH_COLUMNS(4)};
    static const TableKind KIND =
        TABLE_KIND("colour_shift", "Colour shift with the angle", COLUMNS);
    Table *table = report_add(
        report, &KIND,
        s->is_white_only ? "Δu′v′ from white at the normal, CIE 1976. Only white was measured."
                         : "Δu′v′ from the same pattern at the normal, CIE 1976; each primary "
                           "alone at full drive, black included.");
    for (int p = PATTERN_WHITE; p <= (s->is_white_only ? PATTERN_WHITE : PATTERN_BLUE); p++)
        for (int k = 0; k < COUNT_OF(ANGLES_DEG); k++) {
            table_row(table);
            table_text(table, pattern_name((Pattern)p));
            table_number(table, ANGLES_DEG[k]);
            for (int i = 0; i < AZIMUTHS; i++)
                add_figure(table, is_measured(s, ANGLES_DEG[k], i),
                           panel_figure_shift(s->panel, radians_from_degrees(ANGLES_DEG[k]),
                                              i * PI / 4, pattern_codes((Pattern)p)));
        }
}

static void add_whites(Report *report, const PlotData *s) {
    static const Column COLUMNS[] = {COLUMN_FIXED("theta_deg", "θ", "°", 0),
                                     COLUMN_FIXED("phi_deg", "φ", "°", 0),
                                     COLUMN_DIGITS("luminance_cd_m2", "L", "cd/m²", 4),
                                     COLUMN_FIXED("x", "x", NULL, 4),
                                     COLUMN_FIXED("y", "y", NULL, 4),
                                     COLUMN_FIXED("u", "u′", NULL, 4),
                                     COLUMN_FIXED("v", "v′", NULL, 4),
                                     COLUMN_FIXED("cct_k", "CCT", "K", 0),
                                     COLUMN_FIXED("duv", "Duv", NULL, 4)};
    static const TableKind KIND = TABLE_KIND("white", "White and its colour temperature", COLUMNS);
    Table *table = report_add(
        report, &KIND,
        "Correlated colour temperature (CIE 15): of the black body nearest in the CIE 1960 "
        "plane; Duv the distance from it, above 0 on the green side. Not defined further than "
        "0.05 away, below 1,000 or above 25,000 K. Directions that were not measured have no "
        "row.");
    for (int k = -1; k < COUNT_OF(ANGLES_DEG); k++)
        for (int i = 0; i < (k < 0 ? 1 : AZIMUTHS); i += 2) {
            int deg = k < 0 ? 0 : ANGLES_DEG[k];
            if (k >= 0 && !is_measured(s, deg, i)) continue;
            PanelColour colour =
                panel_figure_colour(s->panel, radians_from_degrees(deg), i * PI / 4, PANEL_WHITE);
            ColourTemperature white = colour_temperature(colour.uv);
            const double figure[] = {deg,          45 * i,       colour.xyz[1], colour.xy[0],
                                     colour.xy[1], colour.uv[0], colour.uv[1]};
            table_row(table);
            for (int c = 0; c < COUNT_OF(figure); c++) table_number(table, figure[c]);
            for (int c = 0; c < 2; c++)
                if (white.is_defined) table_number(table, c ? white.duv : white.kelvin);
                else table_text(table, "not defined");
        }
}

static void report_viewing(Report *report, const PlotData *data) {
    if (!data->emits) {
        report_missing(report, "viewing_angle", "Viewing angle",
                       "The emission was not "
                       "measured: no luminance, contrast, colour or grey levels are stated.");
        return;
    }
    add_viewing_angles(report, data);
    add_whites(report, data);
    add_shifts(report, data);
}

/* ---- primaries and gamut ----------------------------------------------------------------- */

static void add_primaries(Report *report, const PlotData *s, const GamutTriangle *xy) {
    GamutTriangle uv = gamut_in_uv(xy);
    static const Column COLUMNS[] = {
        COLUMN_TEXT("primary", "Primary"), COLUMN_DIGITS("luminance_cd_m2", "L", "cd/m²", 4),
        COLUMN_FIXED("x", "x", NULL, 4),   COLUMN_FIXED("y", "y", NULL, 4),
        COLUMN_FIXED("u", "u′", NULL, 4),  COLUMN_FIXED("v", "v′", NULL, 4)};
    static const TableKind KIND = TABLE_KIND("primaries", "Primaries", COLUMNS);
    Table *table =
        report_add(report, &KIND, "At the normal, each alone at full drive, black included.");
    for (int p = 0; p < 3; p++) {
        table_row(table);
        table_text(table, pattern_name((Pattern)(PATTERN_RED + p)));
        table_number(table, panel_figure_luminance(s->panel, 0, 0,
                                                   pattern_codes((Pattern)(PATTERN_RED + p))));
        for (int c = 0; c < 2; c++) table_number(table, xy->at[p][c]);
        for (int c = 0; c < 2; c++) table_number(table, uv.at[p][c]);
    }
}

static void add_gamut(Report *report, const GamutTriangle *xy) {
    GamutTriangle uv = gamut_in_uv(xy);
    static const Column COLUMNS[] = {
        COLUMN_TEXT("standard", "Standard"), COLUMN_FIXED("area_xy_percent", "Area in xy", "%", 1),
        COLUMN_FIXED("coverage_xy_percent", "Coverage in xy", "%", 1),
        COLUMN_FIXED("area_uv_percent", "Area in u′v′", "%", 1),
        COLUMN_FIXED("coverage_uv_percent", "Coverage in u′v′", "%", 1)};
    static const TableKind KIND = TABLE_KIND("gamut", "Gamut", COLUMNS);
    Table *table = report_add(
        report, &KIND,
        "Area: the triangle of the primaries over the standard's. Coverage: the share of the "
        "standard's triangle that lies inside. In CIE 1931 xy and in CIE 1976 u′v′; they "
        "differ, so state the plane with the figure.");
    for (int i = 0; i < GAMUT_STANDARDS; i++) {
        GamutTriangle in_xy = gamut_triangle((GamutStandard)i), in_uv = gamut_in_uv(&in_xy);
        table_row(table);
        table_text(table, gamut_name((GamutStandard)i));
        table_number(table, 100 * gamut_area(xy, &in_xy));
        table_number(table, 100 * gamut_coverage(xy, &in_xy));
        table_number(table, 100 * gamut_area(&uv, &in_uv));
        table_number(table, 100 * gamut_coverage(&uv, &in_uv));
    }
}

static void report_colour(Report *report, const PlotData *data) {
    if (!data->emits) return;
    if (data->is_white_only) {
        report_missing(report, "gamut", "Primaries and gamut",
                       "Only white was measured: the "
                       "panel's primaries are assumed, and no gamut is stated.");
        return;
    }
    GamutTriangle xy = panel_figure_primaries(data->panel);
    add_primaries(report, data, &xy);
    add_gamut(report, &xy);
}

/* ---- gamma by angle ---------------------------------------------------------------------- */

static void add_gamma(Report *report, const PlotData *s) {
    static const Column COLUMNS[] = {COLUMN_FIXED("theta_deg", "θ", "°", 0), AZIMUTH_COLUMNS(3)};
    static const TableKind KIND = TABLE_KIND("gamma", "Gamma by angle", COLUMNS);
    Table *table = report_add(
        report, &KIND,
        s->is_white_only
            ? "Exponent of the power law through full white, least squares of the logarithms "
              "over the measured levels, black subtracted. The levels were measured at the "
              "normal only."
            : "Exponent of the power law through full white, least squares of the logarithms "
              "over the measured levels of grey (red, green and blue at one code), black "
              "subtracted.");
    for (int deg = 0; deg <= 60; deg += 15) {
        double theta = radians_from_degrees(deg);
        bool is_there = theta <= s->cone + 1e-6 && !(s->is_white_only && deg > 0);
        table_row(table);
        table_number(table, deg);
        for (int i = 0; i < AZIMUTHS; i++)
            add_figure(table, deg == 0 || (is_there && has_azimuth(s, i)),
                       panel_figure_gamma(s->panel, PANEL_GREY, theta, i * PI / 4));
    }
}

/* ---- inversion --------------------------------------------------------------------------- */

static void add_inversion_row(Table *table, const char *where, const PanelInversion *most) {
    const double figure[] = {
        degrees_from_radians(most->first), 100 * most->share, degrees_from_radians(most->theta),
        degrees_from_radians(most->phi),   most->low,         most->high};
    table_row(table);
    table_text(table, where);
    table_text(table, most->share > 0 ? "yes" : "none");
    for (int i = 0; i < COUNT_OF(figure); i++)
        table_number(table, most->share > 0 ? figure[i] : NAN);
}

static void add_inversion(Report *report, const PlotData *s) {
    static const char *const WHERE[] = {"φ 0° right",  "φ 45°",  "φ 90° up",    "φ 135°",
                                        "φ 180° left", "φ 225°", "φ 270° down", "φ 315°"};
    static const Column COLUMNS[] = {COLUMN_TEXT("where", "Where"),
                                     COLUMN_TEXT("inverts", "Inverts"),
                                     COLUMN_FIXED("from_theta_deg", "From θ", "°", 2),
                                     COLUMN_FIXED("largest_percent", "Largest", "%", 1),
                                     COLUMN_FIXED("theta_deg", "at θ", "°", 1),
                                     COLUMN_FIXED("phi_deg", "φ", "°", 0),
                                     COLUMN_FIXED("level", "Level", NULL, 0),
                                     COLUMN_FIXED("brighter_than_level", "brighter than", NULL, 0)};
    static const TableKind KIND = TABLE_KIND("grey_inversion", "Grey inversion", COLUMNS);
    Table *table = report_add(
        report, &KIND,
        "Where a higher grey level gives less light than a lower one: the largest of all pairs "
        "of measured levels, 1 − L(higher) / L(lower), black included. Less than 1 % counts as "
        "none. The last row is the largest of all azimuths, every 5°, or of those measured "
        "where they are few.");
    PanelInversion all = {.share = 0};
    for (int i = 0; i < AZIMUTHS; i++) {
        PanelInversion most = panel_figure_inversion(s->panel, i * PI / 4);
        if (has_azimuth(s, i)) add_inversion_row(table, WHERE[i], &most);
    }
    const json_t *emission = json_object_get(s->report, "emission");
    const json_t *few = json_object_get(emission, "azimuths_deg");
    int count = few ? (int)json_array_size(few) : 72;
    for (int i = 0; i < count; i++) {
        double deg = few ? json_number_value(json_array_get(few, (size_t)i)) : 5 * i;
        PanelInversion one = panel_figure_inversion(s->panel, radians_from_degrees(deg));
        if (one.share > all.share) all = one;
    }
    add_inversion_row(table, "largest of all", &all);
}

static void report_levels(Report *report, const PlotData *data) {
    double code[PANEL_INFO_LEVELS_MAX];
    if (!data->emits) return;
    bool has_levels = !data->is_white_only && panel_info_levels(data->panel, 1, code) > 1;
    if (has_levels || data->has_gamma_table) add_gamma(report, data);
    else
        report_missing(report, "gamma", "Gamma by angle",
                       "One level was measured: the level "
                       "curve is assumed, and no gamma is stated.");
    if (has_levels) add_inversion(report, data);
    else
        report_missing(report, "grey_inversion", "Grey inversion",
                       "Grey levels were not "
                       "measured over the angle: whether greys invert is not known.");
}

#define WITHOUT_REFLECTION \
    "The reflection was not measured: no reflectance and no contrast in ambient light are " \
    "stated."

/* ---- reflectance ------------------------------------------------------------------------- */

/* How wavelengths are weighted. */
static const char *weights_text(Report *report, const PlotData *s) {
    if (s->wavelength_count != 1) return "weighted by V(λ) for equal-energy light";
    return arena_format(report->arena, "at %.4g nm, the only wavelength that was measured", s->nm);
}

static void add_incidences(Report *report, const PlotData *s) {
    const char *note = arena_format(
        report->arena,
        "Directional-hemispherical, %s. Specular: "
        "the mirror part. Lambertian: the floor that is the same into every direction. Haze: "
        "what is left, spread about the mirror direction. What leaves beyond the last measured "
        "angle is extrapolated. One row for each measured incidence.",
        weights_text(report, s));
    static const Column COLUMNS[] = {COLUMN_FIXED("incidence_deg", "Incidence", "°", 1),
                                     COLUMN_DIGITS("specular_percent", "Specular", "%", 4),
                                     COLUMN_DIGITS("haze_percent", "Haze", "%", 4),
                                     COLUMN_DIGITS("lambertian_percent", "Lambertian", "%", 4),
                                     COLUMN_DIGITS("total_percent", "Total", "%", 4),
                                     COLUMN_DIGITS("brdf_mirror_direction_sr",
                                                   "BRDF in the mirror direction without specular",
                                                   "sr⁻¹", 4)};
    static const TableKind KIND = TABLE_KIND("reflectance", "Reflectance by incidence", COLUMNS);
    Table *table = report_add(report, &KIND, note);
    for (int i = 0; i < s->incidence_count; i++) {
        double theta = s->incidence[i], phi = s->incidence_phi;
        double mirror = panel_figure_mirror(s->panel, theta, 0);
        double all = panel_figure_diffuse(s->panel, theta);
        double floor = panel_figure_lambertian(s->panel, panel_figure_direction(theta, phi + PI),
                                               panel_figure_direction(theta, phi));
        double even = fmin(PI * floor, all);
        const double figure[] = {
            degrees_from_radians(theta), 100 * mirror,
            100 * (all - even),          100 * even,
            100 * (mirror + all),        plot_data_brdf(s, theta, theta, 0, 0)};
        table_row(table);
        for (int c = 0; c < COUNT_OF(figure); c++) table_number(table, figure[c]);
    }
}

static void add_factors(Report *report, const PlotData *s) {
    double at_8 = radians_from_degrees(8), at_45 = radians_from_degrees(45);
    bool has_8 = plot_data_brdf_is_measured(s, at_8, at_8, PI);
    bool has_45 = plot_data_brdf_is_measured(s, at_45, 0, 0);
    double diffuse = panel_figure_diffuse(s->panel, at_8);
    static const Column COLUMNS[] = {COLUMN_TEXT("geometry", "Geometry"),
                                     COLUMN_TEXT("meaning", "Light : view"),
                                     COLUMN_DIGITS("factor_percent", "Factor", "%", 4)};
    static const TableKind KIND = TABLE_KIND("reflectance_factors", "Reflectance factors", COLUMNS);
    Table *table = report_add(
        report, &KIND,
        arena_format(
            report->arena,
            "Factors over a perfect white diffuser, %s, geometries of "
            "CIE 15. 8/de takes off the mirror part alone: the haze that would fall into an "
            "instrument's gloss trap, whose size no standard fixes, stays in it.",
            weights_text(report, s)));
    const struct {
        const char *geometry, *meaning;
        bool is_measured;
        double value;
    } factor[] = {
        {"45/0", "from 45°, seen at the normal", has_45, PI * plot_data_brdf(s, at_45, 0, 0, 0)},
        {"8/di", "from 8°, into the hemisphere, specular included", has_8,
         diffuse + panel_figure_mirror(s->panel, at_8, 0)},
        {"8/de", "from 8°, into the hemisphere, specular excluded", has_8, diffuse}};
    for (int i = 0; i < COUNT_OF(factor); i++) {
        table_row(table);
        table_text(table, factor[i].geometry);
        table_text(table, factor[i].meaning);
        add_figure(table, factor[i].is_measured, 100 * factor[i].value);
    }
}

static void report_reflection(Report *report, const PlotData *data) {
    if (!data->reflects) {
        report_missing(report, "reflectance", "Reflectance", WITHOUT_REFLECTION);
        return;
    }
    add_incidences(report, data);
    add_factors(report, data);
}

/* ---- ambient contrast --------------------------------------------------------------------
 *
 *   C(d) = (L_white(d) + L_r(d)) / (L_black(d) + L_r(d)),  L_r(d) = R(d) E / pi + f(d, s) E_s
 *
 * E the illuminance of a uniform surround on the panel, E / pi its luminance; R(d) is
 * panel_figure_reflectance: a uniform surround is mirrored too (specular included). E_s is the
 * illuminance on the panel of a small directed source (sun, lamp) that stands at s, f the BRDF.
 * The source's image in the mirror part is seen in one direction only, which a render shows, and
 * counts in none here. Weighted by V(lambda) for equal-energy light: lamps of other spectra
 * change R and f where they depend on the wavelength. Source: E. F. Kelley, M. Lindfors, J.
 * Penczek, Display daylight ambient contrast measurement methods and daylight readability, J.
 * Soc. Inf. Display 14 (2006): sky as a uniform surround and sun as a directed source are
 * measured apart, scaled to the illuminances and added; also SID's Information Display
 * Measurements Standard. */

/* Levels as the public abstracts and summaries of the standards quote them. */
static const struct {
    const char *name;
    double lux, directed_lux;
} CONDITIONS[] = {{"Dark room", 0, 0},
                  {"Daylight, IDMS: surround and source together", 15000, 65000},
                  {"SAE J1757-1 diffuse, CRd: surround alone", 5000, 0},
                  {"SAE J1757-1 direct, CRh: source alone", 0, 45000}};

/* L_r above. even: R there. */
static double reflected_at(const PlotData *s, double theta, double phi, const AmbientLight *light,
                           double even) {
    double directed = 0;
    if (light->directed_lux > 0)
        directed =
            panel_figure_brdf(s->panel, panel_figure_direction(theta, phi),
                              panel_figure_direction(light->directed_theta, s->incidence_phi), 0);
    return even * light->lux / PI + directed * light->directed_lux;
}

static double lit_contrast(const PlotData *s, double theta, double phi, double reflected) {
    double white = panel_figure_luminance(s->panel, theta, phi, PANEL_WHITE) + reflected;
    double black = panel_figure_luminance(s->panel, theta, phi, PANEL_BLACK) + reflected;
    return black > 0 ? white / black : NAN;
}

/* even: R at the normal and at 30 degrees. */
static void add_condition(Table *table, const PlotData *s, const char *name,
                          const AmbientLight *light, const double even[2]) {
    double reflected = reflected_at(s, 0, 0, light, even[0]), theta = radians_from_degrees(30);
    table_row(table);
    table_text(table, name);
    table_number(table, light->lux);
    table_number(table, light->directed_lux);
    table_number(table,
                 light->directed_lux > 0 ? degrees_from_radians(light->directed_theta) : NAN);
    table_number(table, reflected);
    table_number(table, lit_contrast(s, 0, 0, reflected));
    for (int i = 0; i < AZIMUTHS; i += 2) {
        bool is_measured = s->cone >= theta && has_azimuth(s, i) &&
                           !(s->has_black && s->is_white_only); /* black on the axis alone */
        double phi = i * PI / 4;
        add_figure(table, is_measured,
                   lit_contrast(s, theta, phi, reflected_at(s, theta, phi, light, even[1])));
    }
}

static const char *ambient_note(Report *report, const PlotData *s) {
    const char *black = s->has_black
                            ? ""
                            : " Black was not measured, or gives no light: it "
                              "counts as 0, so contrasts are upper limits, and the dark has none.";
    bool is_seen = s->last_incidence >= radians_from_degrees(45);
    return arena_format(
        report->arena,
        "Contrast = (Lw + Lr) / (Lb + Lr), Lr = R E/π + f Es: white and black at an angle, E the "
        "illuminance of an even diffuse surround, R the panel's hemispherical-directional "
        "reflectance into that angle, mirror included, Es the illuminance of a directed source "
        "on the panel, f the BRDF from it into that angle (Kelley, Lindfors, Penczek 2006). The "
        "source stands at "
        "the angle given, at azimuth φ %.4g°; its mirror image is seen in one direction only "
        "and is in no figure.%s SAE J1757-1 states the two lights apart: CRd = (Ldark,w + "
        "Lamb-d) / (Ldark,k + Lamb-d), CRh = (Ldark,w + Lamb-s) / (Ldark,k + Lamb-s), of full "
        "white w and full black k, and sets no limits. The illuminances of both standards are "
        "those that public summaries quote; others by --ambient and --directed.%s",
        degrees_from_radians(s->incidence_phi),
        is_seen ? ""
                : " Light from 45° was not "
                  "measured: its part is extrapolated.",
        black);
}

static void report_ambient(Report *report, const PlotData *data, const Ambient *ambient) {
    static const Column COLUMNS[] = {
        COLUMN_TEXT("condition", "Light"),
        COLUMN_FIXED("diffuse_lx", "Surround", "lx", 0),
        COLUMN_FIXED("directed_lx", "Source", "lx", 0),
        COLUMN_FIXED("directed_theta_deg", "from θ", "°", 1),
        COLUMN_DIGITS("reflected_cd_m2", "Lr at the normal", "cd/m²", 4),
        COLUMN_DIGITS("contrast", "Contrast at the normal", NULL, 4),
        COLUMN_DIGITS("contrast_30_phi_0", "at 30° right", NULL, 4),
        COLUMN_DIGITS("contrast_30_phi_90", "30° up", NULL, 4),
        COLUMN_DIGITS("contrast_30_phi_180", "30° left", NULL, 4),
        COLUMN_DIGITS("contrast_30_phi_270", "30° down", NULL, 4)};
    static const TableKind KIND =
        TABLE_KIND("ambient_contrast", "Contrast in ambient light", COLUMNS);
    if (!data->emits || !data->reflects) {
        report_missing(report, "ambient_contrast", "Contrast in ambient light",
                       data->emits ? WITHOUT_REFLECTION : "The emission was not measured.");
        return;
    }
    Table *table = report_add(report, &KIND, ambient_note(report, data));
    const double even[] = {panel_figure_reflectance(data->panel, 0),
                           panel_figure_reflectance(data->panel, radians_from_degrees(30))};
    for (int i = 0; i < COUNT_OF(CONDITIONS); i++)
        add_condition(table, data, CONDITIONS[i].name,
                      &(AmbientLight){CONDITIONS[i].lux, CONDITIONS[i].directed_lux, PI / 4}, even);
    for (int i = 0; i < ambient->count; i++)
        add_condition(table, data, "as asked", &ambient->light[i], even);
}

/* ---- over the active area ---------------------------------------------------------------- */

static void add_places(Table *table, const PlotData *s, Pattern pattern) {
    PanelEvenness e = panel_figure_evenness(s->panel, pattern_codes(pattern));
    table_row(table);
    table_text(table, pattern_name(pattern));
    for (int i = 0; i < PANEL_NINE; i++) table_number(table, e.nine[i]);
    table_number(table, e.nine_mean);
    table_number(table, 100 * panel_non_uniformity(e.nine_least, e.nine_most));
}

static void report_places(Report *report, const PlotData *data) {
    if (!data->emits) return;
    if (!panel_varies(data->panel)) {
        report_missing(report, "uniformity", "Over the active area",
                       "One place was measured: "
                       "how even the panel is, is not known.");
        return;
    }
#define POINT(n) COLUMN_DIGITS("point_" n "_cd_m2", n, NULL, 4)
    static const Column COLUMNS[] = {
        COLUMN_TEXT("pattern", "Pattern"),
        POINT("1"),
        POINT("2"),
        POINT("3"),
        POINT("4"),
        POINT("5"),
        POINT("6"),
        POINT("7"),
        POINT("8"),
        POINT("9"),
        COLUMN_DIGITS("mean_cd_m2", "Mean", NULL, 4),
        COLUMN_FIXED("non_uniformity_percent", "Non-uniformity", "%", 1)};
    static const TableKind KIND = TABLE_KIND("uniformity", "Over the active area", COLUMNS);
    Table *table = report_add(
        report, &KIND,
        "Luminance along the local normal, cd/m², at nine points, a tenth, a half and nine "
        "tenths of width and height, row by row from the upper left corner (SID, IDMS). "
        "Non-uniformity is 1 − least / most of the nine. All other tables are of the place "
        "where the file's own panel was measured.");
    add_places(table, data, PATTERN_WHITE);
    if (data->has_black) add_places(table, data, PATTERN_BLACK);
}

/* ---- how far the file is from what was measured ------------------------------------------ */

static void add_part(Table *table, const PlotData *s, bool of_reflection) {
    PanelPartError e = panel_part_error(s->report, of_reflection);
    if (!e.tables) return;
    table_row(table);
    table_text(table, of_reflection ? "reflection" : "emission");
    table_number(table, e.tables);
    table_number(table, 100 * e.largest);
    table_text(table, arena_printable(table->arena, e.worst));
    table_number(table, 100 * e.rms);
    table_number(table, e.outliers);
    table_number(table, 100 * e.outlier_largest);
}

static void report_errors(Report *report, const PlotData *data) {
    const json_t *emission = json_object_get(data->report, "emission");
    double floor = json_number_value(json_object_get(emission, "error_floor"));
    const char *dim = floor > 0 ? arena_format(report->arena,
                                               ", or over %.3g %% of the "
                                               "table's largest value where it is less",
                                               100 * floor)
                                : "";
    static const Column COLUMNS[] = {
        COLUMN_TEXT("part", "Part"),
        COLUMN_FIXED("tables", "Tables", NULL, 0),
        COLUMN_DIGITS("largest_error_percent", "Largest error", "%", 4),
        COLUMN_TEXT("in_table", "in the table"),
        COLUMN_DIGITS("rms_error_percent", "RMS error", "%", 4),
        COLUMN_FIXED("outliers", "Outliers left out", NULL, 0),
        COLUMN_DIGITS("outliers_error_percent", "up to", "%", 4)};
    static const TableKind KIND = TABLE_KIND("error", "Panel file against measurement", COLUMNS);
    Table *table = report_add(
        report, &KIND,
        arena_format(
            report->arena,
            "The error of this page: the difference between the panel "
            "file, from which every figure here is made, and a measured value (X, Y and Z of "
            "emission, every wavelength of reflection), over the measured value%s. Largest: of "
            "all directions of all tables, the noise of the source included. RMS: root of the "
            "mean square over the tables of each table's own. Outliers, which the file does "
            "not follow, are not counted in either.",
            dim));
    for (int part = 0; part < 2; part++) add_part(table, data, part == 1);
}
