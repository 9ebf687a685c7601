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

/* Over the leaving angle, degrees; positive on the mirror's side. Finer around the mirror
 * direction. *peak: the largest within the cone. */
static Series *add_plane_curve(ChartRows *out, const PlotData *s, double incidence_deg, int *peak) {
    ChartPoints p = chart_rows_points(out, PLANE_POINTS);
    bool *is_pale = ARENA_NEW(out->arena, bool, PLANE_POINTS);
    double incidence = radians_from_degrees(incidence_deg);
    p.count = *peak = 0;
    for (double deg = -88; deg <= 88 && p.count < PLANE_POINTS; p.count++) {
        double theta = radians_from_degrees(fabs(deg)), phi = deg < 0 ? PI : 0;
        p.x[p.count] = deg;
        p.y[p.count] = plot_data_brdf(s, incidence, theta, phi, 0);
        is_pale[p.count] = !plot_data_brdf_is_measured(s, incidence, theta, phi);
        if (theta <= s->brdf_cone + 1e-6 && p.y[p.count] > p.y[*peak]) *peak = p.count;
        deg += fabs(deg - incidence_deg) < 6 ? 0.05 : 0.25;
    }
    const char *name = arena_format(out->arena, "%.3g°", incidence_deg);
    Series *curve = chart_rows_add(out, SERIES_CURVE, name, (Stroke){.width = 1.5}, p);
    curve->is_pale = is_pale;
    return curve;
}

/* Of all values above 0. */
static void find_range(const ChartRows *rows, double *low, double *high) {
    *low = INFINITY;
    *high = 0;
    for (int k = 0; k < rows->count; k++) {
        ChartPoints p = rows->series[k].points;
        for (int i = 0; i < p.count; i++) {
            if (!(p.y[i] > 0)) continue;
            *low = fmin(*low, p.y[i]);
            *high = fmax(*high, p.y[i]);
        }
    }
    if (!(*high > 0)) *high = 1;
}

static void fill_plane(const PanelChart *shown, ChartRows *out) {
    const PlotData *s = shown->data;
    double deg[INCIDENCES_SHOWN], low, high;
    int peak[INCIDENCES_SHOWN], count = chosen_incidences(s, deg);
    panel_chart_angles(out, "leaving angle in the plane of incidence, mirror side positive",
                       s->brdf_cone);
    for (int k = count - 1; k >= 0; k--) {
        Series *curve = add_plane_curve(out, s, deg[k], &peak[k]);
        curve->stroke.ink = panel_chart_series_ink(out->theme, k, count);
        curve->stroke.dash = k % 2 ? DASH_LONG : DASH_NONE;
    }
    find_range(out, &low, &high);
    low = round_down(fmax(fmin(low, high / 10), high / 1e7));
    out->y = axis_log(low, round_up(high * 1.8), "BRDF, sr⁻¹");
    out->right = 14;
    for (int k = 0; k < count; k++) {
        const Series *curve = &out->series[1 + count - k]; /* behind two hatches */
        ChartPoints p = curve->points;
        Series *word = chart_rows_word(out, p.x[peak[k]], fmax(p.y[peak[k]], low),
                                       curve->stroke.ink, curve->name);
        word->dy = -5;
        word->across = 0.5;
        word->crowd = CROWD_IS_LEFT_OUT;
    }
}

/* ---- over wavelength -------------------------------------------------------------------- */

#define WAVELENGTH_POINTS 101

static const double ASPECULAR_DEG[] = {0, 2, 5, 10, 15, 25, 45};
#define ASPECULAR_COUNT COUNT_OF(ASPECULAR_DEG)

/* The leaving direction goes towards the normal, then past it. */
static ChartPoints over_wavelength(const ChartRows *out, const PlotData *s, int incidence_deg,
                                   double aspecular_deg, bool is_measured) {
    ChartPoints p = chart_rows_points(out, is_measured ? s->wavelength_count : WAVELENGTH_POINTS);
    double first = (double)s->wavelength_nm[0], leaving = incidence_deg - aspecular_deg;
    double last = (double)s->wavelength_nm[s->wavelength_count - 1];
    for (int i = 0; i < p.count; i++) {
        p.x[i] = is_measured ? (double)s->wavelength_nm[i]
                             : first + (last - first) * i / (WAVELENGTH_POINTS - 1);
        p.y[i] = plot_data_brdf(s, radians_from_degrees(incidence_deg),
                                radians_from_degrees(fabs(leaving)), leaving < 0 ? PI : 0, p.x[i]);
    }
    return p;
}

