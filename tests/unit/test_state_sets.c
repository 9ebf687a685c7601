/* SPDX-License-Identifier: Apache-2.0 */
/* Measurement sets of several states: read, fitted to one file, and what is refused. */
#include "panel_fixture.h"

#include "panel/fit/fit_states.h"
#include "panel/fit/panel_states.h"
#include "panel/query/panel_emission.h"
#include "panel/query/panel_info.h"
#include "panel/query/panel_report.h"

#define RECIPE(power, black)                                                                   \
    "{\"emission\": {" FIXTURE_SPECTRA "\"cosine_power\": [" power ", " power "], "            \
    "\"black_cd_m2\": " black ", \"levels\": [96, 255]}, "                                     \
    "\"reflection\": {\"coating\": 0.6, \"haze_share\": 0.8, \"haze_width\": 0.2, "            \
    "\"haze_power\": 1.8, \"floor_albedo\": 0.004, \"wavelengths_nm\": [550], "                \
    "\"incidence_deg\": [10, 40]}, \"instrument\": {\"theta_step_deg\": 8, "                   \
    "\"phi_step_deg\": 30, \"brdf_theta_step_deg\": 8, \"brdf_phi_step_deg\": 30, "            \
    "\"fwhm_deg\": 2.5}}"

#define EMISSION(of)                                                                           \
    "{\"black\": \"" of "/emission/black.csv\", "                                              \
    "\"red\": {\"96\": \"" of "/emission/red_096.csv\", "                                      \
    "\"255\": \"" of "/emission/red_255.csv\"}, "                                              \
    "\"green\": {\"96\": \"" of "/emission/green_096.csv\", "                                  \
    "\"255\": \"" of "/emission/green_255.csv\"}, "                                            \
    "\"blue\": {\"96\": \"" of "/emission/blue_096.csv\", "                                    \
    "\"255\": \"" of "/emission/blue_255.csv\"}}"
#define SET(states) "{\"panel\": \"P\", \"primaries\": \"open/primaries.csv\", "               \
    "\"instrument_fwhm_deg\": 2.5, \"polarisation\": {\"degree\": 0.9, \"azimuth_deg\": 0}, "  \
    "\"states\": " states "}"
#define TWO SET("{\"shared\": {\"emission\": " EMISSION("open") "}, "                          \
                "\"private\": {\"emission\": " EMISSION("narrow") ", "                         \
                "\"polarisation\": {\"degree\": 0.25, \"azimuth_deg\": 90}}}")

static Fixture      folder;
static SyntheticPanel of_state[2]; /* their closed forms */

static void simulate(const char *name, const char *recipe, SyntheticPanel *out)
{
    const char *path = fixture_file(&folder, "recipe.json", recipe);
    assert_done(synthetic_panel_read(path, &folder.arena, out, &err) &&
                simulate_measurement(out, fixture_path(&folder, name), PROGRESS_NONE, &err));
}

/* A manifest, or one of its states, to a file. */
static json_t *fit_to(const char *manifest, const char *file)
{
    FitOptions   options = fit_options_default();
    Measurement *set = ARENA_NEW(&folder.arena, Measurement, 1);
    json_t      *report = NULL;
    options.force = true; /* of a coarse grid */
    options.level = 4;
    assert_done(measurement_read(fixture_path(&folder, manifest), &folder.arena, set, &err) &&
                fit_states(set, &options, fixture_path(&folder, file), &folder.arena, &report,
                           &err));
    return report;
}

static int start(void **state)
{
    *state = &folder;
    fixture_folder(&folder);
    simulate("open", RECIPE("1.2", "0.7"), &of_state[0]);
    simulate("narrow", RECIPE("5", "0.2"), &of_state[1]);
    fixture_file(&folder, "two.json", TWO);
    json_decref(fit_to("two.json", "two.panel"));
    fixture_file(&folder, "white.csv", "theta,phi,X,Y,Z\n0,0,95,100,108\n50,0,60,70,75\n");
    return 0;
}

