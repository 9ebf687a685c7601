/* SPDX-License-Identifier: Apache-2.0 */
/* Clear coat: what it holds back from the base comes out in the end. */
#include "fixture.h"
#include "furnace_fixture.h"
#include "layer_fixture.h"

#include "shaders/layers/coating_tables.h"
#include "shaders/facets/coat.h"
#include "spectrum/fresnel.h"

static const EnergyTable *glass;
static const CoatTable *lacquer;
static Wavelengths wavelengths;

static int make_tables(void **state) {
    make_arena(state);
    glass = energy_table_build(1.5f, test_memory());
    lacquer = coat_table_build(glass, glass, test_memory());
    wavelengths_sample(0.4f, &wavelengths);
    return 0;
}

/* A uniform surround of 1 is sent back whole by white plastic and white metal, whatever lies on
 * it, from 0 to 85 degrees. */
static void check_coated(float metallic, float alpha, double theta_deg) {
    static const float coats[] = {0, 0.01f, 0.1f, 0.35f, 1};
    MetallicRoughness m = metallic_roughness_default(glass);
    m.metallic = metallic;
    m.alpha = alpha;
    m.clearcoat_energy = glass;
    m.coat = lacquer;
    for (int c = 0; c < 5; c++) {
        m.clearcoat = c == 2 ? 0.6f : 1;
        m.clearcoat_alpha = coats[c];
        double coated = furnace_of(&m, theta_deg, 0, 48);
        if (!(fabs(coated - 1) <= 2e-3))
            fail_msg("metal %g, alpha %g under a coat of %g, %g deg: %g", (double)metallic,
                     (double)alpha, (double)coats[c], theta_deg, coated);
    }
}

TEST(a_coat_keeps_a_white_furnace_white) {
    static const float alphas[] = {0, 0.01f, 0.1f, 0.35f, 1};
    static const double thetas_deg[] = {0, 30, 60, 75, 80, 85};
    for (int a = 0; a < 5; a++)
        for (int metallic = 0; metallic < 2; metallic++)
            for (int t = 0; t < 6; t++) check_coated((float)metallic, alphas[a], thetas_deg[t]);
}

/* Between the rows of its tables too, alike and unlike roughness; what the 48 points a side
 * above show of so narrow a lobe is 0.35 % off by themselves. */
TEST(a_coat_keeps_it_white_between_its_tables_rows) {
    static const float alphas[] = {0.022f, 0.16f};
    for (int k = 0; k < 16; k++) {
        MetallicRoughness m = metallic_roughness_default(glass);
        m.metallic = (float)(k & 1);
        m.alpha = alphas[k >> 1 & 1];
        m.clearcoat = 1;
        m.clearcoat_alpha = alphas[k >> 2 & 1];
        m.clearcoat_energy = glass;
        m.coat = lacquer;
        double theta_deg = k >> 3 ? 85 : 71, coated = furnace_of(&m, theta_deg, 0, 144);
        if (!(fabs(coated - 1) <= 2e-3))
            fail_msg("metal %g, alpha %g under a coat of %g, %g deg: %g", (double)m.metallic,
                     (double)m.alpha, (double)m.clearcoat_alpha, theta_deg, coated);
    }
}

/* Brushing, sheen and film or coating under it, by three bits of `layers`. */
static MetallicRoughness layered(int layers, float metallic, float alpha,
                                 const SurfaceCoating *coating) {
    MetallicRoughness m = metallic_roughness_default(glass);
    m.metallic = metallic;
    m.alpha = alpha;
    m.clearcoat = 1;
    m.clearcoat_energy = glass;
    m.coat = lacquer;
    m.wavelengths = &wavelengths;
    if (layers & 1) m.alpha_along = 0.5f * (1 + alpha);
    if (layers & 2) m.overlay.color[0] = m.overlay.color[1] = m.overlay.color[2] = 1;
    if (layers & 2) m.overlay.alpha = 0.16f;
    if (layers & 4 && metallic > 0)
        m.film = (ThinFilm){.share = 1, .ior = 1.8f, .thickness_nm = 350};
    else if (layers & 4) m.coating = coating;
    return m;
}

