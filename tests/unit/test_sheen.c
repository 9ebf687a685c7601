/* SPDX-License-Identifier: Apache-2.0 */
/* Sheen: the extension's formula, its albedo, and what cloth under it returns. */
#include "furnace_fixture.h"

#include "shaders/facets/coat.h"
#include "shaders/layers/sheen.h"

static Wavelengths wavelengths;

static int make_wavelengths(void **state) {
    (void)state;
    wavelengths_sample(0.4f, &wavelengths);
    return 0;
}

/* ---- the extension's text in doubles ----------------------------------------------------- */

static double fitted(double x, double alpha) {
    static const double at_1[] = {21.5473, 3.82987, 0.19823, -1.97760, -4.32054};
    static const double at_0[] = {25.3245, 3.32435, 0.16801, -1.27393, -4.85967};
    double p[5], t = (1 - alpha) * (1 - alpha);
    for (int i = 0; i < 5; i++) p[i] = at_1[i] + (at_0[i] - at_1[i]) * t;
    return p[0] / (1 + p[1] * pow(x, p[2])) + p[3] * x + p[4];
}

static double shadowing(double cosine, double alpha) {
    if (cosine < 0.5) return exp(fitted(cosine, alpha));
    return exp(2 * fitted(0.5, alpha) - fitted(1 - cosine, alpha));
}

static double formula(const double o[3], const double i[3], double alpha) {
    double h[3] = {o[0] + i[0], o[1] + i[1], o[2] + i[2]};
    double cosine2 = h[2] * h[2] / (h[0] * h[0] + h[1] * h[1] + h[2] * h[2]);
    double d = (2 + 1 / alpha) * pow(1 - cosine2, 0.5 / alpha) / (2 * PI);
    double shadows = 1 + shadowing(o[2], alpha) + shadowing(i[2], alpha);
    return d / (shadows * 4 * o[2] * i[2]);
}

static void direction(double cosine, double turn, double w[3]) {
    double side = sqrt(1 - cosine * cosine);
    w[0] = side * cos(2 * PI * turn);
    w[1] = side * sin(2 * PI * turn);
    w[2] = cosine;
}

static Vec3 single(const double w[3]) {
    return vec3((float)w[0], (float)w[1], (float)w[2]);
}

static const double roughnesses[] = {0.07, 0.1, 0.16, 0.25, 0.4, 0.55, 0.7, 0.9, 1};
#define ROUGHNESSES 9

TEST(the_lobe_is_the_extensions_formula) {
    for (int i = 0; i < ROUGHNESSES * 400; i++) {
        double alpha = roughnesses[i % ROUGHNESSES] * roughnesses[i % ROUGHNESSES], o[3], w[3];
        direction(0.1 + 0.9 * fmod(i * 0.618034, 1), 0, o);
        direction(0.1 + 0.9 * fmod(i * 0.754878, 1), fmod(i * 0.569840, 1), w);
        double wanted = formula(o, w, alpha);
        float full = sheen_lobe_full(single(o), single(w), (float)alpha);
        assert_near(full, wanted, 1e-4 * wanted + 1e-6);
        assert_true(full == sheen_lobe(&common_sheen_table, single(o), single(w), (float)alpha));
    }
}

TEST(nothing_comes_from_below) {
    Vec3 up = vec3(0.6f, 0, 0.8f), down = vec3(0.6f, 0, -0.8f);
    assert_true(sheen_lobe(&common_sheen_table, up, down, 0.3f) == 0);
    assert_true(sheen_lobe(&common_sheen_table, down, up, 0.3f) == 0);
}

/* ---- energy ------------------------------------------------------------------------------ */

