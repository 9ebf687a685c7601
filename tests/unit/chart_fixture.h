/* SPDX-License-Identifier: Apache-2.0 */
/* chart_fixture.h -- the sphere in cells that close in on a direction, and whether counts in
 * them are those expected. */
#pragma once
#include "check.h"

#include "base/mathf.h"
#include "base/units.h"
#include "base/vec.h"

#define RINGS 12
#define SECTORS 8
#define CELLS (2 * RINGS * SECTORS)

/* Polar coordinates around the direction where a lobe is expected, rings closing in on it. */
typedef struct Chart {
    Frame frame;
    float width;
} Chart;

/* Ring coordinate in [0, 1] of the angle to the centre: even in log(1 + (angle/width)^2). */
static inline double ring_of(const Chart *chart, double angle) {
    double w = (double)chart->width;
    return log1p(angle * angle / (w * w)) / log1p(PI * PI / (w * w));
}

static inline double angle_of(const Chart *chart, double ring) {
    double w = (double)chart->width;
    return w * sqrt(expm1(ring * log1p(PI * PI / (w * w))));
}

static inline int cell_of(const Chart *chart, Vec3 wi) {
    Vec3 local = frame_to_local(&chart->frame, wi);
    double side = sqrt((double)local.x * (double)local.x + (double)local.y * (double)local.y);
    double ring = ring_of(chart, atan2(side, (double)local.z)) * RINGS;
    double turn = (atan2((double)local.y, (double)local.x) / (2 * PI) + 0.5) * SECTORS;
    int r = ring < RINGS ? (int)ring : RINGS - 1, s = turn < SECTORS ? (int)turn : SECTORS - 1;
    return r * SECTORS + s;
}

/* Standard normal deviate of a chi-square sum (Wilson and Hilferty 1931). */
static inline double deviate(double chi2, int degrees) {
    double v = 2.0 / (9.0 * degrees);
    return (cbrt(chi2 / degrees) - (1 - v)) / sqrt(v);
}

/* Cells of fewer than 8 expected samples are put together. The quadrature's own error (the
 * horizon cuts through cells) counts as 2 % of a cell. */
static inline double chi_square(const double *expected, const double *found, int count,
                                int *degrees) {
    double chi2 = 0, e = 0, f = 0;
    *degrees = -1;
    for (int i = 0; i < count; i++) {
        e += expected[i];
        f += found[i];
        if (e < 8 && i < count - 1) continue;
        if (e < 8 && f < 30) break;
        double spread = e + 4e-4 * e * e + 1e-9;
        chi2 += (f - e) * (f - e) / spread;
        *degrees += 1;
        e = f = 0;
    }
    return chi2;
}
