/* SPDX-License-Identifier: Apache-2.0 */
/* What a fitted panel says against the closed truth that its tables were made of. */
#include "panel_fixture.h"

#include "panel/query/panel_emission.h"
#include "panel/query/panel_file.h"
#include "panel/query/panel_opened.h"
#include "panel/query/panel_report.h"
#include "panel/query/panel_sampling.h"
#include "panel/query/panel_stated.h"
#include "spectrum/spectral_table.h"

static Fixture ips;

static int start_ips(void **state) {
    (void)state;
    FitOptions options = fit_options_default();
    options.threads = 2;
    *state = &ips;
    fixture_start(&ips, FIXTURE_IPS, &options);
    return 0;
}

static json_t *table_of(const char *name) {
    size_t i;
    json_t *table;
    json_array_foreach(json_object_get(ips.report, "tables"), i,
                       table) if (!strcmp(json_text_at(table, "name"), name)) return table;
    fail_msg("no table '%s' in the report", name);
    return NULL;
}

/* Largest error at a table's own rows, in the report's terms. */
static double error_at_samples(const AngleTable *table, const float rgb[3]) {
    double worst = 0, most = 0;
    for (int i = 0; i < 3 * table->rows; i += 3)
        most = fmax(most, (double)(table->value[i] + table->value[i + 1] + table->value[i + 2]));
    for (int i = 0; i < table->rows; i++) {
        const float *m = table->value + 3 * i;
        float xyz[3];
        Vec3 d = direction_deg(degrees_from_radians((double)table->theta[i]),
                               degrees_from_radians((double)table->phi[i]));
        panel_emission_xyz(ips.panel, d, rgb, xyz);
        double scale = fmax(0.01 * most, (double)(m[0] + m[1] + m[2]));
        for (int j = 0; j < 3; j++) worst = fmax(worst, fabs((double)(xyz[j] - m[j])) / scale);
    }
    return worst;
}

TEST(a_fit_stays_within_its_printed_error_at_the_samples) {
    for (int p = 0; p < 3; p++)
        for (int i = 0; i < ips.set->primary[p].level_count; i++) {
            const AngleTable *table = &ips.set->primary[p].table[i];
            float rgb[3] = {0, 0, 0};
            rgb[p] = (float)ips.set->primary[p].level[i];
            double printed = json_number_at(table_of(table->name), "max_error");
            double found = error_at_samples(table, rgb);
            if (!(found <= printed * 1.001 + 1e-6) || !(printed < 0.03))
                fail_msg("%s: printed %g, found %g", table->name, printed, found);
        }
}

TEST(emission_follows_the_truth_between_samples_and_levels) {
    uint32_t random = 1;
    for (int i = 0; i < 4000; i++) {
        double theta = 84 * steady_random(&random), phi = 360 * steady_random(&random);
        float rgb[3], xyz[3];
        double truth[3];
        for (int p = 0; p < 3; p++) rgb[p] = (float)(255 * steady_random(&random));
        true_xyz_deg(&ips.recipe, theta, phi, rgb, truth);
        assert_true(panel_emission_xyz(ips.panel, direction_deg(theta, phi), rgb, xyz));
        double bound = theta < 70 ? 0.006 : 0.03;
        if (!(fabs((double)xyz[1] - truth[1]) <= bound * truth[1]) ||
            !(chromaticity_distance(truth, xyz) < 0.001))
            fail_msg("theta %g phi %g rgb %g %g %g: Y %g, truth %g; u'v' off by %g", theta, phi,
                     (double)rgb[0], (double)rgb[1], (double)rgb[2], (double)xyz[1], truth[1],
                     chromaticity_distance(truth, xyz));
    }
}

