/* SPDX-License-Identifier: Apache-2.0 */
/* Reflection: sections of the BRDF, over wavelength, over the hemisphere; the mirror part. */
#include <math.h>

#include "base/count.h"
#include "base/units.h"
#include "plot/draw/ticks.h"
#include "plot/panel/panel_chart.h"
#include "spectrum/fresnel.h"

#define INCIDENCES_SHOWN 7

/* All measured incidences, or INCIDENCES_SHOWN spread over them; degrees. */
static int chosen_incidences(const PlotData *s, double deg[INCIDENCES_SHOWN]) {
    int count = s->incidence_count < INCIDENCES_SHOWN ? s->incidence_count : INCIDENCES_SHOWN;
    for (int i = 0; i < count; i++) {
        int which = count > 1 ? i * (s->incidence_count - 1) / (count - 1) : 0;
        deg[i] = degrees_from_radians(s->incidence[which]);
    }
    return count;
}

/* The measured incidence nearest to one, whole degrees. */
static int incidence_near(const PlotData *s, double deg) {
    double best = 0;
    for (int i = 0; i < s->incidence_count; i++) {
        double one = degrees_from_radians(s->incidence[i]);
        if (i == 0 || fabs(one - deg) < fabs(best - deg)) best = one;
    }
    return (int)nearbyint(best);
}

/* ---- in the plane of incidence ---------------------------------------------------------- */

#define PLANE_POINTS 1200

typedef struct PlaneCurve {
    int count, peak;
    double deg[PLANE_POINTS], value[PLANE_POINTS];
    bool is_measured[PLANE_POINTS];
} PlaneCurve;

/* Leaving angle, degrees; positive on the mirror's side. Finer around the mirror direction. */
static void fill_plane(const PlotData *s, double incidence_deg, PlaneCurve *out) {
    *out = (PlaneCurve){0};
    for (double deg = -88; deg <= 88 && out->count < PLANE_POINTS;) {
        double theta = radians_from_degrees(fabs(deg));
        out->deg[out->count] = deg;
        out->value[out->count] =
            plot_data_brdf(s, radians_from_degrees(incidence_deg), theta, deg < 0 ? PI : 0, 0);
        bool is_in = theta <= s->brdf_cone + 1e-6;
        out->is_measured[out->count] = plot_data_brdf_is_measured(
            s, radians_from_degrees(incidence_deg), theta, deg < 0 ? PI : 0);
        if (is_in && out->value[out->count] > out->value[out->peak]) out->peak = out->count;
        out->count++;
        deg += fabs(deg - incidence_deg) < 6 ? 0.05 : 0.25;
    }
}

static void brdf_range(const PlaneCurve *curve, int count, double *low, double *high) {
    *low = INFINITY;
    *high = 0;
    for (int k = 0; k < count; k++)
        for (int i = 0; i < curve[k].count; i++) {
            if (!(curve[k].value[i] > 0)) continue;
            *low = fmin(*low, curve[k].value[i]);
            *high = fmax(*high, curve[k].value[i]);
        }
    if (!(*high > 0)) *high = 1;
    *low = round_down(fmax(fmin(*low, *high / 10), *high / 1e7));
    *high = round_up(*high * 1.8);
}

/* Pale where it is extrapolated. */
static void draw_plane_curve(Chart *chart, const PlaneCurve *curve, Stroke stroke) {
    Ink ink = stroke.ink;
    for (int begin = 0, i = 1; i <= curve->count; i++) {
        bool goes_on = i < curve->count && curve->is_measured[i] == curve->is_measured[begin];
        if (goes_on) continue;
        int last = i < curve->count ? i + 1 : i; /* the next piece's first point joins them */
        stroke.ink = ink_alpha(ink, curve->is_measured[begin] ? 1 : 0.3);
        chart_curve(chart, curve->deg + begin, curve->value + begin, last - begin, stroke);
        begin = i;
    }
}

