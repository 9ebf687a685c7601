/* SPDX-License-Identifier: Apache-2.0 */
/* panel_fixture.h -- small synthetic panels for tests: recipe, measurement set, fit, panel. */
#pragma once
#include "json_fixture.h"

#include "base/file.h"
#include "base/units.h"
#include "base/vec.h"
#include "panel/fit/fit.h"
#include "panel/query/panel_open.h"
#include "panel/query/panel_reflection.h"
#include "panel/set/synthetic_format.h"
#include "panel/set/measurement.h"
#include "panel/query/panel.h"
#include "panel/set/simulate.h"
#include "spectrum/wavelengths.h"

typedef struct Fixture {
    Arena arena;
    char folder[FOLDER_BYTES];
    char panel_path[FOLDER_BYTES + 32];
    SyntheticPanel recipe;
    Measurement *set;
    Panel *panel;
    json_t *report;
} Fixture;

#define FIXTURE_SPECTRA \
    "\"red\": {\"luminance_cd_m2\": 200, \"peaks_nm\": [625, 600], \"fwhm_nm\": [40, 80]," \
    " \"weights\": [1, 0.1], \"shift\": [-0.10, -0.12, 0.05]}," \
    "\"green\": {\"luminance_cd_m2\": 600, \"peaks_nm\": [535, 520], \"fwhm_nm\": [50, 90]," \
    " \"weights\": [1, 0.1], \"shift\": [0.04, 0, 0.06]}," \
    "\"blue\": {\"luminance_cd_m2\": 70, \"peaks_nm\": [452, 500], \"fwhm_nm\": [30, 90]," \
    " \"weights\": [1, 0.1], \"shift\": [-0.05, 0.05, -0.10]},"

/* Like the shipped IPS panel, without noise, on a coarse grid. */
#define FIXTURE_IPS \
    "{\"panel\": \"test IPS\", \"refractive_index\": 1.5, \"emission\": {" FIXTURE_SPECTRA \
    "\"gamma\": 2.2, \"gamma_drop\": 0.2, \"cosine_power\": [1.1, 1.6]," \
    "\"black_cd_m2\": 0.7, \"leak\": 3}," \
    "\"reflection\": {\"coating\": 0.6, \"coating_blue\": 0.15, \"haze_share\": 0.8," \
    "\"haze_width\": 0.09, \"haze_power\": 1.8, \"floor_albedo\": 0.004," \
    "\"wavelengths_nm\": [400,420,440,460,480,500,520,540,560,580,600,620,640,660,680,700]}," \
    "\"instrument\": {\"theta_step_deg\": 2, \"phi_step_deg\": 6, \"brdf_theta_step_deg\": 1," \
    "\"brdf_phi_step_deg\": 3, \"fwhm_deg\": 2.5}}"

static inline char *fixture_path(Fixture *fixture, const char *name) {
    return arena_format(&fixture->arena, "%s/%s", fixture->folder, name);
}

/* Writes a text into the fixture's folder and returns its path. */
static inline const char *fixture_file(Fixture *fixture, const char *name, const char *text) {
    const char *path = fixture_path(fixture, name);
    write_text(path, text);
    return path;
}

static inline void fixture_folder(Fixture *fixture) {
    memset(fixture, 0, sizeof *fixture);
    fixture->arena = arena_reserve((size_t)64 << 30);
    assert_true(folder_create(fixture->folder));
    snprintf(fixture->panel_path, sizeof fixture->panel_path, "%s",
             fixture_path(fixture, "test.panel"));
}

/* Recipe text to its files in the fixture's folder; the path of their manifest. */
static inline const char *fixture_simulate(Fixture *fixture, const char *recipe) {
    fixture_folder(fixture);
    const char *path = fixture_file(fixture, "recipe.json", recipe);
    assert_done(synthetic_panel_read(path, &fixture->arena, &fixture->recipe, &err) &&
                simulate_measurement(&fixture->recipe, fixture->folder, PROGRESS_NONE, &err));
    return fixture_path(fixture, "MANIFEST.json");
}

static inline void fixture_read(Fixture *fixture, const char *manifest) {
    fixture->set = ARENA_NEW(&fixture->arena, Measurement, 1);
    assert_done(measurement_read(manifest, &fixture->arena, fixture->set, &err));
}

/* The measurement to an opened panel; options NULL: the usual ones. */
static inline void fixture_fit(Fixture *fixture, const FitOptions *options) {
    FitOptions usual = fit_options_default();
    assert_done(panel_fit(fixture->set, options ? options : &usual, fixture->panel_path,
                          &fixture->arena, &fixture->report, &err) &&
                panel_open(fixture->panel_path, &fixture->arena, &fixture->panel, &err));
}

