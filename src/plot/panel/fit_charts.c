/* SPDX-License-Identifier: Apache-2.0 */
/* Measured against fitted: the source's points over the curves, and what is left. */
#include <math.h>
#include <string.h>

#include "base/units.h"
#include "plot/draw/ticks.h"
#include "plot/panel/panel_chart.h"

/* ---- comparing -------------------------------------------------------------------------- */

/* One emission table with the codes that it shows. */
typedef struct FitTableRef {
    const AngleTable *table;
    float rgb[3];
} FitTableRef;

#define FIT_TABLES_MAX (3 * MEASUREMENT_LEVELS_MAX + 1)

static int emission_tables(const Measurement *set, FitTableRef out[FIT_TABLES_MAX]) {
    int count = 0;
    if (set->has_black) out[count++] = (FitTableRef){&set->black, {0, 0, 0}};
    for (int p = 0; p < 3; p++)
        for (int i = 0; i < set->primary[p].level_count; i++) {
            FitTableRef ref = {&set->primary[p].table[i], {0, 0, 0}};
            ref.rgb[p] = (float)set->primary[p].level[i];
            out[count++] = ref;
        }
    return count;
}

static double table_peak(const AngleTable *table) {
    double peak = 0;
    for (int i = 0; i < table->rows; i++)
        peak = fmax(peak, (double)table->value[i * table->channels + 1]);
    return peak;
}

/* Fitted less measured luminance over the measured one, percent; over a fortieth of the
 * table's peak where the light is dimmer than that. NaN on the horizon. */
static double residual_percent(const PlotData *s, const FitTableRef *ref, int row, double peak) {
    double theta = (double)ref->table->theta[row];
    double measured = (double)ref->table->value[3 * row + 1];
    if (theta > PI / 2 - 1e-4 || !(peak > 0)) return NAN;
    double fitted =
        panel_figure_luminance(s->source.panel, theta, (double)ref->table->phi[row], ref->rgb);
    return 100 * (fitted - measured) / fmax(0.025 * peak, measured);
}

/* The largest error of X, Y and Z that the file states of its emission tables, percent. */
static double stated_error_percent(const PlotData *s) {
    size_t i;
    json_t *table;
    double most = 0;
    json_array_foreach(json_object_get(s->source.report, "tables"), i, table) {
        const char *name = json_string_value(json_object_get(table, "name"));
        if (name && !strncmp(name, "brdf", 4)) continue;
        most = fmax(most, json_number_value(json_object_get(table, "max_error")));
    }
    return 100 * most;
}

/* ---- sections with points --------------------------------------------------------------- */

/* Signed angle of a direction in the plane through phi; false outside it. */
static bool in_plane(double theta, double phi, double plane, double *deg) {
    double away = fabs(remainder(phi - plane, 2 * PI));
    double across = fabs(remainder(phi - plane - PI, 2 * PI));
    if (theta > 1e-6 && away > 1e-3 && across > 1e-3) return false;
    *deg = degrees_from_radians(theta) * (away < across ? 1 : -1);
    return true;
}

static void ring(Chart *chart, double x, double y, Ink ink) {
    double px = chart_x(chart, x), py = chart_y(chart, y);
    Box p = chart->plot;
    if (px < p.x - 1 || px > p.x + p.w + 1 || py < p.y - 1 || py > p.y + p.h + 1) return;
    canvas_circle(chart->canvas, px, py, 1.9);
    canvas_stroke(chart->canvas, (Stroke){ink, 0.8, DASH_NONE});
}

/* Points of one table in the plane, no nearer than 2 degrees. */
static void draw_points(Chart *chart, const AngleTable *table, double plane, Ink ink) {
    bool taken[181] = {false};
    for (int i = 0; i < table->rows; i++) {
        double deg;
        if (!in_plane((double)table->theta[i], (double)table->phi[i], plane, &deg)) continue;
        int slot = (int)floor((deg + 90) / 2);
        if (slot < 0 || slot > 180 || taken[slot]) continue;
        taken[slot] = true;
        ring(chart, deg, (double)table->value[i * table->channels + 1], ink);
    }
}

static void draw_fitted_curve(Chart *chart, const PlotData *s, const float rgb[3], double plane,
                              Ink ink) {
    double deg[353], value[353];
    for (int i = 0; i < 353; i++) {
        deg[i] = -88 + i * 0.5;
        value[i] =
            panel_figure_luminance(s->source.panel, radians_from_degrees(deg[i]), plane, rgb);
    }
    chart_curve(chart, deg, value, 353, (Stroke){ink, 1.2, DASH_NONE});
}

