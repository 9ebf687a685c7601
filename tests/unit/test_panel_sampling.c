/* SPDX-License-Identifier: Apache-2.0 */
/* How a panel's reflection is sampled: densities that integrate to one and fit the samples. */
#include "panel_fixture.h"

#include "panel_bytes.h"

#include <float.h>

#include "base/sampler.h"
#include "hemisphere/geodesic.h"
#include "hemisphere/tree/sampling_tree_build.h"
#include "hemisphere/specular_frame.h"
#include "panel/query/panel_emission.h"
#include "panel/query/panel_file.h"
#include "panel/query/panel_open.h"
#include "panel/query/panel_opened.h"
#include "panel/query/panel_sampling.h"
#include "panel/fit/sampling_make.h"
#include "shaders/display.h"

typedef struct Case {
    const char *name;
    Panel *panel;
} Case;

#define CASES_MAX 5
static Fixture ips, narrow, brushed;
static Panel *shipped[2];
static Arena shipped_arena;
static Case cases[CASES_MAX];
static int case_count;

/* A haze of 1.5 degrees on a coarse grid of incidences. */
#define FIXTURE_NARROW \
    "{\"panel\": \"test narrow\", \"refractive_index\": 1.5, \"emission\": {" FIXTURE_SPECTRA \
    "\"gamma\": 2.2, \"cosine_power\": [1, 1], \"black_cd_m2\": 0, \"leak\": 0}," \
    "\"reflection\": {\"coating\": 0.6, \"coating_blue\": 0.15, \"haze_share\": 0.7," \
    "\"haze_width\": 0.03, \"haze_power\": 1.8, \"floor_albedo\": 0.004," \
    "\"incidence_deg\": [0, 20, 40, 60]," \
    "\"wavelengths_nm\": [420,450,480,510,540,570,600,630,660]}," \
    "\"instrument\": {\"theta_step_deg\": 3, \"phi_step_deg\": 10," \
    "\"brdf_theta_step_deg\": 0.5, \"brdf_phi_step_deg\": 3, \"fwhm_deg\": 1}}"

static void add_case(const char *name, Panel *panel) {
    cases[case_count++] = (Case){name, panel};
}

/* Haze twice as wide along the display's x as along its y; one wavelength. */
static double brushed_brdf(double theta_i, double phi_i, double theta, double phi) {
    double si = sin(theta_i), so = sin(theta);
    double x = so * cos(phi + phi_i - PI) + si * cos(phi_i);
    double y = so * sin(phi + phi_i - PI) + si * sin(phi_i);
    return 0.02 * pow(1 + x * x / 0.09 + y * y / 0.0225, -1.5) / 0.045 + 0.003;
}

static AngleTable brushed_table(double theta_i, double phi_i, Arena *arena) {
    enum { THETAS = 29, PHIS = 60, ROWS = (THETAS - 1) * PHIS + 1 };
    float *theta = ARENA_NEW(arena, float, ROWS), *phi = ARENA_NEW(arena, float, ROWS);
    float *value = ARENA_NEW(arena, float, ROWS);
    int n = 0;
    for (int i = 0; i < THETAS; i++)
        for (int k = 0; k < (i ? PHIS : 1); k++, n++) {
            theta[n] = (float)radians_from_degrees(3 * i);
            phi[n] = (float)radians_from_degrees(6 * k);
            value[n] = (float)brushed_brdf(theta_i, phi_i, (double)theta[n], (double)phi[n]);
        }
    return (AngleTable){.name = "table",
                        .rows = ROWS,
                        .channels = 1,
                        .theta = theta,
                        .phi = phi,
                        .value = value,
                        .theta_max = theta[ROWS - 1]};
}

/* Four incidences by eight azimuths of the light. */
static void start_brushed(const FitOptions *options) {
    fixture_folder(&brushed);
    Measurement *set = brushed.set = ARENA_NEW(&brushed.arena, Measurement, 1);
    set->file = set->panel = set->instrument = set->note = "";
    set->incidence_count = 4;
    set->azimuth_count = 8;
    set->wavelength_count = 1;
    set->wavelength_nm[0] = 550;
    set->brdf = ARENA_NEW(&brushed.arena, AngleTable, 32);
    for (int i = 0; i < 4; i++) set->incidence[i] = radians_from_degrees(5 + 18 * i);
    for (int a = 0; a < 8; a++) set->azimuth[a] = 2 * PI * a / 8;
    for (int t = 0; t < 32; t++)
        set->brdf[t] = brushed_table(set->incidence[t % 4], set->azimuth[t / 4], &brushed.arena);
    fixture_fit(&brushed, options);
}

