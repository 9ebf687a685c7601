/* SPDX-License-Identifier: Apache-2.0 */
/* polar_grid.h -- the directions in which an instrument's table stands: rings of equal theta.
 *
 * Units    degrees. Threads: pure functions.
 */
#pragma once
#include <math.h>

typedef struct PolarGrid {
    double theta_step, phi_step;
    int    rings, azimuths; /* without the normal, which stands once */
} PolarGrid;

/* phi_step becomes the nearest one that divides the circle. */
static inline PolarGrid polar_grid(double theta_step, double phi_step, int rings)
{
    int azimuths = (int)round(360 / phi_step);
    return (PolarGrid){theta_step, 360.0 / azimuths, rings, azimuths};
}

static inline int polar_grid_count(const PolarGrid *grid)
{
    return 1 + grid->rings * grid->azimuths;
}

/* Direction i, theta and phi; 0 is the normal. */
static inline void polar_grid_direction(const PolarGrid *grid, int i, double degrees[2])
{
    degrees[0] = i ? ((i - 1) / grid->azimuths + 1) * grid->theta_step : 0;
    degrees[1] = i ? (i - 1) % grid->azimuths * grid->phi_step : 0;
}