static void draw_fit_section(Canvas *canvas, Box box, const PanelChart *shown, PanelChartMap *out) {
    const PlotData *s = shown->data;
    const Measurement *set = s->source.measured;
    double high = 0, plane = shown->index ? PI / 2 : 0;
    for (int p = 0; p < 3; p++)
        high = fmax(high, table_peak(&set->primary[p].table[set->primary[p].level_count - 1]));
    Chart chart = chart_open(
        canvas, box,
        (AxisSpec){.low = -90,
                   .high = 90,
                   .step = 30,
                   .suffix = "°",
                   .title = shown->index ? "θ along φ 270° to 90°" : "θ along φ 180° to 0°"},
        (AxisSpec){.high = 1.06 * high, .title = "Luminance, cd/m²"}, 48);
    panel_chart_hatch(&chart, s->cone);
    for (int p = 0; p < 3; p++) {
        const MeasuredPrimary *primary = &set->primary[p];
        int last = primary->level_count - 1;
        float rgb[3] = {0, 0, 0};
        rgb[p] = (float)primary->level[last];
        Ink ink = canvas->theme.primary[p];
        draw_points(&chart, &primary->table[last], plane, ink);
        draw_fitted_curve(&chart, s, rgb, plane, ink);
        chart_name(&chart, 78,
                   panel_figure_luminance(s->source.panel, radians_from_degrees(78), plane, rgb),
                   ink, pattern_name((Pattern)(PATTERN_RED + p)));
    }
    chart_close(&chart);
    panel_chart_map_axes(out, &chart);
}

/* ---- levels at the normal -------------------------------------------------------------- */

/* Measured luminance at the least theta of the table. */
static double normal_luminance(const AngleTable *table) {
    return (double)table->value[1];
}

static void draw_fit_level_curve(Chart *chart, const PlotData *s, int primary, Ink ink) {
    enum { POINTS = 120 };
    double code[POINTS], value[POINTS];
    for (int i = 0; i < POINTS; i++) {
        float rgb[3] = {0, 0, 0};
        code[i] = 8 * pow(255.0 / 8, (double)i / (POINTS - 1));
        rgb[primary] = (float)code[i];
        value[i] = panel_figure_luminance(s->source.panel, 0, 0, rgb);
    }
    chart_curve(chart, code, value, POINTS, (Stroke){ink, 1.2, DASH_NONE});
    chart_name(chart, 255, value[POINTS - 1], ink, pattern_name((Pattern)(PATTERN_RED + primary)));
}

static void draw_fit_levels(Canvas *canvas, Box box, const PanelChart *shown, PanelChartMap *out) {
    const PlotData *s = shown->data;
    const Measurement *set = s->source.measured;
    double low = INFINITY, high = 0;
    for (int p = 0; p < 3; p++)
        for (int i = 0; i < set->primary[p].level_count; i++) {
            double y = normal_luminance(&set->primary[p].table[i]);
            if (y > 0) low = fmin(low, y);
            high = fmax(high, y);
        }
    low = fmax(low, high / 1e5);
    Chart chart = chart_open(
        canvas, box, (AxisSpec){.low = 8, .high = 256, .is_log = true, .title = "code of 255"},
        (AxisSpec){.low = round_down(0.6 * low),
                   .high = round_up(1.3 * high),
                   .is_log = true,
                   .title = "Luminance at the normal, cd/m², black included"},
        48);
    for (int p = 0; p < 3; p++) {
        const MeasuredPrimary *primary = &set->primary[p];
        draw_fit_level_curve(&chart, s, p, canvas->theme.primary[p]);
        for (int i = 0; i < primary->level_count; i++)
            ring(&chart, primary->level[i], normal_luminance(&primary->table[i]),
                 canvas->theme.primary[p]);
    }
    chart_close(&chart);
    panel_chart_map_axes(out, &chart);
}

/* ---- all residuals ---------------------------------------------------------------------- */

#define BINS 60
#define LEAST_PERCENT 1e-3 /* what is less counts as so much */

typedef struct Residuals {
    double bin[BINS], highest; /* samples, over the logarithm of the error */
    double reach;              /* percent, of the last bin's end */
    double most, count;
    FitTableRef worst; /* the table with the largest */
} Residuals;

static void count_residual(Residuals *out, double percent) {
    double t = log(fmax(percent, LEAST_PERCENT) / LEAST_PERCENT) / log(out->reach / LEAST_PERCENT);
    int bin = (int)(t * BINS);
    out->bin[bin < BINS ? bin : BINS - 1] += 1;
}

