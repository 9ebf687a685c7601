/* SPDX-License-Identifier: Apache-2.0 */
#include "plot/report/panel_tables.h"

#include <math.h>
#include <string.h>

#include "base/count.h"
#include "base/units.h"
#include "panel/query/panel_place.h"
#include "panel/query/panel_stated.h"
#include "plot/panel/grey_inversion.h"
#include "spectrum/gamut.h"
#include "table/table.h"

/* panel_tables lists the tables in the order of the page; each report_... adds those of its
 * subject, or says why they are not there. Every figure is one of panel_figure.h: here it only
 * gets its row. */

static void report_viewing(Report *report, const PlotData *data);
static void report_colour(Report *report, const PlotData *data);
static void report_levels(Report *report, const PlotData *data);
static void report_reflection(Report *report, const PlotData *data);
static void report_ambient(Report *report, const PlotData *data);
static void report_places(Report *report, const PlotData *data);
static void report_errors(Report *report, const PlotData *data);

Report *panel_tables(const PlotData *data, Arena *arena) {
    Report *report = ARENA_NEW(arena, Report, 1);
    report->arena = arena;
    report_viewing(report, data);
    report_colour(report, data);
    report_levels(report, data);
    report_reflection(report, data);
    report_ambient(report, data);
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
    return report_has_azimuth(data->source.report, index);
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
        double deg = degrees_from_radians(panel_figure_viewing_angle(
            s->source.panel, NULL, CRITERIA[criterion].limit, i * PI / 4));
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
            float rgb[3];
            pattern_codes((Pattern)p, rgb);
            table_text(table, pattern_name((Pattern)p));
            table_number(table, ANGLES_DEG[k]);
            for (int i = 0; i < AZIMUTHS; i++)
                if (is_measured(s, ANGLES_DEG[k], i))
                    table_number(table, panel_figure_shift(s->source.panel,
                                                           radians_from_degrees(ANGLES_DEG[k]),
                                                           i * PI / 4, rgb));
                else table_text(table, NOT_MEASURED);
        }
}

/* The row of one direction; azimuth -1: the normal. */
static void add_white(Table *table, const PlotData *s, int deg, int azimuth) {
    PanelColour colour = panel_figure_colour(s->source.panel, radians_from_degrees(deg),
                                             azimuth * PI / 4, PANEL_WHITE);
    ColourTemperature white = colour_temperature(colour.uv);
    table_row(table);
    table_number(table, deg);
    table_number(table, 45 * azimuth);
    table_number(table, colour.xyz[1]);
    for (int c = 0; c < 2; c++) table_number(table, colour.xy[c]);
    for (int c = 0; c < 2; c++) table_number(table, colour.uv[c]);
    if (white.is_defined) table_number(table, white.kelvin);
    else table_text(table, "not defined");
    if (white.is_defined) table_number(table, white.duv);
    else table_text(table, "not defined");
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
    add_white(table, s, 0, 0);
    for (int k = 0; k < COUNT_OF(ANGLES_DEG); k++)
        for (int i = 0; i < AZIMUTHS; i += 2)
            if (is_measured(s, ANGLES_DEG[k], i)) add_white(table, s, ANGLES_DEG[k], i);
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
        table_number(table, (double)s->normal[PATTERN_RED + p][1]);
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
    GamutTriangle xy = panel_figure_primaries(data->source.panel);
    add_primaries(report, data, &xy);
    add_gamut(report, &xy);
}

/* ---- gamma by angle ---------------------------------------------------------------------- */

static const int GAMMA_DEG[] = {0, 15, 30, 45, 60};

static void add_gamma_row(Table *table, const PlotData *s, int deg) {
    table_row(table);
    table_number(table, deg);
    for (int i = 0; i < AZIMUTHS; i++) {
        double theta = radians_from_degrees(deg);
        bool is_measured =
            theta <= s->cone + 1e-6 && has_azimuth(s, i) && !(s->is_white_only && deg > 0);
        if (is_measured || deg == 0)
            table_number(table, panel_figure_gamma(s->source.panel, PANEL_GREY, theta, i * PI / 4));
        else table_text(table, NOT_MEASURED);
    }
}

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
    for (int k = 0; k < COUNT_OF(GAMMA_DEG); k++) add_gamma_row(table, s, GAMMA_DEG[k]);
}

