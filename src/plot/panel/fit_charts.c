/* SPDX-License-Identifier: Apache-2.0 */
/* Measured against fitted: the source's points over the curves, and what is left. */
#include <math.h>
#include <string.h>

#include "base/units.h"
#include "panel/query/panel_stated.h"
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

/* ---- sections with points --------------------------------------------------------------- */

/* Signed angle of a direction in the plane through phi; false outside it. */
static bool in_plane(double theta, double phi, double plane, double *deg) {
    double away = fabs(remainder(phi - plane, 2 * PI));
    double across = fabs(remainder(phi - plane - PI, 2 * PI));
    if (theta > 1e-6 && away > 1e-3 && across > 1e-3) return false;
    *deg = degrees_from_radians(theta) * (away < across ? 1 : -1);
    return true;
}

/* Rings at the points of a table in the plane, no two in one of `slots` parts of 180 degrees. */
static void add_points(ChartRows *out, const AngleTable *table, int channel, double plane,
                       int slots, Stroke stroke) {
    ChartPoints p = chart_rows_points(out, slots + 1);
    bool *taken = ARENA_NEW(out->arena, bool, slots + 1);
    p.count = 0;
    for (int i = 0; i < table->rows; i++) {
        double deg;
        if (!in_plane((double)table->theta[i], (double)table->phi[i], plane, &deg)) continue;
        int slot = (int)floor((deg + 90) / 180 * slots);
        if (slot < 0 || slot > slots || taken[slot]) continue;
        taken[slot] = true;
        p.x[p.count] = deg;
        p.y[p.count++] = (double)table->value[i * table->channels + channel];
    }
    chart_rows_add(out, SERIES_RINGS, table->name, stroke, p);
}

static void add_curve(ChartRows *out, const char *name, Ink ink, ChartPoints points,
                      int label_index) {
    Series *curve = chart_rows_add(out, SERIES_CURVE, name, (Stroke){ink, 1.2, DASH_NONE}, points);
    curve->label = label_index ? name : NULL;
    curve->label_index = label_index;
}

static void fill_section(const PanelChart *shown, ChartRows *out) {
    const PlotData *s = shown->data;
    const Measurement *set = s->source.measured;
    double high = 0;
    panel_chart_section_axis(out, s, shown->index);
    for (int p = 0; p < 3; p++) {
        const MeasuredPrimary *primary = &set->primary[p];
        int last = primary->level_count - 1;
        float rgb[3] = {0, 0, 0};
        rgb[p] = (float)primary->level[last];
        high = fmax(high, table_peak(&primary->table[last]));
        add_points(out, &primary->table[last], 1, shown->index ? PI / 2 : 0, 90,
                   (Stroke){out->theme->primary[p], 1.9, DASH_NONE});
        add_curve(out, pattern_name((Pattern)(PATTERN_RED + p)), out->theme->primary[p],
                  panel_chart_section(out, s, rgb, shown->index), SECTION_AT(78));
    }
    out->y = axis_even(0, 1.06 * high, "Luminance, cd/m²");
    out->right = 48;
}

/* ---- levels at the normal -------------------------------------------------------------- */

#define LEVEL_POINTS 120

static ChartPoints level_curve(const ChartRows *out, const PlotData *s, int primary) {
    ChartPoints p = chart_rows_points(out, LEVEL_POINTS);
    for (int i = 0; i < p.count; i++) {
        float rgb[3] = {0, 0, 0};
        p.x[i] = 8 * pow(255.0 / 8, (double)i / (LEVEL_POINTS - 1));
        rgb[primary] = (float)p.x[i];
        p.y[i] = panel_figure_luminance(s->source.panel, 0, 0, rgb);
    }
    return p;
}

