/* How a panel's reflection is sampled: densities that integrate to one and fit the samples. */
#include "panel_fixture.h"

#include "hemisphere/geodesic.h"
#include "panel/panel_file.h"
#include "hemisphere/specular_frame.h"

static Fixture ips;

static int start_ips(void **state)
{
    (void)state;
    FitOptions options = fit_options_default();
    options.level = 5;
    fixture_start(&ips, FIXTURE_IPS, &options);
    return 0;
}

static int end_ips(void **state)
{
    (void)state;
    fixture_end(&ips);
    return 0;
}

/* The same direction in the display's frame and in the tree's, the light at azimuth 180. */
static SpecularFrame frame_of(double theta)
{
    return specular_frame((float)theta, ips.panel->reflection->frame_exponent);
}

/* Density per solid angle of the stored frame at a stored direction; the pdf of the display's
 * frame diverges at the peak (integrably), its product with the Jacobian does not. */
static double stored_density(double theta, Vec3 stored)
{
    SpecularFrame frame = frame_of(theta);
    Vec3 wo = vec3((float)-sin(theta), 0, (float)cos(theta));
    Vec3 wi = specular_frame_outer(&frame, stored);
    return (double)panel_pdf(ips.panel, wo, wi) *
           (double)specular_frame_jacobian(&frame, specular_frame_stored(&frame, wi));
}

static void the_density_integrates_to_one(void **state)
{
    (void)state;
    enum { LEVEL = 6 };
    for (int k = 0; k < 16; k++) {
        double theta = radians_from_degrees(0.5 + 5.9 * k), sum = 0;
        for (uint32_t i = 0; i < geodesic_count(LEVEL); i++)
            sum += stored_density(theta, geodesic_center(LEVEL, i)) * geodesic_area(LEVEL, i);
        assert_near(sum, 1, 1e-3);
    }
}

/* How many standard deviations a chi-square value lies above its mean (Wilson, Hilferty). */
static double chi_square_z(double value, int freedom)
{
    double a = 2.0 / (9 * freedom);
    return (cbrt(value / freedom) - (1 - a)) / sqrt(a);
}

enum { BIN_LEVEL = 2, FINE_LEVEL = 5, BINS = 4 << 2 * BIN_LEVEL, DRAWS = 20000 };

/* Probability of every bin of the stored frame. */
static void expected_bins(double theta, double *bins)
{
    memset(bins, 0, BINS * sizeof *bins);
    for (uint32_t i = 0; i < geodesic_count(FINE_LEVEL); i++)
        bins[i >> 2 * (FINE_LEVEL - BIN_LEVEL)] +=
            stored_density(theta, geodesic_center(FINE_LEVEL, i)) *
            geodesic_area(FINE_LEVEL, i);
}

static void samples_fall_as_the_density_says(void **state)
{
    (void)state;
    const Geodesic *geodesic = geodesic_create(BIN_LEVEL, &ips.arena);
    uint32_t random = 7;
    for (int k = 0; k < 64; k++) {
        double        theta = radians_from_degrees(0.3 + 1.38 * k);
        double        bins[BINS], chi = 0, rest = 0;
        int           counts[BINS] = {0}, freedom = -1, drawn = 0, rest_count = 0;
        SpecularFrame frame = frame_of(theta);
        Vec3 wo = vec3((float)-sin(theta), 0, (float)cos(theta));
        expected_bins(theta, bins);
        for (int i = 0; i < DRAWS; i++) {
            float u[3];
            Vec3  wi;
            float pdf;
            for (int j = 0; j < 3; j++) u[j] = (float)steady_random(&random);
            if (!panel_sample(ips.panel, wo, u, &wi, &pdf)) continue;
            drawn++;
            counts[geodesic_find(geodesic, BIN_LEVEL,
                                 specular_frame_stored(&frame, wi)).id]++;
        }
        assert_true(drawn >= DRAWS - 20);
        for (int b = 0; b < BINS; b++) {
            double expected = bins[b] * drawn;
            if (expected < 10) {
                rest += expected;
                rest_count += counts[b];
                continue;
            }
            chi += (counts[b] - expected) * (counts[b] - expected) / expected;
            freedom++;
        }
        if (rest > 10) chi += (rest_count - rest) * (rest_count - rest) / rest, freedom++;
        if (!(chi_square_z(chi, freedom) < 4.5))
            fail_msg("incidence %g degrees: chi-square %g with %d degrees of freedom",
                     degrees_from_radians(theta), chi, freedom);
    }
}

