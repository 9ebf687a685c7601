/* SPDX-License-Identifier: Apache-2.0 */
#include "plot/panel/plot_charts.h"

#include <math.h>

#include "base/units.h"

void plot_samples(Chart *chart, const AngleTable *table, int channel, double phi, Ink ink) {
    Series *series = chart_series(chart, table->name, (Stroke){ink, 0.8, DASH_NONE});
    series->has_rings = true;
    for (int i = 0; i < table->rows; i++) {
        double theta = (double)table->theta[i], at = (double)table->phi[i];
        bool is_here = fabs(remainder(at - phi, 2 * PI)) < 1e-3;
        bool is_opposite = fabs(remainder(at - phi - PI, 2 * PI)) < 1e-3;
        if (theta < 1e-6 || is_here || is_opposite)
            chart_point(chart, degrees_from_radians(is_opposite ? -theta : theta),
                        (double)table->value[i * table->channels + channel]);
    }
}
