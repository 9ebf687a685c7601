/* How noisy a table is, told by third differences of neighbours: smooth data leave nearly
 * nothing of them, noise of deviation s leaves s sqrt(1 + 9 + 9 + 1). */
#include <math.h>
#include <stdlib.h>

#include "base/units.h"
#include "panel/fit_parts.h"

#define NEIGHBOUR_DEG 13.0 /* azimuths further apart than this tell nothing of noise */
#define ENOUGH 16          /* differences */
#define MEDIAN_OF_NORMAL 0.6745

int fit_by_value(const void *a, const void *b)
{
    double p = *(const double *)a, q = *(const double *)b;
    return p < q ? -1 : p > q;
}

/* The row before `row` on its ring, near enough; -1: none. Rows are sorted that way. */
static int before_on_ring(const AngleTable *table, int row)
{
    if (row < 1 || table->theta[row - 1] != table->theta[row]) return -1;
    float gap = table->phi[row] - table->phi[row - 1];
    return gap < (float)radians_from_degrees(NEIGHBOUR_DEG) ? row - 1 : -1;
}

/* The nearest row at a smaller theta with the same azimuth; -1: none. */
static int before_on_meridian(const AngleTable *table, int row)
{
    for (int i = row - 1; i >= 0; i--)
        if (table->phi[i] == table->phi[row] && table->theta[i] < table->theta[row])
            return i;
    return -1;
}

static double value_at(const AngleTable *table, int row, int channel)
{
    return (double)table->value[(size_t)row * (size_t)table->channels + (size_t)channel];
}

/* |third difference| that ends at a row; false: not enough neighbours. */
static bool third_difference(const AngleTable *table, int row, int channel, bool on_ring,
                             double *difference, double *mean)
{
    double v[4];
    for (int k = 0; k < 4; k++) {
        if (row < 0) return false;
        v[k] = value_at(table, row, channel);
        if (k < 3) row = on_ring ? before_on_ring(table, row) : before_on_meridian(table, row);
    }
    *difference = fabs(v[0] - 3 * v[1] + 3 * v[2] - v[3]);
    *mean = (v[0] + v[1] + v[2] + v[3]) / 4;
    return true;
}

/* Median over rows between two polar angles, relative to the mean of the four or not. */
static double median_difference(const AngleTable *table, int channel, const double range[2],
                                bool relative, Arena scratch)
{
    double *list = ARENA_NEW(&scratch, double, table->rows + 1), difference, mean;
    int     count = 0;
    for (int pass = 0; pass < 2 && count < ENOUGH; pass++) {
        count = 0;
        for (int i = 3; i < table->rows; i++) {
            double theta = (double)table->theta[i];
            if (theta < range[0] || theta > range[1]) continue;
            if (!third_difference(table, i, channel, pass == 0, &difference, &mean)) continue;
            if (!relative) list[count++] = difference;
            else if (mean > 0) list[count++] = difference / mean;
        }
    }
    if (count < ENOUGH) return 0;
    qsort(list, (size_t)count, sizeof *list, fit_by_value);
    return list[count / 2] / (MEDIAN_OF_NORMAL * sqrt(20));
}

double fit_noise(const AngleTable *table, int channel, Arena scratch)
{
    return median_difference(table, channel, (double[2]){0, radians_from_degrees(70)}, true,
                             scratch);
}

double fit_dim_noise(const AngleTable *table, int channel, Arena scratch)
{
    double edge = (double)table->theta_max;
    return median_difference(table, channel, (double[2]){0.9 * edge, edge}, false, scratch);
}
