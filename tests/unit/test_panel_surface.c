/* SPDX-License-Identifier: Apache-2.0 */
/* Surfaces whose lobe does not turn with the light, and what lies beyond the last measured
 * incidence: fitted from closed forms of facets (GGX), evaluated where nothing was measured. */
#include "reflection_fixture.h"
#include "panel/query/panel_opened.h"
#include "panel/query/panel_sampling.h"

/* Of the facets of the fit at hand: GGX alphas along x and y, index. */
static struct {
    double along, across, index;
} facets;

static double lambda(const double d[3]) {
    double x = d[0] * facets.along, y = d[1] * facets.across;
    return 0.5 * (sqrt(1 + (x * x + y * y) / (d[2] * d[2])) - 1);
}

/* Walter et al. 2007 with Heitz's height-correlated masking. */
static double facet_brdf(const double i[3], const double o[3]) {
    double z = i[2] + o[2], x = (i[0] + o[0]) / z, y = (i[1] + o[1]) / z;
    double bent =
        1 + x * x / (facets.along * facets.along) + y * y / (facets.across * facets.across);
    double square = (1 + x * x + y * y) * (1 + x * x + y * y);
    double d = square / (PI * facets.along * facets.across * bent * bent);
    double half = sqrt(0.5 * (1 + i[0] * o[0] + i[1] * o[1] + i[2] * o[2]));
    return fresnel_unpolarised_d(fmin(1, half), facets.index) * d / (1 + lambda(i) + lambda(o)) /
           (4 * i[2] * o[2]);
}

static double ggx(double theta_i, double phi_i, double theta, double phi, double nm) {
    double at = phi + phi_i - PI;
    double i[3] = {sin(theta_i) * cos(phi_i), sin(theta_i) * sin(phi_i), cos(theta_i)};
    double o[3] = {sin(theta) * cos(at), sin(theta) * sin(at), cos(theta)};
    (void)nm;
    return facet_brdf(i, o);
}

static Fitted fit_facets(double along, double across, double index, const Tables *tables) {
    Fitted f;
    FitOptions options = fit_options_default();
    options.threads = 2;
    options.level = 6;
    facets.along = along, facets.across = across, facets.index = index;
    fit_tables(&f, *tables, &options);
    return f;
}

static Fitted brushed; /* of BRUSHED, GGX alphas 0.16 x 0.04 */

/* ---- anisotropic ------------------------------------------------------------------------- */

typedef struct Errors {
    double near, far; /* rms */
    double worst;
} Errors;

#define NEAR_DEG 10

/* Of random leaving directions to 80 degrees, half of them within NEAR_DEG of the mirror. */
static Errors random_errors(const Fitted *f, double theta_deg, double phi_deg, uint32_t *random) {
    Errors e = {0, 0, 0};
    Wavelengths w = even_wavelengths(400, 20);
    Vec3 light = direction_deg(theta_deg, phi_deg);
    int count[2] = {0, 0};
    for (int k = 0; k < 400; k++) {
        double t = degrees_from_radians(acos(1 - steady_random(random) * 0.826));
        double p = 360 * steady_random(random);
        if (k % 2) {
            t = theta_deg + 1.4 * NEAR_DEG * (steady_random(random) - 0.5);
            p = phi_deg + 180 +
                1.4 * NEAR_DEG * (steady_random(random) - 0.5) / sin(theta_deg * PI / 180);
        }
        Vec3 mirror = vec3(-light.x, -light.y, light.z), eye = direction_deg(t, p);
        bool is_far = (double)vec3_dot(mirror, eye) < cos(NEAR_DEG * PI / 180);
        if (t < 0 || t > 80) continue;
        double truth = f->tables.surface(theta_deg * PI / 180, phi_deg * PI / 180, t * PI / 180,
                                         (p - phi_deg + 180) * PI / 180, 550);
        double error = (double)panel_brdf(f->fit.panel, eye, light, &w)[0] / truth - 1;
        if (is_far) e.far += error * error;
        else e.near += error * error;
        e.worst = fmax(e.worst, fabs(error));
        count[is_far]++;
    }
    e.near = sqrt(e.near / count[0]);
    e.far = sqrt(e.far / count[1]);
    return e;
}

static const Tables BRUSHED = {.incidence_deg = {35, 50},
                               .incidences = 2,
                               .azimuths = 16,
                               .wavelengths = 1,
                               .theta_step = 2,
                               .phi_step = 2.5,
                               .theta_max = 84,
                               .surface = ggx};

static void expect_near(double found, double most, const char *what, double theta, double phi) {
    if (!(found <= most))
        fail_msg("%s, light at %g, %g degrees: %.4f, at most %g", what, theta, phi, found, most);
}

/* Half way between measured azimuths, at and between incidences: rms within 3 % around the
 * mirror direction and 5 % elsewhere. */