static FileBytes bytes_of(const char *file)
{
    FileBytes bytes;
    assert_done(file_read(fixture_path(&folder, file), (size_t)1 << 24, &folder.arena, &bytes,
                          &err));
    return bytes;
}

static Panel *opened(const char *name)
{
    Panel *panel;
    assert_done(panel_open(fixture_path(&folder, name), &folder.arena, &panel, &err));
    return panel;
}

/* ---- whole ------------------------------------------------------------------------------- */

TEST(a_set_is_what_join_makes_of_its_single_fits)
{
    json_decref(fit_to("two.json#shared", "shared.panel"));
    json_decref(fit_to("two.json#private", "private.panel"));
    const PanelStateFile single[] = {{"shared", fixture_path(&folder, "shared.panel")},
                                     {"private", fixture_path(&folder, "private.panel")}};
    assert_done(panel_states_join(single, 2, fixture_path(&folder, "joined.panel"),
                                  &folder.arena, &err));
    FileBytes two = bytes_of("two.panel"), joined = bytes_of("joined.panel");
    assert_int_equal(two.size, joined.size);
    assert_memory_equal(two.data, joined.data, joined.size);
    assert_true(bytes_of("private.panel").size + bytes_of("shared.panel").size < two.size);
}

/* Of luminance, relative, where it is a hundredth of the largest or more: there no floor of an
 * error counts. */
static double most_off(const Panel *panel, const AngleTable *table, const float rgb[3])
{
    double most = 0, least = 0;
    int    tried = 0;
    for (int i = 0; i < table->rows; i++)
        least = fmax(least, 0.01 * (double)table->value[3 * i + 1]);
    for (int i = 0; i < table->rows; i++) {
        double theta = (double)table->theta[i], phi = (double)table->phi[i];
        double y = (double)table->value[3 * i + 1];
        float  xyz[3];
        if (y < least) continue;
        panel_emission_xyz(panel, vec3((float)(sin(theta) * cos(phi)),
                                       (float)(sin(theta) * sin(phi)), (float)cos(theta)),
                           rgb, xyz);
        most = fmax(most, fabs((double)xyz[1] - y) / y);
        tried++;
    }
    assert_in(tried, 60, table->rows);
    return most;
}

/* max_error of a table in a panel's own report. */
static double stated_error(const json_t *report, const char *table)
{
    size_t        i;
    const json_t *one;
    json_array_foreach(json_object_get(report, "tables"), i, one)
        if (!strcmp(json_string_value(json_object_get(one, "name")), table))
            return json_number_value(json_object_get(one, "max_error"));
    fail_msg("no table %s", table);
    return 0;
}

TEST(each_state_shines_as_it_was_measured)
{
    static const char *const names[] = {"shared", "private"};
    static const double      degree[] = {0.9, 0.25};
    Measurement *set = ARENA_NEW(&folder.arena, Measurement, 1);
    assert_done(measurement_read(fixture_path(&folder, "two.json"), &folder.arena, set, &err));
    assert_int_equal(set->state_count, 2);
    for (int k = 0; k < 2; k++) {
        json_t *own;
        Panel  *panel = opened(k ? "two.panel#private" : "two.panel#shared");
        int     which;
        assert_int_equal(panel_info_states(panel, &which), 2);
        assert_int_equal(which, k);
        assert_string_equal(panel_info_state_name(panel, k), names[k]);
        assert_string_equal(set->state[k].name, names[k]);
        assert_near(panel_polarisation(panel).degree, degree[k], 1e-4);
        assert_done(panel_report(panel, &own, &err));
        const Measurement *of = set->state[k].set;
        for (int p = 0; p < 3; p++) {
            const AngleTable *table = &of->primary[p].table[1];
            float  rgb[3] = {0, 0, 0};
            double bound = stated_error(own, table->name);
            rgb[p] = 255;
            assert_in(bound, 1e-9, 0.02);
            assert_in(most_off(panel, table, rgb), 0, bound * 1.001);
        }
        /* Between the samples the closed form, to the fit's own standard of a coarse grid. */
        double truth[3];
        float  xyz[3];
        const float white[3] = {255, 255, 255};
        true_xyz_deg(&of_state[k], 20, 30, white, truth);
        panel_emission_xyz(panel, direction_deg(20, 30), white, xyz);
        assert_close(xyz[1], truth[1], 0.01);
        json_decref(own);
        panel_close(panel);
    }
}

