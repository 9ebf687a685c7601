/* SPDX-License-Identifier: Apache-2.0 */
/* panel report: every table beside the closed form of the panel that was measured; the same
 * figures on the page, in CSV and in JSON; what was not measured is said. */
#include "panel_fixture.h"

#include "cli/panel/panel_commands.h"
#include "panel/query/panel_emission.h"
#include "spectrum/gamut.h"
#include "text/text.h"

/* The leak sanitizer needs this: the font library keeps what it has found until the end. */
const char *__lsan_default_suppressions(void);
const char *__lsan_default_suppressions(void) {
    return "leak:libfontconfig";
}

static Fixture emits, reflects;
static json_t *emission, *reflection; /* their reports */

/* The black pattern's leak takes the contrast through 100 and 10 between the axes. */
#define RECIPE_EMITS \
    "{\"panel\": \"closed form\", \"emission\": {" FIXTURE_SPECTRA \
    "\"gamma\": 2.2, \"gamma_drop\": 0.2, \"cosine_power\": [1.1, 1.6]," \
    "\"black_cd_m2\": 2, \"leak\": 60, \"levels\": [63, 127, 255]}," \
    "\"instrument\": {\"theta_max_deg\": 80, \"theta_step_deg\": 4, \"phi_step_deg\": 15}}"

/* Grey, so that a figure does not depend on weights over wavelength. */
#define RECIPE_REFLECTS \
    "{\"panel\": \"closed form\", \"emission\": {" FIXTURE_SPECTRA \
    "\"cosine_power\": [0.5, 0.5], \"black_cd_m2\": 0.7, \"levels\": [255]}," \
    "\"reflection\": {\"coating\": 0.8, \"haze_share\": 0.8, \"haze_width\": 0.2," \
    "\"haze_power\": 2, \"floor_albedo\": 0.02, \"wavelengths_nm\": [450, 650]," \
    "\"incidence_deg\": [8, 30, 45, 60]}," \
    "\"instrument\": {\"theta_step_deg\": 4, \"phi_step_deg\": 15," \
    "\"brdf_theta_step_deg\": 2, \"brdf_phi_step_deg\": 15, \"fwhm_deg\": 6}}"

/* Runs `panel report` with these arguments; a list that ends in NULL. */
static bool run(Error *err, const char *first, ...) {
    char *argv[24] = {(char *)"report", (char *)first};
    int argc = 2;
    va_list list;
    va_start(list, first);
    for (char *a; (a = va_arg(list, char *)) && argc < 24; argc++) argv[argc] = a;
    va_end(list);
    ENDS_BY(arena_release) Arena arena = arena_reserve((size_t)1 << 32);
    return command_panel_report.run(argc, argv, &arena, err);
}

#define RUN_FAILS(code, part, ...) assert_fails_as(run(&err, __VA_ARGS__, NULL), code, part)
#define RUN_OK(...) assert_done(run(&err, __VA_ARGS__, NULL))

/* The report of a panel, as report.json has it; and page.html beside it. */
static json_t *report_of(Fixture *fixture, const char *panel, bool has_page) {
    json_error_t why;
    const char *tables = fixture_path(fixture, "tables");
    if (has_page) RUN_OK(panel, "--csv", tables, "-o", fixture_path(fixture, "page.html"));
    else RUN_OK(panel, "--csv", tables);
    json_t *report = json_load_file(fixture_path(fixture, "tables/report.json"), 0, &why);
    if (!report) fail_msg("report.json: %s", why.text);
    return report;
}

static const json_t *table_of(const json_t *report, const char *name) {
    size_t i;
    const json_t *table;
    json_array_foreach(json_object_get(report, "tables"), i,
                       table) if (!strcmp(json_text_at(table, "name"), name)) return table;
    fail_msg("no table %s", name);
    return NULL;
}

static const json_t *row_of(const json_t *report, const char *name, size_t row) {
    return json_array_get(json_object_get(table_of(report, name), "rows"), row);
}

static const char *azimuth_key(int index) {
    static const char *const KEYS[] = {"phi_0",   "phi_45",  "phi_90",  "phi_135",
                                       "phi_180", "phi_225", "phi_270", "phi_315"};
    return KEYS[index];
}

