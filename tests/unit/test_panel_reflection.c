/* SPDX-License-Identifier: Apache-2.0 */
/* Laws of fitted reflections, on tables made from closed forms: no files are read. */
#include "reflection_fixture.h"

#define WAVELENGTHS 16
#define HAZY_INCIDENCES 5

/* ---- surfaces ---------------------------------------------------------------------------- */

/* Haze of the ABC form and a floor, bluer in the haze. */
static double hazy(double theta_i, double phi_i, double theta, double phi, double nm) {
    double si = sin(theta_i), so = sin(theta), sp = sin(0.5 * phi), w = 0.12;
    double b2 = (so - si) * (so - si) + 4 * so * si * sp * sp, d = (nm - 550) / 150;
    (void)phi_i;
    return (0.8 + 0.2 * d * d) * sqrt(fresnel(cos(theta_i)) * fresnel(cos(theta))) * 0.5 / w *
               pow(1 + b2 / (w * w), -1.7) +
           0.002;
}

/* The same, and the mirror's image of 3 degrees on it. */
#define LOBE_FWHM_DEG 3.0
#define LOBE_SHARE 0.3 /* of Fresnel's reflectance */
static double lobed(double theta_i, double phi_i, double theta, double phi, double nm) {
    double dt = sin(0.5 * (theta - theta_i)), dp = sin(0.5 * phi);
    double angle = 2 * asin(sqrt(dt * dt + sin(theta) * sin(theta_i) * dp * dp));
    double sigma = radians_from_degrees(LOBE_FWHM_DEG) / sqrt(8 * log(2));
    return hazy(theta_i, phi_i, theta, phi, nm) +
           LOBE_SHARE * fresnel(cos(theta_i)) / cos(theta_i) *
               exp(-0.5 * angle * angle / (sigma * sigma)) / (2 * PI * sigma * sigma);
}

/* Brushed along x: wide across it. */
static double brushed(double theta_i, double phi_i, double theta, double phi, double nm) {
    double along = phi_i - PI, si = sin(theta_i), so = sin(theta);
    double x = so * cos(phi + along) - si * cos(along), y = so * sin(phi + along) - si * sin(along);
    double b2 = x * x / (0.15 * 0.15) + y * y / (0.3 * 0.3);
    (void)nm;
    return 0.4 * sqrt(fresnel(cos(theta_i)) * fresnel(cos(theta))) * pow(1 + b2, -1.5) / 0.045 +
           0.003;
}

/* As bright as white can be. */
static double white(double theta_i, double phi_i, double theta, double phi, double nm) {
    (void)theta_i, (void)phi_i, (void)theta, (void)phi, (void)nm;
    return 1.02 / PI;
}

static const Tables HAZY = {.incidence_deg = {5, 20, 35, 50, 65},
                            .incidences = 5,
                            .azimuths = 1,
                            .wavelengths = WAVELENGTHS,
                            .theta_step = 2,
                            .phi_step = 6,
                            .theta_max = 84,
                            .surface = hazy};

/* Where it differs from HAZY, fitted with `options`; a zero keeps what HAZY has. */
typedef struct Grid {
    int incidences, azimuths, wavelengths;
    double theta_step, phi_step, theta_max; /* degrees */
    double instrument_fwhm_deg;
} Grid;

static Fitted fit_surface(Surface *surface, Grid grid, FitOptions options) {
    Fitted f;
    Tables tables = HAZY;
    tables.surface = surface;
    tables.instrument_fwhm_deg = grid.instrument_fwhm_deg;
    if (grid.incidences) tables.incidences = grid.incidences;
    if (grid.azimuths) tables.azimuths = grid.azimuths;
    if (grid.wavelengths) tables.wavelengths = grid.wavelengths;
    if (grid.theta_step > 0) tables.theta_step = grid.theta_step;
    if (grid.phi_step > 0) tables.phi_step = grid.phi_step;
    if (grid.theta_max > 0) tables.theta_max = grid.theta_max;
    fit_tables(&f, tables, &options);
    return f;
}

static Fitted shared; /* of HAZY, with what `fit` chooses */

/* ---- laws -------------------------------------------------------------------------------- */

/* Largest error relative to the surface's value, at samples (between = 0) or off them; light
 * at phi_i. */