static void fill_wavelengths(const PanelChart *shown, ChartRows *out) {
    const PlotData *s = shown->data;
    double low, high;
    for (int k = 0; k < ASPECULAR_COUNT; k++) {
        Ink ink = panel_chart_series_ink(out->theme, k, ASPECULAR_COUNT);
        Series *curve =
            chart_rows_add(out, SERIES_CURVE, arena_format(out->arena, "%g°", ASPECULAR_DEG[k]),
                           (Stroke){ink, 1.4, DASH_NONE},
                           over_wavelength(out, s, shown->index, ASPECULAR_DEG[k], false));
        curve->label = curve->name;
        if (s->wavelength_count <= 40)
            chart_rows_add(out, SERIES_DOTS, NULL, (Stroke){ink, 1.5, DASH_NONE},
                           over_wavelength(out, s, shown->index, ASPECULAR_DEG[k], true));
    }
    find_range(out, &low, &high);
    out->x = axis_even((double)s->wavelength_nm[0],
                       (double)s->wavelength_nm[s->wavelength_count - 1], "Wavelength, nm");
    out->x.step = 50;
    out->y = axis_log(round_down(fmin(low, high / 2)), round_up(high * 1.05), "BRDF, sr⁻¹");
    out->right = 40;
}

/* ---- over the hemisphere ---------------------------------------------------------------- */

static void fill_map(const PanelChart *shown, ChartRows *out) {
    const PlotData *s = shown->data;
    double incidence = radians_from_degrees(shown->index);
    Field field = plot_data_brdf_field(s, incidence, out->arena);
    FieldRange range = field_range(&field, radians_from_degrees(85));
    PolarMap map = {.map = MAP_SCATTER,
                    .is_log = true,
                    .strong = NAN,
                    .high = fmax(range.high, 1e-12),
                    .theta_measured = s->brdf_cone,
                    .unit = "sr⁻¹",
                    .has_light = true,
                    .theta_light = incidence};
    map.measured = plot_data_brdf_measured(s, incidence, out->arena);
    map.low = round_down(fmax(range.low, map.high / 1e6));
    if (map.high < 1.5 * map.low) map.low = map.high / 1.5;
    double peak = map.high, most = field_quantile(&field, s->brdf_cone, 0.99, *out->arena);
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
    panel_chart_polar(out, field, map);
}

/* ---- the mirror part -------------------------------------------------------------------- */

#define MIRROR_POINTS 179

/* nm 0: photopic. scale above 0: one surface of index 1.5, times so much. */
static ChartPoints mirror_points(const ChartRows *out, const PlotData *s, double nm, double scale) {
    ChartPoints p = chart_rows_points(out, MIRROR_POINTS);
    for (int i = 0; i < p.count; i++) {
        p.x[i] = i * 0.5;
        double theta = radians_from_degrees(p.x[i]);
        p.y[i] = scale > 0 ? scale * fresnel_unpolarised_d(cos(theta), 1.5)
                           : panel_figure_mirror(s->source.panel, theta, nm);
    }
    return p;
}

static void add_mirror(ChartRows *out, const char *name, Stroke stroke, ChartPoints points) {
    Series *curve = chart_rows_add(out, SERIES_CURVE, name, stroke, points);
    curve->label = stroke.dash == DASH_DOT ? NULL : name;
    curve->label_index = 164; /* 82 degrees */
}

static void fill_mirror(const PanelChart *shown, ChartRows *out) {
    static const double NM[] = {0, 450, 550, 650};
    static const char *const NAMES[] = {"photopic", "450 nm", "550 nm", "650 nm"};
    const PlotData *s = shown->data;
    const Theme *theme = out->theme;
    double low = 1, normal = panel_figure_mirror(s->source.panel, 0, 0);
    chart_rows_hatch(out, degrees_from_radians(s->last_incidence), 90);
    add_mirror(out, "glass", (Stroke){theme->soft, 1, DASH_LONG}, mirror_points(out, s, 0, 1));
    add_mirror(out, "glass, scaled", (Stroke){theme->soft, 1, DASH_DOT},
               mirror_points(out, s, 0, normal / fresnel_unpolarised_d(1, 1.5)));
    for (int k = 3; k >= 0; k--) {
        ChartPoints p = mirror_points(out, s, NM[k], 0);
        add_mirror(out, NAMES[k],
                   (Stroke){k ? theme->primary[3 - k] : theme->ink, k ? 1.2 : 1.9, DASH_NONE}, p);
        for (int i = 0; i < p.count && k == 0; i++)
            if (p.y[i] > 0) low = fmin(low, p.y[i]);
    }
    out->x = (AxisSpec){.high = 90, .step = 15, .suffix = "°", .title = "angle of incidence"};
    out->y = axis_log(round_down(fmax(low * 0.7, 1e-6)), 1, "Mirror reflectance");
    out->right = 62;
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
                fill_map, s, incidences[i], i ? SHEET_SPARE : SHEET_ALWAYS, false});
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
                      fill_plane, s, 0, SHEET_ALWAYS, false});
    if (s->wavelength_count > 1)
        panel_chart_add(
            list,
            &(PanelChart){
                PLOT_BRDF_SPECTRUM, "BRDF over wavelength",
                arena_format(s->arena, "incidence %d°; angle from the mirror direction%s", middle,
                             light_text(s)),
                "BRDF in sr⁻¹ over wavelength at several angles from the mirror direction, towards "
                "the normal; dots at the measured wavelengths.",
                fill_wavelengths, s, middle, SHEET_ALWAYS, false});
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
                fill_mirror, s, 0, SHEET_ALWAYS, false});
}

const PanelCharts reflection_charts = {PLOT_BRDF, PLOT_MIRROR, add_all};