/* Measured at the least theta of each table. */
static void fill_levels(const PanelChart *shown, ChartRows *out) {
    const PlotData *s = shown->data;
    double low = INFINITY, high = 0;
    for (int c = 0; c < 3; c++) {
        const MeasuredPrimary *primary = &s->source.measured->primary[c];
        const char *name = pattern_name((Pattern)(PATTERN_RED + c));
        ChartPoints p = chart_rows_points(out, primary->level_count);
        for (int i = 0; i < p.count; i++) {
            p.x[i] = primary->level[i];
            p.y[i] = (double)primary->table[i].value[1];
            if (p.y[i] > 0) low = fmin(low, p.y[i]);
            high = fmax(high, p.y[i]);
        }
        add_curve(out, name, out->theme->primary[c], level_curve(out, s, c), LEVEL_POINTS - 1);
        chart_rows_add(out, SERIES_RINGS, arena_format(out->arena, "%s, measured", name),
                       (Stroke){out->theme->primary[c], 1.9, DASH_NONE}, p);
    }
    low = fmax(low, high / 1e5);
    out->x = axis_log(8, 256, "code of 255");
    out->y = axis_log(round_down(0.6 * low), round_up(1.3 * high),
                      "Luminance at the normal, cd/m², black included");
    out->right = 48;
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
    out->reach = round_up(
        1.3 * fmax(fmax(out->most, 100 * panel_part_error(s->source.report, false).largest), 0.01));
    for (int t = 0; t < tables; t++) pass_over(s, &ref[t], true, out);
    for (int i = 0; i < BINS; i++) out->highest = fmax(out->highest, out->bin[i]);
}