/* The set's own, unless a state has another. */
TEST(reflection_is_shared_unless_a_state_has_its_own)
{
    static const char OWN[] =
        "{\"reflection\": {\"wavelengths_nm\": [550], \"incidence_deg\": [10, 40], \"files\": "
        "\"open/brdf/i{incidence}.csv\"}, \"primaries\": \"open/primaries.csv\", \"states\": "
        "{\"a\": {\"emission\": " EMISSION("open") "}, "
        "\"b\": {\"emission\": " EMISSION("narrow") ", \"reflection\": {\"wavelengths_nm\": "
        "[550], \"incidence_deg\": [40], \"files\": \"open/brdf/i{incidence}.csv\"}}}}";
    Measurement *set = ARENA_NEW(&folder.arena, Measurement, 1);
    const char  *path = fixture_file(&folder, "MANIFEST.json", OWN);
    assert_done(measurement_read(path, &folder.arena, set, &err));
    const Measurement *a = set->state[0].set, *b = set->state[1].set;
    assert_int_equal(a->incidence_count, 2);
    assert_int_equal(b->incidence_count, 1);
    assert_ptr_equal(a->brdf, set->brdf); /* read once */
    assert_true(a->has_spectra && b->has_spectra);
    assert_int_equal(a->inputs.count, b->inputs.count);
    assert_int_equal(set->primary[0].level_count, 0); /* what emits stands in the states */
}

/* ---- what is wrong ----------------------------------------------------------------------- */

#define WHITE "{\"emission\": {\"white\": \"white.csv\"}}"
#define ONLY(states) "{\"states\": " states "}"

TEST(sets_name_the_state)
{
    static const struct { const char *text, *parts[3]; } cases[] = {
        {ONLY("3"), {"/states", "is a number", "required: an object"}},
        {ONLY("{\"a\": " WHITE "}"), {"/states", "has 1 members", "required: 2 to 16"}},
        {ONLY("{\"a\": " WHITE ", \"a\": " WHITE "}"), {"MANIFEST.json", "duplicate", "a"}},
        {ONLY("{\"a\": " WHITE ", \"b\": {}}"), {"/states/b", "has no 'emission'", "each"}},
        {ONLY("{\"a\": " WHITE ", \"b\": 1}"), {"/states/b", "is a number", "an object"}},
        {ONLY("{\"a\": " WHITE ", \"b c\": " WHITE "}"),
         {"/states/b c", "is no state's name", "letters, digits, '-' and '_'"}},
        {ONLY("{\"a\": " WHITE ", \"\": " WHITE "}"), {"/states", "empty name", "a name"}},
        {ONLY("{\"a\": " WHITE ", \"b\\u001b\": " WHITE "}"),
         {"/states/b", "is no state's name", "1 to 31"}},
        {ONLY("{\"a\": " WHITE ", \"a23456789012345678901234567890_2\": " WHITE "}"),
         {"/states/a2345", "is no state's name", "1 to 31"}},
        {ONLY("{\"a\": " WHITE ", \"b\": {\"emision\": 1}}"),
         {"/states/b/emision", "unknown key", "'emission'"}},
        {"{\"emission\": {\"white\": \"white.csv\"}, \"states\": {\"a\": " WHITE ", \"b\": "
         WHITE "}}", {"/states", "stands beside 'emission'", "in each state"}},
        {"{\"spots\": [{\"position\": [0, 0], \"emission\": {\"white\": \"white.csv\"}}], "
         "\"states\": {\"a\": " WHITE ", \"b\": " WHITE "}}",
         {"/states", "stands beside 'spots'", "in each state"}},
        {"{\"backlight\": \"oled\", \"states\": {\"a\": " WHITE ", \"b\": {\"emission\": "
         "{\"white\": \"white.csv\"}, \"primaries\": \"open/primaries.csv\"}}}",
         {"/states/b", "has 'primaries'", "'backlight'"}},
        {ONLY("{\"a\": " WHITE ", \"b\": {\"emission\": {\"white\": \"none.csv\"}}}"),
         {"none.csv", "", ""}},
    };
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        Error        err = {0};
        Measurement *set = ARENA_NEW(&folder.arena, Measurement, 1);
        const char  *path = fixture_file(&folder, "MANIFEST.json", cases[i].text);
        if (measurement_read(path, &folder.arena, set, &err))
            fail_msg("was accepted: %s", cases[i].text);
        assert_line_has(&err, cases[i].parts, 3);
    }
}

