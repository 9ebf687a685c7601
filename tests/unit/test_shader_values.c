/* SPDX-License-Identifier: Apache-2.0 */
/* Surface models against published values and closed forms. */
#include "fixture.h"

#include "shader_fixture.h"

#include "base/arena.h"
#include "base/units.h"
#include "shaders/bsdf.h"
#include "spectrum/fresnel.h"
#include "shaders/facets/microfacet.h"

static Arena arena;
static const EnergyTable *glass;

static int build_table(void **state) {
    make_arena(state);
    arena = test_arena(state);
    glass = energy_table_build(1.5f, &arena);
    return 0;
}

typedef struct FresnelRow {
    double deg, mean, s, p, slab_t;
} FresnelRow;

/* Exact Fresnel reflectance and slab transmittance of glass, n = 1.52, no absorption. */
static const FresnelRow FRESNEL_TABLE[] = {
    {0, 0.042580, 0.042580, 0.042580, 0.918318},  {15, 0.042663, 0.046605, 0.038721, 0.918192},
    {30, 0.044144, 0.061209, 0.027078, 0.915957}, {45, 0.053045, 0.096733, 0.009357, 0.902528},
    {56.659, 0.078345, 0.156690, 0, 0.864536},    {60, 0.092483, 0.183438, 0.001527, 0.843471},
    {70, 0.174712, 0.307890, 0.041534, 0.724713}, {75, 0.256715, 0.407851, 0.105580, 0.614805},
    {80, 0.390950, 0.546363, 0.235537, 0.456043}, {85, 0.614923, 0.737674, 0.492173, 0.245646},
};

TEST(glass_reflects_as_fresnel_says) {
    for (size_t i = 0; i < sizeof FRESNEL_TABLE / sizeof *FRESNEL_TABLE; i++) {
        const FresnelRow *row = &FRESNEL_TABLE[i];
        float cosine = (float)cos(radians_from_degrees(row->deg)), behind;
        Fresnel face = fresnel_dielectric(cosine, 1.52f, &behind);
        ThinWindow pane = {.tint = spectrum_all(1), .ior = 1.52f};
        assert_near(face.s, row->s, 2e-6);
        assert_near(face.p, row->p, 2e-6);
        assert_near(fresnel_mean(face), row->mean, 2e-6);
        assert_near(thin_window_transmittance(&pane, cosine)[3], row->slab_t, 2e-6);
        assert_near(thin_window_reflectance(&pane, cosine)[3], 1 - row->slab_t, 2e-6);
        Fresnel inside = fresnel_dielectric(behind, 1 / 1.52f, NULL); /* the way back */
        assert_near(inside.s, face.s, 5e-6);
        assert_near(inside.p, face.p, 5e-6);
    }
}

/* R and T of two faces and one body that lets `tint` through along the normal. */
static void pane_shares(double cosine, double tint, double out[2]) {
    double inside = sqrt(1 - (1 - cosine * cosine) / 2.25), t = pow(tint, 1 / inside);
    out[0] = out[1] = 0;
    for (int is_p = 0; is_p < 2; is_p++) {
        double a = is_p ? 1.5 * cosine : cosine, b = is_p ? inside : 1.5 * inside;
        double r = (a - b) / (a + b) * ((a - b) / (a + b)), once = 1 - r * r * t * t;
        out[0] += (r + (1 - r) * (1 - r) * t * t * r / once) / 2;
        out[1] += (1 - r) * (1 - r) * t / once / 2;
    }
}

/* Whatever names the tint: a window, a sheet of glTF's surface that is not all clear, and one
 * seen facet by facet. */
