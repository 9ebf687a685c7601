/* SPDX-License-Identifier: Apache-2.0 */
/* Gamma by angle, and grey inversion. */
#include "plot/report/level_tables.h"

#include <math.h>

#include "base/count.h"
#include "base/units.h"
#include "plot/panel/grey_inversion.h"
#include "plot/report/report_azimuth.h"

static const int ANGLES_DEG[] = {0, 15, 30, 45, 60};

/* ---- gamma ------------------------------------------------------------------------------- */

/* Exponent of the power law through full drive: least squares of the logarithms over the
 * measured levels of grey, black subtracted. */
static double gamma_at(const PlotData *s, double theta, double phi) {
    double code[PANEL_INFO_LEVELS_MAX], black[3], full[3], xyz[3], xx = 0, xy = 0;
    int count = panel_info_levels(s->source.panel, 1, code);
    plot_data_xyz(s, theta, phi, (float[3]){0, 0, 0}, black);
    plot_data_xyz(s, theta, phi, (float[3]){255, 255, 255}, full);
    for (int i = 0; i < count; i++) {
        float c = (float)code[i];
        plot_data_xyz(s, theta, phi, (float[3]){c, c, c}, xyz);
        double light = (xyz[1] - black[1]) / (full[1] - black[1]), x = log(code[i] / 255);
        if (!(light > 0) || x == 0) continue;
        xx += x * x;
        xy += x * log(light);
    }
    return xx > 0 ? xy / xx : NAN;
}

static void add_gamma_row(Report *report, ReportTable *table, const PlotData *s, int deg) {
    report_row(report, table);
    report_fixed(report, table, deg, 0);
    for (int i = 0; i < REPORT_AZIMUTHS; i++) {
        double theta = radians_from_degrees(deg);
        bool is_measured =
            theta <= s->cone + 1e-6 && report_has_azimuth(s, i) && !(s->is_white_only && deg > 0);
        if (is_measured || deg == 0) report_fixed(report, table, gamma_at(s, theta, i * PI / 4), 3);
        else report_text(table, NOT_MEASURED);
    }
}

static void add_gamma(Report *report, const PlotData *s) {
    ReportTable *table = report_add(
        report, "gamma", "Gamma by angle",
        s->is_white_only
            ? "Exponent of the power law through full white, least squares of the logarithms "
              "over the measured levels, black subtracted. The levels were measured at the "
              "normal only."
            : "Exponent of the power law through full white, least squares of the logarithms "
              "over the measured levels of grey (red, green and blue at one code), black "
              "subtracted.");
    report_column(table, "theta_deg", "θ, °");
    report_azimuth_columns(report, table);
    for (int k = 0; k < COUNT_OF(ANGLES_DEG); k++) add_gamma_row(report, table, s, ANGLES_DEG[k]);
}

/* ---- inversion --------------------------------------------------------------------------- */

static void add_inversion_row(Report *report, ReportTable *table, const char *where,
                              const GreyInversion *most, double first) {
    report_row(report, table);
    report_text(table, where);
    report_text(table, most->share > 0 ? "yes" : "none");
    report_fixed(report, table, degrees_from_radians(first), 2);
    report_fixed(report, table, most->share > 0 ? 100 * most->share : NAN, 1);
    report_fixed(report, table, most->share > 0 ? degrees_from_radians(most->theta) : NAN, 1);
    report_fixed(report, table, most->share > 0 ? degrees_from_radians(most->phi) : NAN, 0);
    report_fixed(report, table, most->share > 0 ? most->low : NAN, 0);
    report_fixed(report, table, most->share > 0 ? most->high : NAN, 0);
}

static void add_inversion(Report *report, const PlotData *s, const GreyLevels *levels) {
    static const char *const WHERE[] = {"φ 0° right",  "φ 45°",  "φ 90° up",    "φ 135°",
                                        "φ 180° left", "φ 225°", "φ 270° down", "φ 315°"};
    static const ReportColumn COLUMNS[] = {{"where", "Where"},
                                           {"inverts", "Inverts"},
                                           {"from_theta_deg", "From θ, °"},
                                           {"largest_percent", "Largest, %"},
                                           {"theta_deg", "at θ, °"},
                                           {"phi_deg", "φ, °"},
                                           {"level", "Level"},
                                           {"brighter_than_level", "brighter than"}};
    ReportTable *table = report_add(
        report, "grey_inversion", "Grey inversion",
        "Where a higher grey level gives less light than a lower one: the largest of all pairs "
        "of measured levels, 1 − L(higher) / L(lower), black included. Less than 1 % counts as "
        "none. The last row is the largest of all azimuths, every 5°, or of those measured "
        "where they are few.");
    for (int i = 0; i < COUNT_OF(COLUMNS); i++)
        report_column(table, COLUMNS[i].key, COLUMNS[i].title);
    double first = NAN;
    for (int i = 0; i < REPORT_AZIMUTHS; i++) {
        GreyInversion most = grey_inversion_along(s, levels, i * PI / 4, &first);
        if (!report_has_azimuth(s, i)) continue;
        add_inversion_row(report, table, WHERE[i], &most, first);
    }
    GreyInversion all = grey_inversion_most(s, levels);
    if (all.share > 0) grey_inversion_along(s, levels, all.phi, &first);
    add_inversion_row(report, table, "largest of all", &all, all.share > 0 ? first : NAN);
}

void report_levels(Report *report, const PlotData *data) {
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
