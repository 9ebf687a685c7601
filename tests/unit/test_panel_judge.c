/* SPDX-License-Identifier: Apache-2.0 */
/* A fit judges itself: a good set stays good, and each kind of fault is named. The sets are
 * closed forms written as tables. */
#include "json_fixture.h"

#include "base/units.h"
#include "panel/fit/fit.h"
#include "panel/fit/fit_judge.h"
#include "panel/query/panel_emission.h"
#include "panel/query/panel_open.h"
#include "panel/query/panel_report.h"
#include "panel/set/measurement.h"

/* A white table, or a reflection: what is measured, and what went wrong. */
typedef struct Fault {
    double factor;           /* of all values */
    double noise;            /* relative, uniform */
    double gap_from, gap_to; /* degrees: azimuths in between are missing */
    double phi_step;
    double corners; /* 0: round; how much squarer than an ellipse, and how much narrower in y */
    double zeros;   /* share of rows that are 0 */
    double lobe, lobe_height; /* degrees to 1/e, about theta 30, phi 45; over the rest */
} Fault;

/* What the last fit said; its panel is x.panel in the folder. */
static struct {
    json_t *report;
    bool written;
} work;

static int end(void **state) {
    json_decref(work.report);
    return clear_folder(state);
}

/* In [-1, 1], of a row's number. */
static double shaken(int i) {
    uint32_t x = (uint32_t)i * 2654435761u;
    x ^= x >> 15, x *= 2246822519u, x ^= x >> 13;
    return (double)x / 2147483648.0 - 1;
}

/* Luminance of an OLED behind a lens: corners squeeze it in y and make its outline a
 * rectangle. */
static double luminance(const Fault *fault, double theta, double phi) {
    double t = radians_from_degrees(theta), p = radians_from_degrees(phi);
    double power = 2 + 4 * fault->corners, x = fabs(sin(t) * cos(p)) / 0.75;
    double y = fabs(sin(t) * sin(p)) / (0.75 - 0.4 * fault->corners);
    double c = cos(t) * sqrt(0.75) + 0.5 * sin(t) * cos(p - PI / 4);
    double off = fault->lobe > 0 ? acos(fmin(1, c)) / radians_from_degrees(fault->lobe) : 0;
    double lobe = fault->lobe > 0 ? fault->lobe_height * exp(-off * off) : 0;
    return 400 * exp(-pow(x, power) - pow(y, power)) * (1 + lobe) + 1;
}

static bool is_missing(const Fault *fault, double phi) {
    return phi > fault->gap_from && phi < fault->gap_to;
}

static void write_white(const Fault *fault) {
    FILE *file = fopen(in_folder("white.csv"), "w");
    int row = 0;
    assert_non_null(file);
    fprintf(file, "theta,phi,X,Y,Z\n");
    for (double theta = 0; theta < 81; theta += 5)
        for (double phi = 0; phi < 359; phi += fault->phi_step) {
            double y = fault->factor * luminance(fault, theta, phi);
            if (is_missing(fault, phi)) continue;
            y *= 1 + fault->noise * shaken(row++);
            fprintf(file, "%g,%g,%.7g,%.7g,%.7g\n", theta, phi, 0.95 * y, y, 1.09 * y);
            if (theta == 0) break;
        }
    fclose(file);
}

/* A wide haze on a lambertian part. */
static void write_brdf(const Fault *fault, double incidence) {
    char name[32];
    int row = 0;
    snprintf(name, sizeof name, "i%g.csv", incidence);
    FILE *file = fopen(in_folder(name), "w");
    assert_non_null(file);
    fprintf(file, "theta,phi,brdf\n");
    for (double theta = 0; theta < 81; theta += 5)
        for (double phi = 0; phi < 181; phi += 15) {
            double t = radians_from_degrees(theta), p = radians_from_degrees(phi);
            double x = sin(t) * cos(p) - sin(radians_from_degrees(incidence));
            double y = sin(t) * sin(p), f = 0.05 + 0.05 * exp(-(x * x + y * y) / 0.3);
            f *= fault->factor * (1 + fault->noise * shaken(row++));
            if (0.5 + 0.5 * shaken(row + 7) < fault->zeros) f = 0;
            fprintf(file, "%g,%g,%.7g\n", theta, phi, f);
            if (theta == 0) break;
        }
    fclose(file);
}

static const char WHITE[] = "{\"emission\": {\"white\": \"white.csv\"}}";
static const char REFLECTION[] =
    "{\"reflection\": {\"wavelengths_nm\": [550], \"incidence_deg\": [10, 35, 60],"
    " \"files\": \"i{incidence}.csv\"}}";

