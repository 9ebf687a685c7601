/* SPDX-License-Identifier: Apache-2.0 */
/* A panel's tables written back say what the panel says, and a fit of them says it again. */
#include "panel_fixture.h"

#include "panel/query/panel_emission.h"
#include "text/csv_table.h"
#include "panel/set/export.h"
#include "panel/query/panel_info.h"

#define RECIPE \
    "{\"panel\": \"to export\", \"emission\": {" FIXTURE_SPECTRA \
    "\"black_cd_m2\": 0.5, \"leak\": 2, \"levels\": [63, 127, 255]}," \
    "\"reflection\": {\"haze_share\": 0.7, \"haze_width\": 0.2, \"incidence_deg\": [20, 50]," \
    "\"wavelengths_nm\": [450, 550, 650]}," \
    "\"instrument\": {\"theta_step_deg\": 4, \"phi_step_deg\": 10, \"fwhm_deg\": 5}}"

#define BOUND 0.02

static Fixture first, again; /* the panel, and the one fitted to what it exported */
static char folder[600];

static const ExportOptions coarse = {
    .theta_step_deg = 2, .phi_step_deg = 6, .mirror_fwhm_deg = -1, .progress = PROGRESS_NONE};

static FitOptions options(void) {
    FitOptions fit = fit_options_default();
    fit.bound = (float)BOUND;
    return fit;
}

static int start(void **state) {
    (void)state;
    FitOptions fit = options();
    fixture_start(&first, RECIPE, &fit);
    fixture_folder(&again);
    snprintf(folder, sizeof folder, "%s/out", first.folder);
    const char *manifest = arena_format(&again.arena, "%s/MANIFEST.json", folder);
    again.set = ARENA_NEW(&again.arena, Measurement, 1);
    assert_done(panel_export(first.panel, first.panel_path, &coarse, folder, &err) &&
                measurement_read(manifest, &again.arena, again.set, &err));
    fixture_fit(&again, &fit);
    return 0;
}

static int end(void **state) {
    (void)state;
    fixture_end(&again);
    fixture_end(&first);
    return 0;
}

static Vec3 row_direction(const AngleTable *table, int row) {
    return direction_deg(degrees_from_radians((double)table->theta[row]),
                         degrees_from_radians((double)table->phi[row]));
}

/* Numbers, not errors: what is written has figures enough for float32. */
TEST(exported_emission_is_what_the_panel_says) {
    for (int p = 0; p < 3; p++) {
        assert_int_equal(again.set->primary[p].level_count, 3);
        for (int i = 0; i < 3; i++) {
            const AngleTable *table = &again.set->primary[p].table[i];
            float rgb[3] = {0, 0, 0}, xyz[3];
            rgb[p] = (float)again.set->primary[p].level[i];
            assert_int_equal(table->rows, 1 + 44 * 60);
            for (int r = 0; r < table->rows; r += 17) {
                panel_emission_xyz(first.panel, row_direction(table, r), rgb, xyz);
                for (int j = 0; j < 3; j++)
                    assert_close((double)table->value[3 * r + j], (double)xyz[j], 1e-5);
            }
        }
    }
    assert_true(again.set->has_black);
    assert_true(again.set->has_spectra);
}

TEST(a_fit_of_the_export_is_within_its_bound) {
    float codes[4][3] = {{0, 0, 0}, {255, 255, 255}, {127, 63, 255}, {63, 0, 0}};
    for (int r = 0; r < again.set->black.rows; r += 11)
        for (int c = 0; c < 4; c++) {
            float a[3], b[3];
            Vec3 d = row_direction(&again.set->black, r);
            panel_emission_xyz(first.panel, d, codes[c], a);
            panel_emission_xyz(again.panel, d, codes[c], b);
            for (int j = 0; j < 3; j++) assert_close((double)b[j], (double)a[j], BOUND * 1.01);
        }
}

/* What the instrument of the manifest sees of the second panel: haze and the mirror's image. */
static double seen(const AngleTable *table, int row, double theta_i, double nm) {
    Wavelengths w = even_wavelengths((float)nm, 0);
    Vec3 wo = row_direction(table, row), wi = direction_deg(theta_i, 180);
    Vec3 mirror = direction_deg(theta_i, 0);
    double sigma = radians_from_degrees(again.set->instrument_fwhm_deg) / sqrt(8 * log(2));
    double d = 2 * asin(0.5 * (double)vec3_length(vec3_sub(wo, mirror)));
    double image = exp(-0.5 * d * d / (sigma * sigma)) / (2 * PI * sigma * sigma);
    return (double)panel_brdf(again.panel, wo, wi, &w)[0] +
           (double)panel_mirror(again.panel, wi.z, &w)[0] * image / (double)wi.z;
}