static void draw_plane(Canvas *canvas, Box box, const PanelChart *shown, PanelChartMap *out) {
    const PlotData *s = shown->data;
    double deg[INCIDENCES_SHOWN];
    int count = chosen_incidences(s, deg);
    double low, high, last_x = -INFINITY, last_y = 0;
    PlaneCurve *curve = ARENA_NEW(canvas->arena, PlaneCurve, count);
    for (int k = 0; k < count; k++) fill_plane(s, deg[k], &curve[k]);
    brdf_range(curve, count, &low, &high);
    Chart chart = chart_open(
        canvas, box,
        (AxisSpec){.low = -90,
                   .high = 90,
                   .step = 30,
                   .suffix = "°",
                   .title = "leaving angle in the plane of incidence, mirror side positive"},
        (AxisSpec){.low = low, .high = high, .is_log = true, .title = "BRDF, sr⁻¹"}, 14);
    panel_chart_hatch(&chart, s->brdf_cone);
    for (int k = count - 1; k >= 0; k--)
        draw_plane_curve(
            &chart, &curve[k],
            (Stroke){panel_chart_series_ink(canvas, k, count), 1.5, k % 2 ? DASH_LONG : DASH_NONE});
    for (int k = 0; k < count; k++) {
        double x = chart_x(&chart, curve[k].deg[curve[k].peak]);
        double y = chart_y(&chart, fmax(curve[k].value[curve[k].peak], low)) - 5;
        if (x - last_x < 15 && fabs(y - last_y) < 12) continue;
        canvas_text(canvas, x, y,
                    (Letters){.size = SIZE_TICK,
                              .across = 0.5,
                              .down = 1,
                              .ink = panel_chart_series_ink(canvas, k, count),
                              .halo = canvas->theme.paper},
                    arena_format(canvas->arena, "%.3g°", deg[k]));
        last_x = x;
        last_y = y;
    }
    panel_chart_map_axes(out, &chart);
}

/* ---- over wavelength -------------------------------------------------------------------- */

#define WAVELENGTH_POINTS 101

static const double ASPECULAR_DEG[] = {0, 2, 5, 10, 15, 25, 45};
#define ASPECULAR_COUNT COUNT_OF(ASPECULAR_DEG)

typedef struct WavelengthCurve {
    double nm[WAVELENGTH_POINTS], value[WAVELENGTH_POINTS];
} WavelengthCurve;

static void fill_wavelengths(const PlotData *s, double incidence_deg, double aspecular_deg,
                             WavelengthCurve *out) {
    double first = (double)s->wavelength_nm[0];
    double last = (double)s->wavelength_nm[s->wavelength_count - 1];
    double leaving = incidence_deg - aspecular_deg; /* towards the normal, then past it */
    for (int i = 0; i < WAVELENGTH_POINTS; i++) {
        out->nm[i] = first + (last - first) * i / (WAVELENGTH_POINTS - 1);
        out->value[i] =
            plot_data_brdf(s, radians_from_degrees(incidence_deg),
                           radians_from_degrees(fabs(leaving)), leaving < 0 ? PI : 0, out->nm[i]);
    }
}

static void draw_wavelengths(Canvas *canvas, Box box, const PanelChart *shown, PanelChartMap *out) {
    const PlotData *s = shown->data;
    WavelengthCurve *curve = ARENA_NEW(canvas->arena, WavelengthCurve, ASPECULAR_COUNT);
    double low = INFINITY, high = 0;
    for (int k = 0; k < ASPECULAR_COUNT; k++) {
        fill_wavelengths(s, shown->index, ASPECULAR_DEG[k], &curve[k]);
        for (int i = 0; i < WAVELENGTH_POINTS; i++) {
            if (curve[k].value[i] > 0) low = fmin(low, curve[k].value[i]);
            high = fmax(high, curve[k].value[i]);
        }
    }
    if (!(high > 0)) high = 1;
    low = round_down(fmin(low, high / 2));
    Chart chart = chart_open(
        canvas, box,
        (AxisSpec){.low = curve[0].nm[0],
                   .high = curve[0].nm[WAVELENGTH_POINTS - 1],
                   .step = 50,
                   .title = "Wavelength, nm"},
        (AxisSpec){
            .low = low, .high = round_up(high * 1.05), .is_log = true, .title = "BRDF, sr⁻¹"},
        40);
    for (int k = 0; k < ASPECULAR_COUNT; k++) {
        Ink ink = panel_chart_series_ink(canvas, k, ASPECULAR_COUNT);
        chart_curve(&chart, curve[k].nm, curve[k].value, WAVELENGTH_POINTS,
                    (Stroke){ink, 1.4, DASH_NONE});
        for (int w = 0; w < s->wavelength_count && s->wavelength_count <= 40; w++) {
            double nm = (double)s->wavelength_nm[w], leaving = shown->index - ASPECULAR_DEG[k];
            chart_dot(&chart, nm,
                      plot_data_brdf(s, radians_from_degrees(shown->index),
                                     radians_from_degrees(fabs(leaving)), leaving < 0 ? PI : 0, nm),
                      1.5, ink);
        }
        chart_name_curve(&chart, curve[k].nm, curve[k].value, WAVELENGTH_POINTS, ink,
                         arena_format(canvas->arena, "%g°", ASPECULAR_DEG[k]));
    }
    chart_close(&chart);
    panel_chart_map_axes(out, &chart);
}