static void fill_histogram(const PanelChart *shown, ChartRows *out) {
    const PlotData *s = shown->data;
    Residuals *r = ARENA_NEW(out->arena, Residuals, 1);
    double most = 100 * panel_part_error(s->source.report, false).largest;
    double *edge = ARENA_NEW(out->arena, double, BINS + 1);
    measure_residuals(s, out->arena, r);
    for (int i = 0; i <= BINS; i++)
        edge[i] = LEAST_PERCENT * pow(r->reach / LEAST_PERCENT, (double)i / BINS);
    chart_rows_add(out, SERIES_BARS, "samples from here on",
                   (Stroke){.ink = ink_mix(out->theme->primary[2], out->theme->paper, 0.35)},
                   (ChartPoints){BINS, edge, r->bin});
    chart_rows_line(out, most, (Stroke){out->theme->accent, 1.3, DASH_SHORT},
                    arena_format(out->arena, "largest error %.3g %%", most));
    out->x = axis_log(LEAST_PERCENT, r->reach, "size of fitted less measured luminance");
    out->x.suffix = " %";
    out->y = axis_log(0.7, round_up(fmax(r->highest, 10) * 1.6), "samples");
    out->right = 14;
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

static void fill_residual_map(const PanelChart *shown, ChartRows *out) {
    const PlotData *s = shown->data;
    Residuals *r = ARENA_NEW(out->arena, Residuals, 1);
    measure_residuals(s, out->arena, r);
    Field field = residual_field(s, &r->worst, out->arena);
    double reach = residual_reach(&field, s, out->arena);
    panel_chart_polar(out, field,
                      (PolarMap){.map = MAP_SIGNED,
                                 .low = -reach,
                                 .high = reach,
                                 .is_cut = reach < 0.99 * r->most,
                                 .strong = NAN,
                                 .theta_measured = s->cone,
                                 .unit = "%",
                                 .is_residual = true});
}

/* ---- reflection ------------------------------------------------------------------------- */

/* The channel nearest to 550 nm. */
static int middle_channel(const Measurement *set) {
    int best = 0;
    for (int w = 1; w < set->wavelength_count; w++)
        if (fabsf(set->wavelength_nm[w] - 550) < fabsf(set->wavelength_nm[best] - 550)) best = w;
    return best;
}

#define BRDF_POINTS 705 /* -88 to 88 degrees, every quarter */

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

/* The file's at the incidence-th one of the set. */
static ChartPoints fitted_brdf(const ChartRows *out, const PlotData *s, int incidence,
                               int channel) {
    const Measurement *set = s->source.measured;
    ChartPoints p = chart_rows_points(out, BRDF_POINTS);
    PlotData turned = *s;
    if (set->azimuth_count > 1) turned.source.incidence_phi = set->azimuth[nearest_azimuth(s)];
    for (int i = 0; i < p.count; i++) {
        p.x[i] = -88 + 0.25 * i;
        p.y[i] =
            plot_data_brdf(&turned, set->incidence[incidence], radians_from_degrees(fabs(p.x[i])),
                           p.x[i] < 0 ? PI : 0, (double)set->wavelength_nm[channel]);
    }
    return p;
}

static void fill_brdf(const PanelChart *shown, ChartRows *out) {
    const PlotData *s = shown->data;
    const Measurement *set = s->source.measured;
    int count = set->incidence_count < 6 ? set->incidence_count : 6;
    int channel = middle_channel(set);
    double low = INFINITY, high = 1e-9;
    panel_chart_angles(out, "leaving angle in the plane of incidence", s->brdf_cone);
    for (int k = 0; k < count; k++) {
        int which = count > 1 ? k * (set->incidence_count - 1) / (count - 1) : 0;
        const AngleTable *table = &set->brdf[nearest_azimuth(s) * set->incidence_count + which];
        Ink ink = panel_chart_series_ink(out->theme, k, count);
        add_points(out, table, channel, 0, 150, (Stroke){ink_alpha(ink, 0.75), 1.9, DASH_NONE});
        for (int i = 0; i < table->rows; i++) {
            double deg;
            if (in_plane((double)table->theta[i], (double)table->phi[i], 0, &deg))
                high = fmax(high, (double)table->value[i * table->channels + channel]);
        }
        ChartPoints p = fitted_brdf(out, s, which, channel);
        add_curve(out,
                  arena_format(out->arena, "%.4g°", degrees_from_radians(set->incidence[which])),
                  ink, p, 0);
        for (int i = 0; i < p.count; i++)
            if (p.y[i] > 0) low = fmin(low, p.y[i]);
    }
    low = round_down(fmax(fmin(low, high / 10), high / 1e6) * 0.8);
    out->y = axis_log(low, round_up(high * 1.3), "BRDF, sr⁻¹");
    out->right = 14;
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
                fill_section, s, i, i ? SHEET_SPARE : SHEET_ALWAYS, false});
    if (s->source.measured->primary[0].level_count > 1)
        panel_chart_add(
            list,
            &(PanelChart){
                PLOT_FIT, "Measured and fitted levels",
                "rings: the source's samples, lines: the panel file",
                "The source's luminance at the normal (rings) over the panel file's (lines), for "
                "every measured level of each primary.",
                fill_levels, s, 0, SHEET_SPARE, true});
    panel_chart_add(
        list,
        &(PanelChart){
            PLOT_FIT, "Residuals of all samples",
            arena_format(s->arena, "luminance of %.0f samples; line: the file's largest error",
                         r->count),
            "How often fitted less measured luminance is how large, over every sample of every "
            "emission table, relative to the measured one (to a fortieth of the table's peak where "
            "that is more). The line is the largest error of X, Y and Z that the file states.",
            fill_histogram, s, 0, SHEET_ALWAYS, false});
    if (r->worst.table)
        panel_chart_add(
            list,
            &(PanelChart){
                PLOT_FIT, "Residual of the worst table",
                arena_format(s->arena, "%s, luminance", r->worst.table->name),
                "Fitted less measured luminance, in percent, of the table in which it is largest; "
                "the colours hold all but one direction in fifty.",
                fill_residual_map, s, 0, SHEET_ALWAYS, false});
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
                fill_brdf, s, 0, SHEET_ALWAYS, false});
}

const PanelCharts fit_charts = {PLOT_FIT, PLOT_FIT, add_all};
