/* SPDX-License-Identifier: Apache-2.0 */
/* Emission of fitted panels against closed truth: bounds, noise, grids, levels, sizes. */
#include "panel_fixture.h"

#include "panel/query/panel_components.h"
#include "panel/query/panel_emission.h"
#include "panel/query/panel_file.h"
#include "panel/shape/panel_levels.h"
#include "panel/query/panel_opened.h"
#include "panel/query/panel_report.h"
#include "panel/shape/panel_spline.h"

#define COARSE "\"theta_step_deg\": 4, \"phi_step_deg\": 10"
#define FINE "\"theta_step_deg\": 2, \"phi_step_deg\": 5"
#define CHECK_EMISSION \
    "\"gamma\": 2.2, \"gamma_drop\": 0.2, \"cosine_power\": [1.1, 1.6]," \
    "\"black_cd_m2\": 0.7, \"leak\": 3"
#define FOUR "\"levels\": [31, 95, 175, 255],"
#define RECIPE(emission, instrument) \
    "{\"panel\": \"p\", \"emission\": {" FIXTURE_SPECTRA emission "}," \
    "\"instrument\": {" instrument "}}"

static const char *const recipes[] = {
    RECIPE(CHECK_EMISSION, COARSE),
    RECIPE(FOUR "\"gamma\": 2.2, \"cosine_power\": [0.3, 0.3], \"black_cd_m2\": 0", COARSE),
    RECIPE(FOUR "\"gamma\": 2.4, \"cosine_power\": [3, 4.5], \"black_cd_m2\": 0.05,"
                "\"leak\": 6",
           COARSE),
    RECIPE(FOUR "\"cosine_power\": [1, 1.4], \"black_cd_m2\": 0.3,"
                "\"lobe\": {\"theta_deg\": 35, \"phi_deg\": 70, \"width_deg\": 16, \"gain\": 1.5}",
           COARSE),
};

typedef struct Misses {
    double luminance, colour; /* relative; u'v' */
} Misses;

/* At random directions up to `theta` and random codes of at least `code` less than these. */
static void expect_misses(const char *what, const Fixture *f, double theta, double code, int count,
                          Misses allowed) {
    Misses most = {0, 0};
    uint32_t random = 7;
    for (int i = 0; i < count; i++) {
        double angles[2] = {radians_from_degrees(theta) * steady_random(&random),
                            2 * PI * steady_random(&random)},
               truth[3];
        float rgb[3], xyz[3];
        for (int p = 0; p < 3; p++) rgb[p] = (float)(code + (255 - code) * steady_random(&random));
        true_xyz(&f->recipe, angles, rgb, truth);
        panel_emission_xyz(
            f->panel,
            direction_deg(degrees_from_radians(angles[0]), degrees_from_radians(angles[1])), rgb,
            xyz);
        most.luminance = fmax(most.luminance, fabs((double)xyz[1] / truth[1] - 1));
        most.colour = fmax(most.colour, chromaticity_distance(truth, xyz));
    }
    if (!(most.luminance < allowed.luminance) || !(most.colour < allowed.colour))
        fail_msg("%s: luminance %g, u'v' %g, required: less than %g, %g", what, most.luminance,
                 most.colour, allowed.luminance, allowed.colour);
}

static double emission_figure(const Fixture *f, const char *key) {
    return json_number_at(json_object_get(f->report, "emission"), key);
}

/* The largest |M - measured| / measured of a table's channels; less than 0.0001 cd/m2 counts as
 * that. */
static double worst_sample(const Panel *panel, const AngleTable *table, const float rgb[3]) {
    double worst = 0;
    for (int i = 0; i < table->rows; i++) {
        float xyz[3];
        panel_emission_xyz(panel,
                           direction_deg(degrees_from_radians((double)table->theta[i]),
                                         degrees_from_radians((double)table->phi[i])),
                           rgb, xyz);
        for (int j = 0; j < 3; j++)
            worst = fmax(worst, fabs((double)(xyz[j] - table->value[3 * i + j])) /
                                    fmax(1e-4, (double)table->value[3 * i + j]));
    }
    return worst;
}

static double worst_of_all(const Fixture *f) {
    float dark[3] = {0, 0, 0};
    double worst = f->panel->emission->has_black ? worst_sample(f->panel, &f->set->black, dark) : 0;
    for (int p = 0; p < 3; p++)
        for (int i = 0; i < f->set->primary[p].level_count; i++) {
            float rgb[3] = {0, 0, 0};
            rgb[p] = (float)f->set->primary[p].level[i];
            worst = fmax(worst, worst_sample(f->panel, &f->set->primary[p].table[i], rgb));
        }
    return worst;
}

