/* SPDX-License-Identifier: Apache-2.0 */
/* What a grid cannot see the fit knows: a mirror that it calls known is true, every range holds
 * the truth, and a verdict that had to guess is coarse. Panels are closed forms
 * (synthetic_panel.h), tables are what the virtual instrument reads of them. */
#include "json_fixture.h"

#include "base/units.h"
#include "panel/fit/fit.h"
#include "panel/fit/fit_judge.h"
#include "panel/fit/reflection/reflection_peak.h"
#include "panel/set/synthetic_format.h"
#include "panel/set/set_writer.h"
#include "panel/set/simulate.h"
#include "spectrum/fresnel.h"
#include "text/text.h"

#define NM 550.0
#define FWHM_DEG 1.2
#define HAZE 0.03

/* A panel whose haze takes 3 % of the light at the normal, and the mirror so much besides. */
static SyntheticPanel panel_of(double lobe_deg, double mirror) {
    SyntheticPanel panel = {.refractive_index = 1.6};
    SyntheticReflection *r = &panel.reflection;
    double most = fresnel_unpolarised_d(1, 1.6), total = HAZE + mirror;
    while (total > most)
        panel.refractive_index += 0.01, most = fresnel_unpolarised_d(1, panel.refractive_index);
    *r = (SyntheticReflection){.exists = true,
                               .haze_share = HAZE / total,
                               .haze_power = 1.8,
                               .coating = (total - most * most) / (most - most * most),
                               .lambertian_albedo = 0.003};
    r->haze_width = radians_from_degrees(lobe_deg) / (2 * sqrt(pow(2, 1 / 1.8) - 1));
    panel.instrument.fwhm_deg = FWHM_DEG;
    return panel;
}

/* One wavelength of one incidence on a polar grid. */
static AngleTable table_of(const SyntheticPanel *panel, double incidence, const double step[2],
                           Arena *arena) {
    PolarGrid grid = polar_grid(step[0], step[1], (int)(88 / step[0] + 1e-9));
    int rows = polar_grid_count(&grid);
    float *theta = ARENA_NEW(arena, float, rows), *phi = ARENA_NEW(arena, float, rows);
    float *value = ARENA_NEW(arena, float, rows);
    for (int i = 0; i < rows; i++) {
        double degrees[2];
        polar_grid_direction(&grid, i, degrees);
        theta[i] = (float)radians_from_degrees(degrees[0]);
        phi[i] = (float)radians_from_degrees(degrees[1]);
        value[i] = (float)closed_form_instrument_brdf(panel, incidence, (double)theta[i],
                                                      (double)phi[i], NM);
    }
    return (AngleTable){.name = "brdf",
                        .rows = rows,
                        .channels = 1,
                        .theta = theta,
                        .phi = phi,
                        .value = value,
                        .theta_max = theta[rows - 1]};
}

/* What a table says of the mirror; with a specular measurement of that aperture, or 0. */
static PeakMirror take(const SyntheticPanel *panel, double incidence, const double step[2],
                       double aperture_deg, Arena *arena) {
    AngleTable table = table_of(panel, incidence, step, arena), haze;
    double aperture = radians_from_degrees(aperture_deg);
    double value = closed_form_specular(panel, incidence, aperture, NM);
    PeakSpecular specular = {aperture, 1, value, &value};
    PeakTask task = {&table, incidence, radians_from_degrees(FWHM_DEG), 0.001,
                     aperture_deg > 0 ? &specular : NULL};
    PeakMirror mirror = {.reflectance = ARENA_NEW(arena, double, 1)};
    reflection_peak_take_mirror(&task, arena, &mirror, &haze);
    return mirror;
}

static const double steps[][2] = {{88.0 / 12, 15}, {4, 10}, {2, 4}, {1, 3}};
static const double lobes[] = {0.2, 1, 2, 5, 10}, mirrors[] = {0, 0.002, 0.02};