TEST(black_is_counted_once) {
    for (int i = 0; i < 8; i++) {
        Vec3 d = direction_deg(10.0 * i, 33.0 * i);
        float black[3], white[3], one[3], dark[3] = {0, 0, 0}, rgb[3] = {200, 130, 60};
        double truth[3];
        true_xyz_deg(&ips.recipe, 10.0 * i, 33.0 * i, dark, truth);
        panel_emission_xyz(ips.panel, d, dark, black);
        panel_emission_xyz(ips.panel, d, rgb, white);
        assert_close(black[1], truth[1], 0.01);
        double sum = (double)black[1];
        for (int p = 0; p < 3; p++) {
            float lone[3] = {0, 0, 0};
            lone[p] = rgb[p];
            panel_emission_xyz(ips.panel, d, lone, one);
            sum += (double)(one[1] - black[1]);
        }
        assert_close(white[1], sum, 1e-5);
    }
}

TEST(more_code_is_more_light) {
    for (int p = 0; p < 3; p++)
        for (int a = 0; a < 6; a++) {
            float before[3] = {0, 0, 0}, rgb[3] = {0, 0, 0};
            Vec3 d = direction_deg(17.0 * a, 61.0 * a);
            panel_emission_xyz(ips.panel, d, rgb, before);
            for (int code = 1; code <= 510; code++) {
                float xyz[3];
                rgb[p] = 0.5f * (float)code;
                panel_emission_xyz(ips.panel, d, rgb, xyz);
                if (!(xyz[1] >= before[1]))
                    fail_msg("primary %d, code %g: %g after %g", p, (double)rgb[p], (double)xyz[1],
                             (double)before[1]);
                before[1] = xyz[1];
            }
        }
}

TEST(the_lowest_code_adds_next_to_nothing) {
    float black[3], xyz[3], dark[3] = {0, 0, 0}, faint[3] = {0.01f, 0.01f, 0.01f};
    panel_emission_xyz(ips.panel, direction_deg(20, 0), dark, black);
    panel_emission_xyz(ips.panel, direction_deg(20, 0), faint, xyz);
    assert_true(xyz[1] >= black[1]);
    assert_near(xyz[1], black[1], 1e-4);
}

TEST(below_the_surface_nothing_is_emitted) {
    float xyz[3], rgb[3] = {255, 255, 255};
    assert_false(panel_emission_xyz(ips.panel, vec3(0.6f, 0, -0.8f), rgb, xyz));
    assert_true(xyz[0] == 0 && xyz[1] == 0 && xyz[2] == 0);
    Wavelengths w = even_wavelengths(400, 20);
    assert_true(spectrum_is_zero(panel_brdf(ips.panel, vec3(0, 0.6f, -0.8f), vec3(0, 0, 1), &w)));
    assert_true(panel_pdf(ips.panel, vec3(0, 0, 1), vec3(0, 0.6f, -0.8f)) == 0);
}

TEST(beyond_the_cone_is_flagged_and_falls) {
    float rgb[3] = {255, 255, 255}, inside[3], outside[3];
    assert_true(panel_emission_xyz(ips.panel, direction_deg(87.9, 10), rgb, inside));
    assert_false(panel_emission_xyz(ips.panel, direction_deg(89.5, 10), rgb, outside));
    assert_true(outside[1] >= 0 && outside[1] < inside[1]);
}

TEST(mean_luminance_is_the_cosine_mean) {
    float rgb[3] = {255, 127, 40};
    double sum = 0;
    for (int t = 0; t < 90; t++)
        for (int p = 0; p < 90; p++) {
            float xyz[3];
            panel_emission_xyz(ips.panel, direction_deg(t + 0.5, 4 * p + 2), rgb, xyz);
            sum += (double)xyz[1] * sin(2 * radians_from_degrees(t + 0.5)) / 90 * PI / 180;
        }
    assert_close(panel_mean_luminance(ips.panel, rgb), sum, 0.003);
}

