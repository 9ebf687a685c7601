/* SPDX-License-Identifier: Apache-2.0 */
#include "plot/draw/field.h"

#include <math.h>

#include "base/sort.h"
#include "base/units.h"

#define THETA_LAST (PI / 2 - 1e-3) /* just above the surface */

Field field_new(int side, double theta_rim, Arena *arena)
{
    Field field = {side, theta_rim, ARENA_NEW(arena, float, (size_t)side * (size_t)side)};
    for (int i = 0; i < side * side; i++) field.value[i] = NAN;
    return field;
}

static double grid_theta(const Field *field, int row, int column, double *phi)
{
    double half = (field->side - 1) / 2.0, x = (column - half) / half, y = (half - row) / half;
    *phi = atan2(y, x);
    return hypot(x, y) * field->theta_rim;
}

Vec3 field_direction(const Field *field, int row, int column)
{
    double phi, theta = grid_theta(field, row, column, &phi);
    double limit = fmin(field->theta_rim, THETA_LAST);
    theta = theta < limit ? theta : limit;
    return vec3((float)(sin(theta) * cos(phi)), (float)(sin(theta) * sin(phi)),
                (float)cos(theta));
}

void field_place(const Field *field, double theta, double phi, double *column, double *row)
{
    double half = (field->side - 1) / 2.0, r = half * theta / field->theta_rim;
    *column = half + r * cos(phi);
    *row = half - r * sin(phi);
}

double field_at(const Field *field, double column, double row)
{
    double last = field->side - 1.0;
    column = fmin(fmax(column, 0), last);
    row = fmin(fmax(row, 0), last);
    int    c = (int)fmin(column, last - 1), r = (int)fmin(row, last - 1);
    double fx = column - c, fy = row - r;
    const float *v = field->value + (size_t)r * (size_t)field->side + (size_t)c;
    const float *w = v + field->side;
    return (1 - fy) * ((1 - fx) * (double)v[0] + fx * (double)v[1]) +
           fy * ((1 - fx) * (double)w[0] + fx * (double)w[1]);
}

FieldRange field_range(const Field *field, double theta_limit)
{
    FieldRange range = {.low = INFINITY, .high = -INFINITY};
    double     limit = fmin(theta_limit, field->theta_rim) + 1e-9;
    for (int row = 0; row < field->side; row++) {
        for (int column = 0; column < field->side; column++) {
            double phi, theta = grid_theta(field, row, column, &phi);
            double v = (double)field->value[row * field->side + column];
            if (theta > limit || !isfinite(v)) continue;
            range.low = fmin(range.low, v);
            if (v > range.high) {
                range.high = v;
                range.theta = theta;
                range.phi = phi;
            }
        }
    }
    return range.high < range.low ? (FieldRange){0} : range;
}

double field_quantile(const Field *field, double theta_limit, double share, Arena scratch)
{
    float *sorted = ARENA_NEW(&scratch, float, (size_t)field->side * (size_t)field->side);
    int    count = 0;
    for (int row = 0; row < field->side; row++)
        for (int column = 0; column < field->side; column++) {
            double phi, theta = grid_theta(field, row, column, &phi);
            float  v = field->value[row * field->side + column];
            if (theta <= theta_limit && isfinite(v)) sorted[count++] = v;
        }
    sort_floats(sorted, count);
    return count > 0 ? (double)sorted[(int)(share * (count - 1))] : 0;
}