/* f cos / pdf averages to the albedo: wherever there is light the density is above zero. */
static void weights_average_to_the_albedo(void **state)
{
    (void)state;
    Wavelengths w = even_wavelengths(400, 20);
    uint32_t    random = 3;
    for (int k = 0; k <= 8; k++) {
        double   theta = radians_from_degrees(10 * k + 2), squares = 0;
        Vec3     wo = vec3((float)(sin(theta) * 0.6), (float)(sin(theta) * 0.8),
                           (float)cos(theta));
        Spectrum sum = spectrum_all(0), albedo = spectrum_all(0);
        for (int i = 0; i < DRAWS; i++) {
            float u[3];
            Vec3  wi;
            float pdf;
            for (int j = 0; j < 3; j++) u[j] = (float)steady_random(&random);
            if (!panel_sample(ips.panel, wo, u, &wi, &pdf)) continue;
            assert_true(pdf > 0);
            Spectrum weight = panel_brdf(ips.panel, wo, wi, &w) * spectrum_all(wi.z / pdf);
            sum += weight;
            squares += (double)(weight[7] * weight[7]);
        }
        for (int t = 0; t < 180; t++)
            for (int p = 0; p < 180; p++) {
                double a = radians_from_degrees(0.5 * t + 0.25);
                Vec3   wi = direction_deg(0.5 * t + 0.25, 2 * p + 1);
                albedo += panel_brdf(ips.panel, wo, wi, &w) *
                          spectrum_all((float)(sin(2 * a) * 0.5 * PI / 360 * PI / 90));
            }
        double mean = (double)sum[7] / DRAWS, variance = squares / DRAWS - mean * mean;
        double sigma = sqrt(variance / DRAWS);
        if (!(fabs(mean - (double)albedo[7]) < 5 * sigma + 0.004 * (double)albedo[7]))
            fail_msg("incidence %g: mean weight %g, albedo %g, sigma %g",
                     degrees_from_radians(theta), mean, (double)albedo[7], sigma);
        assert_true(variance < 0.35 * mean * mean); /* uniform: a hundred times that */
    }
}

static void expect_finite(Vec3 wo, Vec3 wi, const Wavelengths *w)
{
    static const float us[][3] = {{0, 0, 0}, {0.9999999f, 0.9999999f, 0.9999999f},
                                  {0.5f, 0, 1e-7f}};
    float    rgb[3] = {255, 1, 0.1f}, xyz[3], pdf = panel_pdf(ips.panel, wo, wi);
    Spectrum f = panel_brdf(ips.panel, wo, wi, w);
    panel_emission_xyz(ips.panel, wo, rgb, xyz);
    if (!(pdf >= 0) || isinf(pdf) || !spectrum_is_finite(f) || !(spectrum_max_lane(f) >= 0) ||
        !isfinite(xyz[0] + xyz[1] + xyz[2]) ||
        !spectrum_is_finite(panel_emission_spectrum(ips.panel, wo, rgb, w)))
        fail_msg("wo %g %g %g, wi %g %g %g: pdf %g, f %g", (double)wo.x, (double)wo.y,
                 (double)wo.z, (double)wi.x, (double)wi.y, (double)wi.z, (double)pdf,
                 (double)f[0]);
    for (int i = 0; i < 3; i++) {
        Vec3 drawn;
        if (!panel_sample(ips.panel, wo, us[i], &drawn, &pdf)) continue;
        assert_true(pdf > 0 && isfinite(pdf));
        assert_true(vec3_is_finite(drawn) && drawn.z > 0);
        assert_near(vec3_length(drawn), 1, 1e-5);
    }
}

/* Poles, axes, exact mirror directions, and the horizon from very near. */
static void answers_are_finite_in_every_corner(void **state)
{
    (void)state;
    Wavelengths w = even_wavelengths(360, 31.3f);
    static const float heights[] = {1, 0.9999999f, 0.999f, 0.7f, 0.05f, 1e-3f, 1e-5f, 1e-20f};
    Vec3 corner[8 * 9];
    int  count = 0;
    for (int h = 0; h < 8; h++)
        for (int p = 0; p < 9; p++) {
            float s = sqrtf(1 - heights[h] * heights[h]), sine, cosine;
            sincos_turns((float)p / 8 + (p == 8 ? 0.01f : 0), &sine, &cosine);
            corner[count++] = vec3(s * cosine, s * sine, heights[h]);
        }
    for (int i = 0; i < count; i++)
        for (int j = 0; j < count; j++) expect_finite(corner[i], corner[j], &w);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(the_density_integrates_to_one),
        cmocka_unit_test(samples_fall_as_the_density_says),
        cmocka_unit_test(answers_are_finite_in_every_corner),
        cmocka_unit_test(weights_average_to_the_albedo),
    };
    return cmocka_run_group_tests(tests, start_ips, end_ips);
}
