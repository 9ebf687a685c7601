/* SPDX-License-Identifier: Apache-2.0 */
/* reflection_fixture.h -- reflections fitted from tables of closed forms: no files are read. */
#pragma once
#include "panel_fixture.h"
#include "panel/query/panel_reflection.h"
#include "spectrum/fresnel.h"

#define INCIDENCES 8 /* at most */

/* sr^-1 of a surface with the light at theta_i, azimuth phi_i (radians). phi is the leaving
 * azimuth, counted from the mirror direction. */
typedef double Surface(double theta_i, double phi_i, double theta, double phi, double nm);

/* A set of tables in memory. */
typedef struct Tables {
    double incidence_deg[INCIDENCES];
    int incidences, azimuths, wavelengths;
    double theta_step, phi_step, theta_max; /* degrees */
    double instrument_fwhm_deg;
    Surface *surface;
} Tables;

typedef struct Fitted {
    Fixture fit;
    Tables tables;
} Fitted;

static inline AngleTable make_table(const Tables *t, const Measurement *set, int index,
                                    Arena *arena) {
    int thetas = (int)(t->theta_max / t->theta_step) + 1, phis = (int)(360 / t->phi_step);
    int rows = (thetas - 1) * phis + 1, n = 0;
    float *theta = ARENA_NEW(arena, float, rows), *phi = ARENA_NEW(arena, float, rows);
    float *value = ARENA_NEW(arena, float, rows * t->wavelengths);
    for (int i = 0; i < thetas; i++)
        for (int k = 0; k < (i ? phis : 1); k++, n++) {
            theta[n] = (float)radians_from_degrees(i * t->theta_step);
            phi[n] = (float)radians_from_degrees(k * t->phi_step);
            for (int w = 0; w < t->wavelengths; w++)
                value[n * t->wavelengths + w] = (float)t->surface(
                    set->incidence[index % t->incidences], set->azimuth[index / t->incidences],
                    (double)theta[n], (double)phi[n], (double)set->wavelength_nm[w]);
        }
    return (AngleTable){.name = "table",
                        .rows = rows,
                        .channels = t->wavelengths,
                        .theta = theta,
                        .phi = phi,
                        .value = value,
                        .theta_max = theta[rows - 1]};
}

static inline Measurement *make_set(const Tables *t, Arena *arena) {
    Measurement *set = ARENA_NEW(arena, Measurement, 1);
    set->file = set->panel = set->instrument = set->note = "";
    set->instrument_fwhm_deg = t->instrument_fwhm_deg;
    set->incidence_count = t->incidences;
    set->wavelength_count = t->wavelengths;
    set->azimuth_count = t->azimuths;
    set->brdf = ARENA_NEW(arena, AngleTable, t->incidences * t->azimuths);
    for (int i = 0; i < t->incidences; i++)
        set->incidence[i] = radians_from_degrees(t->incidence_deg[i]);
    for (int i = 0; i < t->azimuths; i++) set->azimuth[i] = 2 * PI * i / t->azimuths;
    for (int w = 0; w < t->wavelengths; w++) set->wavelength_nm[w] = (float)(400 + 20 * w);
    for (int i = 0; i < t->incidences * t->azimuths; i++)
        set->brdf[i] = make_table(t, set, i, arena);
    return set;
}

static inline void fit_tables(Fitted *f, Tables tables, const FitOptions *options) {
    fixture_folder(&f->fit);
    f->tables = tables;
    f->fit.set = make_set(&tables, &f->fit.arena);
    fixture_fit(&f->fit, options);
}

static inline void fitted_end(Fitted *f) {
    fixture_end(&f->fit);
}

/* Of a lane of 400, 420 ... 700 nm: eye and light as {theta, phi}, degrees. */
static inline double brdf_deg(const Panel *panel, const double eye[2], const double light[2],
                              int lane) {
    Wavelengths w = even_wavelengths(400, 20);
    return (double)panel_brdf(panel, direction_deg(eye[0], eye[1]),
                              direction_deg(light[0], light[1]), &w)[lane];
}

/* What most laws need. */
static inline FitOptions quick(void) {
    FitOptions options = fit_options_default();
    options.level = 6;
    return options;
}

static inline double fresnel(double c) {
    return fresnel_unpolarised_d(c, 1.5);
}