/* ---- over the hemisphere ---------------------------------------------------------------- */

static void draw_map(Canvas *canvas, Box box, const PanelChart *shown, PanelChartMap *out) {
    const PlotData *s = shown->data;
    Field *field = ARENA_NEW(canvas->arena, Field, 1);
    double incidence = radians_from_degrees(shown->index);
    *field = plot_data_brdf_field(s, incidence, canvas->arena);
    FieldRange range = field_range(field, radians_from_degrees(85));
    PolarMap map = {.field = field,
                    .map = MAP_SCATTER,
                    .is_log = true,
                    .strong = NAN,
                    .high = fmax(range.high, 1e-12),
                    .theta_measured = s->brdf_cone,
                    .unit = "sr⁻¹",
                    .has_light = true,
                    .theta_light = incidence};
    map.measured = plot_data_brdf_measured(s, incidence, canvas->arena);
    map.low = round_down(fmax(range.low, map.high / 1e6));
    if (map.high < 1.5 * map.low) map.low = map.high / 1.5;
    double peak = map.high, most = field_quantile(field, s->brdf_cone, 0.99, *canvas->arena);
    if (map.high > 20 * most && most > map.low) { /* a narrow peak leaves no colours for haze */
        map.high = round_up(8 * most);
        map.is_cut = true;
        peak = map.high;
    }
    static const double STEPS[3][3] = {{1, 2, 5}, {1, 3, 3}, {1, 1, 1}};
    int density = peak / map.low < 60 ? 0 : map.high / map.low < 3000 ? 1 : 2;
    for (double decade = pow(10, floor(log10(map.low))); decade < peak; decade *= 10)
        for (int k = 0; k < 3 - density; k++) {
            double level = decade * STEPS[density][k];
            if (level > range.low * 1.02 && level < peak * 0.98 &&
                map.level_count < POLAR_LEVELS_MAX)
                map.level[map.level_count++] = level;
        }
    panel_chart_polar(canvas, box, &map, out);
}

/* ---- the mirror part -------------------------------------------------------------------- */

#define MIRROR_POINTS 179

static void draw_mirror(Canvas *canvas, Box box, const PanelChart *shown, PanelChartMap *out) {
    static const double NM[] = {0, 450, 550, 650};
    static const char *const NAMES[] = {"photopic", "450 nm", "550 nm", "650 nm"};
    const PlotData *s = shown->data;
    double deg[MIRROR_POINTS], value[4][MIRROR_POINTS], glass[2][MIRROR_POINTS], low = 1;
    double normal = panel_figure_mirror(s->source.panel, 0, 0) / fresnel_unpolarised_d(1, 1.5);
    for (int i = 0; i < MIRROR_POINTS; i++) {
        deg[i] = i * 0.5;
        double theta = radians_from_degrees(deg[i]);
        for (int k = 0; k < 4; k++)
            value[k][i] = panel_figure_mirror(s->source.panel, theta, NM[k]);
        glass[0][i] = fresnel_unpolarised_d(cos(theta), 1.5);
        glass[1][i] = normal * glass[0][i];
        if (value[0][i] > 0) low = fmin(low, value[0][i]);
    }
    Chart chart =
        chart_open(canvas, box,
                   (AxisSpec){.high = 90, .step = 15, .suffix = "°", .title = "angle of incidence"},
                   (AxisSpec){.low = round_down(fmax(low * 0.7, 1e-6)),
                              .high = 1,
                              .is_log = true,
                              .title = "Mirror reflectance"},
                   62);
    chart_hatch(&chart, degrees_from_radians(s->last_incidence), 90);
    for (int i = 0; i < 2; i++)
        chart_curve(&chart, deg, glass[i], MIRROR_POINTS,
                    (Stroke){canvas->theme.soft, 1, i ? DASH_DOT : DASH_LONG});
    for (int k = 3; k >= 0; k--) {
        Ink ink = k == 0 ? canvas->theme.ink : canvas->theme.primary[3 - k];
        chart_curve(&chart, deg, value[k], MIRROR_POINTS,
                    (Stroke){ink, k == 0 ? 1.9 : 1.2, DASH_NONE});
        chart_name(&chart, 82, value[k][164], ink, NAMES[k]);
    }
    chart_name(&chart, 82, glass[0][164], canvas->theme.soft, "glass");
    chart_close(&chart);
    panel_chart_map_axes(out, &chart);
}