TEST(tinted_panes_are_two_faces_and_one_body) {
    const double tints[] = {1, 0.5, 0.25, 0.1, 0};
    double upright[2];
    pane_shares(1, 0.5, upright);
    assert_near(upright[0], 0.049220, 1e-6);
    pane_shares(1, 0.1, upright);
    assert_near(upright[0], 0.040369, 1e-6);
    for (int i = 0; i < 5 * 18; i++) {
        double wanted[2], tint = tints[i % 5], angle = radians_from_degrees(5 * (i / 5));
        float cosine = (float)cos(angle), sine = (float)sin(angle);
        ThinWindow window = {.tint = spectrum_all((float)tint), .ior = 1.5f};
        Bsdf sheet = {.kind = BSDF_METALLIC_ROUGHNESS,
                      .metallic_roughness = metallic_roughness_default(&common_energy_table)};
        sheet.metallic_roughness.metallic = 0;
        sheet.metallic_roughness.alpha = 0;
        sheet.metallic_roughness.transmission = 1;
        sheet.metallic_roughness.tint = window.tint;
        pane_shares(cos(angle), tint, wanted);
        assert_near(thin_window_reflectance(&window, cosine)[3], wanted[0], 2e-6);
        assert_near(thin_window_transmittance(&window, cosine)[3], wanted[1], 2e-6);
        assert_near(bsdf_mirror(&sheet, vec3(sine, 0, cosine))[3], wanted[0], 2e-6);
        assert_near(bsdf_pass(&sheet, vec3(sine, 0, cosine))[3], wanted[1], 2e-6);
    }
}

TEST(light_is_totally_reflected_beyond_the_critical_angle) {
    float critical = sqrtf(1 - 1 / (1.5f * 1.5f)), behind;
    assert_near(fresnel_mean(fresnel_dielectric(critical - 1e-4f, 1 / 1.5f, &behind)), 1, 0);
    assert_near(behind, 0, 0);
    assert_true(fresnel_mean(fresnel_dielectric(critical + 1e-2f, 1 / 1.5f, NULL)) < 0.6f);
    assert_near(fresnel_mean(fresnel_dielectric(0, 1.5f, NULL)), 1, 0);
}

/* Value of the delta part that goes to `wi`: weight times probability, over a scan of u. */
static Spectrum delta_part(const Bsdf *bsdf, Vec3 wo, Vec3 wi) {
    for (int i = 0; i < 4000; i++) {
        float u[3] = {((float)i + 0.5f) / 4000, 0.5f, 0.5f};
        BsdfSample s;
        if (!bsdf_sample(bsdf, wo, u, &s) || !s.is_delta) continue;
        if (vec3_length(vec3_sub(s.wi, wi)) < 1e-3f) return s.weight * spectrum_all(s.pdf);
    }
    return spectrum_all(0);
}

static Bsdf smooth_bsdf(float metallic) {
    Bsdf bsdf = {.kind = BSDF_METALLIC_ROUGHNESS,
                 .metallic_roughness = metallic_roughness_default(glass)};
    bsdf.metallic_roughness.metallic = metallic;
    bsdf.metallic_roughness.alpha = 0;
    return bsdf;
}

TEST(smooth_metal_reflects_its_colour_at_normal_incidence) {
    Bsdf bsdf = smooth_bsdf(1);
    bsdf.metallic_roughness.base_color = ramp(0.2f, 0.95f);
    Spectrum f = delta_part(&bsdf, vec3(0, 0, 1), vec3(0, 0, 1));
    for (int k = 0; k < SPECTRUM_LANES; k++)
        assert_close(f[k], bsdf.metallic_roughness.base_color[k], 1e-5);
    f = delta_part(&bsdf, eye(4), vec3(-eye(4).x, -eye(4).y, eye(4).z));
    for (int k = 0; k < SPECTRUM_LANES; k++) {
        double f0 = (double)bsdf.metallic_roughness.base_color[k];
        assert_close(f[k], f0 + (1 - f0) * pow(0.95, 5), 1e-4);
    }
}

TEST(plastic_reflects_between_f0_and_specular) {
    Bsdf bsdf = smooth_bsdf(0);
    bsdf.metallic_roughness.specular = 0.5f;
    bsdf.metallic_roughness.specular_color = ramp(0.5f, 30);
    Vec3 up = vec3(0, 0, 1), low = vec3(sqrtf(1 - 1e-8f), 0, 1e-4f);
    Spectrum normal = delta_part(&bsdf, up, up);
    Spectrum grazing = delta_part(&bsdf, low, vec3(-low.x, 0, low.z));
    for (int k = 0; k < SPECTRUM_LANES; k++) {
        double tinted = 0.04 * (double)bsdf.metallic_roughness.specular_color[k];
        assert_close(normal[k], 0.5 * (tinted < 1 ? tinted : 1), 1e-5);
        assert_close(grazing[k], 0.5, 1e-3);
    }
}

