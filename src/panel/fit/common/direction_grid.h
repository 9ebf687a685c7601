/* SPDX-License-Identifier: Apache-2.0 */
/* direction_grid.h -- values measured at scattered directions, readable at any direction.
 *
 * The rows of a table become the cells of a grid over theta (rows) and phi (columns). Where a
 * table IS such a grid, a cell is a measured row; a missing direction is filled from its
 * nearest neighbours, and so are all cells of a table without a grid's order. Between cells a
 * cubic through four rings and four azimuths each (Hermite, parabolic slopes) reads the value;
 * it runs through the pole to the opposite azimuth, and phi is periodic. Two sections only
 * (such as azimuths 0 and 90) are a grid of four azimuths and are read by the same cubic, which
 * makes an ellipse-like ring of them.
 *
 * Units    radians. Memory: the arena's. Threads: const once built. Fails: never.
 */
#pragma once
#include <stdbool.h>

#include "base/arena.h"
#include "base/units.h"
#include "panel/set/angle_table.h"

typedef struct DirectionGrid {
    int thetas, phis;
    const float *theta, *phi; /* rising; phi over [0, 2 pi), or [0, pi] when mirrored */
    bool is_mirrored;         /* values at -phi are those at phi */
    bool has_pole;            /* theta[0] is 0 */
    bool is_scattered;        /* the table had no grid's order */
    int filled_cells;         /* cells that no row stands for */
    float widest_gap;         /* of the measured azimuths */
    /* what a cell is made of: rows and weights from start[cell] to start[cell + 1] */
    const int *start, *row;
    const float *weight;
} DirectionGrid;

/* A value as a weighted sum of cells. */
typedef struct GridTaps {
    int count;
    int cell[16];
    float weight[16];
} GridTaps;

/* mirrored: the table is symmetric in phi (isotropic reflection); both halves are averaged. */
void direction_grid_build(const AngleTable *table, bool mirrored, Arena *arena, DirectionGrid *out);

/* thetas x phis x channels of the cells, from values of the rows. */
float *direction_grid_cells(const DirectionGrid *grid, const float *value, int channels,
                            Arena *arena);

/* theta in [0, pi/2], any phi. */
void direction_grid_taps(const DirectionGrid *grid, float theta, float phi, GridTaps *taps);

/* Weighted sum of the cells' channels. */
void direction_grid_read(const GridTaps *taps, const float *cells, int channels, float *out);

/* The first of rising angles that is not below a value by `apart` or more; else the last. */
int direction_grid_index(const float *rising, int count, float value, float apart);

/* An azimuth of [0, 2 pi) in [0, pi], where values at -phi are those at phi. */
static inline float direction_grid_fold(float phi, bool is_mirrored) {
    return is_mirrored && phi > PI_F ? 2 * PI_F - phi : phi;
}