/* The first pass finds the largest one, the second counts. */
static void pass_over(const PlotData *s, const FitTableRef *ref, bool counts, Residuals *out) {
    double peak = table_peak(ref->table);
    for (int i = 0; i < ref->table->rows; i++) {
        double r = fabs(residual_percent(s, ref, i, peak));
        if (!isfinite(r)) continue;
        if (counts) {
            count_residual(out, r);
            continue;
        }
        out->count += 1;
        if (r <= out->most) continue;
        out->most = r;
        out->worst = *ref;
    }
}

/* The drawing's arena: the data's own may be the one that it was copied from. */
static void measure_residuals(const PlotData *s, Arena *arena, Residuals *out) {
    FitTableRef *ref = ARENA_NEW(arena, FitTableRef, FIT_TABLES_MAX);
    int tables = emission_tables(s->source.measured, ref);
    for (int t = 0; t < tables; t++) pass_over(s, &ref[t], false, out);
    out->reach = round_up(1.3 * fmax(fmax(out->most, stated_error_percent(s)), 0.01));
    for (int t = 0; t < tables; t++) pass_over(s, &ref[t], true, out);
    for (int i = 0; i < BINS; i++) out->highest = fmax(out->highest, out->bin[i]);
}

static double bin_start(const Residuals *r, int bin) {
    return LEAST_PERCENT * pow(r->reach / LEAST_PERCENT, (double)bin / BINS);
}

static void draw_histogram(Canvas *canvas, Box box, const PanelChart *shown, PanelChartMap *out) {
    const PlotData *s = shown->data;
    Residuals *r = ARENA_NEW(canvas->arena, Residuals, 1);
    double most = stated_error_percent(s);
    measure_residuals(s, canvas->arena, r);
    Chart chart = chart_open(canvas, box,
                             (AxisSpec){.low = LEAST_PERCENT,
                                        .high = r->reach,
                                        .is_log = true,
                                        .suffix = " %",
                                        .title = "size of fitted less measured luminance"},
                             (AxisSpec){.low = 0.7,
                                        .high = round_up(fmax(r->highest, 10) * 1.6),
                                        .is_log = true,
                                        .title = "samples"},
                             14);
    for (int i = 0; i < BINS; i++) {
        if (!(r->bin[i] > 0)) continue;
        double x0 = chart_x(&chart, bin_start(r, i)), x1 = chart_x(&chart, bin_start(r, i + 1));
        double y = chart_y(&chart, r->bin[i]);
        cairo_rectangle(canvas->cr, x0 + 0.4, y, x1 - x0 - 0.8, chart.plot.y + chart.plot.h - y);
        canvas_fill(canvas, ink_mix(canvas->theme.primary[2], canvas->theme.paper, 0.35));
    }
    chart_mark_x(&chart, most, (Stroke){canvas->theme.accent, 1.3, DASH_SHORT},
                 arena_format(canvas->arena, "largest error %.3g %%", most));
    panel_chart_map_axes(out, &chart);
}

/* The worst table's residuals as a map: every grid point takes its nearest sample's value. */
static Field residual_field(const PlotData *s, const FitTableRef *ref, Arena *arena) {
    Field field = field_new(301, PI / 2, arena);
    double peak = table_peak(ref->table), *nearest = ARENA_NEW(arena, double, 301 * 301);
    double spacing = sqrt(2 * PI / ref->table->rows) * 1.3; /* radians between samples */
    int reach = (int)ceil(spacing / (PI / 300)) + 1;
    reach = reach > 12 ? 12 : reach;
    double rim = 150 * ((double)ref->table->theta_max + 0.01) / (PI / 2);
    for (int i = 0; i < 301 * 301; i++) nearest[i] = INFINITY;
    for (int k = 0; k < ref->table->rows; k++) {
        double c, r, value = residual_percent(s, ref, k, peak);
        if (!isfinite(value)) continue;
        field_place(&field, (double)ref->table->theta[k], (double)ref->table->phi[k], &c, &r);
        for (int y = (int)r - reach; y <= (int)r + reach; y++)
            for (int x = (int)c - reach; x <= (int)c + reach; x++) {
                double d = hypot(x - c, y - r);
                if (x < 0 || y < 0 || x > 300 || y > 300 || d > reach ||
                    d >= nearest[y * 301 + x] || hypot(x - 150, y - 150) > rim)
                    continue;
                nearest[y * 301 + x] = d;
                field.value[y * 301 + x] = (float)value;
            }
    }
    return field;
}