/* ---- bounds ---------------------------------------------------------------------------- */

/* Every recipe with the tolerance that the fit chooses. */
static Fixture fitted[4];

static int start_all(void **state) {
    (void)state;
    for (int r = 0; r < 4; r++) {
        fixture_start(&fitted[r], recipes[r], NULL);
    }
    return 0;
}

static int end_all(void **state) {
    (void)state;
    for (int r = 0; r < 4; r++) fixture_end(&fitted[r]);
    return 0;
}

TEST(every_sample_keeps_the_bound_that_was_asked_for) {
    for (int r = 0; r < 4; r++) {
        ENDS_BY(fixture_end) Fixture f;
        FitOptions options = fit_options_default();
        options.bound = r % 2 ? 0.005f : 0.02f;
        fixture_start(&f, recipes[r], &options);
        double worst = worst_of_all(&f), said = json_number_at(f.report, "total/max_error");
        if (!(worst <= (double)options.bound) || !(worst <= said * 1.01 + 1e-5))
            fail_msg("recipe %d: %g, asked for %g, said %g", r, worst, (double)options.bound, said);
        if (emission_figure(&f, "outliers") > 0 || emission_figure(&f, "holes") > 0)
            fail_msg("recipe %d: outliers or holes without any", r);
    }
}

TEST(between_samples_the_truth_is_near) {
    for (int r = 0; r < 4; r++)
        expect_misses(recipes[r], &fitted[r], 80, 20, 25000, (Misses){0.02, 0.0015});
}

TEST(beyond_the_cone_light_falls) {
    float rgb[3] = {255, 255, 255}, edge[3], before[3], xyz[3];
    for (int r = 0; r < 4; r++)
        for (int phi = 0; phi < 360; phi += 15) {
            assert_true(panel_emission_xyz(fitted[r].panel, direction_deg(87.9, phi), rgb, edge));
            memcpy(before, edge, sizeof edge);
            for (int i = 1; i < 20; i++) {
                Vec3 d = direction_deg(88 + 0.1 * i, phi);
                assert_false(panel_emission_xyz(fitted[r].panel, d, rgb, xyz));
                assert_true(xyz[1] >= 0 && xyz[1] <= before[1] * 1.0001f);
                memcpy(before, xyz, sizeof xyz);
            }
        }
}

TEST(noise_is_smoothed_not_stored) {
    ENDS_BY(fixture_end) Fixture clean, noisy;
    fixture_start(&clean, RECIPE(FOUR CHECK_EMISSION, FINE), NULL);
    fixture_start(&noisy, RECIPE(FOUR CHECK_EMISSION, FINE ", \"noise_relative\": 0.003"), NULL);
    expect_misses("noisy", &noisy, 75, 31, 5000, (Misses){0.005, 0.001});
    assert_true(emission_figure(&noisy, "share_of_source") < 0.008);
    /* Three scores in each of 3,169 directions: noise that is stored costs a byte for each. */
    double added = emission_figure(&noisy, "bytes") - emission_figure(&clean, "bytes");
    assert_true(added < 0.2 * 3 * 3169);
    assert_close(json_number_at(noisy.report, "tables/5/noise"), 0.003, 0.2);
}

TEST(sets_and_lone_tables_take_few_bytes) {
    ENDS_BY(fixture_end) Fixture f;
    FitOptions options = fit_options_default();
    options.bound = 0.02f;
    fixture_start(&f, RECIPE(CHECK_EMISSION, FINE), &options);
    assert_true(worst_of_all(&f) <= 0.02);
    assert_true(emission_figure(&f, "share_of_source") < 0.008);
    const char *lone = fixture_path(&f, "emission/green_255.csv");
    json_decref(f.report);
    panel_close(f.panel);
    assert_done(measurement_read(lone, &f.arena, f.set, &err));
    fixture_fit(&f, &options);
    assert_true(emission_figure(&f, "share_of_source") < 0.015);
}

TEST(a_table_is_as_bright_as_it_was_measured_on_the_whole) {
    for (int r = 0; r < 4; r++) {
        size_t i;
        json_t *table;
        json_array_foreach(json_object_get(fitted[r].report, "tables"), i, table) {
            double error = json_number_at(table, "integral_error");
            if (!(fabs(error) < 0.001)) fail_msg("recipe %d, table %zu: %g", r, i, error);
        }
    }
}