TEST(plain_plastic_mirrors_by_the_exact_curve) {
    Bsdf bsdf = smooth_bsdf(0);
    for (int i = 0; i < EYE_COUNT; i++) {
        Vec3 wo = eye(i);
        Spectrum f = delta_part(&bsdf, wo, vec3(-wo.x, -wo.y, wo.z));
        assert_close(f[7], fresnel_mean(fresnel_dielectric(wo.z, 1.5f, NULL)), 1e-5);
    }
}

TEST(crossing_a_solid_twice_restores_radiance) {
    Bsdf glass_face = {.kind = BSDF_DIELECTRIC,
                       .dielectric = {.tint = spectrum_all(1), .ior = 1.5f}};
    Vec3 wo = vec3(0.6f, 0, 0.8f), inside = vec3(-0.4f, 0, -sqrtf(1 - 0.16f));
    Vec3 back = vec3_neg(inside);
    float f = fresnel_mean(fresnel_dielectric(0.8f, 1.5f, NULL));
    Spectrum in = delta_part(&glass_face, wo, inside);
    Spectrum out = delta_part(&glass_face, vec3(-back.x, back.y, -back.z), vec3(0.6f, 0, 0.8f));
    assert_close(in[0], (1 - f) / 2.25f, 1e-4);
    assert_close(out[0], (1 - f) * 2.25f, 1e-4);
}

TEST(tabulated_energy_is_the_lobe_s_own) {
    const float alphas[] = {0.003f, 0.02f, 0.1f, 0.33f, 0.6f, 0.95f};
    for (int a = 0; a < 6; a++)
        for (int c = 0; c < 40; c++) {
            float cosine = ((float)c + 0.5f) / 40, alpha = alphas[a];
            Vec3 wo = vec3(safe_sqrtf(1 - cosine * cosine), 0, cosine);
            double all = 0, shape = 0;
            for (uint32_t i = 0; i < 4096; i++) {
                Sampler sampler = sampler_start(1, 2, 3, i);
                Vec2 u = sampler_2d(&sampler);
                Vec3 wi = ggx_sample_reflection(wo, alpha, u.x, u.y);
                if (!(wi.z > 0)) continue;
                Vec3 half = vec3_normalize(vec3_add(wo, wi));
                double w = (double)(ggx_reflection(wo, wi, half, alpha) * wi.z /
                                    ggx_reflection_pdf(wo, half, alpha)) /
                           4096;
                float f = fresnel_mean(fresnel_dielectric(vec3_dot(wo, half), 1.5f, NULL));
                all += w;
                shape += w * ((double)f - 0.04) / 0.96;
            }
            Energy e = energy_directional(glass, cosine, alpha);
            assert_near(e.all, all, 4e-3);
            assert_near(e.shape, shape, 4e-3);
        }
}

TEST(visible_facets_are_all_there_is_to_see) {
    const float alphas[] = {0.05f, 0.3f, 1};
    for (int a = 0; a < 3; a++)
        for (int i = 0; i < 4; i++) { /* the projected area of visible facets is wo.z */
            double sum = 0;
            Vec3 wo = eye(i);
            for (int k = 0; k < 400 * 400; k++) {
                double rest = (k / 400 + 0.5) / 400, share = rest * rest;
                double angle = atan((double)alphas[a] * sqrt((1 - share) / share));
                double turn = 2 * PI * (k % 400 + 0.5) / 400;
                Vec3 h = vec3((float)(sin(angle) * cos(turn)), (float)(sin(angle) * sin(turn)),
                              (float)cos(angle));
                /* 1 - share is even under GGX's density D cos; its tail is stretched */
                double density = (double)ggx_density(h, alphas[a]) * cos(angle);
                sum += (double)ggx_visible_pdf(wo, h, alphas[a]) * 2 * rest / density / (400 * 400);
            }
            assert_close(sum, 1, 3e-3);
        }
}

TEST_PROGRAM(build_table, drop_arena)