ARENA_TEST(it_stays_white_over_all_layers_together) {
    static const float coats[] = {0, 0.1f, 0.5f}, alphas[] = {0.02f, 0.15f, 0.6f};
    static const double thetas_deg[] = {20, 60, 75, 85};
    const SurfaceCoating four = {.face =
                                     coating_of_face(stack_four(&arena), 1.5, ALPHA_ALL, &arena)};
    for (int i = 0; i < 36; i++) {
        int layers = i % 8 ? i % 8 : 7;
        float metallic = 0.5f * (float)(i % 3);
        MetallicRoughness m = layered(layers, metallic, alphas[i / 3 % 3], &four);
        m.clearcoat_alpha = coats[i / 9 % 3];
        double theta_deg = thetas_deg[i % 4];
        double sent = furnace_of(&m, theta_deg, 40 * i, furnace_side(&m));
        if (!(fabs(sent - 1) <= 2e-3))
            fail_msg("layers %d, metal %g, alpha %g under a coat of %g, %g deg: %g", layers,
                     (double)metallic, (double)m.alpha, (double)m.clearcoat_alpha, theta_deg, sent);
    }
}

/* The layer of albedo takes part in the turns: a coat makes a grey plastic darker. */
TEST(the_albedo_of_coated_plastic_is_what_it_sends_back) {
    for (int k = 0; k < 24; k++) {
        MetallicRoughness m = metallic_roughness_default(glass);
        m.metallic = 0;
        m.alpha = 0.3f;
        m.base_color = spectrum_all(0.1f + 0.2f * (float)(k % 4));
        m.clearcoat = k / 4 % 2 ? 1 : 0.5f;
        m.clearcoat_alpha = 0.2f;
        m.clearcoat_energy = glass;
        m.coat = lacquer;
        double theta_deg = 20 + 25.0 * (k / 8), t = radians_from_degrees(theta_deg);
        Bsdf bsdf = {.kind = BSDF_METALLIC_ROUGHNESS, .metallic_roughness = m};
        Vec3 wo = vec3((float)sin(t), 0, (float)cos(t));
        double sent = furnace_of(&m, theta_deg, 0, 48);
        double told = (double)bsdf_albedo(&bsdf, wo)[7];
        if (!(fabs(told - sent) <= 5e-3))
            fail_msg("colour %g, coat %g, %g deg: albedo %g, furnace %g", (double)m.base_color[7],
                     (double)m.clearcoat, theta_deg, told, sent);
    }
}

/* A mirror under a smooth coat is what the series of their turns gives, whatever its colour. */
TEST(a_coated_mirror_sums_up_its_turns) {
    for (float colour = 0; colour <= 1; colour += 0.25f)
        for (int i = 1; i <= 10; i++) {
            MetallicRoughness m = metallic_roughness_default(glass);
            float cosine = 0.1f * (float)i, f = fresnel_unpolarised(cosine, 1.5f);
            m.alpha = 0;
            m.base_color = spectrum_all(colour);
            m.clearcoat = 1;
            m.clearcoat_energy = glass;
            m.coat = lacquer;
            Vec3 wo = vec3(safe_sqrtf(1 - cosine * cosine), 0, cosine);
            Bsdf bsdf = {.kind = BSDF_METALLIC_ROUGHNESS, .metallic_roughness = m};
            float metal = spectrum_mean(fresnel_schlick(m.base_color, cosine));
            float mean = colour + (1 - colour) / 21; /* of its further turns */
            double sum = 0;
            for (int k = 0; k < 200; k++) {
                float u[3] = {((float)k + 0.5f) / 200, 0.5f, 0.5f};
                BsdfSample s;
                if (bsdf_sample(&bsdf, wo, u, &s)) sum += (double)s.weight[3] / 200;
            }
            double series = (double)(f + (1 - f) * (1 - f) * metal / (1 - mean * f));
            assert_near(sum, series, 6e-3);
        }
}