TEST(a_brushed_lobe_is_told_between_azimuths_and_incidences) {
    uint32_t random = 5;
    Errors most = {0, 0, 0};
    for (double theta = 35; theta <= 50; theta += 7.5)
        for (double phi = 11.25; phi < 360; phi += 45) {
            Errors e = random_errors(&brushed, theta, phi, &random);
            expect_near(e.near, 0.03, "near the mirror direction", theta, phi);
            expect_near(e.far, 0.05, "elsewhere", theta, phi);
            most =
                (Errors){fmax(most.near, e.near), fmax(most.far, e.far), fmax(most.worst, e.worst)};
        }
    print_message("rms %.4f near the mirror direction, %.4f elsewhere; worst %.4f; %zu bytes\n",
                  most.near, most.far, most.worst, brushed.fit.panel->size);
}

TEST(its_axes_and_its_frame_are_reported) {
    const json_t *r = json_object_get(brushed.fit.report, "reflection");
    assert_string_equal(json_text_at(r, "frame"), "slopes");
    assert_string_equal(json_text_at(r, "beyond"), "facets");
    assert_close(json_number_at(r, "facet_alpha/0"), 0.16, 0.03);
    assert_close(json_number_at(r, "facet_alpha/1"), 0.04, 0.03);
    assert_close(json_number_at(r, "facet_index"), 1.5, 0.02);
}

/* Both directions exchanged; also through the normal, where azimuths jump. */
TEST(it_stays_reciprocal_and_has_no_seam_at_the_normal) {
    Wavelengths w = even_wavelengths(400, 20);
    for (double phi = 0; phi < 360; phi += 24) {
        Vec3 a = direction_deg(40, phi), b = direction_deg(47, phi + 170);
        double there = (double)panel_brdf(brushed.fit.panel, a, b, &w)[0];
        double back = (double)panel_brdf(brushed.fit.panel, b, a, &w)[0];
        assert_close(back, there, 0.05);
        there = (double)panel_brdf(brushed.fit.panel, a, direction_deg(0.02, phi), &w)[0];
        back = (double)panel_brdf(brushed.fit.panel, a, direction_deg(0.02, phi + 180), &w)[0];
        assert_close(back, there, 0.01);
    }
}

/* f cos / pdf of drawn directions: the albedo of the closed form, little spread, and never more
 * than the light. */
TEST(its_samples_average_to_the_albedo) {
    Wavelengths w = even_wavelengths(400, 20);
    uint32_t random = 9;
    for (double theta = 5; theta < 50; theta += 14) {
        double sum = 0, squares = 0, albedo = 0;
        Vec3 wo = direction_deg(theta, 3 * theta);
        int draws = 4000;
        for (int i = 0; i < draws; i++) {
            float u[3], pdf;
            Vec3 wi;
            for (int j = 0; j < 3; j++) u[j] = (float)steady_random(&random);
            if (!panel_sample(brushed.fit.panel, wo, u, &wi, &pdf)) continue;
            assert_close(panel_pdf(brushed.fit.panel, wo, wi), pdf, 0.01);
            double weight = (double)(panel_brdf(brushed.fit.panel, wo, wi, &w)[0] * wi.z / pdf);
            sum += weight;
            squares += weight * weight;
        }
        for (double t = 0.25; t < 90; t += 0.5)
            for (double p = 0.5; p < 360; p++)
                albedo += (double)panel_brdf(brushed.fit.panel, wo, direction_deg(t, p), &w)[0] *
                          sin(t * PI / 90) * 0.5 * (0.5 * PI / 180) * (PI / 180);
        double mean = sum / draws, variance = squares / draws / (mean * mean) - 1;
        print_message("%g degrees: weights vary %.4f; albedo %.4f\n", theta, variance, albedo);
        assert_close(mean, albedo, 0.005 + 5 * sqrt(variance / draws));
        expect_near(variance, 0.1, "variance of the weights", theta, 3 * theta);
        expect_near(mean, 1.001, "furnace", theta, 3 * theta);
    }
}

/* At grazing light no side sends back more than it gets. */
TEST(it_goes_on_without_making_light) {
    Wavelengths w = even_wavelengths(400, 20);
    for (double theta = 60; theta < 89; theta += 14)
        for (double phi = 0; phi < 180; phi += 45) {
            Vec3 light = direction_deg(theta, phi);
            double sum = 0;
            for (double t = 0.5; t < 90; t++)
                for (double p = 0.5; p < 360; p++)
                    sum +=
                        (double)panel_brdf(brushed.fit.panel, direction_deg(t, p), light, &w)[0] *
                        sin(t * PI / 90) * 0.5 * (PI / 180) * (PI / 180);
            expect_near(sum, 1, "albedo", theta, phi);
        }
}

/* ---- beyond the last incidence ----------------------------------------------------------- */