static int start(void **state) {
    (void)state;
    FitOptions options = fit_options_default();
    options.progress = PROGRESS_NONE;
    options.threads = 2;
    options.level = 5;
    fixture_start(&emits, RECIPE_EMITS, &options);
    fixture_start(&reflects, RECIPE_REFLECTS, &options);
    emission = report_of(&emits, emits.panel_path, false);
    reflection = report_of(&reflects, reflects.panel_path, true);
    return 0;
}

static int end(void **state) {
    (void)state;
    json_decref(emission);
    json_decref(reflection);
    fixture_end(&reflects);
    fixture_end(&emits);
    return 0;
}

/* ---- viewing angle ----------------------------------------------------------------------- */

enum { LIMITS = 5 };
static const double limits[LIMITS] = {100, 10, 0.5, 0.01, 0.02};

static double shift_between(const double a[3], const double b[3]) {
    float other[3] = {(float)b[0], (float)b[1], (float)b[2]};
    return chromaticity_distance(a, other);
}

/* What is held against a limit, by the closed form. */
static double true_value(int limit, double theta, double phi) {
    double white[3], black[3], normal[3];
    true_xyz_deg(&emits.recipe, theta, phi, (float[3]){255, 255, 255}, white);
    true_xyz_deg(&emits.recipe, theta, phi, (float[3]){0, 0, 0}, black);
    true_xyz_deg(&emits.recipe, 0, 0, (float[3]){255, 255, 255}, normal);
    if (limit < 2) return white[1] / black[1];
    return limit == 2 ? white[1] / normal[1] : shift_between(white, normal);
}

/* The first crossing of the closed form, degrees; NaN: none within 80. */
static double true_crossing(int limit, double phi) {
    bool falls = limit < 3;
    for (double theta = 0; theta <= 80; theta += 0.02)
        if ((true_value(limit, theta, phi) < limits[limit]) == falls) return theta;
    return NAN;
}

TEST(viewing_angles_are_where_the_limit_is_crossed) {
    const json_t *report = emission;
    int crossed = 0;
    for (int limit = 0; limit < LIMITS; limit++)
        for (int i = 0; i < 8; i++) {
            const json_t *cell =
                json_object_get(row_of(report, "viewing_angle", (size_t)limit), azimuth_key(i));
            double wanted = true_crossing(limit, 45 * i), found = json_number_value(cell);
            if (isnan(wanted)) {
                assert_string_equal(json_string_value(cell), "> 80");
                continue;
            }
            crossed++;
            assert_near(found, wanted, 0.5);
        }
    assert_true(crossed >= 16 && crossed < 40); /* both kinds of cells are there */
}

/* ---- colour and levels ------------------------------------------------------------------- */

TEST(colour_shifts_and_gamma_are_the_closed_forms) {
    static const double SHIFT_DEG[] = {30, 45, 60}, GAMMA_DEG[] = {0, 15, 30, 45, 60};
    const json_t *report = emission;
    for (size_t k = 0; k < 3; k++)
        for (int i = 0; i < 8; i++)
            assert_near(json_number_at(row_of(report, "colour_shift", k), azimuth_key(i)),
                        true_value(3, SHIFT_DEG[k], 45 * i), 5e-4);
    for (size_t k = 0; k < 5; k++) {
        double sine = sin(radians_from_degrees(GAMMA_DEG[k]));
        for (int i = 0; i < 8; i++)
            assert_near(json_number_at(row_of(report, "gamma", k), azimuth_key(i)),
                        2.2 - 0.2 * sine * sine, 0.01);
    }
    for (size_t i = 0; i < 9; i++)
        assert_string_equal(json_text_at(row_of(report, "grey_inversion", i), "inverts"), "none");
}

TEST(a_triangle_covers_itself) {
    for (int i = 0; i < GAMUT_STANDARDS; i++) {
        GamutTriangle xy = gamut_triangle((GamutStandard)i), uv = gamut_in_uv(&xy);
        assert_close(gamut_area(&xy, &xy), 1, 1e-12);
        assert_close(gamut_coverage(&xy, &xy), 1, 1e-12);
        assert_close(gamut_coverage(&uv, &uv), 1, 1e-12);
        GamutTriangle half = xy; /* one corner to the middle of the opposite side */
        for (int c = 0; c < 2; c++) half.at[2][c] = 0.5 * (xy.at[2][c] + xy.at[1][c]);
        assert_close(gamut_area(&half, &xy), 0.5, 1e-9);
        assert_close(gamut_coverage(&half, &xy), 0.5, 1e-9);
        assert_close(gamut_area(&xy, &half), 2, 1e-9);
    }
    GamutTriangle srgb = gamut_triangle(GAMUT_SRGB), wide = gamut_triangle(GAMUT_BT2020);
    assert_close(gamut_coverage(&wide, &srgb), 1, 1e-3);
    assert_close(gamut_area(&srgb, &wide), 0.112050 / 0.211866, 1e-4); /* by their corners */
}