static const char *light_text(const PlotData *s) {
    double deg = degrees_from_radians(s->source.incidence_phi);
    return fabs(s->source.incidence_phi - PI) < 1e-9 && !s->is_anisotropic
               ? ""
               : arena_format(s->arena, ", light from φ %.4g°", deg);
}

static void add_maps(PanelChartList *list, const PlotData *s) {
    int incidences[2] = {incidence_near(s, 30), incidence_near(s, 60)};
    for (int i = 0; i < 2; i++) {
        char peak[32];
        if (i == 1 && incidences[1] < incidences[0] + 10) continue;
        double incidence = radians_from_degrees(incidences[i]);
        Field field = plot_data_brdf_field(s, incidence, s->arena);
        FieldRange range = field_range(&field, s->brdf_cone);
        panel_chart_add(
            list,
            &(PanelChart){
                PLOT_BRDF_MAP, arena_format(s->arena, "BRDF at %d° incidence", incidences[i]),
                arena_format(s->arena,
                             "φ from the mirror direction, photopic mean; %s sr⁻¹ at the "
                             "peak%s",
                             figure_text(range.high, peak), light_text(s)),
                "BRDF in sr⁻¹ over the leaving directions on a logarithmic scale, without the "
                "mirror part; φ counts from the mirror direction, the light's own direction is "
                "marked.",
                draw_map, s, incidences[i], i ? SHEET_SPARE : SHEET_ALWAYS, false});
    }
}

static void add_all(PanelChartList *list, const PlotData *s) {
    if (!s->reflects) return;
    int middle = incidence_near(s, 30);
    panel_chart_add(
        list,
        &(PanelChart){PLOT_BRDF, "BRDF in the plane of incidence",
                      arena_format(s->arena,
                                   "photopic mean, without the mirror part; incidence at each "
                                   "peak%s",
                                   light_text(s)),
                      "BRDF in sr⁻¹ over the leaving angle in the plane of incidence, one curve an "
                      "incidence. The mirror part is not in it.",
                      draw_plane, s, 0, SHEET_ALWAYS, false});
    if (s->wavelength_count > 1)
        panel_chart_add(
            list,
            &(PanelChart){
                PLOT_BRDF_SPECTRUM, "BRDF over wavelength",
                arena_format(s->arena, "incidence %d°; angle from the mirror direction%s", middle,
                             light_text(s)),
                "BRDF in sr⁻¹ over wavelength at several angles from the mirror direction, towards "
                "the normal; dots at the measured wavelengths.",
                draw_wavelengths, s, middle, SHEET_ALWAYS, false});
    add_maps(list, s);
    if (s->has_mirror)
        panel_chart_add(
            list,
            &(PanelChart){
                PLOT_MIRROR, "Mirror reflectance",
                "dashed: a surface of index 1.5; dotted: scaled to the panel's",
                "Reflectance of the mirror part over the angle of incidence beside the Fresnel "
                "reflectance of one surface of refractive index 1.5 (dashed), also scaled to the "
                "panel's value at the normal (dotted).",
                draw_mirror, s, 0, SHEET_ALWAYS, false});
}

const PanelCharts reflection_charts = {PLOT_BRDF, PLOT_MIRROR, add_all};