static const Tables ROUGH = {.incidence_deg = {5, 20, 35, 50, 65},
                             .incidences = 5,
                             .azimuths = 1,
                             .wavelengths = 1,
                             .theta_step = 1,
                             .phi_step = 4,
                             .theta_max = 84,
                             .surface = ggx};

/* Relative error at an eye so far off the mirror direction. */
static double error_off(const Fitted *f, double incidence, double off_theta, double off_phi) {
    Wavelengths w = even_wavelengths(400, 20);
    double at = radians_from_degrees(incidence + off_theta);
    double truth = f->tables.surface(radians_from_degrees(incidence), PI, at,
                                     radians_from_degrees(off_phi), 550);
    return (double)panel_brdf(f->fit.panel, direction_deg(incidence + off_theta, off_phi),
                              direction_deg(incidence, 180), &w)[0] /
               truth -
           1;
}

/* Peak, 3 degrees inside and outside of it and aside. */
TEST(rough_dielectrics_go_on_to_85_degrees) {
    static const double cases[][2] = {{0.05, 1.5}, {0.3, 1.4}};
    static const double off[][2] = {{0, 0}, {-3, 0}, {3, 0}, {0, 1.5}};
    for (int c = 0; c < 2; c++) {
        Fitted f = fit_facets(cases[c][0], cases[c][0], cases[c][1], &ROUGH);
        for (double i = 66; i <= 85.5; i += 4.75) {
            double worst = 0;
            for (int k = 0; k < 4; k++)
                worst = fmax(worst, fabs(error_off(&f, i, off[k][0], off[k][1])));
            print_message("alpha %g, index %g, light at %g: peak %+.4f, worst %.4f\n", cases[c][0],
                          cases[c][1], i, error_off(&f, i, 0, 0), worst);
            expect_near(worst, 0.05, "extrapolated", i, 180);
        }
        fixture_end(&f.fit);
    }
}

/* Fine roughness of narrow haze depends on direction cosines instead, and is told apart. */
static double narrow(double theta_i, double phi_i, double theta, double phi, double nm) {
    double si = sin(theta_i), so = sin(theta), sp = sin(0.5 * phi), w = 0.03;
    double b2 = (so - si) * (so - si) + 4 * so * si * sp * sp;
    (void)phi_i, (void)nm;
    return 0.3 * sqrt(fresnel(cos(theta_i)) * fresnel(cos(theta))) * pow(1 + b2 / (w * w), -1.6) /
               (w * w) +
           0.0004;
}

/* Where the directions exchanged are read, the cubic between two incidences counts too. */
TEST(tails_of_narrow_haze_go_on) {
    Tables tables = ROUGH;
    tables.surface = narrow;
    ENDS_BY(fitted_end) Fitted f;
    FitOptions options = fit_options_default();
    options.threads = 2;
    fit_tables(&f, tables, &options);
    for (double i = 66; i <= 85.5; i += 4.75)
        for (double off = -25; off <= 4; off += 1)
            expect_near(fabs(error_off(&f, i, off, 0)), 0.035, "tails", i, off);
}

/* The image of a bare face as wide as the instrument, and a lambertian part. */
static double smooth(double theta_i, double phi_i, double theta, double phi, double nm) {
    double dt = sin(0.5 * (theta - theta_i)), dp = sin(0.5 * phi);
    double angle = 2 * asin(sqrt(dt * dt + sin(theta) * sin(theta_i) * dp * dp));
    double sigma = radians_from_degrees(3) / sqrt(8 * log(2));
    (void)phi_i, (void)nm;
    return fresnel_unpolarised_d(cos(theta_i), facets.index) / cos(theta_i) *
               exp(-0.5 * angle * angle / (sigma * sigma)) / (2 * PI * sigma * sigma) +
           0.002;
}

TEST(smooth_dielectrics_go_on_by_their_own_index) {
    static const double indices[] = {1.33, 1.5, 1.75};
    Wavelengths w = even_wavelengths(400, 20);
    for (int k = 0; k < 3; k++) {
        Tables tables = ROUGH;
        FitOptions options = quick();
        ENDS_BY(fitted_end) Fitted f;
        tables.surface = smooth, tables.instrument_fwhm_deg = 3;
        facets.index = indices[k];
        fit_tables(&f, tables, &options);
        for (double i = 66; i <= 85.5; i += 4.75) {
            double c = cos(radians_from_degrees(i));
            double truth = fresnel_unpolarised_d(c, indices[k]);
            double error = (double)panel_mirror(f.fit.panel, (float)c, &w)[0] / truth - 1;
            print_message("index %g, light at %g: mirror %+.4f\n", indices[k], i, error);
            expect_near(fabs(error), 0.05, "mirror", i, 180);
        }
    }
}

static int start(void **state) {
    *state = &brushed.fit;
    brushed = fit_facets(0.16, 0.04, 1.5, &BRUSHED);
    return 0;
}

TEST_PROGRAM(start, fixture_group_end)
