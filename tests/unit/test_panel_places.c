/* SPDX-License-Identifier: Apache-2.0 */
/* A panel that is not the same everywhere: spots and a uniformity map of a synthetic display
 * whose truth is known at every place, and the weights between spots. */
#include "panel_fixture.h"

#include "panel/query/panel_place.h"
#include "panel/shape/spot_ground.h"
#include "shaders/bsdf.h"

static Fixture folder; /* files */

static int start(void **state) {
    *state = &folder;
    fixture_folder(&folder);
    return 0;
}

/* ---- weights ----------------------------------------------------------------------------- */

static const float grid_at[9][2] = {{0.1f, 0.1f}, {0.5f, 0.1f}, {0.9f, 0.1f},
                                    {0.1f, 0.5f}, {0.5f, 0.5f}, {0.9f, 0.5f},
                                    {0.1f, 0.9f}, {0.5f, 0.9f}, {0.9f, 0.9f}};
static const float scattered_at[7][2] = {{0.05f, 0.1f}, {0.9f, 0.05f}, {0.5f, 0.5f}, {0.1f, 0.95f},
                                         {0.85f, 0.9f}, {0.6f, 0.2f},  {0.3f, 0.45f}};
/* A square with its middle, turned: four corners on one circle, no grid. */
static const float diamond_at[5][2] = {
    {0.5f, 0.1f}, {0.9f, 0.5f}, {0.5f, 0.9f}, {0.1f, 0.5f}, {0.5f, 0.5f}};
/* Eight on a circle: every triangle of them has all others on its rim. */
static const float ring_at[8][2] = {{0.9f, 0.5f}, {0.75f, 0.75f}, {0.5f, 0.9f}, {0.25f, 0.75f},
                                    {0.1f, 0.5f}, {0.25f, 0.25f}, {0.5f, 0.1f}, {0.75f, 0.25f}};
static const float line_at[4][2] = {{0.1f, 0.2f}, {0.7f, 0.8f}, {0.3f, 0.4f}, {0.5f, 0.6f}};
static const float row_at[3][2] = {{0.8f, 0.5f}, {0.2f, 0.5f}, {0.4f, 0.5f}};
static const float lone_at[1][2] = {{0.3f, 0.6f}};

typedef struct GroundCase {
    const char *name;
    const float (*at)[2];
    int count;
    bool is_area; /* linear functions are followed inside `inner` about the middle */
    float inner;
} GroundCase;

static const GroundCase ground_cases[] = {
    {"grid", grid_at, 9, true, 0.39f},       {"scattered", scattered_at, 7, true, 0.3f},
    {"diamond", diamond_at, 5, true, 0.19f}, {"ring", ring_at, 8, true, 0.24f},
    {"line", line_at, 4, false, 0},          {"row", row_at, 3, false, 0},
    {"lone", lone_at, 1, false, 0},
};
#define GROUNDS ((int)(sizeof ground_cases / sizeof *ground_cases))

/* Of every spot, those that do not count too. */
static void all_weights(const SpotGround *ground, const float place[2], double *weight) {
    SpotWeights w = spot_ground_weights(ground, place);
    double sum = 0;
    for (int i = 0; i < ground->count; i++) weight[i] = 0;
    assert_true(w.count >= 1 && w.count <= SPOT_GROUND_COUNT);
    for (int i = 0; i < w.count; i++) {
        assert_true(w.weight[i] > 0 && w.spot[i] >= 0 && w.spot[i] < ground->count);
        weight[w.spot[i]] += (double)w.weight[i];
        sum += (double)w.weight[i];
    }
    assert_close(sum, 1, 1e-5);
}

