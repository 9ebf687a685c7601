/* SPDX-License-Identifier: Apache-2.0 */
#include "plot/report/report_azimuth.h"

#include <math.h>

/* emission.azimuths_deg of the file: those measured, where they stand 45 degrees apart or
 * more; without it every azimuth has a measured one near. */
bool report_has_azimuth(const PlotData *data, int index) {
    const json_t *emission = json_object_get(data->source.report, "emission");
    const json_t *list = json_object_get(emission, "azimuths_deg"), *one;
    size_t i;
    json_array_foreach(list, i, one) if (fabs(remainder(json_number_value(one) - 45 * index, 360)) <
                                         22.5 + 1e-6) return true;
    return json_array_size(list) == 0;
}

void report_azimuth_columns(Report *report, ReportTable *table) {
    static const char *const WORDS[] = {" right", "", " up", "", " left", "", " down", ""};
    for (int i = 0; i < REPORT_AZIMUTHS; i++)
        report_column(table, arena_format(report->arena, "phi_%d", 45 * i),
                      arena_format(report->arena, "φ %d°%s", 45 * i, WORDS[i]));
}