/* ---- inversion --------------------------------------------------------------------------- */

static void add_inversion_row(Table *table, const char *where, const GreyInversion *most,
                              double first) {
    table_row(table);
    table_text(table, where);
    table_text(table, most->share > 0 ? "yes" : "none");
    table_number(table, degrees_from_radians(first));
    table_number(table, most->share > 0 ? 100 * most->share : NAN);
    table_number(table, most->share > 0 ? degrees_from_radians(most->theta) : NAN);
    table_number(table, most->share > 0 ? degrees_from_radians(most->phi) : NAN);
    table_number(table, most->share > 0 ? most->low : NAN);
    table_number(table, most->share > 0 ? most->high : NAN);
}

static void add_inversion(Report *report, const PlotData *s, const GreyLevels *levels) {
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
    double first = NAN;
    for (int i = 0; i < AZIMUTHS; i++) {
        GreyInversion most = grey_inversion_along(s, levels, i * PI / 4, &first);
        if (!has_azimuth(s, i)) continue;
        add_inversion_row(table, WHERE[i], &most, first);
    }
    GreyInversion all = grey_inversion_most(s, levels);
    if (all.share > 0) grey_inversion_along(s, levels, all.phi, &first);
    add_inversion_row(table, "largest of all", &all, all.share > 0 ? first : NAN);
}

static void report_levels(Report *report, const PlotData *data) {
    GreyLevels levels = grey_levels(data);
    double code[PANEL_INFO_LEVELS_MAX];
    if (!data->emits) return;
    bool has_levels = data->is_white_only ? data->has_gamma_table
                                          : panel_info_levels(data->source.panel, 1, code) > 1;
    if (has_levels) add_gamma(report, data);
    else
        report_missing(report, "gamma", "Gamma by angle",
                       "One level was measured: the level "
                       "curve is assumed, and no gamma is stated.");
    if (levels.count) add_inversion(report, data, &levels);
    else
        report_missing(report, "grey_inversion", "Grey inversion",
                       "Grey levels were not "
                       "measured over the angle: whether greys invert is not known.");
}

#define WITHOUT_REFLECTION \
    "The reflection was not measured: no reflectance and no contrast in ambient light are " \
    "stated."

/* ---- reflectance ------------------------------------------------------------------------- */

static void add_incidence(Table *table, const PlotData *s, double theta) {
    double mirror = panel_figure_mirror(s->source.panel, theta, 0);
    double all = panel_figure_diffuse(s->source.panel, theta);
    double phi = s->source.incidence_phi;
    double floor = panel_figure_lambertian(s->source.panel, panel_figure_direction(theta, phi + PI),
                                           panel_figure_direction(theta, phi));
    double even = fmin(PI * floor, all);
    table_row(table);
    table_number(table, degrees_from_radians(theta));
    table_number(table, 100 * mirror);
    table_number(table, 100 * (all - even));
    table_number(table, 100 * even);
    table_number(table, 100 * (mirror + all));
    table_number(table, plot_data_brdf(s, theta, theta, 0, 0));
}

/* How wavelengths are weighted. */
static const char *weights_text(Report *report, const PlotData *s) {
    if (s->wavelength_count != 1) return "weighted by V(λ) for equal-energy light";
    return arena_format(report->arena, "at %.4g nm, the only wavelength that was measured",
                        (double)s->wavelength_nm[0]);
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
    for (int i = 0; i < s->incidence_count; i++) add_incidence(table, s, s->incidence[i]);
}

static void add_factor(Table *table, const char *const texts[2], bool is_measured, double value) {
    table_row(table);
    for (int i = 0; i < 2; i++) table_text(table, texts[i]);
    if (is_measured) table_number(table, 100 * value);
    else table_text(table, NOT_MEASURED);
}