TEST(weights_are_shares_of_one_and_a_spots_own_is_one) {
    for (int c = 0; c < GROUNDS; c++) {
        SpotGround ground;
        double weight[SPOT_GROUND_MAX];
        uint32_t random = 7;
        spot_ground_build(ground_cases[c].at, ground_cases[c].count, &folder.arena, &ground);
        for (int i = 0; i < ground_cases[c].count; i++) {
            all_weights(&ground, ground_cases[c].at[i], weight);
            if (fabs(weight[i] - 1) > 1e-5)
                fail_msg("%s: spot %d has %g of itself", ground_cases[c].name, i, weight[i]);
        }
        for (int i = 0; i < 4000; i++) {
            float place[2] = {(float)(1.4 * steady_random(&random) - 0.2),
                              (float)(1.4 * steady_random(&random) - 0.2)};
            all_weights(&ground, place, weight);
        }
    }
}

/* A small step changes every weight by little; across the border too. */
TEST(weights_have_no_jumps) {
    for (int c = 0; c < GROUNDS; c++) {
        SpotGround ground;
        double weight[2][SPOT_GROUND_MAX];
        uint32_t random = 11;
        spot_ground_build(ground_cases[c].at, ground_cases[c].count, &folder.arena, &ground);
        for (int i = 0; i < 20000; i++) {
            float place[2] = {(float)steady_random(&random), (float)steady_random(&random)};
            float beside[2] = {place[0] + 2e-4f, place[1] - 1e-4f};
            all_weights(&ground, place, weight[0]);
            all_weights(&ground, beside, weight[1]);
            for (int k = 0; k < ground.count; k++)
                if (fabs(weight[0][k] - weight[1][k]) > 0.01)
                    fail_msg("%s: spot %d jumps by %g at %g, %g", ground_cases[c].name, k,
                             weight[1][k] - weight[0][k], (double)place[0], (double)place[1]);
        }
    }
}

/* Between spots a linear function of the place is followed; on a grid u v too. */
TEST(linear_functions_are_followed_between_spots) {
    for (int c = 0; c < GROUNDS; c++) {
        SpotGround ground;
        double weight[SPOT_GROUND_MAX];
        uint32_t random = 5;
        if (!ground_cases[c].is_area) continue;
        spot_ground_build(ground_cases[c].at, ground_cases[c].count, &folder.arena, &ground);
        double uv = c == 0 ? 2 : 0;
        for (int i = 0; i < 2000; i++) {
            double r = (double)ground_cases[c].inner, sum = 0;
            float place[2] = {(float)(0.5 + r * (2 * steady_random(&random) - 1)),
                              (float)(0.5 + r * (2 * steady_random(&random) - 1))};
            all_weights(&ground, place, weight);
            for (int k = 0; k < ground.count; k++) {
                double u = (double)ground.at[k][0], v = (double)ground.at[k][1];
                sum += weight[k] * (1 + 2 * u - 3 * v + uv * u * v);
            }
            double u = (double)place[0], v = (double)place[1];
            assert_near(sum, 1 + 2 * u - 3 * v + uv * u * v, 2e-5);
        }
    }
}

/* ---- known truth ------------------------------------------------------------------------- */

#define EMITTER \
    "\"emission\": {" FIXTURE_SPECTRA "\"gamma\": 2.2, \"cosine_power\": [1.1, 1.6]," \
    "\"black_cd_m2\": 0.7, \"leak\": 1, \"levels\": [127, 255]," \
    "\"lobe\": {\"theta_deg\": 30, \"phi_deg\": 60, \"width_deg\": 25, \"gain\": 0.3}}"
#define INSTRUMENT "\"instrument\": {\"theta_step_deg\": 2, \"phi_step_deg\": 6}"
#define NINE "\"u\": [0, 0.5, 1, 0, 0.5, 1, 0, 0.5, 1], \"v\": [0, 0, 0, 0.5, 0.5, 0.5, 1, 1, 1]"
#define MURA \
    "\"map\": [48, 27], \"mura\": 0.06, \"mura_cycles\": [3, 2], \"tint\": 0.08," \
    "\"clouding\": 0.6"