static double largest_error(const Fitted *f, double incidence_deg, double phi_i, double between) {
    const Tables *t = &f->tables;
    double worst = 0, theta_i = radians_from_degrees(incidence_deg);
    Wavelengths w = even_wavelengths(400, 20);
    Vec3 light = direction_deg(incidence_deg, degrees_from_radians(phi_i));
    for (double a = between; a <= t->theta_max; a += 2 * t->theta_step)
        for (double p = between; p < 360; p += 3 * t->phi_step) {
            Spectrum v = panel_brdf(
                f->fit.panel, direction_deg(a, p + degrees_from_radians(phi_i) - 180), light, &w);
            for (int k = 0; k < t->wavelengths; k++) {
                double truth = t->surface(theta_i, phi_i, radians_from_degrees(a),
                                          radians_from_degrees(p), (double)w.nm[k]);
                worst = fmax(worst, fabs((double)v[k] / truth - 1));
            }
        }
    return worst;
}

TEST(the_bound_holds_at_every_sample_and_wavelength) {
    for (int i = 0; i < HAZY_INCIDENCES; i++) {
        double worst = largest_error(&shared, HAZY.incidence_deg[i], PI, 0);
        if (!(worst <= 0.0205)) fail_msg("%g degrees: %.4f", HAZY.incidence_deg[i], worst);
    }
}

TEST(between_incidences_the_peak_has_moved_and_keeps_its_height) {
    Wavelengths w = even_wavelengths(400, 20);
    for (double incidence = 10; incidence <= 60; incidence += 10) {
        double best = 0, at = 0, truth = 0;
        double theta_i = radians_from_degrees(incidence);
        Vec3 light = direction_deg(incidence, 180);
        for (double a = incidence - 8; a < incidence + 8; a += 0.05) {
            double f = (double)panel_brdf(shared.fit.panel, direction_deg(fabs(a), a < 0 ? 180 : 0),
                                          light, &w)[8];
            double t = hazy(theta_i, PI, radians_from_degrees(fabs(a)), a < 0 ? PI : 0, 560);
            if (f > best) best = f, at = a;
            truth = fmax(truth, t);
        }
        assert_close(best, truth, 0.02);
        assert_near(at, incidence, incidence < 55 ? 1.0 : 3.0); /* the haze leans outwards */
    }
}

TEST(light_from_any_azimuth_reads_the_same) {
    Wavelengths w = even_wavelengths(400, 20);
    for (double turn = 0; turn < 360; turn += 37)
        assert_turns(shared.fit.panel, (double[]){40, 12}, 30, turn, &w, 5);
}

TEST(at_the_normal_the_azimuth_does_not_matter) {
    Wavelengths w = even_wavelengths(400, 20);
    Spectrum a = panel_brdf(shared.fit.panel, direction_deg(9, 0), direction_deg(0, 0), &w);
    for (double p = 0; p < 360; p += 30) {
        Spectrum b = panel_brdf(shared.fit.panel, direction_deg(9, p), direction_deg(0, 0), &w);
        assert_close(b[8], a[8], 0.02);
        assert_close(b[8], hazy(0, 0, radians_from_degrees(9), 0, 560), 0.03);
    }
}

TEST(wavelengths_between_the_measured_ones_lie_between_their_values) {
    Wavelengths at = even_wavelengths(400, 20), between = even_wavelengths(410, 20);
    Spectrum a = panel_brdf(shared.fit.panel, direction_deg(30, 20), direction_deg(35, 180), &at);
    Spectrum b =
        panel_brdf(shared.fit.panel, direction_deg(30, 20), direction_deg(35, 180), &between);
    for (int i = 0; i < 15; i++) {
        assert_true(b[i] <= fmaxf(a[i], a[i + 1]) * 1.0001f);
        assert_true(b[i] >= fminf(a[i], a[i + 1]) * 0.9999f);
    }
    assert_close(b[15], a[15], 1e-5);
}

static bool is_measured(double incidence_deg, double theta_deg) {
    return panel_brdf_is_measured(shared.fit.panel, direction_deg(theta_deg, 90),
                                  direction_deg(incidence_deg, 180));
}