/* u', v' of D65 (0.3127, 0.3290) and of illuminant A (0.44757, 0.40745): CIE 15. */
TEST(colour_temperatures_of_illuminants) {
    ColourTemperature d65 = colour_temperature((double[2]){0.19783, 0.46832});
    ColourTemperature a = colour_temperature((double[2]){0.25597, 0.52430});
    assert_near(d65.kelvin, 6504, 4);
    assert_near(d65.duv, 0.0032, 1e-4);
    assert_near(a.kelvin, 2856, 2);
    assert_near(a.duv, 0, 1e-4);
    assert_false(colour_temperature((double[2]){0.11, 0.57}).is_defined); /* a green */
}

/* ---- grey inversion ---------------------------------------------------------------------- */

static const int inverting[] = {63, 127, 255};

/* Downwards middle greys overtake white; as the panels of wrist watches do. */
static double inverting_luminance(int code, double theta_deg, double phi_deg) {
    double down = fmax(0, -sin(radians_from_degrees(phi_deg))) * theta_deg / 60;
    double hump = code == 127 ? 1.1 : code == 63 ? 0.2 : 0;
    return 300 * (pow(code / 255.0, 2.2) * (1 - 0.6 * down) + hump * down * down);
}

static void write_inverting(Fixture *fixture, const char *name, int code, double share) {
    char *text = arena_format(&fixture->arena, "theta,phi,X,Y,Z\n");
    for (int theta = 0; theta <= 60; theta += 5)
        for (int phi = 0; phi < 360; phi += 15) {
            double y = 0.3 + (code ? share * inverting_luminance(code, theta, phi) : 0);
            text = arena_format(&fixture->arena, "%s%d,%d,%.6g,%.6g,%.6g\n", text, theta, phi,
                                0.95 * y, y, 1.09 * y);
        }
    fixture_file(fixture, name, text);
}

static double true_inversion(double theta, double phi) {
    double most = 0, brightest = 0.3;
    for (int i = 0; i < 3; i++) {
        double y = 0.3 + inverting_luminance(inverting[i], theta, phi);
        most = fmax(most, 1 - y / brightest);
        brightest = fmax(brightest, y);
    }
    return most;
}

static const char *fit_inverting(Fixture *fixture) {
    static const char *const NAMES[] = {"red", "green", "blue"};
    static const double SHARES[] = {0.2, 0.7, 0.1};
    char *parts = arena_format(&fixture->arena, "%s", "");
    for (int p = 0; p < 3; p++) {
        parts = arena_format(&fixture->arena, "%s, \"%s\": {", parts, NAMES[p]);
        for (int i = 0; i < 3; i++) {
            char *name = arena_format(&fixture->arena, "%s_%d.csv", NAMES[p], inverting[i]);
            write_inverting(fixture, name, inverting[i], SHARES[p]);
            parts = arena_format(&fixture->arena, "%s%s\"%d\": \"%s\"", parts, i ? ", " : "",
                                 inverting[i], name);
        }
        parts = arena_format(&fixture->arena, "%s}", parts);
    }
    write_inverting(fixture, "black.csv", 0, 0);
    const char *manifest = fixture_file(
        fixture, "M.json",
        arena_format(&fixture->arena,
                     "{\"panel\": \"watch\", \"date\": \"2026-03-14\", \"operator\": \"A. <Name>\","
                     " \"conditions\": \"23 C, dark\", \"emission\": {\"black\": \"black.csv\"%s}}",
                     parts));
    const char *panel = fixture_path(fixture, "inverting.panel");
    FitOptions options = fit_options_default();
    options.progress = PROGRESS_NONE;
    options.level = 5;
    assert_done(fixture_try(fixture, manifest, &options, panel, NULL, NULL, &err));
    return panel;
}