static int start_panels(void **state) {
    (void)state;
    static const char *const paths[2] = {PROJECT_DIR "/assets/panels/ips_cluster.panel",
                                         PROJECT_DIR "/assets/panels/oled_centre.panel"};
    FitOptions options = fit_options_default();
    options.level = 5;
    options.basis = FIT_HAAR; /* fitted in no time; the shipped panels have the other one */
    options.force = true;     /* what its bound misses is another matter */
    fixture_start(&ips, FIXTURE_IPS, &options);
    add_case("anti-glare", ips.panel);
    start_brushed(&options);
    add_case("brushed", brushed.panel);
    options.level = 6;
    fixture_start(&narrow, FIXTURE_NARROW, &options);
    add_case("narrow", narrow.panel);
    shipped_arena = arena_reserve((size_t)1 << 30);
    for (int i = 0; i < 2; i++) {
        if (panel_open(paths[i], &shipped_arena, &shipped[i], why()))
            add_case(strrchr(paths[i], '/') + 1, shipped[i]);
        else print_message("skipped: %s: %s: %s\n", why()->file, why()->path, why()->text);
    }
    return 0;
}

static int end_panels(void **state) {
    (void)state;
    for (int i = 0; i < 2; i++) panel_close(shipped[i]);
    arena_release(&shipped_arena);
    fixture_end(&narrow);
    fixture_end(&brushed);
    fixture_end(&ips);
    return 0;
}

/* The same direction in the display's frame and in the tree's, the light at azimuth 180. */
static SpecularFrame frame_of(double theta) {
    return specular_frame((float)theta, PANEL_SAMPLING_EXPONENT);
}

/* wo at an azimuth, and a direction of the frame in which wo's azimuth is 180 degrees, turned
 * along. */
static Vec3 direction_at(double theta, double phi) {
    return vec3((float)(sin(theta) * cos(phi)), (float)(sin(theta) * sin(phi)), (float)cos(theta));
}

static Vec3 turned_by(Vec3 d, double phi) {
    float c = (float)cos(phi), s = (float)sin(phi);
    return vec3(c * d.x - s * d.y, s * d.x + c * d.y, d.z);
}

/* Density per solid angle of the stored frame at a stored direction; the pdf of the display's
 * frame diverges at the peak (integrably), its product with the Jacobian does not. */
static double stored_density(const Panel *panel, double theta, double phi, Vec3 stored) {
    SpecularFrame frame = frame_of(theta);
    Vec3 outer = specular_frame_outer(&frame, stored);
    return (double)panel_pdf(panel, direction_at(theta, phi), turned_by(outer, phi - PI)) *
           (double)specular_frame_jacobian(&frame, specular_frame_stored(&frame, outer));
}

static double density_integral(const Panel *panel, double theta, double phi) {
    enum { LEVEL = 6 };
    double sum = 0;
    for (uint32_t i = 0; i < geodesic_count(LEVEL); i++)
        sum +=
            stored_density(panel, theta, phi, geodesic_center(LEVEL, i)) * geodesic_area(LEVEL, i);
    return sum;
}

TEST(the_density_integrates_to_one) {
    for (int c = 0; c < case_count; c++)
        for (int k = 0; k < 16; k++) {
            double theta = radians_from_degrees(0.5 + 5.9 * k);
            double sum = density_integral(cases[c].panel, theta, 0.7 * k);
            if (!(fabs(sum - 1) <= 1e-3))
                fail_msg("%s at %g degrees: %.6f", cases[c].name, degrees_from_radians(theta), sum);
        }
}

/* How many standard deviations a chi-square value lies above its mean (Wilson, Hilferty). */
static double chi_square_z(double value, int freedom) {
    double a = 2.0 / (9 * freedom);
    return (cbrt(value / freedom) - (1 - a)) / sqrt(a);
}

enum { BIN_LEVEL = 2, FINE_LEVEL = 5, BINS = 4 << 2 * BIN_LEVEL, DRAWS = 12000, CHI_DRAWS = 5000 };

/* Probability of every bin of the stored frame. */
static void expected_bins(const Panel *panel, double theta, double phi, double *bins) {
    memset(bins, 0, BINS * sizeof *bins);
    for (uint32_t i = 0; i < geodesic_count(FINE_LEVEL); i++)
        bins[i >> 2 * (FINE_LEVEL - BIN_LEVEL)] +=
            stored_density(panel, theta, phi, geodesic_center(FINE_LEVEL, i)) *
            geodesic_area(FINE_LEVEL, i);
}