TEST(extrapolation_is_continuous_and_flagged) {
    Wavelengths w = even_wavelengths(400, 20);
    for (double theta = 0; theta < 84; theta += 7)
        for (double phi = 0; phi <= 180; phi += 45) {
            Vec3 out = direction_deg(theta, phi);
            Spectrum a = panel_brdf(shared.fit.panel, out, direction_deg(64.99, 180), &w);
            Spectrum b = panel_brdf(shared.fit.panel, out, direction_deg(65.01, 180), &w);
            for (int k = 0; k < SPECTRUM_LANES; k++) assert_close(b[k], a[k], 0.01);
            assert_true(is_measured(64.9, theta));
            assert_int_equal(is_measured(65.1, theta), theta < 65);
        }
    assert_false(is_measured(30, 86));
}

TEST(beyond_the_measured_incidences_haze_follows_fresnel) {
    for (double theta = 68; theta <= 80; theta += 4) {
        double f = brdf_deg(shared.fit.panel, (double[]){theta, 0}, (double[]){theta, 180}, 8);
        double angle = radians_from_degrees(theta);
        assert_close(f, hazy(angle, PI, angle, 0, 560), 0.12);
    }
}

/* Haze integrated over the hemisphere, with the cosine. */
static double albedo_at(const Panel *panel, double incidence_deg, int lane) {
    double sum = 0, step = radians_from_degrees(1);
    for (double a = 0.5; a < 90; a++)
        for (double p = 1; p < 360; p += 2) {
            double t = radians_from_degrees(a);
            sum += brdf_deg(panel, (double[]){a, p}, (double[]){incidence_deg, 180}, lane) *
                   cos(t) * sin(t) * step * 2 * step;
        }
    return sum;
}

TEST(a_white_furnace_gives_no_more_than_it_gets) {
    ENDS_BY(fitted_end) Fitted f = fit_surface(white, (Grid){.wavelengths = 2}, quick());
    for (double i = 0; i < 90; i += 8.9)
        if (!(albedo_at(f.fit.panel, i, 0) <= 1.001))
            fail_msg("%g degrees: %.5f", i, albedo_at(f.fit.panel, i, 0));
}

TEST(the_albedo_is_the_integral) {
    size_t i;
    json_t *table;
    json_array_foreach(json_object_get(shared.fit.report, "tables"), i, table)
        assert_near(json_number_at(table, "integral_error"), 0, 1e-3);
    for (double theta = 5; theta <= 65; theta += 15) { /* the luminous mean is near 560 nm */
        double albedo = albedo_at(shared.fit.panel, theta, 8);
        assert_close(panel_haze_albedo(shared.fit.panel, (float)cos(radians_from_degrees(theta))),
                     albedo, 0.02);
    }
}

/* ---- bases on the hemisphere -------------------------------------------------------------- */

TEST(both_bases_hold_the_bound) {
    static const struct {
        const char *name;
        FitBasis basis;
        double most;
    } CASES[] = {{"vertex", FIT_VERTEX, 0.0205}, {"haar", FIT_HAAR, 0.25}};
    for (size_t i = 0; i < sizeof CASES / sizeof *CASES; i++) {
        FitOptions options = quick();
        options.basis = CASES[i].basis;
        ENDS_BY(fitted_end)
        Fitted f = fit_surface(
            hazy, (Grid){.incidences = 2, .phi_step = 12, .theta_step = 3, .wavelengths = 8},
            options);
        double worst = fmax(largest_error(&f, 5, PI, 0), largest_error(&f, 20, PI, 0));
        if (!(worst <= CASES[i].most)) fail_msg("%s: %.4f", CASES[i].name, worst);
    }
}

/* ---- the parts --------------------------------------------------------------------------- */

TEST(an_image_as_wide_as_the_instrument_becomes_the_mirror) {
    Wavelengths w = even_wavelengths(400, 20);
    Grid grid = {.wavelengths = 4,
                 .incidences = 3,
                 .theta_step = 1,
                 .phi_step = 3,
                 .instrument_fwhm_deg = LOBE_FWHM_DEG};
    ENDS_BY(fitted_end) Fitted f = fit_surface(lobed, grid, quick());
    for (int i = 0; i < 3; i++) {
        double c = cos(f.fit.set->incidence[i]);
        assert_close(panel_mirror(f.fit.panel, (float)c, &w)[1], LOBE_SHARE * fresnel(c), 0.02);
        Spectrum v = panel_brdf(f.fit.panel, direction_deg(HAZY.incidence_deg[i], 0),
                                direction_deg(HAZY.incidence_deg[i], 180), &w);
        double theta = f.fit.set->incidence[i];
        assert_close(v[1], hazy(theta, PI, theta, 0, 420), 0.05);
    }
}