TEST(greys_that_invert_downwards_are_said) {
    Fixture own;
    fixture_folder(&own);
    const char *panel = fit_inverting(&own);
    json_auto_t *report = report_of(&own, panel, false);
    for (int i = 0; i < 8; i++) {
        const json_t *row = row_of(report, "grey_inversion", (size_t)i);
        double phi = 45 * i;
        if (phi <= 180) {
            assert_string_equal(json_text_at(row, "inverts"), "none");
            continue;
        }
        double first = 0;
        while (true_inversion(first, phi) < 0.01) first += 0.02;
        assert_near(json_number_at(row, "from_theta_deg"), first, 0.7);
        assert_close(json_number_at(row, "largest_percent"), 100 * true_inversion(60, phi), 0.02);
        assert_near(json_number_at(row, "level"), 127, 0);
        assert_near(json_number_at(row, "brighter_than_level"), 255, 0);
    }
    assert_near(json_number_at(row_of(report, "grey_inversion", 8), "phi_deg"), 270, 0);
    assert_string_equal(json_text_at(report, "date"), "2026-03-14");
    assert_string_equal(json_text_at(report, "operator"), "A. <Name>");
    assert_string_equal(json_text_at(report, "conditions"), "23 C, dark");
    arena_release(&own.arena);
    folder_destroy(own.folder);
}

/* ---- reflection -------------------------------------------------------------------------- */

/* Integral of f cos over the leaving hemisphere, by the closed form. */
static double true_albedo(double incidence) {
    enum { THETAS = 180, PHIS = 180 };
    double sum = 0, ti = radians_from_degrees(incidence);
    for (int i = 0; i < THETAS; i++)
        for (int j = 0; j < PHIS; j++) {
            double t = (i + 0.5) * PI / 2 / THETAS, p = (j + 0.5) * PI / PHIS;
            sum += closed_form_brdf(&reflects.recipe, ti, t, p, 550) * sin(t) * cos(t);
        }
    return 2 * sum * (PI / 2 / THETAS) * (PI / PHIS);
}

TEST(reflectances_are_the_closed_forms) {
    static const double INCIDENCE[] = {8, 30, 45, 60};
    const json_t *report = reflection;
    for (size_t i = 0; i < 4; i++) {
        const json_t *row = row_of(report, "reflectance", i);
        double ti = radians_from_degrees(INCIDENCE[i]), all = true_albedo(INCIDENCE[i]);
        double mirror = closed_form_mirror(&reflects.recipe, ti, 550);
        double haze = json_number_at(row, "haze_percent");
        double even = json_number_at(row, "lambertian_percent");
        assert_near(json_number_at(row, "incidence_deg"), INCIDENCE[i], 1e-9);
        assert_close(json_number_at(row, "specular_percent"), 100 * mirror, 0.05);
        assert_close(haze + even, 100 * all, 0.03);
        assert_close(json_number_at(row, "total_percent"), 100 * (all + mirror), 0.03);
    }
    double mirror = closed_form_mirror(&reflects.recipe, radians_from_degrees(8), 550);
    assert_close(json_number_at(row_of(report, "reflectance_factors", 0), "factor_percent"),
                 100 * PI * closed_form_brdf(&reflects.recipe, PI / 4, 0, 0, 550), 0.03);
    assert_close(json_number_at(row_of(report, "reflectance_factors", 1), "factor_percent"),
                 100 * (true_albedo(8) + mirror), 0.03);
    assert_close(json_number_at(row_of(report, "reflectance_factors", 2), "factor_percent"),
                 100 * true_albedo(8), 0.03);
}

/* Even surround and directed source, apart and together, seen at the normal. */
TEST(ambient_contrast_has_both_lights) {
    static const double LIGHT[][2] = {{0, 0}, {15000, 65000}, {5000, 0}, {0, 45000}};
    const json_t *report = reflection;
    double white[3], black[3];
    double even = true_albedo(0) + closed_form_mirror(&reflects.recipe, 0, 550);
    double beam = closed_form_brdf(&reflects.recipe, PI / 4, 0, 0, 550);
    true_xyz_deg(&reflects.recipe, 0, 0, (float[3]){255, 255, 255}, white);
    true_xyz_deg(&reflects.recipe, 0, 0, (float[3]){0, 0, 0}, black);
    for (size_t i = 0; i < 4; i++) {
        const json_t *row = row_of(report, "ambient_contrast", i);
        double reflected = even * LIGHT[i][0] / PI + beam * LIGHT[i][1];
        assert_near(json_number_at(row, "diffuse_lx"), LIGHT[i][0], 0);
        assert_near(json_number_at(row, "directed_lx"), LIGHT[i][1], 0);
        assert_near(json_number_at(row, "reflected_cd_m2"), reflected, 0.03 * reflected);
        assert_close(json_number_at(row, "contrast"),
                     (white[1] + reflected) / (black[1] + reflected), 0.03);
    }
}