/* Fits what the fault made of a set. */
static void fit(const Fault *fault, const char *manifest, bool force) {
    Measurement *set = ARENA_NEW(test_memory(), Measurement, 1);
    FitOptions options = fit_options_default();
    const char *path = in_folder("MANIFEST.json"), *panel = in_folder("x.panel");
    options.force = force;
    json_decref(work.report);
    work.report = NULL;
    remove(panel);
    if (manifest == WHITE && fault) write_white(fault);
    else if (fault)
        for (int i = 0; i < 3; i++) write_brdf(fault, 10 + 25 * i);
    write_text(path, manifest);
    assert_done(measurement_read(path, test_memory(), set, &err));
    if (!panel_fit(set, &options, panel, test_memory(), &work.report, why()) &&
        why()->code != ERROR_UNUSABLE)
        fail_told("panel_fit", why());
    work.written = file_exists(panel);
}

static Panel *fitted_panel(void) {
    Panel *panel = NULL;
    assert_done(panel_open(in_folder("x.panel"), test_memory(), &panel, &err));
    return panel;
}

/* The grade is no better than this, and a reason says the word. */
static void expect_verdict(JudgeGrade least, JudgeGrade most, const char *word) {
    JudgeGrade grade = fit_judge_grade(work.report);
    char *all = json_dumps(json_object_get(work.report, "reasons"), 0);
    if (grade < least || grade > most || !strstr(all, word))
        fail_msg("grade %d, '%s' wanted in: %s", (int)grade, word, all);
    free(all);
}

/* The same of what a fault makes of a set. */
static void expect(const Fault *fault, const char *manifest, JudgeGrade least, JudgeGrade most,
                   const char *word) {
    fit(fault, manifest, false);
    expect_verdict(least, most, word);
}

TEST(good_sets_are_good) {
    Fault plain = {.factor = 1, .phi_step = 15};
    expect(&plain, WHITE, JUDGE_GOOD, JUDGE_GOOD, "[]");
    assert_true(work.written);
    plain.noise = 0.01;
    expect(&plain, REFLECTION, JUDGE_GOOD, JUDGE_GOOD, "[]");
}

TEST(an_emission_in_another_unit_is_named) {
    const double factors[] = {1000, 0.001, 1e6};
    for (int i = 0; i < 3; i++) {
        Fault fault = {.factor = factors[i], .phi_step = 15};
        expect(&fault, WHITE, JUDGE_CARE, JUDGE_UNUSABLE, "unit");
    }
}

TEST(a_reflection_in_another_unit_is_named) {
    const double factors[] = {1000, 0.001};
    for (int i = 0; i < 2; i++) {
        Fault fault = {.factor = factors[i]};
        expect(&fault, REFLECTION, factors[i] > 1 ? JUDGE_UNUSABLE : JUDGE_CARE, JUDGE_UNUSABLE,
               "check the unit");
    }
    Fault little = {.factor = 1};
    fit(&little, REFLECTION, false);
    little.factor = 1.15 / json_number_at(work.report, "judged/largest_albedo");
    expect(&little, REFLECTION, JUDGE_CARE, JUDGE_UNUSABLE, "albedo");
}

TEST(noise_is_named) {
    Fault fault = {.factor = 1, .phi_step = 15, .noise = 0.4};
    fit(&fault, WHITE, true);
    expect_verdict(JUDGE_CARE, JUDGE_UNUSABLE, "noise");
}

TEST(zeros_are_named) {
    Fault fault = {.factor = 1, .zeros = 0.5};
    fit(&fault, REFLECTION, true);
    expect_verdict(JUDGE_CARE, JUDGE_UNUSABLE, "zero or negative");
}

TEST(what_is_not_usable_is_not_written_unless_forced) {
    Fault fault = {.factor = 1000};
    fit(&fault, REFLECTION, false);
    assert_false(work.written);
    assert_int_equal(why()->code, ERROR_UNUSABLE);
    assert_non_null(strstr(why()->text, "--force"));
    fit(&fault, REFLECTION, true);
    assert_true(work.written);
    json_auto_t *kept = NULL;
    Panel *panel = fitted_panel();
    assert_done(panel_report(panel, &kept, &err));
    assert_string_equal(json_text_at(kept, "verdict"), "not usable");
    assert_true(
        json_equal(json_object_get(kept, "reasons"), json_object_get(work.report, "reasons")));
    panel_close(panel);
}

/* ---- azimuths ---------------------------------------------------------------------------- */

/* A white pixel's luminance in a direction, degrees. */
static double white_at(const Panel *panel, double theta, double phi) {
    double t = radians_from_degrees(theta), p = radians_from_degrees(phi);
    Vec3 d = vec3((float)(sin(t) * cos(p)), (float)(sin(t) * sin(p)), (float)cos(t));
    float xyz[3], white[3] = {255, 255, 255};
    panel_emission_xyz(panel, d, white, xyz);
    return (double)xyz[1];
}