/* ---- odd sources ----------------------------------------------------------------------- */

static AngleTable *table_of(Fixture *f, int primary, int level) {
    return &f->set->primary[primary].table[level];
}

TEST(hot_pixels_are_found_listed_and_not_followed) {
    ENDS_BY(fixture_end) Fixture f;
    FitOptions options = fit_options_default();
    int hot[][3] = {{0, 2, 100}, {1, 3, 555}, {2, 1, 640}, {1, 0, 2}};
    fixture_measure(&f, RECIPE(FOUR CHECK_EMISSION, COARSE ", \"noise_relative\": 0.01"));
    for (int i = 0; i < 4; i++) {
        AngleTable *t = table_of(&f, hot[i][0], hot[i][1]);
        float *value = (float *)t->value + 3 * hot[i][2];
        for (int j = 0; j < 3; j++) value[j] *= i == 2 ? 0.2f : 8;
    }
    fixture_fit(&f, &options);
    json_t *list = json_object_get(f.report, "outliers");
    assert_int_equal(json_array_size(list), 4);
    for (size_t i = 0; i < 4; i++) {
        double value = json_number_at(json_array_get(list, i), "value");
        double wanted = json_number_at(json_array_get(list, i), "expected");
        assert_true(value > 7 * wanted || value < 0.25 * wanted);
    }
    assert_true(emission_figure(&f, "bound") < 0.03); /* beside 5 sigma of 1% noise */
    assert_true(json_number_at(f.report, "total/max_error") < 0.08);
    assert_int_equal(json_number_at(f.report, "total/outliers"), 4);
    assert_true(json_number_at(f.report, "total/outliers_max_error") > 0.8);
    expect_misses("f", &f, 75, 31, 3000, (Misses){0.015, 0.004});
    assert_string_equal(json_text_at(f.report, "verdict"), "good");
}

TEST(a_direction_that_is_hot_in_every_table_may_be_a_peak) {
    ENDS_BY(fixture_end) Fixture f;
    fixture_measure(&f, RECIPE(FOUR CHECK_EMISSION, COARSE ", \"noise_relative\": 0.01"));
    for (int p = 0; p < 3; p++)
        for (int i = 0; i < f.set->primary[p].level_count; i++) {
            float *value = (float *)table_of(&f, p, i)->value + 3 * 300;
            for (int j = 0; j < 3; j++) value[j] *= 8;
        }
    fixture_fit(&f, NULL);
    const char *reason = json_string_value(json_array_get(json_object_get(f.report, "reasons"), 0));
    assert_string_equal(json_text_at(f.report, "verdict"), "usable with care");
    assert_non_null(strstr(reason, "coarse: emission: 1 direction is in every table far from"));
}

static void drop_row(AngleTable *t, int row) {
    int behind = t->rows - row - 1;
    memmove((float *)t->theta + row, t->theta + row + 1, sizeof(float) * (size_t)behind);
    memmove((float *)t->phi + row, t->phi + row + 1, sizeof(float) * (size_t)behind);
    memmove((float *)t->value + 3 * row, t->value + 3 * (row + 1),
            3 * sizeof(float) * (size_t)behind);
    t->rows--;
}

TEST(holes_are_listed_and_filled_by_what_is_known) {
    ENDS_BY(fixture_end) Fixture f;
    fixture_measure(&f, RECIPE(FOUR CHECK_EMISSION, COARSE));
    for (int i = 0; i < 6; i++) drop_row(table_of(&f, i % 3, i % 4), 150 + 40 * i);
    fixture_fit(&f, NULL);
    assert_int_equal(json_array_size(json_object_get(f.report, "holes")), 6);
    assert_true(emission_figure(&f, "outliers") == 0);
    expect_misses("f", &f, 80, 20, 4000, (Misses){0.012, 0.0015});
}

TEST(tables_may_have_grids_of_their_own) {
    ENDS_BY(fixture_end) Fixture f, other;
    fixture_measure(&f, RECIPE(FOUR CHECK_EMISSION, COARSE));
    fixture_measure(&other,
                    RECIPE(FOUR CHECK_EMISSION, "\"theta_step_deg\": 3, \"phi_step_deg\": 7.5,"
                                                "\"theta_max_deg\": 78"));
    for (int i = 0; i < 2; i++) *table_of(&f, 1, i) = *table_of(&other, 1, i);
    f.set->black = other.set->black;
    fixture_fit(&f, NULL);
    expect_misses("f", &f, 75, 20, 4000, (Misses){0.02, 0.004});
    float rgb[3] = {255, 255, 255}, xyz[3];
    assert_true(panel_emission_xyz(f.panel, direction_deg(77, 10), rgb, xyz));
    assert_false(panel_emission_xyz(f.panel, direction_deg(80, 10), rgb, xyz));
}

