/* SPDX-License-Identifier: Apache-2.0 */
/* Brushed surfaces: GGX of two alphas, and what its lobes send back in all. */
#include "furnace_fixture.h"

#include "base/units.h"
#include "shaders/facets/microfacet.h"
#include "shaders/facets/coat.h"

/* ---- the lobe --------------------------------------------------------------------------- */

TEST(equal_alphas_are_the_even_lobe) {
    static const float alphas[] = {0.002f, 0.05f, 0.3f, 1};
    for (int k = 0; k < 4; k++)
        for (uint32_t i = 0; i < 200; i++) {
            Sampler sampler = sampler_start(1, 2, k, i);
            Vec3 wo = random_direction(&sampler);
            Vec2 u = sampler_2d(&sampler), both = {alphas[k], alphas[k]};
            if (fabsf(wo.z) < 0.01f) continue;
            wo.z = fabsf(wo.z);
            Vec3 wi = ggx_sample_reflection(wo, alphas[k], u.x, u.y);
            Vec3 same = brushed_sample_reflection(wo, both, u.x, u.y);
            Vec3 half = vec3_normalize(vec3_add(wo, wi));
            assert_near(vec3_length(vec3_sub(wi, same)), 0, 2e-6);
            double pdf = (double)ggx_reflection_pdf(wo, half, alphas[k]);
            double lobe = (double)ggx_reflection(wo, wi, half, alphas[k]);
            assert_near(brushed_reflection_pdf(wo, half, both), pdf, 2e-3 * pdf);
            assert_near(brushed_reflection(wo, wi, half, both), lobe, 2e-3 * lobe);
        }
}

/* Of facets of slope m along x: D = 1 / (pi ax ay (1 + (m / ax)^2)^2 n_z^4), and no light is
 * hidden where eye and light stand above. */
TEST(the_lobe_is_longer_along_the_brushing) {
    const Vec2 alpha = {0.4f, 0.05f};
    const Vec3 up = {0, 0, 1};
    double peak = 1 / (4 * PI * 0.4 * 0.05);
    assert_near(brushed_reflection(up, up, up, alpha), peak, 1e-5 * peak);
    for (int axis = 0; axis < 2; axis++) {
        double own = axis ? 0.05 : 0.4, slope = own; /* at which D n_z^4 is a quarter */
        double z = 1 / sqrt(1 + slope * slope), cosine = 2 * z * z - 1;
        float x = (float)(slope * z), y = (float)(2 * slope * z * z);
        Vec3 half = axis ? vec3(0, x, (float)z) : vec3(x, 0, (float)z);
        Vec3 wi = axis ? vec3(0, y, (float)cosine) : vec3(y, 0, (float)cosine);
        double tangent2 = 1 / (cosine * cosine) - 1;
        double lambda = 0.5 * (sqrt(1 + own * own * tangent2) - 1);
        double wanted = peak / 4 / (z * z * z * z) / cosine / (1 + lambda);
        assert_near(brushed_reflection(up, wi, half, alpha), wanted, 1e-4 * wanted);
    }
}

/* ---- energy ----------------------------------------------------------------------------- */

static MetallicRoughness brushed(float metallic, float alpha, float strength) {
    MetallicRoughness m = metallic_roughness_default(&common_energy_table);
    m.metallic = metallic;
    m.alpha = alpha;
    m.alpha_along = lerpf(alpha, 1, strength * strength);
    m.clearcoat_energy = &common_energy_table;
    m.coat = &common_coat_table;
    return m;
}

static void check_white(const MetallicRoughness *m, double theta_deg, double phi_deg,
                        double allowed) {
    double sent = furnace_of(m, theta_deg, phi_deg, 48);
    if (!(fabs(sent - 1) <= allowed))
        fail_msg("metal %g, alpha %g by %g, coat %g of %g, %g deg at %g: %g", (double)m->metallic,
                 (double)m->alpha_along, (double)m->alpha, (double)m->clearcoat,
                 (double)m->clearcoat_alpha, theta_deg, phi_deg, sent);
}

static const float grooves[] = {0.001f, 0.01f, 0.04f, 0.16f, 0.5f};
static const float strengths[] = {0.05f, 0.3f, 0.6f, 0.8f, 1};
static const double thetas_deg[] = {0, 30, 60, 75, 85};
static const double phis_deg[] = {0, 30, 60, 80, 90};

/* Every so many of all 1250, by day a third of these. */
static void check_all(float coat, int step) {
    static const float coats[] = {0, 0.01f, 0.1f, 0.35f, 1};
    for (int i = 0; i < 1250; i += all_laws() ? step : 3 * step) {
        MetallicRoughness m = brushed((float)(i & 1), grooves[i / 2 % 5], strengths[i / 10 % 5]);
        m.clearcoat = coat;
        m.clearcoat_alpha = coats[i / step % 5];
        check_white(&m, thetas_deg[i / 50 % 5], phis_deg[i / 250], 2e-3);
    }
}

TEST(a_white_furnace_stays_white) {
    check_all(0, 7);
}

TEST(under_a_lacquer_it_stays_white) {
    check_all(1, 29);
}

TEST_PROGRAM(NULL, NULL)