/* The largest error of the panel in the middle of what was not measured, relative to the truth,
 * where there is light. */
static double error_between(const Fault *fault, double phi) {
    Panel *panel = fitted_panel();
    double worst = 0;
    for (double theta = 4; theta < 77; theta += 4) {
        double truth = luminance(fault, theta, phi);
        if (truth > 20) worst = fmax(worst, fabs(white_at(panel, theta, phi) / truth - 1));
    }
    panel_close(panel);
    return worst;
}

TEST(a_panel_of_two_azimuths_names_the_gap_and_its_cost) {
    const double corners[] = {0.25, 1};
    for (int i = 0; i < 2; i++) {
        Fault fault = {.factor = 1, .phi_step = 90, .corners = corners[i]};
        expect(&fault, WHITE, JUDGE_CARE, JUDGE_CARE, "azimuths");
        const json_t *judged = json_object_get(work.report, "judged");
        double cost = json_number_at(judged, "azimuth_gap_error");
        double gap = json_number_at(judged, "azimuth_gap_deg");
        double found = error_between(&fault, 45);
        assert_true(fabs(gap - 90) < 0.1);
        if (!(cost > 0.05 && cost >= 0.5 * found))
            fail_msg("cost %g stated, %g found between", cost, found);
    }
}

TEST(a_missing_sector_is_named_and_a_round_panel_does_not_need_it) {
    Fault fault = {.factor = 1, .phi_step = 15, .corners = 0.5, .gap_from = 20, .gap_to = 100};
    expect(&fault, WHITE, JUDGE_CARE, JUDGE_CARE, "between the azimuths 15 and 105 degrees");
    fault.corners = 0;
    expect(&fault, WHITE, JUDGE_GOOD, JUDGE_GOOD, "[]");
}

TEST(four_azimuths_that_agree_do_not_tell_a_pattern_of_four_lobes) {
    Fault fault = {.factor = 1, .phi_step = 90};
    expect(&fault, WHITE, JUDGE_CARE, JUDGE_CARE, "the 4 azimuths agree");
    fault.phi_step = 60;
    expect(&fault, WHITE, JUDGE_GOOD, JUDGE_GOOD, "[]");
}

/* ---- peaks ------------------------------------------------------------------------------- */

/* What is stated is two standard deviations. */
TEST(a_peak_that_one_sample_shows_is_coarse_and_one_that_several_show_is_not) {
    const double widths[] = {2, 4, 6, 25}, heights[] = {0.6, 0.8, 0.8, 0.5};
    for (int i = 0; i < 4; i++) {
        Fault fault = {.factor = 1, .phi_step = 15, .lobe = widths[i], .lobe_height = heights[i]};
        fit(&fault, WHITE, false);
        double told = json_number_at(work.report, "judged/emission_between_samples/worst");
        double worst = 0;
        Panel *panel = fitted_panel();
        for (double theta = 26; theta < 35; theta++)
            for (double phi = 36; phi < 55; phi++) {
                double truth = luminance(&fault, theta, phi);
                worst = fmax(worst, fabs(white_at(panel, theta, phi) / truth - 1));
            }
        panel_close(panel);
        if (i < 2) expect_verdict(JUDGE_CARE, JUDGE_CARE, "coarse: emission:");
        else expect_verdict(JUDGE_GOOD, JUDGE_GOOD, "[]");
        if (!(worst < told))
            fail_msg("lobe of %g degrees: %g stated, %g found", widths[i], told, worst);
    }
}

/* Luminances of lamps in a direction, degrees. */
typedef double Lamp(double theta, double phi);

static double narrow_lamp(double theta, double phi) {
    (void)phi;
    return theta < 10 ? 8e5 * exp(-pow(theta / 3, 2)) : 0;
}

static double cut_off_lamp(double theta, double phi) {
    (void)phi;
    return theta <= 65 ? 16000 : 0;
}

/* A beam around theta 40, phi 90. */
static double flood_lamp(double theta, double phi) {
    double t = radians_from_degrees(theta), c = radians_from_degrees(40);
    double cosine = cos(t) * cos(c) + sin(t) * sin(c) * sin(radians_from_degrees(phi));
    double beam = degrees_from_radians(acos(fmin(1, fmax(-1, cosine)))) / 14;
    return 3e5 * exp(-beam * beam);
}

static double batwing_lamp(double theta, double phi) {
    (void)phi;
    return 800 * (0.3 + exp(-pow((theta - 45) / 14, 2)));
}

/* A cut-off whose angle turns with the azimuth. */
static double turning_lamp(double theta, double phi) {
    return theta < 55 + 15 * cos(radians_from_degrees(phi)) ? 3000 : 0;
}