static void add_factors(Report *report, const PlotData *s) {
    double at_8 = radians_from_degrees(8), at_45 = radians_from_degrees(45);
    bool has_8 = plot_data_brdf_is_measured(s, at_8, at_8, PI);
    bool has_45 = plot_data_brdf_is_measured(s, at_45, 0, 0);
    double diffuse = panel_figure_diffuse(s->source.panel, at_8);
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
    add_factor(table, (const char *const[]){"45/0", "from 45°, seen at the normal"}, has_45,
               PI * plot_data_brdf(s, at_45, 0, 0, 0));
    add_factor(table,
               (const char *const[]){"8/di", "from 8°, into the hemisphere, "
                                             "specular included"},
               has_8, diffuse + panel_figure_mirror(s->source.panel, at_8, 0));
    add_factor(table,
               (const char *const[]){"8/de", "from 8°, into the hemisphere, "
                                             "specular excluded"},
               has_8, diffuse);
}

static void report_reflection(Report *report, const PlotData *data) {
    if (!data->reflects) {
        report_missing(report, "reflectance", "Reflectance", WITHOUT_REFLECTION);
        return;
    }
    add_incidences(report, data);
    add_factors(report, data);
}

/* ---- ambient contrast -------------------------------------------------------------------- */

/* Levels as the public abstracts and summaries of the standards quote them. */
static const struct {
    const char *name;
    double lux, directed_lux;
} CONDITIONS[] = {{"Dark room", 0, 0},
                  {"Daylight, IDMS: surround and source together", 15000, 65000},
                  {"SAE J1757-1 diffuse, CRd: surround alone", 5000, 0},
                  {"SAE J1757-1 direct, CRh: source alone", 0, 45000}};

static void add_condition(Table *table, const PlotData *s, const char *name,
                          const PlotLight *light) {
    table_row(table);
    table_text(table, name);
    table_number(table, light->lux);
    table_number(table, light->directed_lux);
    table_number(table,
                 light->directed_lux > 0 ? degrees_from_radians(light->directed_theta) : NAN);
    table_number(table, ambient_reflected(s, 0, 0, light));
    table_number(table, ambient_contrast(s, 0, 0, light));
    for (int i = 0; i < AZIMUTHS; i += 2) {
        bool is_measured = s->cone >= radians_from_degrees(30) && has_azimuth(s, i) &&
                           !(s->has_black && s->is_white_only); /* black on the axis alone */
        if (is_measured)
            table_number(table, ambient_contrast(s, radians_from_degrees(30), i * PI / 4, light));
        else table_text(table, NOT_MEASURED);
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
        "Contrast = " AMBIENT_FORMULA ". The source stands at "
        "the angle given, at azimuth φ %.4g°; its mirror image is seen in one direction only "
        "and is in no figure.%s SAE J1757-1 states the two lights apart: CRd = (Ldark,w + "
        "Lamb-d) / (Ldark,k + Lamb-d), CRh = (Ldark,w + Lamb-s) / (Ldark,k + Lamb-s), of full "
        "white w and full black k, and sets no limits. The illuminances of both standards are "
        "those that public summaries quote; others by --ambient and --directed.%s",
        degrees_from_radians(s->source.incidence_phi),
        is_seen ? ""
                : " Light from 45° was not "
                  "measured: its part is extrapolated.",
        black);
}

static void report_ambient(Report *report, const PlotData *data) {
    const PlotAmbient *ambient = &data->source.ambient;
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
    for (int i = 0; i < COUNT_OF(CONDITIONS); i++)
        add_condition(table, data, CONDITIONS[i].name,
                      &(PlotLight){CONDITIONS[i].lux, CONDITIONS[i].directed_lux, PI / 4});
    for (int i = 0; i < ambient->count; i++)
        add_condition(table, data, "as asked", &ambient->light[i]);
}

/* ---- over the active area ---------------------------------------------------------------- */

static void add_places(Table *table, const PlotData *s, Pattern pattern) {
    float rgb[3];
    pattern_codes(pattern, rgb);
    PanelEvenness e = panel_figure_evenness(s->source.panel, rgb);
    table_row(table);
    table_text(table, pattern_name(pattern));
    for (int i = 0; i < PANEL_NINE; i++) table_number(table, e.nine[i]);
    table_number(table, e.nine_mean);
    table_number(table, 100 * panel_non_uniformity(e.nine_least, e.nine_most));
}

static void report_places(Report *report, const PlotData *data) {
    if (!data->emits) return;
    if (!panel_varies(data->source.panel)) {
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
    PanelPartError e = panel_part_error(s->source.report, of_reflection);
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
    const json_t *emission = json_object_get(data->source.report, "emission");
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