TEST(two_sections_are_met_where_they_were_measured) {
    ENDS_BY(fixture_end) Fixture f;
    FitOptions options = fit_options_default();
    options.bound = 0.01f;
    fixture_measure(&f, RECIPE("\"cosine_power\": [1.1, 1.6], \"black_cd_m2\": 0.2",
                               "\"theta_step_deg\": 4, \"phi_step_deg\": 30"));
    for (int p = 0; p < 4; p++)
        for (int i = 0; i < (p < 3 ? f.set->primary[p].level_count : 1); i++) {
            AngleTable *t = p < 3 ? table_of(&f, p, i) : &f.set->black;
            for (int row = t->rows - 1; row > 0; row--)
                if (fabs(remainder((double)t->phi[row], PI / 2)) > 0.1) drop_row(t, row);
        }
    fixture_fit(&f, &options);
    assert_true(worst_of_all(&f) <= 0.01);
    assert_true(emission_figure(&f, "outliers") == 0);
}

TEST(both_bases_answer_the_same_query) {
    ENDS_BY(fixture_end) Fixture haar;
    FitOptions options = fit_options_default();
    options.basis = FIT_HAAR;
    fixture_start(&haar, recipes[3], &options);
    expect_misses("haar", &haar, 75, 20, 4000, (Misses){0.015, 0.002});
    assert_true(emission_figure(&haar, "bytes") > emission_figure(&fitted[3], "bytes"));
    assert_true(emission_figure(&haar, "share_of_source") < 0.1);
}

TEST(a_surface_that_only_reflects_emits_nothing) {
    ENDS_BY(fixture_end) Fixture f;
    FitOptions options = fit_options_default();
    fixture_measure(&f, "{\"panel\": \"p\", \"emission\": {" FIXTURE_SPECTRA "\"levels\": [255]},"
                        "\"reflection\": {\"haze_share\": 1, \"haze_width\": 0.4,"
                        "\"floor_albedo\": 0.02, \"incidence_deg\": [20, 40],"
                        "\"wavelengths_nm\": [550]},"
                        "\"instrument\": {\"theta_step_deg\": 8, \"phi_step_deg\": 30,"
                        "\"brdf_theta_step_deg\": 8, \"brdf_phi_step_deg\": 20, \"fwhm_deg\": 2}}");
    const char *manifest =
        fixture_file(&f, "reflects.json",
                     "{\"panel\": \"matt\", \"reflection\": {\"wavelengths_nm\": [550],"
                     "\"incidence_deg\": [20, 40], \"files\": \"brdf/i{incidence}.csv\"}}");
    assert_done(measurement_read(manifest, &f.arena, f.set, &err));
    fixture_fit(&f, &options);
    float rgb[3] = {255, 255, 255}, xyz[3];
    assert_false(panel_emission_xyz(f.panel, direction_deg(20, 0), rgb, xyz));
    assert_true(xyz[0] == 0 && xyz[1] == 0 && xyz[2] == 0);
    assert_true(panel_mean_luminance(f.panel, rgb) == 0);
    assert_true(panel_reflects(f.panel));
    const char *nothing = fixture_file(&f, "nothing.json", "{\"panel\": \"none\"}");
    assert_false(measurement_read(nothing, &f.arena, f.set, why()));
}

/* ---- levels ---------------------------------------------------------------------------- */

TEST(a_level_left_out_is_predicted) {
    for (int left = 1; left <= 6; left += 5) {
        ENDS_BY(fixture_end) Fixture f;
        fixture_measure(&f, recipes[0]);
        double code = f.set->primary[0].level[left];
        for (int p = 0; p < 3; p++) {
            MeasuredPrimary *from = &f.set->primary[p];
            for (int i = left; i + 1 < from->level_count; i++) {
                from->level[i] = from->level[i + 1];
                from->table[i] = from->table[i + 1];
            }
            from->level_count--;
        }
        fixture_fit(&f, NULL);
        for (int i = 0; i < 200; i++) {
            double angles[2] = {radians_from_degrees(0.37 * i), 0.7 * i}, truth[3];
            float rgb[3] = {(float)code, (float)code, (float)code}, xyz[3];
            rgb[i % 3] = 0;
            true_xyz(&f.recipe, angles, rgb, truth);
            panel_emission_xyz(f.panel, direction_deg(0.37 * i, degrees_from_radians(0.7 * i)), rgb,
                               xyz);
            assert_close(xyz[1], truth[1], 0.01);
            assert_true(chromaticity_distance(truth, xyz) < 0.001);
        }
    }
}