/* ---- the lambertian part ----------------------------------------------------------------- */

#define FLOOR 0.002 /* sr^-1, of hazy */
static Spectrum lambertian(const Panel *panel, Vec3 wo, Vec3 wi, const Wavelengths *w) {
    PanelLanes lanes;
    panel_lanes(panel, w, &lanes);
    return panel_lambertian_at(panel, panel_brdf_at(panel, wo, wi, &lanes), wi, &lanes);
}

static double floor_at(const Panel *panel, Vec3 wo, Vec3 wi) {
    Wavelengths w = even_wavelengths(400, 20);
    return (double)lambertian(panel, wo, wi, &w)[8];
}

TEST(the_lambertian_part_is_a_share_of_the_whole) {
    Wavelengths w = even_wavelengths(395, 21);
    for (double incidence = 0; incidence < 90; incidence += 7.3)
        for (double theta = 0; theta < 90; theta += 11)
            for (double phi = 0; phi < 360; phi += 40) {
                Vec3 wo = direction_deg(theta, phi), wi = direction_deg(incidence, 180);
                Spectrum f = panel_brdf(shared.fit.panel, wo, wi, &w);
                Spectrum l = lambertian(shared.fit.panel, wo, wi, &w);
                for (int k = 0; k < SPECTRUM_LANES; k++) assert_true(l[k] > 0 && l[k] <= f[k]);
            }
    assert_true(floor_at(shared.fit.panel, direction_deg(95, 0), direction_deg(5, 0)) == 0);
    assert_true(floor_at(shared.fit.panel, direction_deg(5, 0), direction_deg(95, 0)) == 0);
}

/* Above it by the haze that is left far from the mirror direction, 3e-4 at most here. */
TEST(the_lambertian_part_is_the_floor_below_the_haze) {
    for (double incidence = 0; incidence <= 65; incidence += 2.5) {
        Vec3 wi = direction_deg(incidence, 180);
        double mirror = floor_at(shared.fit.panel, direction_deg(incidence, 0), wi);
        assert_true(mirror > 0.98 * FLOOR && mirror < 1.15 * FLOOR);
        for (double phi = 0; phi < 360; phi += 60) /* alike to all sides */
            assert_close(floor_at(shared.fit.panel, direction_deg(20, phi), wi), mirror, 0.025);
    }
}

TEST(beyond_the_measured_incidences_the_floor_stays) {
    Vec3 wo = direction_deg(10, 0);
    double last = floor_at(shared.fit.panel, wo, direction_deg(65, 180));
    for (double theta = 65.01; theta <= 89; theta += 4)
        assert_close(floor_at(shared.fit.panel, wo, direction_deg(theta, 180)), last, 1e-4);
}

/* Helmholtz: where the two directions exchanged were measured, both are one number; it is the
 * surface's, which is reciprocal, and it comes and goes smoothly. */
TEST(beyond_the_measured_incidences_exchanged_directions_are_read) {
    const Panel *panel = shared.fit.panel;
    for (double theta = 68; theta <= 81; theta += 3)
        for (double to = 5; to <= 62; to += 15) /* as measured */
            for (double phi = 0; phi < 360; phi += 40) {
                Vec3 wi = direction_deg(theta, 180), wo = direction_deg(to, phi);
                double here = brdf_deg(panel, (double[]){to, phi}, (double[]){theta, 180}, 8);
                double back = brdf_deg(panel, (double[]){theta, 180}, (double[]){to, phi}, 8);
                double truth = hazy(radians_from_degrees(theta), PI, radians_from_degrees(to),
                                    radians_from_degrees(phi), 560);
                assert_close(here, back, 1e-5);
                assert_close(here, truth, 0.025);
                assert_true(panel_brdf_is_measured(panel, wo, wi));
            }
    double before = 0;
    for (double theta = 64; theta < 89; theta += 0.05) {
        double here = brdf_deg(panel, (double[]){30, 77}, (double[]){theta, 180}, 8);
        if (before > 0) assert_close(here, before, 0.02);
        before = here;
    }
}

static double matt(double theta_i, double phi_i, double theta, double phi, double nm) {
    (void)theta_i, (void)phi_i, (void)theta, (void)phi;
    return 0.003 * nm / 550;
}