static void expect_truth(const Fixture *f, const float place[2], double bound) {
    static const float codes[5][3] = {
        {255, 255, 255}, {0, 0, 0}, {127, 200, 90}, {255, 0, 0}, {0, 31, 255}};
    double at[2] = {(double)place[0], (double)place[1]};
    SyntheticPanel local = closed_form_at(&f->recipe, at);
    for (int i = 0; i < 24; i++) {
        double theta = 3.1 * i, phi = 67.0 * i, wanted[3];
        float xyz[3];
        true_xyz_deg(&local, theta, phi, codes[i % 5], wanted);
        panel_place_emission_xyz(f->panel, place, direction_deg(theta, phi), codes[i % 5], xyz);
        for (int j = 0; j < 3; j++)
            if (!(fabs((double)xyz[j] / wanted[j] - 1) < bound))
                fail_msg("at %g, %g, theta %g, phi %g, codes %d: %g, required: "
                         "%g",
                         at[0], at[1], theta, phi, i % 5, (double)xyz[j], wanted[j]);
    }
}

/* Truth that is linear over the surface, its slope and its angular lobe each (their product is
 * not, which adds 0.02 %): within 0.5 % everywhere, off the spots too. */
TEST(nine_spots_say_the_truth_everywhere) {
    ENDS_BY(fixture_end) Fixture f;
    uint32_t random = 3;
    fixture_start(&f,
                  "{" EMITTER "," INSTRUMENT ", \"places\": {" NINE
                  ", \"slope\": [0.3, -0.2], \"lobe_slope\": 0.4}}",
                  NULL);
    for (int i = 0; i < 60; i++) {
        float place[2] = {(float)steady_random(&random), (float)steady_random(&random)};
        expect_truth(&f, place, 0.005);
    }
    assert_int_equal(json_array_size(json_object_get(f.report, "spots")), 8);
}

/* White and black along the normal are the map's at every pixel's middle; a truth whose places
 * and angles are a product is followed everywhere, between few spots too. */
TEST(the_map_says_what_lies_between_spots) {
    static const char *const recipes[2] = {
        "{" EMITTER "," INSTRUMENT ", \"places\": {" MURA ", \"slope\": [0.3, -0.2]}}",
        "{" EMITTER "," INSTRUMENT ", \"places\": {\"u\": [0.1, 0.9, 0.4], \"v\": [0.2, 0.3, "
        "0.9], " MURA ", \"slope\": [0.3, -0.2], \"bend_deg\": 60}}"};
    for (int r = 0; r < 2; r++) {
        ENDS_BY(fixture_end) Fixture f;
        fixture_start(&f, recipes[r], NULL);
        for (int i = 0; i < 48 * 27; i += 37) {
            float place[2] = {((float)(i % 48) + 0.5f) / 48, ((float)(i / 48) + 0.5f) / 27};
            expect_truth(&f, place, 0.005);
        }
        for (int i = 0; i < 2; i++) { /* from pixel to pixel the ratio is the map's own */
            float a[2] = {20.5f / 48, 13.5f / 27}, b[2] = {33.5f / 48, 4.5f / 27};
            float rgb[3] = {i ? 0 : 255, i ? 0 : 255, i ? 0 : 255}, at[2][3];
            size_t pixel[2] = {13 * 48 + 20, 4 * 48 + 33};
            const UniformityMap *map = f.set->map;
            if (map->is_seen) continue; /* under the camera's angles */
            panel_place_emission_xyz(f.panel, a, vec3(0, 0, 1), rgb, at[0]);
            panel_place_emission_xyz(f.panel, b, vec3(0, 0, 1), rgb, at[1]);
            for (int j = 0; j < 3; j++) {
                const float *plane = map->value[3 * i + j];
                assert_close((double)(at[0][j] / at[1][j]),
                             (double)(plane[pixel[0]] / plane[pixel[1]]), 5e-5);
            }
        }
    }
}