/* ---- the page ----------------------------------------------------------------- */

TEST(the_page_says_what_is_missing_and_stands_alone) {
    const char *page = read_text(fixture_path(&reflects, "page.html"), &reflects.arena);
    const json_t *table;
    size_t i, missing = 0;
    json_array_foreach(json_object_get(reflection, "tables"), i, table) {
        const char *why = json_string_value(json_object_get(table, "missing"));
        const char *csv =
            arena_format(&reflects.arena, "tables/%s.csv", json_text_at(table, "name"));
        assert_true(file_exists(fixture_path(&reflects, csv)) == !why);
        if (why) assert_non_null(strstr(page, why));
        missing += why != NULL;
    }
    assert_true(missing > 0 && missing + 8 <= i);
    assert_non_null(strstr(page, "@page{size:A4}"));
    assert_non_null(strstr(page, "<td>not stated</td>"));
}

TEST(what_was_not_measured_is_said) {
    const char *table =
        fixture_file(&emits, "white.csv",
                     "theta,phi,X,Y,Z\n0,0,361,380,414\n30,0,280,295,321\n60,0,100,105,114\n");
    const char *panel = fixture_path(&emits, "white.panel");
    FitOptions options = fit_options_default();
    options.progress = PROGRESS_NONE;
    options.level = 5;
    assert_done(fixture_try(&emits, table, &options, panel, NULL, NULL, &err));
    json_auto_t *report = report_of(&emits, panel, false);
    const json_t *half = row_of(report, "viewing_angle", 2);
    assert_true(json_number_at(half, "phi_0") > 30);
    assert_string_equal(json_text_at(half, "phi_90"), "not measured");
    assert_string_equal(json_text_at(row_of(report, "viewing_angle", 1), "phi_0"), "no black");
    const char *levels =
        fixture_file(&emits, "levels.csv", "level,luminance\n0,0.5\n0.5,80\n1,380\n");
    fixture_read(&emits, table); /* black on the axis alone: no contrast at an angle */
    assert_done(measurement_read_levels(emits.set, levels, 0, &emits.arena, &err));
    json_decref(emits.report);
    panel_close(emits.panel);
    fixture_fit(&emits, &options);
    json_auto_t *axis = report_of(&emits, emits.panel_path, false);
    assert_string_equal(json_text_at(row_of(axis, "viewing_angle", 1), "phi_0"), "not measured");
    assert_true(json_number_at(row_of(axis, "gamma", 0), "phi_0") > 1.8);
    assert_string_equal(json_text_at(row_of(axis, "gamma", 2), "phi_0"), "not measured");
    const char *const missing[] = {"gamut", "gamma", "grey_inversion", "reflectance",
                                   "ambient_contrast"};
    for (size_t i = 0; i < 5; i++)
        assert_true(strlen(json_text_at(table_of(report, missing[i]), "missing")) > 20);
    assert_true(json_is_null(json_object_get(report, "operator")));
}

TEST(a_wrong_command_line_says_what_is_required) {
    const char *panel = emits.panel_path, *page = fixture_path(&emits, "no.html");
    RUN_FAILS(ERROR_USAGE, "--csv DIR", panel);
    RUN_FAILS(ERROR_USAGE, "ends in .html", panel, "-o", fixture_path(&emits, "no.txt"));
    RUN_FAILS(ERROR_INPUT, "has no reflection", panel, "-o", page, "--ambient", "500");
    RUN_FAILS(ERROR_USAGE, "--directed", panel, "-o", page, "--directed", "500,95");
    RUN_FAILS(ERROR_OUTPUT, "", panel, "-o", fixture_path(&emits, "none/x.html"));
    assert_false(file_exists(page));
}

TEST_PROGRAM(start, end)