/* Integral of radiance times the observer, exact for what is linear between whole nm. */
static void integrate_spectrum(Vec3 d, const float rgb[3], double xyz[3], float *least) {
    xyz[0] = xyz[1] = xyz[2] = 0;
    for (int first = 0; first <= 940; first += SPECTRUM_LANES) {
        Wavelengths w = even_wavelengths(360 + 0.5f * (float)first, 0.5f);
        Spectrum s = panel_emission_spectrum(ips.panel, d, rgb, &w);
        for (int i = 0; i < SPECTRUM_LANES && first + i <= 940; i++) {
            int h = first + i, n = h / 2;
            double weight = (h % 2 ? 4 : h && h < 940 ? 2 : 1) / 6.0 * LUMINOUS_EFFICACY_MAX;
            const SpectralRow *a = &spectral_table[n], *b = h % 2 ? a + 1 : a;
            *least = fminf(*least, s[i]);
            xyz[0] += weight * (double)s[i] * 0.5 * (double)(a->x + b->x);
            xyz[1] += weight * (double)s[i] * 0.5 * (double)(a->y + b->y);
            xyz[2] += weight * (double)s[i] * 0.5 * (double)(a->z + b->z);
        }
    }
}

TEST(spectra_integrate_to_the_measured_colour) {
    static const float pixels[][3] = {{255, 0, 0},     {0, 255, 0}, {0, 0, 255},
                                      {255, 255, 255}, {0, 0, 0},   {100, 180, 30}};
    for (int i = 0; i < 6; i++)
        for (int a = 0; a < 5; a++) {
            Vec3 d = direction_deg(16.0 * a, 77.0 * a);
            float xyz[3], least = 1;
            double found[3];
            panel_emission_xyz(ips.panel, d, pixels[i], xyz);
            integrate_spectrum(d, pixels[i], found, &least);
            double size = fmax((double)xyz[0], fmax((double)xyz[1], (double)xyz[2]));
            for (int j = 0; j < 3; j++)
                if (!(fabs(found[j] - (double)xyz[j]) <= 1e-4 * size))
                    fail_msg("pixel %d, direction %d, component %d: %g, required: %g", i, a, j,
                             found[j], (double)xyz[j]);
            assert_true(least >= 0);
        }
}

/* ---- reflection ------------------------------------------------------------------------ */

static double true_brdf(double incidence_deg, double theta_deg, double phi_deg, double nm) {
    return closed_form_brdf(&ips.recipe, radians_from_degrees(incidence_deg),
                            radians_from_degrees(theta_deg), radians_from_degrees(phi_deg), nm);
}

TEST(the_peak_stands_at_the_mirror_direction_and_has_no_ghosts) {
    Wavelengths w = even_wavelengths(420, 15);
    for (int incidence = 5; incidence <= 60; incidence += 5) {
        float before = 0, best = 0;
        double best_at = 0, truth_best = 0, truth_at = 0;
        int turns = 0, rising = 1;
        for (int t = -300; t <= 340; t++) {
            double theta = 0.25 * t;
            Spectrum f = panel_brdf(ips.panel, direction_deg(fabs(theta), theta < 0 ? 180 : 0),
                                    direction_deg(incidence, 180), &w);
            double truth = true_brdf(incidence, fabs(theta), theta < 0 ? 180 : 0, (double)w.nm[7]);
            if (truth > truth_best) truth_best = truth, truth_at = theta;
            if (f[7] > best) best = f[7], best_at = theta;
            bool is_falling = f[7]<before * 0.995f, is_rising = f[7]> before * 1.005f;
            if (rising && is_falling) turns++, rising = 0;
            else if (is_rising && f[7] > 0.1f * best) rising = 1;
            before = f[7];
        }
        if (turns != 1 || !(fabs(best_at - truth_at) <= 0.8) ||
            !(fabs((double)best / truth_best - 1) < 0.03))
            fail_msg("incidence %d: %d peaks, the highest %g at %g, required: %g at "
                     "%g",
                     incidence, turns, (double)best, best_at, truth_best, truth_at);
    }
}

