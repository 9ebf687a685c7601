/* SPDX-License-Identifier: Apache-2.0 */
/* What the panel sends back: its BRDF in the plane of incidence, and reflectances over the
 * incidence. */
#include <math.h>

#include "base/units.h"
#include "plot/draw/ticks.h"
#include "plot/panel/plot_charts.h"
#include "spectrum/fresnel.h"

#define INCIDENCES_SHOWN 7

/* What was measured, positive on the mirror's side; finer around the mirror direction. */
static void add_plane(Chart *chart, const PlotData *s, double incidence, Stroke stroke) {
    double peak = degrees_from_radians(incidence);
    chart_series(chart, arena_format(s->arena, "%.3g°", peak), stroke)->is_key = true;
    for (double deg = -88; deg <= 88; deg += fabs(deg - peak) < 6 ? 0.1 : 0.5) {
        double theta = radians_from_degrees(fabs(deg)), phi = deg < 0 ? PI : 0;
        bool is_measured = plot_data_brdf_is_measured(s, incidence, theta, phi);
        chart_point(chart, deg,
                    is_measured ? plot_data_brdf(s, incidence, theta, phi, s->nm) : (double)NAN);
    }
}

/* The set's samples at that incidence, of the light from that azimuth. */
static void add_samples(Chart *chart, const PlotData *s, double incidence, Ink ink) {
    const Measurement *set = s->measured;
    int channel = 0;
    for (int w = 1; w < set->wavelength_count; w++)
        if (fabs((double)set->wavelength_nm[w] - s->nm) <
            fabs((double)set->wavelength_nm[channel] - s->nm))
            channel = w;
    for (int a = 0; a < set->azimuth_count; a++)
        for (int i = 0; i < set->incidence_count; i++) {
            bool is_azimuth = set->azimuth_count == 1 ||
                              fabs(remainder(set->azimuth[a] - s->incidence_phi, 2 * PI)) < 1e-3;
            if (is_azimuth && fabs(set->incidence[i] - incidence) < 1e-3)
                plot_samples(chart, &set->brdf[a * set->incidence_count + i], channel, 0, ink);
        }
}

static void add_brdf(PlotCharts *charts, const PlotData *s) {
    double last = degrees_from_radians(panel_info_reflection_cone(s->panel));
    int count = s->incidence_count < INCIDENCES_SHOWN ? s->incidence_count : INCIDENCES_SHOWN;
    Chart *chart = chart_new(CHART_AXES, "BRDF in the plane of incidence",
                             "leaving angle, mirror side positive", "BRDF, sr⁻¹", s->arena);
    chart->x = (ChartAxis){.low = -90, .high = 90, .step = 30, .suffix = "°"};
    chart->measured[0] = -last;
    chart->measured[1] = last;
    for (int k = 0; k < count; k++) {
        int which = count > 1 ? k * (s->incidence_count - 1) / (count - 1) : 0;
        Ink ink = ink_of_amount(count > 1 ? 0.1 + 0.55 * k / (count - 1) : 0.1);
        add_plane(chart, s, s->incidence[which], (Stroke){ink, 1.5, k % 2 ? DASH_LONG : DASH_NONE});
        if (s->measured) add_samples(chart, s, s->incidence[which], ink);
    }
    double low = INFINITY, high = chart_range(chart, 0).high;
    for (int i = 0; i < chart->table->row_count; i++)
        if (chart_cell(chart, i, 2) > 0) low = fmin(low, chart_cell(chart, i, 2));
    chart->y = (ChartAxis){round_down(fmax(fmin(low, high / 10), high / 1e7)), round_up(high * 1.3),
                           .is_log = true};
    double from = degrees_from_radians(s->incidence_phi);
    chart->subtitle =
        arena_format(s->arena, "%.4g nm, without the mirror part; one curve an incidence%s", s->nm,
                     s->is_anisotropic || fabs(from - 180) > 1e-6
                         ? arena_format(s->arena, "; light from φ %.4g°", from)
                         : "");
    chart->caption =
        "BRDF in sr⁻¹ over the leaving angle in the plane of incidence, where it was measured, at "
        "one wavelength. Rings: the samples of the set, where it is given; what stands above the "
        "line at the mirror direction is the instrument's image of the mirror part, which the file "
        "keeps apart.";
    plot_add(charts, chart);
}

/* index 0: the mirror part, 1: haze and floor, 2: one surface of index 1.5. */
static void add_reflectance(Chart *chart, const PlotData *s, int index) {
    for (double deg = 0; deg <= degrees_from_radians(s->last_incidence) + 1e-6; deg += 0.5) {
        double theta = radians_from_degrees(deg);
        chart_point(chart, deg,
                    index == 0   ? panel_figure_mirror(s->panel, theta, 0)
                    : index == 1 ? panel_figure_diffuse(s->panel, theta)
                                 : fresnel_unpolarised_d(cos(theta), 1.5));
    }
}

static void add_reflectances(PlotCharts *charts, const PlotData *s) {
    static const char *const NAMES[] = {"mirror", "haze, floor", "glass"};
    Chart *chart = chart_new(CHART_AXES, "Reflectance by incidence", "angle of incidence",
                             "Luminous reflectance", s->arena);
    double low = 1, high = 0;
    for (int i = 0; i < 3; i++) {
        Stroke stroke = {i == 0   ? INK_TEXT
                         : i == 1 ? ink_of_primary(2)
                                  : INK_SOFT,
                         1.6, i == 2 ? DASH_LONG : DASH_NONE};
        chart_series(chart, NAMES[i], stroke)->is_key = true;
        add_reflectance(chart, s, i);
    }
    for (int i = 0; i < chart->table->row_count; i++) {
        double value = chart_cell(chart, i, 2);
        if (value > 1e-6) low = fmin(low, value);
        high = fmax(high, value);
    }
    chart->x = (ChartAxis){.high = 90, .step = 15, .suffix = "°"};
    chart->y = (ChartAxis){round_down(low * 0.7), round_up(high * 1.2), .is_log = true};
    chart->measured[1] = degrees_from_radians(s->last_incidence);
    chart->subtitle = "dashed: one surface of refractive index 1.5";
    chart->caption = "What the panel sends back of light from an angle: like a mirror, and as haze "
                     "and floor into the hemisphere, beside the Fresnel reflectance of one surface "
                     "of refractive index 1.5 (dashed).";
    plot_add(charts, chart);
}

static void add_all(PlotCharts *charts, const PlotData *data, PlotKind kind) {
    if (plot_wants(kind, PLOT_BRDF)) add_brdf(charts, data);
    if (plot_wants(kind, PLOT_REFLECTANCE)) add_reflectances(charts, data);
}

PlotAdd *const reflection_charts = add_all;