/* A manifest, by its path, to the file of a panel and, where requested, its bytes and
 * itself. */
static inline bool fixture_try(Fixture *fixture, const char *manifest, const FitOptions *options,
                               const char *file, FileBytes *bytes, Panel **panel, Error *err) {
    FitOptions usual = fit_options_default();
    json_auto_t *report = NULL;
    Measurement *set = ARENA_NEW(&fixture->arena, Measurement, 1);
    return measurement_read(manifest, &fixture->arena, set, err) &&
           panel_fit(set, options ? options : &usual, file, &fixture->arena, &report, err) &&
           (!bytes || file_read(file, (size_t)1 << 30, &fixture->arena, bytes, err)) &&
           (!panel || panel_open(file, &fixture->arena, panel, err));
}

/* Recipe text to a measurement that has been read back. */
static inline void fixture_measure(Fixture *fixture, const char *recipe) {
    fixture_read(fixture, fixture_simulate(fixture, recipe));
}

/* Recipe text to a fitted, opened panel. */
static inline void fixture_start(Fixture *fixture, const char *recipe, const FitOptions *options) {
    fixture_measure(fixture, recipe);
    fixture_fit(fixture, options);
}

static inline void fixture_end(Fixture *fixture) {
    panel_close(fixture->panel);
    json_decref(fixture->report);
    folder_destroy(fixture->folder);
    arena_release(&fixture->arena);
}

/* Of a group of tests whose state is their one fixture. */
static inline int fixture_group_end(void **state) {
    fixture_end(*state);
    return 0;
}

/* Unit vector of a direction in degrees. */
static inline Vec3 direction_deg(double theta_deg, double phi_deg) {
    double t = radians_from_degrees(theta_deg), p = radians_from_degrees(phi_deg);
    return vec3((float)(sin(t) * cos(p)), (float)(sin(t) * sin(p)), (float)cos(t));
}

/* An eye at {theta, phi}, light at {theta, 180}: turned by `turn` together, or mirrored and
 * then turned, they have the same BRDF at w.nm[lane]. */
static inline void assert_turns(const Panel *panel, const double eye[2], double light_theta,
                                double turn, const Wavelengths *w, int lane) {
    Vec3 light = direction_deg(light_theta, 180 + turn);
    Spectrum a =
        panel_brdf(panel, direction_deg(eye[0], eye[1]), direction_deg(light_theta, 180), w);
    Spectrum b = panel_brdf(panel, direction_deg(eye[0], eye[1] + turn), light, w);
    Spectrum c = panel_brdf(panel, direction_deg(eye[0], turn - eye[1]), light, w);
    assert_close(b[lane], a[lane], 1e-3);
    assert_close(c[lane], a[lane], 1e-3);
}

/* A number in [0, 1) that depends on nothing but its index. */
static inline double steady_random(uint32_t *state) {
    *state = *state * 1664525u + 1013904223u;
    return (double)(*state >> 8) / 16777216.0;
}

/* 16 wavelengths, evenly from first_nm on. */
static inline Wavelengths even_wavelengths(float first_nm, float step_nm) {
    Wavelengths wavelengths = {0};
    for (int i = 0; i < SPECTRUM_LANES; i++) wavelengths.nm[i] = first_nm + step_nm * (float)i;
    return wavelengths;
}

/* The recipe's XYZ for a pixel; angles in radians. */
static inline void true_xyz(const SyntheticPanel *recipe, const double angles[2],
                            const float rgb[3], double xyz[3]) {
    double add[3];
    closed_form_black_xyz(recipe, angles, xyz);
    for (int p = 0; p < 3; p++) {
        closed_form_emission_xyz(recipe, p, (double)rgb[p], angles, add);
        for (int j = 0; j < 3; j++) xyz[j] += add[j];
    }
}

/* The same at degrees. */
static inline void true_xyz_deg(const SyntheticPanel *recipe, double theta_deg, double phi_deg,
                                const float rgb[3], double xyz[3]) {
    double angles[2] = {radians_from_degrees(theta_deg), radians_from_degrees(phi_deg)};
    true_xyz(recipe, angles, rgb, xyz);
}

/* Between XYZ, in u'v'. */
static inline double chromaticity_distance(const double a[3], const float b[3]) {
    double da = a[0] + 15 * a[1] + 3 * a[2];
    double db = (double)b[0] + 15 * (double)b[1] + 3 * (double)b[2];
    return hypot(4 * a[0] / da - 4 * (double)b[0] / db, 9 * a[1] / da - 9 * (double)b[1] / db);
}