/* Percent: all but one direction in fifty have less; the few are for the histogram. */
static double residual_reach(const Field *field, const PlotData *s, Arena *arena) {
    Field size = field_new(field->side, field->theta_rim, arena);
    for (int i = 0; i < field->side * field->side; i++) size.value[i] = fabsf(field->value[i]);
    return fmax(field_quantile(&size, s->cone, 0.98, *arena), LEAST_PERCENT);
}

static void draw_residual_map(Canvas *canvas, Box box, const PanelChart *shown,
                              PanelChartMap *out) {
    const PlotData *s = shown->data;
    Residuals *r = ARENA_NEW(canvas->arena, Residuals, 1);
    Field *field = ARENA_NEW(canvas->arena, Field, 1);
    measure_residuals(s, canvas->arena, r);
    *field = residual_field(s, &r->worst, canvas->arena);
    double reach = residual_reach(field, s, canvas->arena);
    PolarMap map = {.field = field,
                    .map = MAP_SIGNED,
                    .low = -reach,
                    .high = reach,
                    .is_cut = reach < 0.99 * r->most,
                    .strong = NAN,
                    .theta_measured = s->cone,
                    .unit = "%",
                    .is_residual = true};
    panel_chart_polar(canvas, box, &map, out);
}

/* ---- reflection ------------------------------------------------------------------------- */

/* The channel nearest to 550 nm. */
static int middle_channel(const Measurement *set) {
    int best = 0;
    for (int w = 1; w < set->wavelength_count; w++)
        if (fabsf(set->wavelength_nm[w] - 550) < fabsf(set->wavelength_nm[best] - 550)) best = w;
    return best;
}

#define BRDF_POINTS 2048
#define BRDF_FINE 705 /* -88 to 88 degrees, every quarter */

typedef struct BrdfPoints {
    int count;
    double deg[BRDF_POINTS], value[BRDF_POINTS];
    double fine_deg[BRDF_FINE], fitted[BRDF_FINE];
} BrdfPoints;

/* The measured azimuth of the light that is nearest to the one requested. */
static int nearest_azimuth(const PlotData *s) {
    const Measurement *set = s->source.measured;
    int best = 0;
    for (int a = 1; a < set->azimuth_count; a++)
        if (fabs(remainder(set->azimuth[a] - s->source.incidence_phi, 2 * PI)) <
            fabs(remainder(set->azimuth[best] - s->source.incidence_phi, 2 * PI)))
            best = a;
    return best;
}

static void fill_brdf_points(const PlotData *s, int incidence, int channel, BrdfPoints *out) {
    const Measurement *set = s->source.measured;
    int azimuth = nearest_azimuth(s);
    const AngleTable *table = &set->brdf[azimuth * set->incidence_count + incidence];
    PlotData turned = *s;
    if (set->azimuth_count > 1) turned.source.incidence_phi = set->azimuth[azimuth];
    *out = (BrdfPoints){0};
    for (int i = 0; i < table->rows && out->count < BRDF_POINTS; i++) {
        double deg;
        if (!in_plane((double)table->theta[i], (double)table->phi[i], 0, &deg)) continue;
        out->deg[out->count] = deg;
        out->value[out->count++] = (double)table->value[i * table->channels + channel];
    }
    for (int i = 0; i < BRDF_FINE; i++) {
        double deg = -88 + 0.25 * i;
        out->fine_deg[i] = deg;
        out->fitted[i] =
            plot_data_brdf(&turned, set->incidence[incidence], radians_from_degrees(fabs(deg)),
                           deg < 0 ? PI : 0, (double)set->wavelength_nm[channel]);
    }
}