TEST(what_is_told_is_true_and_ranges_hold_the_truth) {
    int told = 0, open = 0;
    for (int k = 0; k < 4 * 5 * 3; k++) {
        Arena arena = test_arena(state);
        double incidence = radians_from_degrees(k % 2 ? 30 : 40);
        SyntheticPanel panel = panel_of(lobes[k / 3 % 5], mirrors[k % 3]);
        double truth = closed_form_mirror(&panel, incidence, NM);
        PeakMirror found = take(&panel, incidence, steps[k / 15], 0, &arena);
        double room = 0.05 * fmax(truth, 0.002), *range = found.range.mirror;
        bool is_told = found.source == PEAK_SAMPLES;
        told += is_told, open += !is_told;
        if ((is_told && fabs(found.reflectance[0] - truth) > room) || range[0] > truth + room ||
            range[1] < truth - room)
            fail_msg("step %g, lobe %g: %s, mirror %g, range %g to %g, truth %g", steps[k / 15][0],
                     lobes[k / 3 % 5], is_told ? "told" : "open", found.reflectance[0], range[0],
                     range[1], truth);
    }
    assert_true(told >= 20 && open >= 10);
}

TEST(a_specular_measurement_tells_the_mirror_of_a_coarse_grid) {
    for (int k = 0; k < 6; k++) {
        Arena arena = test_arena(state);
        SyntheticPanel panel = panel_of(k % 2 ? 5 : 10, k < 2 ? 0.002 : k < 4 ? 0.006 : 0.06);
        double incidence = radians_from_degrees(30);
        double truth = closed_form_mirror(&panel, incidence, NM);
        PeakMirror found = take(&panel, incidence, steps[1], 1.2, &arena);
        assert_int_equal(found.source, PEAK_SPECULAR);
        assert_near(found.reflectance[0], truth, 0.05 * truth);
    }
}

ARENA_TEST(a_lobe_narrower_than_the_grid_is_open) {
    SyntheticPanel panel = panel_of(0.2, 0.006);
    PeakMirror found = take(&panel, radians_from_degrees(40), steps[3], 0, &arena);
    assert_true(found.has_haze_open);
}

/* ---- the closed form and the tables ------------------------------------------------------ */

/* At the normal R hardly changes over the aperture: the haze's integral is closed. */
TEST(the_specular_closed_form_is_mirror_and_haze_within_the_aperture) {
    for (int k = 0; k < 4; k++) {
        double lobe = k < 2 ? 2 : 0.3, aperture = radians_from_degrees(k % 2 ? 1.2 : 4);
        SyntheticPanel panel = panel_of(lobe, 0.01);
        panel.reflection.lambertian_albedo = 0;
        double b = sin(0.5 * aperture) / panel.reflection.haze_width;
        double wanted = 0.01 + HAZE * (1 - pow(1 + b * b, -0.8));
        assert_near(closed_form_specular(&panel, 0, aperture, NM), wanted, 0.01 * wanted);
    }
}

ARENA_TEST(gloss_is_a_hundredth_of_black_glass) {
    Gloss gloss = {0};
    double aperture;
    SpecularTable table;
    assert_done(specular_gloss_add(&gloss, 85, 100, &err));
    assert_done(specular_gloss_add(&gloss, 60, 50, &err));
    specular_table_from_gloss(&gloss, "x", &arena, &table);
    double sixty = radians_from_degrees(60);
    assert_near(specular_table_at(&table, sixty, 450, &aperture), 0.5 * 0.10006, 1e-4);
    assert_near(aperture, radians_from_degrees(2 * sqrt(4.4 * 11.7 / PI)), 1e-9);
    double glass = fresnel_unpolarised_d(cos(1.2), 1.5);
    double ratio = specular_table_at(&table, 1.2, 600, &aperture) / glass;
    assert_true(ratio > 0.5 && ratio < 1.4);
}

/* ---- whole fits -------------------------------------------------------------------------- */