TEST(reflection_follows_the_truth_between_incidences) {
    Wavelengths w = even_wavelengths(420, 15);
    for (int incidence = 5; incidence <= 60; incidence += 5) {
        double miss = 0, all = 0;
        for (int t = 0; t < 85; t++)
            for (int p = 0; p < 60; p++) {
                Spectrum f = panel_brdf(ips.panel, direction_deg(t + 0.3, 6 * p),
                                        direction_deg(incidence, 180), &w);
                double weight = sin(2 * radians_from_degrees(t + 0.3));
                for (int i = 0; i < SPECTRUM_LANES; i += 5) {
                    double truth = true_brdf(incidence, t + 0.3, 6 * p, (double)w.nm[i]);
                    miss += weight * ((double)f[i] - truth) * ((double)f[i] - truth);
                    all += weight * truth * truth;
                }
            }
        if (!(sqrt(miss / all) < 0.03))
            fail_msg("incidence %d: L2 error %g", incidence, sqrt(miss / all));
    }
}

TEST(only_the_difference_of_azimuths_counts) {
    Wavelengths w = even_wavelengths(420, 15);
    for (int turn = 0; turn < 360; turn += 45)
        assert_turns(ips.panel, (double[]){36, 15}, 33, turn, &w, 3);
}

TEST(the_mirror_part_is_told_from_the_haze) {
    Wavelengths w = even_wavelengths(420, 15);
    for (int incidence = 0; incidence <= 60; incidence += 5) {
        double theta = radians_from_degrees(incidence);
        Spectrum r = panel_mirror(ips.panel, (float)cos(theta), &w);
        for (int i = 0; i < SPECTRUM_LANES; i += 5)
            assert_close(r[i], closed_form_mirror(&ips.recipe, theta, (double)w.nm[i]), 0.06);
    }
}

TEST(the_reciprocity_defect_is_reported_and_small) {
    assert_true(json_number_at(ips.report, "reflection/reciprocity_defect") < 0.04);
}

TEST(no_more_comes_back_than_falls_in) {
    Wavelengths w = even_wavelengths(400, 20);
    for (int incidence = 0; incidence <= 89; incidence += 4) {
        Spectrum sum = panel_mirror(ips.panel, (float)cos(radians_from_degrees(incidence)), &w);
        for (int t = 0; t < 180; t++)
            for (int p = 0; p < 90; p++) {
                double theta = radians_from_degrees(0.5 * t + 0.25);
                Spectrum f = panel_brdf(ips.panel, direction_deg(0.5 * t + 0.25, 2 * p + 1),
                                        direction_deg(incidence, 180), &w);
                sum += f * spectrum_all((float)(sin(2 * theta) * 0.5 * PI / 360 * 2 * PI / 90));
            }
        if (!(spectrum_max_lane(sum) <= 1.001f))
            fail_msg("incidence %d: albedo %g", incidence, (double)spectrum_max_lane(sum));
        float cosine = (float)cos(radians_from_degrees(incidence));
        assert_true(panel_haze_albedo(ips.panel, cosine) <= 1);
    }
}

TEST(the_report_has_what_scripts_rely_on) {
    static const char *const keys[] = {
        "name",      "source_bytes_text", "source_bytes_float32", "stored_values", "bytes", "ratio",
        "max_error", "rms_error",         "integral_error",       "noise"};
    json_auto_t *report;
    assert_done(panel_report(ips.panel, &report, &err));
    assert_int_equal(json_array_size(json_object_get(report, "tables")), 31);
    for (size_t i = 0; i < sizeof keys / sizeof *keys; i++) {
        assert_non_null(json_object_get(json_at(report, "tables/0"), keys[i]));
        assert_non_null(json_object_get(json_object_get(report, "total"), keys[i]));
    }
}

TEST(a_fit_gives_the_same_bytes_again) {
    FitOptions options = fit_options_default();
    json_auto_t *report;
    const char *path = fixture_path(&ips, "again.panel");
    assert_done(panel_fit(ips.set, &options, path, &ips.arena, &report, &err));
    FileBytes before = read_bytes(ips.panel_path, &ips.arena);
    FileBytes after = read_bytes(path, &ips.arena);
    assert_int_equal(before.size, after.size);
    assert_memory_equal(before.data, after.data, before.size);
}

/* ---- other panels ---------------------------------------------------------------------- */

