/* SPDX-License-Identifier: Apache-2.0 */
/* Reflectance by incidence and in the usual geometries; contrast in ambient light. */
#include "plot/report/light_tables.h"

#include <math.h>

#include "base/count.h"
#include "base/units.h"
#include "plot/report/report_azimuth.h"

#define WITHOUT_REFLECTION \
    "The reflection was not measured: no reflectance and no contrast in ambient light are " \
    "stated."

/* ---- reflectance ------------------------------------------------------------------------- */

static void add_incidence(Report *report, ReportTable *table, const PlotData *s, double theta) {
    double mirror = plot_data_mirror(s, theta, 0), all = plot_data_albedo(s, theta);
    double even = fmin(PI * plot_data_lambertian(s, theta), all);
    report_row(report, table);
    report_fixed(report, table, degrees_from_radians(theta), 1);
    report_figure(report, table, 100 * mirror);
    report_figure(report, table, 100 * (all - even));
    report_figure(report, table, 100 * even);
    report_figure(report, table, 100 * (mirror + all));
    report_figure(report, table, plot_data_brdf(s, theta, theta, 0, 0));
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
    ReportTable *table = report_add(report, "reflectance", "Reflectance by incidence", note);
    static const ReportColumn COLUMNS[] = {
        {"incidence_deg", "Incidence, °"},
        {"specular_percent", "Specular, %"},
        {"haze_percent", "Haze, %"},
        {"lambertian_percent", "Lambertian, %"},
        {"total_percent", "Total, %"},
        {"brdf_mirror_direction_sr", "BRDF in the mirror direction without specular, sr⁻¹"}};
    for (int i = 0; i < COUNT_OF(COLUMNS); i++)
        report_column(table, COLUMNS[i].key, COLUMNS[i].title);
    for (int i = 0; i < s->incidence_count; i++) add_incidence(report, table, s, s->incidence[i]);
}

static void add_factor(Report *report, ReportTable *table, const char *const texts[2],
                       bool is_measured, double value) {
    report_row(report, table);
    for (int i = 0; i < 2; i++) report_text(table, texts[i]);
    if (is_measured) report_figure(report, table, 100 * value);
    else report_text(table, NOT_MEASURED);
}

static void add_factors(Report *report, const PlotData *s) {
    double at_8 = radians_from_degrees(8), at_45 = radians_from_degrees(45);
    bool has_8 = plot_data_brdf_is_measured(s, at_8, at_8, PI);
    bool has_45 = plot_data_brdf_is_measured(s, at_45, 0, 0);
    double diffuse = plot_data_albedo(s, at_8);
    ReportTable *table = report_add(
        report, "reflectance_factors", "Reflectance factors",
        arena_format(
            report->arena,
            "Factors over a perfect white diffuser, %s, geometries of "
            "CIE 15. 8/de takes off the mirror part alone: the haze that would fall into an "
            "instrument's gloss trap, whose size no standard fixes, stays in it.",
            weights_text(report, s)));
    report_column(table, "geometry", "Geometry");
    report_column(table, "meaning", "Light : view");
    report_column(table, "factor_percent", "Factor, %");
    add_factor(report, table, (const char *const[]){"45/0", "from 45°, seen at the normal"}, has_45,
               PI * plot_data_brdf(s, at_45, 0, 0, 0));
    add_factor(report, table,
               (const char *const[]){"8/di", "from 8°, into the hemisphere, "
                                             "specular included"},
               has_8, diffuse + plot_data_mirror(s, at_8, 0));
    add_factor(report, table,
               (const char *const[]){"8/de", "from 8°, into the hemisphere, "
                                             "specular excluded"},
               has_8, diffuse);
}

void report_reflection(Report *report, const PlotData *data) {
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

static void add_condition(Report *report, ReportTable *table, const PlotData *s, const char *name,
                          const PlotLight *light) {
    report_row(report, table);
    report_text(table, name);
    report_fixed(report, table, light->lux, 0);
    report_fixed(report, table, light->directed_lux, 0);
    report_fixed(report, table,
                 light->directed_lux > 0 ? degrees_from_radians(light->directed_theta) : NAN, 1);
    report_figure(report, table, ambient_reflected(s, 0, 0, light));
    report_figure(report, table, ambient_contrast(s, 0, 0, light));
    for (int i = 0; i < REPORT_AZIMUTHS; i += 2) {
        bool is_measured = s->cone >= radians_from_degrees(30) && report_has_azimuth(s, i) &&
                           !(s->has_black && s->is_white_only); /* black on the axis alone */
        if (is_measured)
            report_figure(report, table,
                          ambient_contrast(s, radians_from_degrees(30), i * PI / 4, light));
        else report_text(table, NOT_MEASURED);
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

void report_ambient(Report *report, const PlotData *data) {
    const PlotAmbient *ambient = &data->source.ambient;
    static const ReportColumn COLUMNS[] = {{"condition", "Light"},
                                           {"diffuse_lx", "Surround, lx"},
                                           {"directed_lx", "Source, lx"},
                                           {"directed_theta_deg", "from θ, °"},
                                           {"reflected_cd_m2", "Lr at the normal, cd/m²"},
                                           {"contrast", "Contrast at the normal"},
                                           {"contrast_30_phi_0", "at 30° right"},
                                           {"contrast_30_phi_90", "30° up"},
                                           {"contrast_30_phi_180", "30° left"},
                                           {"contrast_30_phi_270", "30° down"}};
    if (!data->emits || !data->reflects) {
        report_missing(report, "ambient_contrast", "Contrast in ambient light",
                       data->emits ? WITHOUT_REFLECTION : "The emission was not measured.");
        return;
    }
    ReportTable *table = report_add(report, "ambient_contrast", "Contrast in ambient light",
                                    ambient_note(report, data));
    for (int i = 0; i < COUNT_OF(COLUMNS); i++)
        report_column(table, COLUMNS[i].key, COLUMNS[i].title);
    for (int i = 0; i < COUNT_OF(CONDITIONS); i++)
        add_condition(report, table, data, CONDITIONS[i].name,
                      &(PlotLight){CONDITIONS[i].lux, CONDITIONS[i].directed_lux, PI / 4});
    for (int i = 0; i < ambient->count; i++)
        add_condition(report, table, data, "as asked", &ambient->light[i]);
}