/* z of the counts; bins in which little is expected are taken together. */
static double compare_bins(const double *bins, const int *counts, int drawn) {
    double chi = 0, rest = 0;
    int freedom = -1, rest_count = 0;
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
    return chi_square_z(chi, freedom);
}

TEST(samples_fall_as_the_density_says) {
    Arena scratch = ips.arena;
    const Geodesic *geodesic = geodesic_create(BIN_LEVEL, &scratch);
    uint32_t random = 7;
    for (int k = 0; k < 64 * case_count; k++) {
        const Panel *panel = cases[k % case_count].panel;
        double theta = radians_from_degrees(0.3 + 1.38 * (k / case_count)), bins[BINS];
        double phi = 0.61 * k;
        int counts[BINS] = {0}, drawn = 0;
        SpecularFrame frame = frame_of(theta);
        Vec3 wo = direction_at(theta, phi);
        expected_bins(panel, theta, phi, bins);
        for (int i = 0; i < CHI_DRAWS; i++) {
            float u[3], pdf;
            Vec3 wi;
            for (int j = 0; j < 3; j++) u[j] = unit_float(hash_u32(random++));
            if (!panel_sample(panel, wo, u, &wi, &pdf)) continue;
            drawn++;
            wi = specular_frame_stored(&frame, turned_by(wi, PI - phi));
            counts[geodesic_find(geodesic, BIN_LEVEL, wi).id]++;
        }
        assert_true(drawn >= CHI_DRAWS - 20);
        double z = compare_bins(bins, counts, drawn);
        if (!(z < 4.5))
            fail_msg("%s, incidence %g degrees: chi-square is %.1f sigma above its mean",
                     cases[k % case_count].name, degrees_from_radians(theta), z);
    }
}

/* The whole display: its mirror as often as it says, the rest as display_eval's density; 64
 * incidences, each for blue, green and red light. */
TEST(displays_draw_mirror_and_haze_as_they_say) {
    Arena scratch = ips.arena;
    const Geodesic *geodesic = geodesic_create(BIN_LEVEL, &scratch);
    uint32_t random = 99;
    for (int k = 0; k < 64 * 3; k++) {
        Wavelengths w = even_wavelengths(420 + 90 * (float)(k % 3), 2);
        DisplaySurface display = {.panel = narrow.panel};
        panel_lanes(narrow.panel, &w, &display.lanes);
        double theta = radians_from_degrees(0.4 + 1.38 * (k / 3)), bins[BINS];
        int counts[BINS] = {0}, drawn = 0, mirrored = 0;
        float mirror = 0;
        SpecularFrame frame = frame_of(theta);
        Vec3 wo = direction_at(theta, PI);
        expected_bins(narrow.panel, theta, PI, bins);
        for (int i = 0; i < CHI_DRAWS / 2; i++) {
            BsdfSample s;
            float u[3];
            for (int j = 0; j < 3; j++) u[j] = unit_float(hash_u32(random++));
            if (!display_model.scatter.sample(&display, wo, u, &s)) continue;
            drawn++;
            mirrored += s.is_delta;
            if (s.is_delta) mirror = s.pdf;
            if (s.is_delta) continue;
            Vec3 stored = specular_frame_stored(&frame, s.wi);
            counts[geodesic_find(geodesic, BIN_LEVEL, stored).id]++;
        }
        double share = (double)mirror * drawn, z = compare_bins(bins, counts, drawn - mirrored);
        assert_true(drawn >= CHI_DRAWS / 2 - 20);
        if (!(z < 4.5) || !(fabs(mirrored - share) <= 4.5 * sqrt(share) + 0.5))
            fail_msg("%g degrees, %g nm: haze %.1f sigma off; mirror %d times, required: %.1f",
                     degrees_from_radians(theta), (double)w.nm[0], z, mirrored, share);
    }
}

/* What panel_sample says of its density is what panel_pdf says of the direction. */
TEST(samples_know_their_density) {
    uint32_t random = 77;
    for (int c = 0; c < case_count; c++) {
        int unlike = 0;
        for (int i = 0; i < DRAWS; i++) {
            float u[3], pdf;
            for (int j = 0; j < 3; j++) u[j] = unit_float(hash_u32(random++));
            Vec3 wo = direction_at(radians_from_degrees(0.02 + 0.004 * (i % 20000)), i), wi;
            if (!panel_sample(cases[c].panel, wo, u, &wi, &pdf)) continue;
            assert_true(pdf > 0 && isfinite(pdf));
            float seen = panel_pdf(cases[c].panel, wo, wi);
            unlike += fabsf(seen - pdf) > 2e-3f * pdf; /* at the very peak */
        }
        if (unlike > 1) fail_msg("%s: %d of %d differ", cases[c].name, unlike, DRAWS);
    }
}

