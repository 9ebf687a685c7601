/* SPDX-License-Identifier: Apache-2.0 */
/* At which angle a display falls below a limit, and its colour at an angle. */
#include "plot/report/viewing_tables.h"

#include <math.h>

#include "base/count.h"
#include "base/units.h"
#include "plot/report/report_azimuth.h"
#include "spectrum/gamut.h"
#include "spectrum/photometry.h"

/* ---- crossings --------------------------------------------------------------------------- */

typedef enum ViewingKind { VIEWING_CONTRAST, VIEWING_LUMINANCE, VIEWING_SHIFT } ViewingKind;

static const struct {
    ViewingKind kind;
    double limit;
    const char *key, *text;
} CRITERIA[] = {{VIEWING_CONTRAST, 100, "contrast_100", "Contrast ratio ≥ 100 : 1"},
                {VIEWING_CONTRAST, 10, "contrast_10", "Contrast ratio ≥ 10 : 1"},
                {VIEWING_LUMINANCE, 0.5, "half_luminance", "Luminance ≥ half of the normal's"},
                {VIEWING_SHIFT, 0.01, "shift_0.01", "Δu′v′ of white ≤ 0.01"},
                {VIEWING_SHIFT, 0.02, "shift_0.02", "Δu′v′ of white ≤ 0.02"}};

static double shift_at(const PlotData *s, Pattern pattern, double theta, double phi) {
    double uv[2], at_normal[2], xyz[3];
    float rgb[3];
    pattern_codes(pattern, rgb);
    plot_data_xyz(s, theta, phi, rgb, xyz);
    uv_from_xyz(xyz, uv);
    plot_data_normal_uv(s, pattern, at_normal);
    return hypot(uv[0] - at_normal[0], uv[1] - at_normal[1]);
}

/* Above 0 where the limit is held. */
static double margin_at(const PlotData *s, int criterion, double theta, double phi) {
    const PlotLight dark = {0};
    double xyz[3], limit = CRITERIA[criterion].limit;
    switch (CRITERIA[criterion].kind) {
    case VIEWING_CONTRAST: return ambient_contrast(s, theta, phi, &dark) - limit;
    case VIEWING_SHIFT: return limit - shift_at(s, PATTERN_WHITE, theta, phi);
    default:
        plot_data_xyz(s, theta, phi, (float[3]){255, 255, 255}, xyz);
        return xyz[1] / (double)s->normal[PATTERN_WHITE][1] - limit;
    }
}

/* The first theta, degrees, at which the limit is crossed, by quarters and then halved; 0: it
 * is not held at the normal. NaN: it is held as far as was measured. */
static double crossing_deg(const PlotData *s, int criterion, double phi) {
    double last = degrees_from_radians(s->cone), low = 0, high = 0;
    if (margin_at(s, criterion, 0, phi) < 0) return 0;
    for (;; low = high) {
        if (low >= last) return NAN;
        high = fmin(low + 0.25, last);
        if (margin_at(s, criterion, radians_from_degrees(high), phi) < 0) break;
    }
    while (high - low > 1e-4) {
        double middle = 0.5 * (low + high);
        if (margin_at(s, criterion, radians_from_degrees(middle), phi) < 0) high = middle;
        else low = middle;
    }
    return 0.5 * (low + high);
}

static void add_crossings(Report *report, ReportTable *table, const PlotData *s, int criterion) {
    report_row(report, table);
    report_text(table, CRITERIA[criterion].text);
    bool is_contrast = CRITERIA[criterion].kind == VIEWING_CONTRAST;
    for (int i = 0; i < REPORT_AZIMUTHS; i++) {
        double deg = crossing_deg(s, criterion, i * PI / 4);
        if (!report_has_azimuth(s, i)) report_text(table, NOT_MEASURED);
        else if (is_contrast && !s->has_black) report_text(table, "no black");
        else if (is_contrast && s->is_white_only && !(deg <= 0))
            report_text(table, NOT_MEASURED); /* black on the axis alone */
        else if (isnan(deg)) report_beyond(report, table, degrees_from_radians(s->cone));
        else if (deg <= 0) report_text(table, "not at 0");
        else report_fixed(report, table, deg, 2);
    }
}

