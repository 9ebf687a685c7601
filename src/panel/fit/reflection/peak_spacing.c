/* SPDX-License-Identifier: Apache-2.0 */
#include "panel/fit/reflection/peak_spacing.h"

#include <math.h>

#include "base/mathd.h"
#include "base/sort.h"
#include "base/units.h"
#include "panel/fit/common/table_rows.h"
#include "panel/fit/reflection/peak_window.h"

#define RING_ROWS 4     /* fewer on a ring: no grid, the rows' density is taken */
#define DENSITY_ROWS 16 /* nearest rows for it */

/* Between the azimuths on both sides of the mirror direction. */
static double ring_gap(const AngleTable *table, int begin, int end)
{
    double left = PI, right = PI, nearest = PI, next = PI;
    for (int i = begin; i < end; i++) {
        double phi = (double)table->phi[i], turn = phi > PI ? phi - 2 * PI : phi;
        if (turn >= 0) right = fmin(right, turn);
        if (turn <= 0) left = fmin(left, -turn);
        double away = fabs(turn);
        if (away < nearest) next = nearest, nearest = away;
        else if (away > nearest) next = fmin(next, away);
    }
    return nearest < 1e-6 ? next : fmin(left + right, 2 * nearest);
}

/* Rows without a grid: the side of the square that each has for itself. */
static double density_gap(const AngleTable *table, double incidence, Arena scratch)
{
    double *angle = ARENA_NEW(&scratch, double, table->rows);
    for (int i = 0; i < table->rows; i++)
        angle[i] = peak_window_angle((double)table->theta[i], (double)table->phi[i], incidence);
    sort_doubles(angle, table->rows);
    int rows = table->rows < DENSITY_ROWS ? table->rows : DENSITY_ROWS;
    return angle[rows - 1] * sqrt(PI / rows);
}

PeakSpacing peak_spacing_find(const AngleTable *table, double incidence, Arena scratch)
{
    PeakSpacing out = {PI, PI, PI};
    int    nearest = 0, end = 0;
    double before = -1, best = PI, ring = 0;
    for (int i = 0; i < table->rows; i = table_ring_end(table, i)) {
        double theta = (double)table->theta[i], away = fabs(theta - incidence);
        bool   is_beyond = before >= 0 && theta >= incidence - 1e-6 && out.theta == PI;
        if (is_beyond) out.theta = theta - before;
        if (away < best) best = away, nearest = i, ring = theta;
        before = theta;
    }
    end = table_ring_end(table, nearest);
    out.across = ring_gap(table, nearest, end) * sin_d(fmax(ring, incidence));
    if (end - nearest < RING_ROWS && ring > 0)
        out.theta = out.across = density_gap(table, incidence, scratch);
    if (!(ring > 0)) out.across = out.theta;
    out.widest = fmax(out.theta, out.across);
    return out;
}