/* ---- weights --------------------------------------------------------------------------- */

/* f cos / pdf over many samples. */
typedef struct Weights {
    double albedo, variance; /* luminous: mean, and relative variance */
    double furnace;          /* largest mean of a lane, the mirror included */
    double worst;            /* largest relative variance of a lane */
} Weights;

static Weights draw_weights(const Panel *panel, double theta, double phi, int draws) {
    Wavelengths w = even_wavelengths(420, 16);
    Vec3 wo = direction_at(theta, phi);
    Spectrum mirror = panel_mirror(panel, wo.z, &w);
    double sum[17] = {0}, squares[17] = {0}, eye[16], total = 0;
    for (int k = 0; k < 16; k++)
        total += eye[k] = (double)spectral_table[(int)w.nm[k] - SPECTRAL_FIRST_NM].y;
    for (int i = 0; i < draws; i++) {
        Sampler sampler = sampler_start(3, (int)(1e3 * theta), 0, (uint32_t)i);
        Vec2 a = sampler_2d(&sampler);
        float u[3] = {a.x, a.y, sampler_1d(&sampler)}, pdf;
        Vec3 wi;
        double luminous = 0;
        if (!panel_sample(panel, wo, u, &wi, &pdf)) continue;
        Spectrum f = panel_brdf(panel, wo, wi, &w) * spectrum_all(wi.z / pdf);
        for (int k = 0; k < 16; k++) {
            double value = (double)f[k];
            luminous += eye[k] / total * value;
            sum[k] += value;
            squares[k] += value * value;
        }
        sum[16] += luminous;
        squares[16] += luminous * luminous;
    }
    Weights out = {.albedo = sum[16] / draws,
                   .variance = draws * squares[16] / (sum[16] * sum[16]) - 1};
    for (int k = 0; k < 16; k++) {
        out.worst = fmax(out.worst, draws * squares[k] / (sum[k] * sum[k]) - 1);
        out.furnace = fmax(out.furnace, sum[k] / draws + (double)mirror[k]);
    }
    return out;
}

/* At incidences that have a tree and half way between: 0.035 up to 65 degrees, 0.1 to 80. */
TEST(weights_vary_little_at_every_incidence) {
    for (int c = 0; c < case_count; c++) {
        const PanelSampling *s = &cases[c].panel->sampling;
        double worst[2] = {0, 0}, furnace = 0, lane = 0;
        for (int k = 0; k < 2 * s->incidences - 1; k++) {
            double theta = 0.5 * (double)(s->theta[k / 2] + s->theta[(k + 1) / 2]);
            double deg = degrees_from_radians(theta);
            if (deg > 80.5) break;
            Weights found = draw_weights(cases[c].panel, fmax(theta, 1e-3), 0.37 * k, 6000);
            bool steep = deg > 65, is_coarse = cases[c].panel == brushed.panel;
            double most = steep ? 0.1 : is_coarse ? 0.08 : 0.035;
            worst[steep] = fmax(worst[steep], found.variance);
            furnace = fmax(furnace, found.furnace);
            lane = fmax(lane, steep ? 0 : found.worst);
            if (!(found.variance <= most) || !(found.furnace <= 1.001))
                fail_msg("%s at %.1f degrees: variance %.4f, furnace %.5f", cases[c].name, deg,
                         found.variance, found.furnace);
        }
        print_message("%s: %d x %d functions, %u cells; weights vary %.4f to 65 degrees (any "
                      "wavelength %.4f), %.4f to 80; furnace %.4f\n",
                      cases[c].name, s->incidences, s->azimuths, s->tree.cell_count, worst[0], lane,
                      worst[1], furnace);
    }
}