TEST(a_face_alike_to_all_sides_has_no_haze) {
    Wavelengths w = even_wavelengths(400, 20);
    Grid grid = {.wavelengths = 4, .azimuths = 4, .incidences = 3};
    ENDS_BY(fitted_end) Fitted f = fit_surface(matt, grid, quick());
    for (double turn = 0; turn < 360; turn += 51)
        for (double incidence = 3; incidence < 35; incidence += 9) {
            Vec3 wo = direction_deg(30, 2 * turn), wi = direction_deg(incidence, turn);
            Spectrum all = panel_brdf(f.fit.panel, wo, wi, &w);
            Spectrum part = lambertian(f.fit.panel, wo, wi, &w);
            for (int k = 0; k < 4; k++) assert_close(part[k], all[k], 0.021);
        }
}

/* ---- azimuths of the light --------------------------------------------------------------- */

TEST(a_brushed_surface_is_told_between_azimuths) {
    Grid grid = {.wavelengths = 1,
                 .azimuths = 16,
                 .incidences = 2,
                 .theta_step = 3,
                 .phi_step = 9,
                 .theta_max = 81};
    ENDS_BY(fitted_end) Fitted f = fit_surface(brushed, grid, quick());
    for (int a = 0; a < 16; a += 5) {
        double at = largest_error(&f, 20, 2 * PI * a / 16, 0);
        double between = largest_error(&f, 20, 2 * PI * (a + 0.5) / 16, 0);
        if (!(at <= 0.0205)) fail_msg("azimuth %.1f: %.4f", 22.5 * a, at);
        if (!(between <= 0.06)) fail_msg("azimuth %.2f: %.4f", 22.5 * (a + 0.5), between);
    }
}

static bool is_told_of_azimuths(const Fitted *f) {
    size_t i;
    json_t *reason;
    json_array_foreach(json_object_get(f->fit.report, "reasons"), i,
                       reason) if (strstr(json_string_value(reason),
                                          "each azimuth of the light left out")) return true;
    return false;
}

TEST(azimuths_of_the_light_too_far_apart_are_told) {
    for (int azimuths = 4; azimuths <= 32; azimuths += 28) {
        Grid grid = {.wavelengths = 1,
                     .azimuths = azimuths,
                     .incidences = 2,
                     .theta_step = 3,
                     .phi_step = 9,
                     .theta_max = 81};
        ENDS_BY(fitted_end) Fitted f = fit_surface(brushed, grid, quick());
        assert_int_equal(is_told_of_azimuths(&f), azimuths == 4);
    }
}

TEST(an_isotropic_surface_stored_with_azimuths_answers_the_same) {
    ENDS_BY(fitted_end)
    Fitted f = fit_surface(hazy, (Grid){.wavelengths = 1, .azimuths = 4, .incidences = 3}, quick());
    for (double turn = 0; turn < 360; turn += 51) {
        double worst = largest_error(&f, 20, radians_from_degrees(turn), 0);
        if (!(worst <= 0.0205)) fail_msg("turned by %g: %.4f", turn, worst);
        worst = largest_error(&f, 3, radians_from_degrees(turn), 0);
        if (!(worst <= 0.05)) fail_msg("near the normal, turned by %g: %.4f", turn, worst);
    }
}

/* ---- zeros ------------------------------------------------------------------------------- */

static double with_zeros(double theta_i, double phi_i, double theta, double phi, double nm) {
    return fabs(phi - PI) < 0.3 && theta > 1.2 ? -1e-6 : hazy(theta_i, phi_i, theta, phi, nm);
}

TEST(zeros_and_negative_values_are_held_counted_and_told) {
    Grid grid = {.wavelengths = 1, .incidences = 1};
    ENDS_BY(fitted_end) Fitted f = fit_surface(with_zeros, grid, quick());
    long masked = 0;
    for (int i = 0; i < f.fit.set->brdf[0].rows; i++) masked += f.fit.set->brdf[0].value[i] < 0;
    assert_true(masked > 0);
    assert_int_equal(json_number_at(f.fit.report, "reflection/zeros_masked"), masked);
    for (double a = 0; a < 90; a += 3)
        assert_true(brdf_deg(f.fit.panel, (double[]){a, 180}, (double[]){5, 180}, 0) > 0);
}

static int start(void **state) {
    FitOptions options = fit_options_default();
    *state = &shared.fit;
    fit_tables(&shared, HAZY, &options);
    return 0;
}

TEST_PROGRAM(start, fixture_group_end)