TEST(a_fit_of_the_exported_reflection_is_near_its_bound) {
    for (int i = 0; i < 2; i++)
        for (int r = 0; r < again.set->brdf[i].rows; r += 11)
            assert_close(seen(&again.set->brdf[i], r, i ? 50 : 20, 550),
                         (double)again.set->brdf[i].value[3 * r + 1], 2 * BOUND);
}

/* The mirror part is drawn as the declared instrument sees it, and taken out again. */
TEST(the_mirror_part_survives) {
    Wavelengths w = even_wavelengths(450, 12.5f);
    for (int t = 20; t <= 50; t += 30) {
        float cosine = (float)cos(radians_from_degrees(t));
        double a = (double)panel_mirror(first.panel, cosine, &w)[0];
        assert_true(a > 1e-4);
        assert_close((double)panel_mirror(again.panel, cosine, &w)[0], a, 0.1);
    }
}

/* ---- azimuths of the light, and a true black --------------------------------------------- */

/* What the light at (theta_i, phi_i) is scattered by, phi from the mirror direction: brushed
 * along x; degrees. */
static double brushed(double theta_i, double phi_i, double theta, double phi) {
    Vec3 light = direction_deg(theta_i, phi_i), to = direction_deg(theta, phi_i - 180 + phi);
    double x = (double)(to.x + light.x) / 0.4, y = (double)(to.y + light.y) / 0.8;
    return 0.3 / (double)(light.z + to.z) * pow(1 + x * x + y * y, -1.5) + 0.003;
}

#define AZIMUTHS 6
#define BRUSHED \
    "{\"panel\": \"brushed\", \"reflection\": {\"wavelengths_nm\": [550]," \
    "\"incidence_deg\": [20, 50], \"incidence_phi_deg\": [0, 60, 120, 180, 240, 300]," \
    "\"files\": \"i{incidence}_a{azimuth}.csv\"}}"

static void write_brushed(Fixture *to) {
    for (int i = 0; i < 2 * AZIMUTHS; i++) {
        int incidence = i % 2 ? 50 : 20, azimuth = 60 * (i / 2);
        char *text = arena_alloc(&to->arena, 1, 1, 1 << 16), *at = text;
        at += sprintf(at, "theta,phi,550\n");
        for (int t = 0; t <= 80; t += 5)
            for (int p = 0; p < (t ? 360 : 1); p += 15)
                at += sprintf(at, "%d,%d,%.7g\n", t, p, brushed(incidence, azimuth, t, p));
        fixture_file(to, arena_format(&to->arena, "i%d_a%d.csv", incidence, azimuth), text);
    }
}

/* Reads, fits, opens. */
static void fit_manifest(Fixture *to, const char *manifest) {
    FitOptions fit = options();
    fit.frame_exponent = 1;
    fit.level = 5;
    fixture_read(to, manifest);
    fixture_fit(to, &fit);
}

/* Largest deviation of a panel from the tables of a set, all azimuths of the light. */
static double deviation(const Panel *panel, const Measurement *set) {
    Wavelengths w = even_wavelengths(550, 0);
    double worst = 0;
    for (int i = 0; i < set->azimuth_count * set->incidence_count; i++) {
        const AngleTable *table = &set->brdf[i];
        double phi = degrees_from_radians(set->azimuth[i / set->incidence_count]);
        double incidence = degrees_from_radians(set->incidence[i % set->incidence_count]);
        for (int r = 0; r < table->rows; r++) {
            Vec3 to = direction_deg(degrees_from_radians((double)table->theta[r]),
                                    degrees_from_radians((double)table->phi[r]) + phi - 180);
            double f = (double)panel_brdf(panel, to, direction_deg(incidence, phi), &w)[0];
            worst = fmax(worst, fabs(f / (double)table->value[r] - 1));
        }
    }
    return worst;
}

TEST(every_azimuth_of_the_light_is_exported) {
    ENDS_BY(fixture_end) Fixture from, back;
    double phi[PANEL_INFO_AZIMUTHS_MAX];
    ExportOptions fine = {
        .theta_step_deg = 5, .phi_step_deg = 15, .mirror_fwhm_deg = 0, .progress = PROGRESS_NONE};
    fixture_folder(&from);
    fixture_folder(&back);
    write_brushed(&from);
    fit_manifest(&from, fixture_file(&from, "BRUSHED.json", BRUSHED));
    assert_int_equal(panel_info_azimuths(from.panel, phi), AZIMUTHS);
    for (int i = 0; i < AZIMUTHS; i++) assert_near(degrees_from_radians(phi[i]), 60 * i, 1e-4);
    const char *out = fixture_path(&from, "out");
    assert_done(panel_export(from.panel, "x.panel", &fine, out, &err));
    fit_manifest(&back, arena_format(&from.arena, "%s/MANIFEST.json", out));
    assert_int_equal(back.set->azimuth_count, AZIMUTHS);
    /* the tables are what the panel says; the panel is near the source, its fit near both */
    double written = deviation(from.panel, back.set), source = deviation(from.panel, from.set);
    double fitted = deviation(back.panel, back.set), both = deviation(back.panel, from.set);
    if (written > 1e-5 || source > BOUND || fitted > BOUND || both > 2.05 * BOUND)
        fail_msg("written %.3g source %.3g fitted %.3g both %.3g", written, source, fitted, both);
}