/* f cos / pdf averages to the albedo: wherever there is light the density is above zero. */
TEST(weights_average_to_the_albedo) {
    Wavelengths w = even_wavelengths(400, 20);
    uint32_t random = 3;
    for (int k = 0; k <= 8; k++) {
        double theta = radians_from_degrees(10 * k + 2), squares = 0;
        Vec3 wo = vec3((float)(sin(theta) * 0.6), (float)(sin(theta) * 0.8), (float)cos(theta));
        Spectrum sum = spectrum_all(0), albedo = spectrum_all(0);
        for (int i = 0; i < DRAWS; i++) {
            float u[3];
            Vec3 wi;
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
                Vec3 wi = direction_deg(0.5 * t + 0.25, 2 * p + 1);
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

static void expect_finite(Vec3 wo, Vec3 wi, const Wavelengths *w) {
    static const float us[][3] = {
        {0, 0, 0}, {0.9999999f, 0.9999999f, 0.9999999f}, {0.5f, 0, 1e-7f}};
    float rgb[3] = {255, 1, 0.1f}, xyz[3], pdf = panel_pdf(ips.panel, wo, wi);
    Spectrum f = panel_brdf(ips.panel, wo, wi, w);
    panel_emission_xyz(ips.panel, wo, rgb, xyz);
    if (!(pdf >= 0) || isinf(pdf) || !spectrum_is_finite(f) || !(spectrum_max_lane(f) >= 0) ||
        !isfinite(xyz[0] + xyz[1] + xyz[2]) ||
        !spectrum_is_finite(panel_emission_spectrum(ips.panel, wo, rgb, w)))
        fail_msg("wo %g %g %g, wi %g %g %g: pdf %g, f %g", (double)wo.x, (double)wo.y, (double)wo.z,
                 (double)wi.x, (double)wi.y, (double)wi.z, (double)pdf, (double)f[0]);
    for (int i = 0; i < 3; i++) {
        Vec3 drawn;
        if (!panel_sample(ips.panel, wo, us[i], &drawn, &pdf)) continue;
        assert_true(pdf > 0 && isfinite(pdf));
        assert_true(vec3_is_within(drawn, FLT_MAX) && drawn.z > 0);
        assert_near(vec3_length(drawn), 1, 1e-5);
    }
}

/* Poles, axes, exact mirror directions, and the horizon from very near. */
TEST(answers_are_finite_in_every_corner) {
    Wavelengths w = even_wavelengths(360, 31.3f);
    static const float heights[] = {1, 0.9999999f, 0.999f, 0.7f, 0.05f, 1e-3f, 1e-5f, 1e-20f};
    Vec3 corner[8 * 9];
    int count = 0;
    for (int h = 0; h < 8; h++)
        for (int p = 0; p < 9; p++) {
            float s = sqrtf(1 - heights[h] * heights[h]), sine, cosine;
            sincos_turns((float)p / 8 + (p == 8 ? 0.01f : 0), &sine, &cosine);
            corner[count++] = vec3(s * cosine, s * sine, heights[h]);
        }
    for (int i = 0; i < count; i++)
        for (int j = 0; j < count; j++) expect_finite(corner[i], corner[j], &w);
}

/* The path of a copy of this panel whose sampling section is renamed, or emptied. */
static const char *forged(const Fixture *of, bool is_emptied, Arena *arena) {
    PanelHeader header;
    FileBytes bytes = read_bytes(of->panel_path, arena);
    unsigned char *copy = arena_alloc(arena, 1, 64, bytes.size);
    memcpy(copy, bytes.data, bytes.size);
    memcpy(&header, copy, sizeof header);
    for (uint32_t i = 0; i < header.section_count; i++) {
        PanelSection section;
        unsigned char *at = copy + sizeof header + i * sizeof section;
        memcpy(&section, at, sizeof section);
        if (section.kind == PANEL_SAMPLING && is_emptied) section.size = 0;
        else if (section.kind == PANEL_SAMPLING) section.index = 1;
        memcpy(at, &section, sizeof section);
    }
    repair_checksum(copy, bytes.size);
    const char *path = arena_format(arena, "%s/without.panel", of->folder);
    write_bytes(path, copy, bytes.size);
    return path;
}

static void expect_forged_is_refused(const Fixture *of, bool is_emptied, const char *words) {
    Arena scratch = of->arena;
    Panel *panel;
    const char *path = forged(of, is_emptied, &scratch);
    assert_fails_as(panel_open(path, &scratch, &panel, &err), ERROR_INPUT, words);
}

/* Nothing of a reflection without its sampling: the file would light a scene wrongly. */
TEST(a_panel_without_its_sampling_is_refused) {
    expect_forged_is_refused(&ips, false, "without its sampling tree");
    expect_forged_is_refused(&ips, true, "sampling");
}

TEST_PROGRAM(start_panels, end_panels)