TEST(a_lobe_at_phi_90_is_seen_from_above) {
    ENDS_BY(fixture_end) Fixture lobe;
    fixture_start(&lobe,
                  "{\"panel\": \"lobe\", \"emission\": {" FIXTURE_SPECTRA
                  "\"lobe\": {\"theta_deg\": 40, \"phi_deg\": 90, \"width_deg\": 12,"
                  "\"gain\": 4}},"
                  "\"instrument\": {\"theta_step_deg\": 3, \"phi_step_deg\": 6}}",
                  NULL);
    float rgb[3] = {255, 255, 255}, up[3], right[3], down[3], left[3];
    float up_by_hand = 0.6427876f; /* sin 40 degrees: +y is up, +x the viewer's right */
    panel_emission_xyz(lobe.panel, vec3(0, up_by_hand, 0.7660444f), rgb, up);
    panel_emission_xyz(lobe.panel, vec3(up_by_hand, 0, 0.7660444f), rgb, right);
    panel_emission_xyz(lobe.panel, vec3(0, -up_by_hand, 0.7660444f), rgb, down);
    panel_emission_xyz(lobe.panel, vec3(-up_by_hand, 0, 0.7660444f), rgb, left);
    assert_close(up[1], 5 * down[1], 0.02);
    assert_close(right[1], left[1], 0.01);
    assert_true(up[1] > 4 * right[1]);
    assert_false(panel_reflects(lobe.panel));
}

TEST(a_true_black_stays_black) {
    ENDS_BY(fixture_end) Fixture oled;
    fixture_start(&oled,
                  "{\"panel\": \"oled\", \"emission\": {" FIXTURE_SPECTRA
                  "\"black_cd_m2\": 0}, \"instrument\": {\"theta_step_deg\": 3,"
                  "\"phi_step_deg\": 6, \"noise_cd_m2\": 0.0005, \"noise_relative\": 0.001}}",
                  NULL);
    float black[3], dark[3] = {0, 0, 0}, rgb[3] = {0, 200, 0}, xyz[3];
    panel_emission_xyz(oled.panel, direction_deg(30, 40), dark, black);
    panel_emission_xyz(oled.panel, direction_deg(30, 40), rgb, xyz);
    assert_true(black[1] == 0);
    double truth[3];
    true_xyz_deg(&oled.recipe, 30, 40, rgb, truth);
    assert_close(xyz[1], truth[1], 0.005);
}

TEST(a_white_only_table_of_two_sections_becomes_a_panel) {
    static const struct {
        double theta, phi, y;
    } seen[] = {
        {0, 0, 848.3}, {20, 0, 881.34}, {45, 0, 510.18}, {50, 180, 375.96}, {20, 90, 552.28}};
    const char *path = SHARED_DATA_DIR "/display/viewing_angle_oled_phi0_90.csv";
    if (!file_exists(path)) skip();
    ENDS_BY(fixture_end) Fixture real;
    fixture_folder(&real);
    fixture_read(&real, path);
    fixture_fit(&real, NULL);
    for (int i = 0; i < 5; i++) {
        float rgb[3] = {255, 255, 255}, xyz[3];
        panel_emission_xyz(real.panel, direction_deg(seen[i].theta, seen[i].phi), rgb, xyz);
        assert_close(xyz[1], seen[i].y, 0.01);
    }
    float rgb[3] = {128, 128, 128}, xyz[3];
    panel_emission_xyz(real.panel, direction_deg(0, 0), rgb, xyz);
    assert_close(xyz[1], 848.3 * pow(128.0 / 255, 2.2), 0.005);
    assert_true(json_array_size(json_object_get(real.report, "notes")) >= 2);
}

/* A table alone may be any pattern's: colours that no three Rec.709 amounts make come back as
 * they were measured, mostly from the primary next to them. */