static const char *const RECIPE =
    "{\"emission\": {\"red\": {\"peaks_nm\": [628], \"fwhm_nm\": [26], \"weights\": [1]},"
    " \"green\": {\"peaks_nm\": [538], \"fwhm_nm\": [26], \"weights\": [1]},"
    " \"blue\": {\"peaks_nm\": [449], \"fwhm_nm\": [26], \"weights\": [1]}, \"levels\": [255]},"
    " \"reflection\": {\"coating\": 0.6, \"haze_share\": 0.8, \"haze_width\": 0.055,"
    " \"haze_power\": 1.8, \"incidence_deg\": [10, 30, 50], \"wavelengths_nm\": [550]},"
    " \"instrument\": {\"theta_max_deg\": 88, \"theta_step_deg\": 4, \"phi_step_deg\": 10,"
    " \"fwhm_deg\": 1.2}}";

static SyntheticPanel simulate_set(Arena *arena) {
    SyntheticPanel panel;
    write_text(in_folder("x.recipe.json"), RECIPE);
    assert_done(synthetic_panel_read(in_folder("x.recipe.json"), arena, &panel, &err) &&
                simulate_measurement(&panel, test_folder(), PROGRESS_NONE, &err));
    return panel;
}

static const char *manifest(const char *rest, Arena *arena) {
    return arena_format(arena,
                        "{\"instrument_fwhm_deg\": 1.2, \"reflection\": {"
                        "\"wavelengths_nm\": [550], \"incidence_deg\": [10, 30, 50],"
                        " \"files\": \"brdf/i{incidence}.csv\"%s}}",
                        rest);
}

static json_t *fit_set(const char *rest, Arena *arena) {
    Measurement *set = ARENA_NEW(arena, Measurement, 1);
    FitOptions options = fit_options_default();
    json_t *report = NULL;
    write_text(in_folder("MANIFEST.json"), manifest(rest, arena));
    assert_done(measurement_read(in_folder("MANIFEST.json"), arena, set, &err) &&
                panel_fit(set, &options, in_folder("x.panel"), arena, &report, &err));
    return report;
}

/* At the incidence that an entry of a report is about. */
static double true_mirror(const SyntheticPanel *panel, const json_t *entry) {
    double theta = radians_from_degrees(json_number_at(entry, "incidence_deg"));
    return closed_form_mirror(panel, theta, NM);
}

ARENA_TEST(a_coarse_set_is_coarse_and_states_its_range) {
    SyntheticPanel panel = simulate_set(&arena);
    json_t *report = fit_set("", &arena), *list, *one;
    size_t i;
    const char *reason = json_text_at(report, "reasons/0");
    assert_int_equal(fit_judge_grade(report), JUDGE_CARE);
    assert_true(json_is_true(json_object_get(report, "coarse")));
    assert_ptr_equal(strstr(reason, "coarse: "), reason);
    assert_non_null(strstr(reason, "measure the specular reflectance"));
    list = json_at(report, "judged/coarse");
    assert_true(json_array_size(list) > 0);
    json_array_foreach(list, i, one) {
        double truth = true_mirror(&panel, one);
        assert_true(json_number_at(one, "mirror/0") <= truth);
        assert_true(json_number_at(one, "mirror/1") >= truth);
    }
    json_decref(report);
}

ARENA_TEST(the_same_set_with_its_specular_measurement_is_good) {
    SyntheticPanel panel = simulate_set(&arena);
    json_t *report = fit_set(", \"specular\": {\"file\": \"specular.csv\", "
                             "\"aperture_deg\": 1.2}",
                             &arena);
    json_t *list = json_at(report, "reflection/mirror"), *one;
    size_t i;
    assert_int_equal(fit_judge_grade(report), JUDGE_GOOD);
    assert_null(json_object_get(report, "coarse"));
    json_array_foreach(list, i, one) {
        double truth = true_mirror(&panel, one);
        assert_near(json_number_at(one, "luminous_reflectance"), truth, 0.05 * truth);
    }
    json_decref(report);
}

/* ---- errors ------------------------------------------------------------------------------ */

typedef struct Wrong {
    const char *keys, *table, *place, *text; /* table NULL: a good one */
} Wrong;