/* The spectrum has the colour and the light that XYZ have, by place too. */
TEST(spectra_have_the_places_colour) {
    ENDS_BY(fixture_end) Fixture f;
    fixture_start(
        &f, "{" EMITTER "," INSTRUMENT ", \"places\": {" MURA ", \"slope\": [0.3, -0.2]}}", NULL);
    for (int i = 0; i < 6; i++) {
        float place[2] = {0.19f * (float)i, 1 - 0.17f * (float)i}, rgb[3] = {255, 180, 220};
        float xyz[3];
        double sum[3] = {0, 0, 0};
        Vec3 d = direction_deg(9.0 * i, 50.0 * i);
        panel_place_emission_xyz(f.panel, place, d, rgb, xyz);
        for (int first = 0; first + 16 <= SPECTRAL_COUNT; first += 16) {
            Wavelengths w = even_wavelengths((float)(SPECTRAL_FIRST_NM + first), 1);
            Spectrum s = panel_place_emission_spectrum(f.panel, place, d, rgb, &w);
            for (int k = 0; k < SPECTRUM_LANES; k++) {
                const SpectralRow *row = &spectral_table[first + k];
                sum[0] += 683.002 * (double)s[k] * (double)row->x;
                sum[1] += 683.002 * (double)s[k] * (double)row->y;
                sum[2] += 683.002 * (double)s[k] * (double)row->z;
            }
        }
        assert_close((double)xyz[1], sum[1], 2e-3);
        assert_true(chromaticity_distance(sum, xyz) < 1e-3);
    }
}

/* ---- reflection -------------------------------------------------------------------------- */

#define GLOSS \
    "\"reflection\": {\"coating\": 0.6, \"haze_share\": 0.5, \"haze_width\": 0.2," \
    "\"haze_power\": 1.6, \"floor_albedo\": 0.01, \"incidence_deg\": [10, 30, 50]," \
    "\"wavelengths_nm\": [450, 550, 650]}"
#define GLOSSY \
    "{" EMITTER "," GLOSS ", \"instrument\": {\"theta_step_deg\": 2, \"phi_step_deg\": 6," \
    "\"fwhm_deg\": 3}, \"places\": {\"u\": [0, 1], \"v\": [0, 1], \"haze_slope\": 1.2}}"

typedef struct Bin {
    double probability, count;
} Bin;

#define BINS_Z 12
#define BINS_PHI 24
#define FINE 24 /* quadrature in a bin, each way */

static int bin_of(Vec3 d) {
    double phi = atan2((double)d.y, (double)d.x);
    int z = (int)((double)d.z * BINS_Z), p = (int)((phi + PI) / (2 * PI) * BINS_PHI);
    return (z < BINS_Z ? z : BINS_Z - 1) * BINS_PHI + (p < BINS_PHI ? p : BINS_PHI - 1);
}

static void fill_probabilities(const PanelMix *mix, Vec3 wo, Bin *bin) {
    for (int z = 0; z < BINS_Z * FINE; z++)
        for (int p = 0; p < BINS_PHI * FINE; p++) {
            double c = (z + 0.5) / (BINS_Z * FINE), s = sqrt(1 - c * c);
            double phi = 2 * PI * (p + 0.5) / (BINS_PHI * FINE) - PI;
            Vec3 wi = vec3((float)(s * cos(phi)), (float)(s * sin(phi)), (float)c);
            bin[z / FINE * BINS_PHI + p / FINE].probability +=
                2 * PI * (double)panel_mix_pdf(mix, wo, wi) /
                (BINS_Z * FINE * (double)BINS_PHI * FINE);
        }
}