#define TRUE_BLACK \
    "{\"panel\": \"no black\", \"emission\": {" FIXTURE_SPECTRA \
    "\"black_cd_m2\": 0, \"levels\": [127, 255]}," \
    "\"instrument\": {\"theta_step_deg\": 8, \"phi_step_deg\": 30}}"

TEST(levels_over_a_true_black_are_exported) {
    FitOptions fit = options();
    ENDS_BY(fixture_end) Fixture from, back;
    fixture_start(&from, TRUE_BLACK, &fit);
    fixture_folder(&back);
    float nothing[3] = {0, 0, 0}, black[3];
    for (int i = 0; i < 200; i++) { /* nowhere on the hemisphere does its black shine */
        panel_emission_xyz(from.panel, direction_deg(0.45 * i, 137.5 * i), nothing, black);
        assert_true(black[0] == 0 && black[1] == 0 && black[2] == 0);
    }
    const char *out = fixture_path(&from, "out");
    assert_done(panel_export(from.panel, "x.panel", &coarse, out, &err));
    fit_manifest(&back, arena_format(&from.arena, "%s/MANIFEST.json", out));
    for (int p = 0; p < 3; p++) assert_int_equal(back.set->primary[p].level_count, 2);
    for (int i = 0; i < 20; i++) {
        Vec3 d = direction_deg(4 * i, 17 * i);
        float rgb[3] = {127, 255, (float)(12 * i)}, a[3], b[3];
        panel_emission_xyz(from.panel, d, rgb, a);
        panel_emission_xyz(back.panel, d, rgb, b);
        for (int j = 0; j < 3; j++) assert_close((double)b[j], (double)a[j], BOUND);
    }
}

TEST(a_folder_with_files_is_left_alone) {
    int before = folder_count(first.folder);
    assert_fails_as(panel_export(first.panel, "x.panel", &coarse, first.folder, &err), ERROR_OUTPUT,
                    "holds something already");
    assert_string_equal(why()->file, first.folder);
    assert_int_equal(folder_count(first.folder), before);
    assert_false(panel_export(first.panel, "x.panel", &coarse, "/no/such/place", why()));
    assert_int_equal(why()->code, ERROR_OUTPUT);
    assert_int_equal(folder_count(first.folder), before);
}

TEST(an_empty_folder_is_filled) {
    const char *empty = fixture_path(&first, "empty");
    ExportOptions wide = {
        .theta_step_deg = 30, .phi_step_deg = 90, .extrapolates = true, .progress = PROGRESS_NONE};
    assert_int_equal(mkdir(empty, 0777), 0);
    assert_done(panel_export(first.panel, "x.panel", &wide, empty, &err));
    assert_int_equal(folder_count(empty), 4); /* manifest, primaries, emission, brdf */
    CsvTable table;
    assert_done(csv_table_read(arena_format(&first.arena, "%s/emission/black.csv", empty),
                               &first.arena, &table, &err));
    assert_int_equal(table.rows, 1 + 3 * 4); /* the normal, and rings at 30, 60 and 90 */
}

TEST(single_tables_are_named_as_in_info) {
    static const struct {
        const char *name;
        int columns;
    } tables[] = {{"black", 5},   {"white 255", 5},     {"red 127.5", 5}, {"brdf 20 deg", 5},
                  {"brdf 33", 5}, {"brdf 20 at 90", 5}, {"primaries", 4}};
    const char *file = fixture_path(&first, "one.csv");
    for (size_t i = 0; i < sizeof tables / sizeof *tables; i++) {
        CsvTable csv;
        FileBytes bytes;
        if (!panel_export_table(first.panel, tables[i].name, &coarse, file, why()) ||
            !csv_table_read(file, &first.arena, &csv, why()) ||
            !file_read(file, 1u << 24, &first.arena, &bytes, why()))
            fail_msg("%s: %s", tables[i].name, why()->text);
        assert_int_equal(csv.columns, tables[i].columns);
        assert_int_equal(bytes.data[0], '#'); /* units stand in front */
    }
    static const char *const wrong[] = {"",         "red",     "red 256",    "pink 3",
                                        "brdf",     "brdf 95", "brdf 20 at", "brdf 20 at 90 x",
                                        "black 3 4"};
    for (size_t i = 0; i < sizeof wrong / sizeof *wrong; i++) {
        assert_false(panel_export_table(first.panel, wrong[i], &coarse, file, why()));
        assert_int_equal(why()->code, ERROR_USAGE);
    }
}

TEST_PROGRAM(start, end)