/* Quadrature in the root of the cosine and the root of the turn. */
static double albedo_of(double cosine, double alpha) {
    enum { HEIGHTS = 300, TURNS = 120 };
    double o[3], w[3], sum = 0;
    direction(cosine, 0, o);
    for (int i = 0; i < HEIGHTS * TURNS; i++) {
        double root = (i / TURNS + 0.5) / HEIGHTS, turn = (i % TURNS + 0.5) / TURNS;
        direction(root * root, 0.5 * turn * turn, w);
        sum += root * root * root * 8 * PI * turn / (HEIGHTS * TURNS) *
               (double)sheen_lobe(&common_sheen_table, single(o), single(w), (float)alpha);
    }
    return sum;
}

TEST(its_albedo_is_as_tabulated) {
    for (int i = 0; i < ROUGHNESSES; i++)
        for (int k = 0; k < 9; k++) {
            static const double cosines[] = {0.005, 0.02, 0.045, 0.1, 0.17, 0.3, 0.5, 0.8, 1};
            double alpha = roughnesses[i] * roughnesses[i];
            double own = albedo_of(cosines[k], alpha);
            float told = sheen_albedo(&common_sheen_table, (float)cosines[k], (float)alpha);
            if (!(fabs((double)told - own) < 1e-3 && told <= 1))
                fail_msg("roughness %g, cosine %g: %g, by quadrature %g", roughnesses[i],
                         cosines[k], (double)told, own);
        }
}

static MetallicRoughness cloth(float metallic, float alpha, double roughness) {
    MetallicRoughness m = metallic_roughness_default(&common_energy_table);
    m.metallic = metallic;
    m.alpha = alpha;
    m.wavelengths = &wavelengths;
    m.clearcoat_energy = &common_energy_table;
    m.coat = &common_coat_table;
    m.overlay.color[0] = m.overlay.color[1] = m.overlay.color[2] = 1;
    m.overlay.alpha = (float)(roughness * roughness);
    return m;
}

static void check_white(const MetallicRoughness *m, double theta_deg) {
    double sent = furnace_of(m, theta_deg, 0, furnace_side(m) == 48 ? 64 : 144);
    if (!(fabs(sent - 1) <= 2e-3))
        fail_msg("metal %g, alpha %g, sheen alpha %g, coat %g of %g, %g deg: %g",
                 (double)m->metallic, (double)m->alpha, (double)m->overlay.alpha,
                 (double)m->clearcoat, (double)m->clearcoat_alpha, theta_deg, sent);
}

static const float alphas[] = {0, 0.01f, 0.1f, 0.35f, 1};
static const double thetas_deg[] = {0, 30, 60, 75, 85};

/* Every so many of all. */
static void check_cloths(float metallic, float clearcoat, int step) {
    static const float coats[] = {0, 0.01f, 0.1f, 0.35f, 1};
    for (int i = 0; i < 25 * ROUGHNESSES; i += step) {
        MetallicRoughness m = cloth(metallic, alphas[i % 5], roughnesses[i / 25]);
        m.clearcoat = clearcoat;
        m.clearcoat_alpha = coats[i / step % 5];
        check_white(&m, thetas_deg[i / 5 % 5]);
    }
}

TEST(a_white_furnace_stays_white) {
    check_cloths(0, 0, 1);
    check_cloths(1, 0, 1);
    check_cloths(0.5f, 0, 1);
}

TEST(under_a_lacquer_it_stays_white) {
    check_cloths(0, 1, 17);
    check_cloths(1, 1, 19);
}

/* A coloured sheen takes from a white base what its strongest primary reflects. */
TEST(a_coloured_sheen_darkens_what_is_beneath) {
    MetallicRoughness m = cloth(0, 1, 0.6);
    m.overlay.color[0] = 0.5f;
    m.overlay.color[1] = m.overlay.color[2] = 0;
    double own = (double)sheen_albedo(&common_sheen_table, 0.5f, m.overlay.alpha);
    Spectrum tint = spectrum_from_rgb(&wavelengths, m.overlay.color);
    double sent = furnace_of(&m, 60, 0, 64);
    assert_near(sent, 1 + own * ((double)tint[7] - 0.5), 2e-3);
}

TEST_PROGRAM(make_wavelengths, NULL)