/* Directions are drawn as the density says, which is that of the mixture. */
TEST(a_mixture_is_the_sum_of_its_panels) {
    ENDS_BY(fixture_end) Fixture f;
    const float middle[2] = {0.5f, 0.5f};
    const int draws = 60000;
    fixture_start(&f, GLOSSY, NULL);
    PanelMix mix = panel_place_reflection(f.panel, middle);
    Wavelengths w = even_wavelengths(450, 12.5f);
    assert_int_equal(mix.count, 2);
    assert_near(mix.weight[0], 0.5f, 1e-5);
    for (int e = 0; e < 3; e++) {
        Vec3 wo = direction_deg(5 + 25 * e, 40 + 70 * e);
        Bin bin[BINS_Z * BINS_PHI] = {{0, 0}};
        double sum = 0, chi = 0;
        int used = 0;
        fill_probabilities(&mix, wo, bin);
        for (int i = 0; i < draws; i++) {
            float u[3] = {((float)i + 0.5f) / (float)draws, 0, 0}, pdf;
            Vec3 wi;
            uint32_t random = (uint32_t)i * 2654435761u + 17;
            for (int k = 1; k < 3; k++) u[k] = (float)steady_random(&random);
            if (!panel_mix_sample(&mix, wo, u, &wi, &pdf)) continue;
            assert_close((double)pdf, (double)panel_mix_pdf(&mix, wo, wi), 1e-3);
            bin[bin_of(wi)].count++;
        }
        for (int i = 0; i < BINS_Z * BINS_PHI; i++) {
            double wanted = bin[i].probability * draws, miss = bin[i].count - wanted;
            sum += bin[i].probability;
            if (wanted < 20) continue;
            chi += miss * miss / (wanted + 4e-4 * wanted * wanted); /* quadrature's own error */
            used++;
        }
        assert_near(sum, 1, 0.01);
        assert_true(used > 30);
        if (chi > used + 5 * sqrt(2.0 * used)) fail_msg("chi-square %g of %d bins", chi, used);
        for (int i = 0; i < 5; i++) { /* and the BRDF and the mirror are the panels' own */
            Vec3 wi = direction_deg(15.0 * i, 80.0 * i);
            Spectrum f0 = panel_brdf(mix.panel[0], wo, wi, &w);
            Spectrum f1 = panel_brdf(mix.panel[1], wo, wi, &w);
            Spectrum all = panel_mix_brdf(&mix, wo, wi, &w);
            Spectrum r = panel_mix_mirror(&mix, wo.z, &w);
            Spectrum r0 = panel_mirror(mix.panel[0], wo.z, &w);
            Spectrum r1 = panel_mirror(mix.panel[1], wo.z, &w);
            for (int k = 0; k < SPECTRUM_LANES; k++) {
                assert_close((double)all[k], 0.5 * (double)(f0[k] + f1[k]), 1e-5);
                assert_close((double)r[k], 0.5 * (double)(r0[k] + r1[k]), 1e-5);
            }
        }
    }
    assert_true(panel_has_mirror(f.panel));
}

/* As a surface: what comes back is no more than came, and sampling finds the same energy as
 * the albedo says. Truth in the middle: the BRDF is linear in the share of haze. */
TEST(a_mixture_reflects_as_the_display_does) {
    ENDS_BY(fixture_end) Fixture f;
    const float place[2] = {0.3f, 0.3f};
    const double at[2] = {0.3, 0.3};
    fixture_start(&f, GLOSSY, NULL);
    Wavelengths w = even_wavelengths(450, 12.5f);
    SyntheticPanel local = closed_form_at(&f.recipe, at);
    Bsdf bsdf = {.kind = BSDF_DISPLAY};
    bsdf.display = (DisplaySurface){
        .panel = f.panel, .wavelengths = &w, .mix = panel_place_reflection(f.panel, place)};
    for (int e = 0; e < 3; e++) {
        Vec3 wo = direction_deg(10 + 20 * e, 0);
        double sum = 0;
        for (int i = 0; i < 20000; i++) {
            uint32_t random = (uint32_t)i * 2654435761u + 5;
            BsdfSample s;
            float u[3];
            for (int k = 0; k < 3; k++) u[k] = (float)steady_random(&random);
            if (bsdf_sample(&bsdf, wo, u, &s)) sum += (double)s.weight[8] / 20000;
        }
        assert_true(sum < 1);
        assert_close(sum, (double)bsdf_albedo(&bsdf, wo)[8], 0.05);
        double theta[2] = {radians_from_degrees(10 + 20 * e), radians_from_degrees(18 + 20 * e)};
        float pdf;
        Vec3 wi = direction_deg(10 + 20 * e + 8, 180);
        double wanted = closed_form_brdf(&local, theta[1], theta[0], 0, 550);
        assert_close((double)bsdf_eval(&bsdf, wo, wi, &pdf)[8], wanted, 0.05);
    }
}

TEST_PROGRAM(start, fixture_group_end)
