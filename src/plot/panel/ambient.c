/* SPDX-License-Identifier: Apache-2.0 */
#include "plot/panel/ambient.h"

#include <math.h>

#include "base/units.h"

double ambient_reflectance(const PlotData *data, double theta)
{
    double at = degrees_from_radians(fmin(fmax(theta, 0), PI / 2 - 1e-4));
    int    i = (int)at < PLOT_REFLECTANCES - 2 ? (int)at : PLOT_REFLECTANCES - 2;
    const double *diffuse = data->diffuse_reflectance;
    return diffuse[i] + (diffuse[i + 1] - diffuse[i]) * (at - i) +
           plot_data_mirror(data, theta, 0);
}

static double contrast_of(double white, double black, double reflected)
{
    return black + reflected > 0 ? (white + reflected) / (black + reflected) : NAN;
}

double ambient_contrast(const PlotData *data, double theta, double phi, double lux)
{
    double white[3], black[3];
    plot_data_xyz(data, theta, phi, (float[3]){255, 255, 255}, white);
    plot_data_xyz(data, theta, phi, (float[3]){0, 0, 0}, black);
    return contrast_of(white[1], black[1], ambient_reflectance(data, fabs(theta)) * lux / PI);
}

/* R at every half degree: it depends on theta alone. */
enum { STEPS = 181 };

static void fill_reflectance(const PlotData *data, double value[STEPS])
{
    for (int i = 0; i < STEPS; i++)
        value[i] = ambient_reflectance(data, fmin(i * PI / (2 * (STEPS - 1)), PI / 2 - 1e-4));
}

static double reflectance_at(const double value[STEPS], double theta)
{
    double at = fmin(fmax(theta / (PI / 2) * (STEPS - 1), 0), STEPS - 1);
    int    i = at < STEPS - 2 ? (int)at : STEPS - 2;
    return value[i] + (value[i + 1] - value[i]) * (at - i);
}

Field ambient_contrast_field(const PlotData *data, double lux, Arena *arena)
{
    const Field *white = &data->xyz[PATTERN_WHITE][1], *black = &data->xyz[PATTERN_BLACK][1];
    Field  field = field_new(white->side, white->theta_rim, arena);
    double reflectance[STEPS];
    fill_reflectance(data, reflectance);
    for (int i = 0; i < field.side * field.side; i++) {
        Vec3   d = field_direction(&field, i / field.side, i % field.side);
        double theta = atan2(hypot((double)d.x, (double)d.y), (double)d.z);
        field.value[i] = (float)contrast_of((double)white->value[i], (double)black->value[i],
                                            reflectance_at(reflectance, theta) * lux / PI);
    }
    return field;
}