static void add_viewing_angles(Report *report, const PlotData *s) {
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
    ReportTable *table = report_add(report, "viewing_angle", "Viewing angle", note);
    report_column(table, "limit", "Limit");
    report_azimuth_columns(report, table);
    for (int i = 0; i < COUNT_OF(CRITERIA); i++) add_crossings(report, table, s, i);
}

/* ---- colour at 30, 45 and 60 degrees ----------------------------------------------------- */

static const int ANGLES_DEG[] = {30, 45, 60};

static bool is_measured(const PlotData *s, int deg, int azimuth) {
    return radians_from_degrees(deg) <= s->cone + 1e-6 && report_has_azimuth(s, azimuth);
}

static void add_shifts(Report *report, const PlotData *s) {
    ReportTable *table = report_add(
        report, "colour_shift", "Colour shift with the angle",
        s->is_white_only ? "Δu′v′ from white at the normal, CIE 1976. Only white was measured."
                         : "Δu′v′ from the same pattern at the normal, CIE 1976; each primary "
                           "alone at full drive, black included.");
    report_column(table, "pattern", "Pattern");
    report_column(table, "theta_deg", "θ, °");
    report_azimuth_columns(report, table);
    for (int p = PATTERN_WHITE; p <= (s->is_white_only ? PATTERN_WHITE : PATTERN_BLUE); p++)
        for (int k = 0; k < COUNT_OF(ANGLES_DEG); k++) {
            report_row(report, table);
            report_text(table, pattern_name((Pattern)p));
            report_fixed(report, table, ANGLES_DEG[k], 0);
            for (int i = 0; i < REPORT_AZIMUTHS; i++)
                if (is_measured(s, ANGLES_DEG[k], i))
                    report_fixed(
                        report, table,
                        shift_at(s, (Pattern)p, radians_from_degrees(ANGLES_DEG[k]), i * PI / 4),
                        4);
                else report_text(table, NOT_MEASURED);
        }
}

/* The row of one direction; azimuth -1: the normal. */
static void add_white(Report *report, ReportTable *table, const PlotData *s, int deg, int azimuth) {
    double xyz[3], uv[2], sum;
    plot_data_xyz(s, radians_from_degrees(deg), azimuth * PI / 4, (float[3]){255, 255, 255}, xyz);
    uv_from_xyz(xyz, uv);
    sum = xyz[0] + xyz[1] + xyz[2];
    ColourTemperature white = colour_temperature(uv);
    report_row(report, table);
    report_fixed(report, table, deg, 0);
    report_fixed(report, table, 45 * azimuth, 0);
    report_figure(report, table, xyz[1]);
    report_fixed(report, table, xyz[0] / sum, 4);
    report_fixed(report, table, xyz[1] / sum, 4);
    report_fixed(report, table, uv[0], 4);
    report_fixed(report, table, uv[1], 4);
    if (white.is_defined) report_fixed(report, table, white.kelvin, 0);
    else report_text(table, "not defined");
    if (white.is_defined) report_fixed(report, table, white.duv, 4);
    else report_text(table, "not defined");
}

static void add_whites(Report *report, const PlotData *s) {
    ReportTable *table = report_add(
        report, "white", "White and its colour temperature",
        "Correlated colour temperature (CIE 15): of the black body nearest in the CIE 1960 "
        "plane; Duv the distance from it, above 0 on the green side. Not defined further than "
        "0.05 away, below 1,000 or above 25,000 K. Directions that were not measured have no "
        "row.");
    static const ReportColumn COLUMNS[] = {{"theta_deg", "θ, °"},
                                           {"phi_deg", "φ, °"},
                                           {"luminance_cd_m2", "L, cd/m²"},
                                           {"x", "x"},
                                           {"y", "y"},
                                           {"u", "u′"},
                                           {"v", "v′"},
                                           {"cct_k", "CCT, K"},
                                           {"duv", "Duv"}};
    for (int i = 0; i < COUNT_OF(COLUMNS); i++)
        report_column(table, COLUMNS[i].key, COLUMNS[i].title);
    add_white(report, table, s, 0, 0);
    for (int k = 0; k < COUNT_OF(ANGLES_DEG); k++)
        for (int i = 0; i < REPORT_AZIMUTHS; i += 2)
            if (is_measured(s, ANGLES_DEG[k], i)) add_white(report, table, s, ANGLES_DEG[k], i);
}

void report_viewing(Report *report, const PlotData *data) {
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