TEST(a_lone_table_keeps_a_colour_outside_of_rec_709) {
    ENDS_BY(fixture_end) Fixture red;
    fixture_folder(&red);
    char *text = arena_alloc(&red.arena, 1, 1, 1 << 16), *at = text;
    at += sprintf(at, "theta,phi,X,Y,Z\n");
    for (int t = 0; t <= 80; t += 10)
        for (int p = 0; p < (t ? 360 : 1); p += 30)
            at += sprintf(at, "%d,%d,%g,%g,%g\n", t, p, 233.0 - t, 100 - 0.5 * t, 0.3 + 0.01 * t);
    fixture_read(&red, fixture_file(&red, "red.csv", text));
    fixture_fit(&red, NULL);
    for (int t = 0; t <= 80; t += 10) {
        float full[3] = {255, 255, 255}, first[3] = {255, 0, 0}, xyz[3], alone[3];
        panel_emission_xyz(red.panel, direction_deg(t, 60), full, xyz);
        panel_emission_xyz(red.panel, direction_deg(t, 60), first, alone);
        assert_close((double)xyz[0], 233 - t, 0.004);
        assert_close((double)xyz[1], 100 - 0.5 * t, 0.004);
        assert_close((double)xyz[2], 0.3 + 0.01 * t, 0.004);
        assert_true(alone[1] > 0.9f * xyz[1]);
    }
    char *report = json_dumps(red.report, 0);
    assert_non_null(strstr(report, "the primaries share the table's own colour"));
    free(report);
}

static void check_shipped(const char *name) {
    SyntheticPanel recipe;
    Panel *panel;
    ENDS_BY(arena_release) Arena arena = arena_reserve((size_t)1 << 30);
    uint32_t random = 9;
    char path[512], recipe_path[512];
    snprintf(path, sizeof path, PROJECT_DIR "/assets/panels/%s.panel", name);
    snprintf(recipe_path, sizeof recipe_path, PROJECT_DIR "/assets/panels/%s.recipe.json", name);
    assert_done(synthetic_panel_read(recipe_path, &arena, &recipe, &err) &&
                panel_open(path, &arena, &panel, &err));
    Wavelengths w = even_wavelengths(420, 15);
    for (int i = 0; i < 1000; i++) {
        double theta = 75 * steady_random(&random), phi = 360 * steady_random(&random);
        double truth[3];
        float rgb[3], xyz[3];
        for (int p = 0; p < 3; p++) rgb[p] = (float)(20 + 235 * steady_random(&random));
        true_xyz_deg(&recipe, theta, phi, rgb, truth);
        panel_emission_xyz(panel, direction_deg(theta, phi), rgb, xyz);
        assert_close(xyz[1], truth[1], 0.01);
        assert_true(chromaticity_distance(truth, xyz) < 0.002);
    }
    for (int t = 0; t <= 60; t += 5) {
        Spectrum f = panel_brdf(panel, direction_deg(t, 0), direction_deg(t, 180), &w);
        double angle = radians_from_degrees(t);
        assert_close(f[7], closed_form_brdf(&recipe, angle, angle, 0, (double)w.nm[7]), 0.03);
    }
    panel_close(panel);
}

TEST(shipped_panels_say_what_their_recipes_say) {
    check_shipped("ips_cluster");
    check_shipped("oled_centre");
}

/* Of this fit: a file of an older one states none, or other figures than the guides. */
TEST(shipped_panels_state_a_verdict) {
    static const char *const names[] = {"ips_cluster", "oled_centre", "hud_pgu", "hud_pgu_p"};
    for (int i = 0; i < 4; i++) {
        ENDS_BY(arena_release) Arena arena = arena_reserve((size_t)1 << 30);
        Panel *panel;
        char path[512];
        snprintf(path, sizeof path, PROJECT_DIR "/assets/panels/%s.panel", names[i]);
        assert_done(panel_open(path, &arena, &panel, &err));
        PanelStated stated = panel_stated(panel, &arena);
        assert_non_null(stated.verdict);
        assert_false(stated.is_unusable);
        assert_true(stated.is_synthetic);
        assert_true(stated.emission_error > 0 && stated.emission_error < 0.05);
        assert_true(stated.reflection_error > 0 && stated.reflection_error < 0.05);
        panel_close(panel);
    }
}

TEST_PROGRAM(start_ips, fixture_group_end)
