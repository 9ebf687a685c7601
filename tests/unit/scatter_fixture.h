/* SPDX-License-Identifier: Apache-2.0 */
/* scatter_fixture.h -- reflections fitted from samples of closed forms in any layout: rings
 * about the normal or the mirror direction, scattered, other ones at each incidence. */
#pragma once
#include <stdlib.h>

#include "reflection_fixture.h"

#define ROWS_MAX 4000

/* ---- layouts ----------------------------------------------------------------------------- */

typedef struct Layout {
    Vec3 direction[ROWS_MAX];
    int rows;
} Layout;

typedef void LayoutMaker(double theta_i, Layout *out);

#define CONE_DEG 80.0

static inline void add(Layout *out, Vec3 d) {
    if ((double)d.z >= cos(radians_from_degrees(CONE_DEG + 1e-4))) out->direction[out->rows++] = d;
}

/* Round an axis in the plane of incidence, `theta` from the normal. */
static inline Vec3 around(double theta, double angle, double turn) {
    double a = radians_from_degrees(angle), t = radians_from_degrees(turn);
    double x = sin(a) * cos(t), y = sin(a) * sin(t), z = cos(a);
    return vec3((float)(cos(theta) * x + sin(theta) * z), (float)y,
                (float)(cos(theta) * z - sin(theta) * x));
}

static inline void normal_rings(double theta_i, Layout *out) {
    (void)theta_i;
    add(out, vec3(0, 0, 1));
    for (double a = 5; a <= 80; a += 5)
        for (double t = 0; t < 360; t += 10) add(out, around(0, a, t));
}

static inline void mirror_rings(double theta_i, Layout *out) {
    static const double ring[] = {5,  10, 15, 20, 25,  30,  35,  40, 50,
                                  60, 70, 80, 90, 105, 120, 135, 150};
    add(out, around(theta_i, 0, 0));
    for (size_t i = 0; i < sizeof ring / sizeof *ring; i++)
        for (double t = 0; t < 360; t += 10) add(out, around(theta_i, ring[i], t));
}

/* Evenly by the golden angle, each moved at random; other ones at each incidence. */
static inline void scattered(double theta_i, Layout *out) {
    unsigned state = 1 + (unsigned)(1000 * theta_i);
    for (int i = 0; i < 577; i++) {
        state = 1664525 * state + 1013904223;
        double u = (state >> 8) / 16777216.0;
        state = 1664525 * state + 1013904223;
        double v = (state >> 8) / 16777216.0;
        double z = 1 - (i + u) / 577 * (1 - cos(radians_from_degrees(CONE_DEG)));
        add(out, around(0, degrees_from_radians(acos(z)), 137.50776 * i + 6 * v));
    }
}

static inline void mixed(double theta_i, Layout *out) {
    if (theta_i < 0.3) normal_rings(theta_i, out);
    else if (theta_i < 1.0) mirror_rings(theta_i, out);
    else scattered(theta_i, out);
}

/* ---- closed forms ------------------------------------------------------------------------ */

typedef struct Lobe {
    double width_deg, height, floor;
    double noise; /* of its samples, relative, rms */
} Lobe;

static inline double lobe_of(const Lobe *lobe, double theta_i, Vec3 d) {
    double cosine = sin(theta_i) * (double)d.x + cos(theta_i) * (double)d.z;
    double angle = acos(fmin(1, cosine)) / radians_from_degrees(lobe->width_deg);
    return lobe->floor + lobe->height * exp(-angle * angle) * (1 + theta_i * theta_i);
}

/* ---- sets -------------------------------------------------------------------------------- */

static inline int by_direction(const void *a, const void *b) {
    const float *p = a, *q = b;
    return p[0] != q[0] ? (p[0] > q[0]) - (p[0] < q[0]) : (p[1] > q[1]) - (p[1] < q[1]);
}

static inline AngleTable table_of(const Layout *layout, const Lobe *lobe, double theta_i,
                                  Arena *arena) {
    float(*row)[3] = arena_alloc(arena, (size_t)layout->rows, 8, sizeof *row);
    float *theta = ARENA_NEW(arena, float, layout->rows);
    float *phi = ARENA_NEW(arena, float, layout->rows);
    float *value = ARENA_NEW(arena, float, layout->rows);
    uint32_t random = 5;
    for (int i = 0; i < layout->rows; i++) {
        Vec3 d = layout->direction[i];
        double error = lobe->noise * sqrt(12) * (steady_random(&random) - 0.5);
        double turn = atan2((double)d.y, (double)d.x);
        row[i][0] = (float)atan2(hypot((double)d.x, (double)d.y), (double)d.z);
        row[i][1] = (float)(turn < 0 ? turn + 2 * PI : turn);
        row[i][2] = (float)(lobe_of(lobe, theta_i, d) * (1 + error));
    }
    qsort(row, (size_t)layout->rows, sizeof *row, by_direction);
    for (int i = 0; i < layout->rows; i++)
        theta[i] = row[i][0], phi[i] = row[i][1], value[i] = row[i][2];
    return (AngleTable){.name = "table",
                        .rows = layout->rows,
                        .channels = 1,
                        .theta = theta,
                        .phi = phi,
                        .value = value,
                        .theta_max = theta[layout->rows - 1]};
}

static const double incidence_deg[] = {10, 30, 50, 70};
#define COUNT 4

static inline Fitted fit_layout(LayoutMaker *make, const Lobe *lobe) {
    Fitted f;
    FitOptions options = quick();
    fixture_folder(&f.fit);
    Measurement *set = ARENA_NEW(&f.fit.arena, Measurement, 1);
    Layout *layout = ARENA_NEW(&f.fit.arena, Layout, 1);
    set->file = set->panel = set->instrument = set->note = "";
    set->incidence_count = COUNT;
    set->azimuth_count = set->wavelength_count = 1;
    set->wavelength_nm[0] = 550;
    set->brdf = ARENA_NEW(&f.fit.arena, AngleTable, COUNT);
    for (int i = 0; i < COUNT; i++) {
        set->incidence[i] = radians_from_degrees(incidence_deg[i]);
        layout->rows = 0;
        make(set->incidence[i], layout);
        set->brdf[i] = table_of(layout, lobe, set->incidence[i], &f.fit.arena);
    }
    f.fit.set = set;
    fixture_fit(&f.fit, &options);
    return f;
}

/* Off the mirror direction, radians. */
static inline double off_mirror(double theta_i, Vec3 d) {
    return acos(fmin(1, sin(theta_i) * (double)d.x + cos(theta_i) * (double)d.z));
}