static void draw_fit_brdf(Canvas *canvas, Box box, const PanelChart *shown, PanelChartMap *out) {
    const PlotData *s = shown->data;
    const Measurement *set = s->source.measured;
    int count = set->incidence_count < 6 ? set->incidence_count : 6;
    BrdfPoints *points = ARENA_NEW(canvas->arena, BrdfPoints, count);
    double low = INFINITY, high = 1e-9;
    for (int k = 0; k < count; k++) {
        int which = count > 1 ? k * (set->incidence_count - 1) / (count - 1) : 0;
        fill_brdf_points(s, which, middle_channel(set), &points[k]);
        for (int i = 0; i < points[k].count; i++) high = fmax(high, points[k].value[i]);
        for (int i = 0; i < BRDF_FINE; i++)
            if (points[k].fitted[i] > 0) low = fmin(low, points[k].fitted[i]);
    }
    low = round_down(fmax(fmin(low, high / 10), high / 1e6) * 0.8);
    Chart chart = chart_open(
        canvas, box,
        (AxisSpec){.low = -90,
                   .high = 90,
                   .step = 30,
                   .suffix = "°",
                   .title = "leaving angle in the plane of incidence"},
        (AxisSpec){.low = low, .high = round_up(high * 1.3), .is_log = true, .title = "BRDF, sr⁻¹"},
        14);
    panel_chart_hatch(&chart, s->brdf_cone);
    for (int k = 0; k < count; k++) {
        Ink ink = panel_chart_series_ink(canvas, k, count);
        bool taken[151] = {false}; /* rings no nearer than 1.2 degrees */
        for (int i = 0; i < points[k].count; i++) {
            int slot = (int)((points[k].deg[i] + 90) / 1.2);
            if (slot < 0 || slot > 150 || taken[slot]) continue;
            taken[slot] = true;
            ring(&chart, points[k].deg[i], points[k].value[i], ink_alpha(ink, 0.75));
        }
        chart_curve(&chart, points[k].fine_deg, points[k].fitted, BRDF_FINE,
                    (Stroke){ink, 1.2, DASH_NONE});
    }
    panel_chart_map_axes(out, &chart);
}

static void add_emission_fit(PanelChartList *list, const PlotData *s) {
    Residuals *r = ARENA_NEW(s->arena, Residuals, 1);
    measure_residuals(s, s->arena, r);
    for (int i = 0; i < 2; i++)
        panel_chart_add(
            list,
            &(PanelChart){
                PLOT_FIT, i ? "Measured and fitted, vertical" : "Measured and fitted, horizontal",
                "rings: the source's samples, lines: the panel file",
                "The source's luminance (rings) over the panel file's (lines), each primary at its "
                "highest level.",
                draw_fit_section, s, i, i ? SHEET_SPARE : SHEET_ALWAYS, false});
    if (s->source.measured->primary[0].level_count > 1)
        panel_chart_add(
            list,
            &(PanelChart){
                PLOT_FIT, "Measured and fitted levels",
                "rings: the source's samples, lines: the panel file",
                "The source's luminance at the normal (rings) over the panel file's (lines), for "
                "every measured level of each primary.",
                draw_fit_levels, s, 0, SHEET_SPARE, true});
    panel_chart_add(
        list,
        &(PanelChart){
            PLOT_FIT, "Residuals of all samples",
            arena_format(s->arena, "luminance of %.0f samples; line: the file's largest error",
                         r->count),
            "How often fitted less measured luminance is how large, over every sample of every "
            "emission table, relative to the measured one (to a fortieth of the table's peak where "
            "that is more). The line is the largest error of X, Y and Z that the file states.",
            draw_histogram, s, 0, SHEET_ALWAYS, false});
    if (r->worst.table)
        panel_chart_add(
            list,
            &(PanelChart){
                PLOT_FIT, "Residual of the worst table",
                arena_format(s->arena, "%s, luminance", r->worst.table->name),
                "Fitted less measured luminance, in percent, of the table in which it is largest; "
                "the colours hold all but one direction in fifty.",
                draw_residual_map, s, 0, SHEET_ALWAYS, false});
}

static const char *azimuth_text(const PlotData *s) {
    const Measurement *set = s->source.measured;
    return set->azimuth_count < 2
               ? ""
               : arena_format(s->arena, "; light from φ %.4g°",
                              degrees_from_radians(set->azimuth[nearest_azimuth(s)]));
}

static void add_all(PanelChartList *list, const PlotData *s) {
    const Measurement *set = s->source.measured;
    if (!set) return;
    if (s->emits && set->primary[0].level_count > 0) add_emission_fit(list, s);
    if (s->reflects && set->incidence_count > 0)
        panel_chart_add(
            list,
            &(PanelChart){
                PLOT_FIT, "Measured and fitted BRDF",
                arena_format(s->arena,
                             "%.4g nm; rings: the source, lines: without the mirror "
                             "part%s",
                             (double)set->wavelength_nm[middle_channel(set)], azimuth_text(s)),
                "The source's BRDF in the plane of incidence (rings) over the panel file's haze "
                "and floor (lines). What stands above the line at the mirror direction is the "
                "instrument's image of the mirror part, which the file keeps apart.",
                draw_fit_brdf, s, 0, SHEET_ALWAYS, false});
}

const PanelCharts fit_charts = {PLOT_FIT, PLOT_FIT, add_all};