/* A non-metal of that reflectance at normal incidence. */
static MetallicRoughness dielectric(float f0, float base, float alpha) {
    MetallicRoughness m = metallic_roughness_default(glass);
    m.metallic = 0;
    m.specular_color = spectrum_all(f0 / fresnel_normal(1.5f));
    m.base_color = spectrum_all(base);
    m.alpha = alpha;
    m.clearcoat = 1;
    m.clearcoat_energy = glass;
    m.coat = lacquer;
    return m;
}

/* Its facets follow all turns, and the Lambert base is coupled to what they leave. */
TEST(a_coat_keeps_white_of_any_reflectance_white) {
    static const float f0s[] = {0.2f, 0.5f, 0.8f, 1}, alphas[] = {0, 0.1f, 0.35f, 1};
    static const float coats[] = {0, 0.1f, 0.5f};
    static const double thetas_deg[] = {0, 40, 65, 80, 85};
    for (int i = 0; i < 4 * 4 * 3 * 5; i++) {
        MetallicRoughness m = dielectric(f0s[i % 4], 1, alphas[i / 4 % 4]);
        m.clearcoat_alpha = coats[i / 16 % 3];
        double theta_deg = thetas_deg[i / 48], sent = furnace_of(&m, theta_deg, 0, 96);
        if (!(fabs(sent - 1) <= 1e-3))
            fail_msg("F0 %g, alpha %g under a coat of %g, %g deg: %g", (double)f0s[i % 4],
                     (double)m.alpha, (double)m.clearcoat_alpha, theta_deg, sent);
    }
}

/* Over a black base nothing hides a turn that is left out: a face that reflects all sends back
 * all, as a white metal does. */
TEST(a_coated_face_that_reflects_all_is_a_white_metal) {
    static const float alphas[] = {0, 0.02f, 0.1f}, coats[] = {0, 0.1f, 0.5f};
    static const double thetas_deg[] = {0, 40, 65, 80};
    for (int i = 0; i < 3 * 3 * 4; i++) {
        MetallicRoughness m = dielectric(1, 0, alphas[i % 3]), metal = m;
        m.clearcoat_alpha = metal.clearcoat_alpha = coats[i / 3 % 3];
        metal.metallic = 1;
        metal.base_color = spectrum_all(1);
        double theta_deg = thetas_deg[i / 9], face = furnace_of(&m, theta_deg, 0, 96);
        double whole = furnace_of(&metal, theta_deg, 0, 96);
        Vec3 wo = vec3((float)sin(radians_from_degrees(theta_deg)), 0,
                       (float)cos(radians_from_degrees(theta_deg)));
        double hidden = 1 - (double)energy_directional(glass, wo.z, m.alpha).all;
        if (!(fabs(face + hidden - whole) <= 1e-3 + hidden))
            fail_msg("alpha %g under a coat of %g, %g deg: %g, metal %g", (double)m.alpha,
                     (double)m.clearcoat_alpha, theta_deg, face, whole);
    }
}

/* A smooth black one under a smooth coat: the series of their turns. */
TEST(a_coated_dielectric_sums_up_its_turns) {
    for (float f0 = 0.2f; f0 <= 1; f0 += 0.2f)
        for (int i = 1; i <= 10; i++) {
            float cosine = 0.1f * (float)i, f = fresnel_unpolarised(cosine, 1.5f), t = 1 - f;
            MetallicRoughness m = dielectric(f0, 0, 0);
            double face = (double)(f0 + (1 - f0) * fresnel_shape(1.5f, cosine));
            double mean = (double)(f0 + (1 - f0) * energy_average(glass, 0).shape);
            double theta_deg = acos((double)cosine) / radians_from_degrees(1);
            double series = (double)f + (double)(t * t) * face / (1 - mean * (double)f);
            assert_near(furnace_of(&m, theta_deg, 0, 48), series, 1e-3);
        }
}

TEST(the_programs_own_tables_are_those_that_a_run_would_make) {
    assert_float_equal(CLEARCOAT_IOR, 1.5f, 0);
    assert_memory_equal(&common_energy_table, glass, sizeof *glass);
    assert_memory_equal(&common_coat_table, lacquer, sizeof *lacquer);
}

TEST_PROGRAM(make_tables, drop_arena)