TEST(a_state_is_named_where_one_is_required)
{
    Measurement *set = ARENA_NEW(&folder.arena, Measurement, 1);
    const char  *path = fixture_file(&folder, "MANIFEST.json",
                                     ONLY("{\"a\": " WHITE ", \"b\": " WHITE "}"));
    assert_done(measurement_read(path, &folder.arena, set, &err));
    assert_false(measurement_take_state(set, NULL, why()));
    assert_non_null(strstr(why()->text, "has the states a, b, required: one of them, as "
                                        "MANIFEST.json#a"));
    assert_false(measurement_take_state(set, "c", why()));
    assert_non_null(strstr(why()->text, "has no state 'c', required: a, b"));
    assert_false(measurement_read_levels(set, path, 0, &folder.arena, why()));
    assert_non_null(strstr(why()->text, "in the emission of each"));
    assert_done(measurement_take_state(set, "b", &err));
    assert_true(set->is_white_only && !set->state_count);
    assert_done(measurement_take_state(set, NULL, &err));
    assert_false(measurement_take_state(set, "b", why()));
    assert_non_null(strstr(why()->text, "this set has one only"));
}

/* The line says which. */
TEST(a_state_that_cannot_be_fitted_is_named)
{
    static const char BAD[] = ONLY("{\"good\": " WHITE ", \"bad\": {\"emission\": {\"white\": "
        "\"white.csv\"}, \"reflection\": {\"wavelengths_nm\": [550], \"incidence_deg\": [10], "
        "\"files\": \"much{incidence}.csv\"}}}");
    FitOptions   options = fit_options_default();
    Measurement *set = ARENA_NEW(&folder.arena, Measurement, 1);
    json_t      *report = NULL;
    const char  *much = "theta,phi,550\n0,0,2\n";
    for (int theta = 20; theta < 90; theta += 20)
        for (int phi = 0; phi < 360; phi += 60)
            much = arena_format(&folder.arena, "%s%d,%d,2\n", much, theta, phi);
    fixture_file(&folder, "much10.csv", much); /* sends back more than comes */
    const char *path = fixture_file(&folder, "MANIFEST.json", BAD);
    const char *to = fixture_path(&folder, "none.panel");
    assert_done(measurement_read(path, &folder.arena, set, &err));
    assert_false(fit_states(set, &options, to, &folder.arena, &report, why()));
    assert_int_equal(why()->code, ERROR_UNUSABLE);
    assert_non_null(strstr(why()->text, "the state 'bad'"));
    assert_string_equal(json_string_value(json_object_get(report, "state")), "bad");
    assert_false(file_exists(to));
    json_decref(report);
}

TEST_PROGRAM(start, fixture_group_end)