static const Wrong wrongs[] = {
    {", \"specular\": 7", NULL, "/reflection/specular", "required: a table's path"},
    {", \"specular\": {}", NULL, "/reflection/specular", "key 'file' is missing"},
    {", \"specular\": {\"file\": \"s.csv\", \"aperture\": 1}", NULL, "/reflection/specular",
     "aperture_deg"},
    {", \"specular\": {\"file\": \"s.csv\", \"aperture_deg\": 40}", NULL,
     "/reflection/specular/aperture_deg", "40"},
    {", \"specular\": \"none.csv\"", NULL, "", "No such file"},
    {", \"specular\": \"s.csv\"", "incidence,wavelength\n10,550\n", "header line",
     "'reflectance' is missing"},
    {", \"specular\": \"s.csv\"", "incidence,wavelength,reflectance\n10,550,4\n", "line 2",
     "required: 0 to 1"},
    {", \"specular\": \"s.csv\"", "incidence,wavelength,reflectance\n95,550,0.1\n", "line 2",
     "95 degrees"},
    {", \"specular\": \"s.csv\"", "incidence,wavelength,reflectance\n10,55,0.1\n", "line 2",
     "55 nm"},
    {", \"specular\": \"s.csv\"", "incidence,wavelength,reflectance\n10,550,0.1\n10,550,0.2\n",
     "line 3", "already"},
    {", \"specular\": \"s.csv\"", "incidence,wavelength,reflectance\n10,550,0.1\n20,450,0.2\n", "",
     "no reflectance at 10"},
    {", \"specular\": \"s.csv\", \"gloss\": [{\"geometry_deg\": 60, \"gu\": 1}]", NULL,
     "/reflection", "required: one of them"},
    {", \"gloss\": 60", NULL, "/reflection/gloss", "required: an array"},
    {", \"gloss\": []", NULL, "/reflection/gloss", "required: 1 to 3"},
    {", \"gloss\": [60]", NULL, "/reflection/gloss/0", "required: an object"},
    {", \"gloss\": [{\"geometry_deg\": 60}]", NULL, "/reflection/gloss/0", "'gu' is missing"},
    {", \"gloss\": [{\"geometry_deg\": 45, \"gu\": 9}]", NULL, "/reflection/gloss/0",
     "required: 20, 60 or 85"},
    {", \"gloss\": [{\"geometry_deg\": 60, \"gu\": -1}]", NULL, "/reflection/gloss/0/gu", "-1"},
    {", \"gloss\": [{\"geometry_deg\": 60, \"gu\": 9}, {\"geometry_deg\": 60, \"gu\": 8}]", NULL,
     "/reflection/gloss/1", "twice"},
    {", \"gloss\": [{\"geometry_deg\": 60, \"gu\": 1500}]", NULL, "/reflection/gloss/0",
     "a perfect mirror has 999.4 gloss units"},
};

TEST(malformed_measurements_are_refused_with_place_and_wish) {
    for (size_t i = 0; i < sizeof wrongs / sizeof *wrongs; i++) {
        Arena arena = test_arena(state);
        const Wrong *wrong = &wrongs[i];
        Measurement *set = ARENA_NEW(&arena, Measurement, 1);
        write_text(in_folder("s.csv"),
                   wrong->table ? wrong->table : "incidence,wavelength,reflectance\n10,550,0.1\n");
        write_text(in_folder("MANIFEST.json"), manifest(wrong->keys, &arena));
        if (measurement_read(in_folder("MANIFEST.json"), &arena, set, why()) ||
            !strstr(why()->path, wrong->place) || !strstr(why()->text, wrong->text))
            fail_msg("%s: place '%s', text '%s'", wrong->keys, why()->path, why()->text);
    }
}

/* Their product is more than an int holds. */
ARENA_TEST(a_table_of_a_diagonal_is_refused) {
    Text text = {.arena = &arena};
    SpecularTable table;
    text_add(&text, "incidence,wavelength,reflectance\n");
    for (int i = 0; i < 50000; i++)
        text_format(&text, "%.6f,%.6f,0.01\n", i * 80.0 / 50000, 400 + i * 300.0 / 50000);
    write_text(in_folder("s.csv"), text.data);
    assert_fails_as(specular_table_read_file(in_folder("s.csv"), 1, &arena, &table, &err),
                    ERROR_INPUT, "has 50000 incidences and 50000 wavelengths in 50000");
}

TEST_PROGRAM(make_folder, clear_folder)
