/* SPDX-License-Identifier: Apache-2.0 */
#include "plot/report/state_tables.h"

#include <math.h>

#include "base/count.h"
#include "base/units.h"
#include "panel/query/panel_emission.h"
#include "panel/query/panel_report.h"

static double luminance(const Panel *panel, Pattern pattern, double theta, double phi)
{
    float rgb[3], xyz[3];
    Vec3  d = vec3((float)(sin(theta) * cos(phi)), (float)(sin(theta) * sin(phi)),
                   (float)cos(theta));
    pattern_codes(pattern, rgb);
    panel_emission_xyz(panel, d, rgb, xyz);
    return (double)xyz[1];
}

/* The first theta, in tenths of a degree inside the cone, with less than half of the normal's
 * white. */
static void add_half(Report *report, ReportTable *table, const Panel *panel, double phi)
{
    double half = 0.5 * luminance(panel, PATTERN_WHITE, 0, 0);
    double cone = degrees_from_radians(panel_info_emission_cone(panel));
    for (int i = 1; 0.1 * i <= cone + 1e-6; i++) {
        double theta = radians_from_degrees(0.1 * i);
        if (!(luminance(panel, PATTERN_WHITE, theta, phi) < half)) continue;
        report_fixed(report, table, 0.1 * i, 1);
        return;
    }
    report_beyond(report, table, cone);
}

static void add_row(Report *report, ReportTable *table, const PlotState *state)
{
    Error        unheard;
    json_auto_t *own = NULL;
    const Panel *panel = state->panel;
    double       white = luminance(panel, PATTERN_WHITE, 0, 0);
    double       black = luminance(panel, PATTERN_BLACK, 0, 0);
    if (!panel_report(panel, &own, &unheard)) own = json_object();
    const json_t *total = json_object_get(own, "total");
    const char   *verdict = json_string_value(json_object_get(own, "verdict"));
    report_row(report, table);
    report_text(table, state->name);
    report_figure(report, table, white);
    report_figure(report, table, black > 0 ? black : (double)NAN);
    report_figure(report, table, white / black);
    for (int i = 0; i < 4; i++) add_half(report, table, panel, i * PI / 2);
    static const char *const errors[] = {"max_error", "rms_error"};
    for (int i = 0; i < COUNT_OF(errors); i++)
        report_figure(report, table,
                      100 * json_number_value(json_object_get(total, errors[i])));
    report_text(table, verdict ? arena_format(report->arena, "%s", verdict) : "–");
}

void report_states(Report *report, const PlotData *data)
{
    static const ReportColumn columns[] = {
        {"state", "State"}, {"white_cd_m2", "White, cd/m²"}, {"black_cd_m2", "Black, cd/m²"},
        {"contrast", "Contrast"}, {"half_right_deg", "½ right, °"}, {"half_up_deg", "½ up, °"},
        {"half_left_deg", "½ left, °"}, {"half_down_deg", "½ down, °"},
        {"max_error_percent", "Max. error, %"}, {"rms_error_percent", "Rms error, %"},
        {"verdict", "Verdict"}};
    if (!data->source.state_count) return;
    ReportTable *table = report_add(report, "states", "States",
        "Along the normal; the angle at which white falls below half of that, to four sides; "
        "the errors over all tables of the state, and its verdict. All other tables and "
        "figures are of one state, named behind # of the file's name, or of the first.");
    for (int i = 0; i < COUNT_OF(columns); i++)
        report_column(table, columns[i].key, columns[i].title);
    for (int i = 0; i < data->source.state_count; i++)
        add_row(report, table, &data->source.states[i]);
}