TEST(level_weights_reproduce_the_mean_curve) {
    static const float codes[] = {16, 31, 80, 127, 200, 255};
    float x[6], y[6];
    for (int i = 0; i < 6; i++) {
        x[i] = logf(codes[i]);
        y[i] = 2.2f * x[i] + 0.2f * sinf(3 * x[i]);
    }
    for (int code = 2; code < 256; code++) {
        float at = logf((float)code), sum = 0, ones = 0, line = 0;
        PanelLevelWeights w = panel_level_weights(x, y, 6, 2.2f, at);
        for (int i = 0; i < 4 && w.first + i < 6; i++) {
            sum += w.weight[i] * y[w.first + i];
            line += w.weight[i] * x[w.first + i];
            ones += w.weight[i];
        }
        assert_near(ones, 1, 1e-4);
        for (int i = 0; i < 6; i++)
            if (codes[i] == (float)code) assert_near(sum, y[i], 1e-4);
        if (code > 16) assert_true(sum > y[0] - 1e-4f && sum < y[5] + 1e-4f);
        if (code < 16) assert_near(line, at, 1e-3); /* a power law stays one */
    }
}

TEST(fractions_of_codes_lie_between_whole_ones) {
    const Panel *panel = fitted[0].panel;
    for (int code = 0; code < 255; code += 3)
        for (int p = 0; p < 3; p++) {
            float low[3] = {0, 0, 0}, middle[3] = {0, 0, 0}, high[3] = {0, 0, 0};
            float a[3], b[3], c[3];
            Vec3 d = direction_deg(0.3 * code, 7.0 * code);
            low[p] = (float)code;
            middle[p] = (float)code + 0.4f;
            high[p] = (float)code + 1;
            panel_emission_xyz(panel, d, low, a);
            panel_emission_xyz(panel, d, middle, b);
            panel_emission_xyz(panel, d, high, c);
            assert_true(a[1] <= b[1] && b[1] <= c[1]);
            assert_true(panel_mean_luminance(panel, low) <= panel_mean_luminance(panel, middle));
            assert_true(panel_mean_luminance(panel, middle) <= panel_mean_luminance(panel, high));
        }
}

/* ---- pieces of the file ---------------------------------------------------------------- */

TEST(a_smooth_part_comes_back_as_it_was_packed) {
    ENDS_BY(arena_release) Arena arena = arena_reserve((size_t)64 << 20);
    uint8_t term[4] = {0, 1, 3, 8};
    float step[5] = {1e-3f, 2e-3f, 0.01f, 0.05f, 0.1f};
    float numbers[4 * 5 * PANEL_SPLINE_NUMBERS];
    uint32_t random = 3;
    for (int i = 0; i < 4 * 5 * PANEL_SPLINE_NUMBERS; i++)
        numbers[i] = (float)(2 * steady_random(&random) - 1);
    const void *bytes;
    PanelSplineNumbers all = {term, 4, 5, numbers, step};
    size_t used, size = panel_spline_pack(&all, &arena, &bytes);
    PanelSpline exact, stored;
    panel_spline_expand(term, 4, 5, numbers, &arena, &exact);
    assert_true(panel_spline_open(bytes, size, 5, &arena, &stored, &used));
    assert_int_equal(used, size);
    for (int i = 0; i < 300; i++) {
        float a[8] = {0}, b[8] = {0};
        Vec3 d = direction_deg(0.29 * i, 13.0 * i);
        panel_components_add_spline(&exact, d, logf(d.z), a);
        panel_components_add_spline(&stored, d, logf(d.z), b);
        for (int k = 0; k < 5; k++) assert_near(a[k], b[k], (double)step[k] * (4 + 4 * 4.5));
    }
    for (size_t cut = 0; cut < size; cut++)
        assert_false(panel_spline_open(bytes, cut, 5, &arena, &stored, &used) && used == size);
}

TEST_PROGRAM(start_all, end_all)