/* Light to one side only, and a flood that ends within an ellipse. */
static double half_lamp(double theta, double phi) {
    double up = sin(radians_from_degrees(phi));
    return up > 1e-9 ? 3000 * up * cos(radians_from_degrees(theta)) : 0;
}

static double ellipse_lamp(double theta, double phi) {
    double t = radians_from_degrees(theta), p = radians_from_degrees(phi);
    double x = sin(t) * cos(p) / 0.95, y = sin(t) * sin(p) / 0.6;
    return x * x + y * y < 1 ? 5000 * (1 - 0.5 * (x * x + y * y)) : 0;
}

/* The fit of a lamp with default options; steps in degrees. */
static void fit_lamp(Lamp *lamp, double step_deg, double phi_step_deg) {
    FILE *file = fopen(in_folder("white.csv"), "w");
    assert_non_null(file);
    fprintf(file, "theta,phi,X,Y,Z\n");
    for (double theta = 0; theta < 89; theta += step_deg)
        for (double phi = 0; phi < 359.9; phi += phi_step_deg) {
            double y = lamp(theta, phi);
            fprintf(file, "%g,%g,%.6g,%.6g,%.6g\n", theta, phi, 0.95 * y, y, 1.09 * y);
            if (theta == 0) break;
        }
    fclose(file);
    fit(NULL, WHITE, false);
}

/* Light that is missed between samples too, over all light: of the panel against the lamp. */
static double light_missed(Lamp *lamp) {
    Panel *panel = fitted_panel();
    double missed = 0, light = 0;
    for (double theta = 0.13; theta < 85; theta += 0.67)
        for (double phi = 0.21; phi < 360; phi += 1.7) {
            double t = radians_from_degrees(theta), truth = lamp(theta, phi);
            double weight = sin(t) * cos(t);
            missed += weight * fabs(white_at(panel, theta, phi) - truth);
            light += weight * truth;
        }
    panel_close(panel);
    return missed / light;
}

/* Errors are relative to no less than a thousandth of the largest value, so that darkness
 * beyond a beam or a cut-off cannot spoil what shines. Between samples an edge stands anywhere:
 * half an interval of theta along it is what nobody can know. */
TEST(lamps_are_fitted_with_darkness_around_them) {
    static const struct {
        const char *name;
        Lamp *lamp;
        double step, phi_step, worst, rms, missed;
    } cases[] = {{"narrow", narrow_lamp, 1, 30, 0.01, 0.005, 0.02},
                 {"cut-off", cut_off_lamp, 2.5, 30, 0.01, 0.005, 0.025},
                 {"fine cut-off", cut_off_lamp, 1, 30, 0.01, 0.005, 0.016},
                 {"turning", turning_lamp, 2.5, 10, 0.015, 0.005, 0.04},
                 {"turning, coarse", turning_lamp, 5, 22.5, 0.01, 0.005, 0.1},
                 {"half", half_lamp, 5, 15, 0.01, 0.005, 0.02},
                 {"ellipse", ellipse_lamp, 2.5, 10, 0.015, 0.005, 0.035},
                 {"flood", flood_lamp, 2.5, 30, 0.01, 0.005, 0.01},
                 {"batwing", batwing_lamp, 2.5, 30, 0.01, 0.005, 0.001}};
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        fit_lamp(cases[i].lamp, cases[i].step, cases[i].phi_step);
        if (!work.written) fail_msg("%s: %s", cases[i].name, why()->text);
        const json_t *total = json_object_get(work.report, "total");
        double worst = json_number_at(total, "max_error");
        double flux = json_number_at(total, "integral_error");
        double rms = json_number_at(total, "rms_error");
        double missed = light_missed(cases[i].lamp);
        if (!(worst < cases[i].worst) || !(rms < cases[i].rms) || !(fabs(flux) < 0.01) ||
            !(missed < cases[i].missed))
            fail_msg("%s: max %g, rms %g, flux %g, missed %g", cases[i].name, worst, rms, flux,
                     missed);
    }
}

/* Nobody measured where an edge that turns with the azimuth stands between two of them. */
TEST(edges_between_azimuths_make_a_panel_coarse) {
    fit_lamp(turning_lamp, 2.5, 22.5);
    expect_verdict(JUDGE_CARE, JUDGE_CARE, "coarse: emission:");
    assert_true(light_missed(turning_lamp) <
                json_number_at(work.report, "judged/emission_between_samples/light"));
}

TEST(the_report_says_what_decided) {
    Fault fault = {.factor = 1, .phi_step = 15};
    fit(&fault, WHITE, false);
    json_number_at(work.report, "judged/integral_error");
    json_number_at(work.report, "judged/noise");
    assert_true(json_is_object(json_at(work.report, "judged/emission")));
}

TEST_PROGRAM(make_folder, end)
