/* SPDX-License-Identifier: Apache-2.0 */
/* A clear coat on both sides of a thin sheet: what their turns send back and on. */
#include "fixture.h"
#include "furnace_fixture.h"
#include "layer_fixture.h"

#include "shaders/layers/coating_tables.h"
#include "shaders/facets/coat.h"
#include "shaders/metallic/metallic_facet.h"
#include "spectrum/fresnel.h"

static Wavelengths wavelengths;
static SurfaceCoating one_sided; /* silver on the front alone */

static int make_tables(void **state) {
    make_arena(state);
    LayerStack *silver = stack_silver(test_memory());
    silver->faces = COATED_FRONT;
    one_sided.sheet = coating_of_sheet(silver, 1.52, test_memory());
    wavelengths_sample(0.4f, &wavelengths);
    return 0;
}

/* White, and under a whole coat. */
static MetallicRoughness sheet(float alpha, float coat_alpha) {
    MetallicRoughness m = metallic_roughness_default(&common_energy_table);
    m.metallic = 0;
    m.transmission = 1;
    m.alpha = alpha;
    m.clearcoat = 1;
    m.clearcoat_alpha = coat_alpha;
    m.clearcoat_energy = &common_energy_table;
    m.coat = &common_coat_table;
    m.wavelengths = &wavelengths;
    return m;
}

/* ---- smooth: a stack whose turns can be followed --------------------------------------- */

/* Light from above through two like layers that let pass `open`, about a sheet. */
static void follow_turns(double front, double rear, double through, double open, double out[2]) {
    double above = open, below = 0; /* what comes to the sheet from either side */
    out[0] = 1 - open;
    out[1] = 0;
    for (int i = 0; i < 1000; i++) {
        double up = front * above + through * below, down = through * above + rear * below;
        out[0] += open * up;
        out[1] += open * down;
        above = (1 - open) * up;
        below = (1 - open) * down;
    }
}

TEST(turns_are_summed_up) {
    for (int i = 0; i < 625; i++) {
        double front = 0.25 * (i % 5), rear = 0.25 * (i / 5 % 5), held = 0.2 * (i / 125 % 5);
        double through = 0.25 * (i / 25 % 5) * (1 - fmax(front, rear)), sent[2];
        SheetFaces faces = {spectrum_all((float)front), spectrum_all((float)rear),
                            spectrum_all((float)through)};
        SheetLight light = sheet_turns(&faces, (float)held);
        follow_turns(front, rear, through, 1 - held, sent);
        double pass = (1 - held) * (1 - held);
        assert_near(pass * (double)light.back[3], sent[0] - held, 2e-6);
        assert_near(pass * (double)light.through[3], sent[1], 2e-6);
    }
}

/* What the model gives for smooth sheets is that stack; how much light the coat lets pass is
 * its own table's affair, what it reflects itself, Fresnel's. */
static void pane_of(double cosine, double tint, double *reflected, double *passed) {
    double inside = sqrt(1 - (1 - cosine * cosine) / 2.25), t = pow(tint, 1 / inside);
    *reflected = *passed = 0;
    for (int is_p = 0; is_p < 2; is_p++) {
        double a = is_p ? 1.5 * cosine : cosine, b = is_p ? inside : 1.5 * inside;
        double r = (a - b) / (a + b) * ((a - b) / (a + b)), once = 1 - r * r * t * t;
        *reflected += (r + (1 - r) * (1 - r) * t * t * r / once) / 2;
        *passed += (1 - r) * (1 - r) * t / once / 2;
    }
}

TEST(a_smooth_sheet_is_a_stack_of_its_boundaries) {
    for (int i = 0; i < 60; i++) {
        float cosine = i % 20 ? 0.05f * (float)(i % 20) : 0.02f, share = i / 20 ? 0.6f : 1;
        float tint = i / 20 == 2 ? 0.5f : 1;
        MetallicRoughness m = sheet(0, 0);
        m.tint = spectrum_all(tint);
        m.clearcoat = share;
        Bsdf bsdf = {.kind = BSDF_METALLIC_ROUGHNESS, .metallic_roughness = m};
        Vec3 wo = vec3(safe_sqrtf(1 - cosine * cosine), 0, cosine);
        double f = (double)fresnel_unpolarised(cosine, 1.5f), pane, through, sent[2];
        double held = (double)coat_reflectance(m.clearcoat_energy, cosine, 0);
        double s = (double)share;
        pane_of((double)cosine, (double)tint, &pane, &through);
        follow_turns(pane, pane, through, 1 - held, sent);
        double back = s * (sent[0] - held + f) + (1 - s) * pane;
        assert_near(bsdf_mirror(&bsdf, wo)[5], back, 1e-4);
        assert_near(bsdf_pass(&bsdf, wo)[5], s * sent[1] + (1 - s) * through, 1e-4);
    }
}

/* ---- white furnaces ---------------------------------------------------------------------- */

static const float coats[] = {0, 0.01f, 0.1f, 0.35f, 1}, alphas[] = {0, 0.01f, 0.1f, 0.35f, 1};
static const double thetas_deg[] = {0, 30, 60, 75, 80, 85};

static void check_white(const MetallicRoughness *m, double theta_deg, double tolerance) {
    double sent = furnace_of(m, theta_deg, 40, furnace_side(m) == 48 ? 64 : 144);
    if (!(fabs(sent - 1) <= tolerance))
        fail_msg("metal %g, clear %g, alpha %g and %g, sheen %g, film %g, across %g under a "
                 "coat %g of %g, %g deg: %g",
                 (double)m->metallic, (double)m->transmission, (double)m->alpha,
                 (double)m->alpha_along, (double)m->overlay.color[0], (double)m->film.share,
                 (double)m->across, (double)m->clearcoat, (double)m->clearcoat_alpha, theta_deg,
                 sent);
}

TEST(a_coat_keeps_a_clear_and_a_frosted_sheet_white) {
    for (int i = 0; i < 150; i++) {
        MetallicRoughness m = sheet(alphas[i % 5], coats[i / 5 % 5]);
        if (i % 3 == 1) m.specular = 0;
        if (i % 7 == 1) m.clearcoat = 0.5f;
        if (i % 4 == 1) m.transmission = 0.5f;
        check_white(&m, thetas_deg[i / 25], 2e-3);
    }
}

/* Sheen, film, brushing, diffuse transmission and metal, by the bits of `layers`. */
static MetallicRoughness layered(int layers, float alpha, float coat_alpha) {
    MetallicRoughness m = sheet(alpha, coat_alpha);
    if (layers & 1) m.overlay.color[0] = m.overlay.color[1] = m.overlay.color[2] = 0.3f;
    if (layers & 1) m.overlay.alpha = 0.25f;
    if (layers & 2) m.film = (ThinFilm){.share = 1, .ior = 1.3f, .thickness_nm = 400};
    if (layers & 4 && !(layers & 1)) m.alpha_along = 0.5f * (1 + alpha);
    if (layers & 8) {
        m.across = 0.3f;
        m.across_color[0] = m.across_color[1] = m.across_color[2] = 1;
        m.transmission = 0.5f;
    }
    if (layers & 16) m.metallic = 0.4f;
    return m;
}

TEST(it_keeps_layered_sheets_white) {
    for (int i = 0; i < 32; i++) {
        int layers = i % 32;
        float alpha = alphas[(i * 7 + i / 32) % 5];
        if (layers & 4) alpha = fmaxf(alpha, 0.1f); /* finer brushing: within 0.3 % */
        MetallicRoughness m = layered(layers, alpha, coats[i % 5]);
        check_white(&m, thetas_deg[i * 5 / 3 % 6], 2e-3);
    }
    MetallicRoughness mixed = layered(1 | 2 | 8 | 16, 0.36f, 0);
    for (int t = 1; t < 6; t += 2) check_white(&mixed, thetas_deg[t], 2e-3);
}

/* ---- both sides -------------------------------------------------------------------------- */

static Spectrum across(MetallicRoughness m, Vec3 wo, Vec3 wi, bool from_back) {
    m.seen_from_back = from_back;
    Bsdf bsdf = {.kind = BSDF_METALLIC_ROUGHNESS, .metallic_roughness = m};
    float pdf;
    if (!from_back) return bsdf_eval(&bsdf, wo, wi, &pdf);
    return bsdf_eval(&bsdf, vec3(wi.x, wi.y, -wi.z), vec3(wo.x, wo.y, -wo.z), &pdf);
}

/* Also where the sheet's faces are unlike: its coat lies on both alike. */
TEST(as_much_goes_through_from_either_side) {
    for (int i = 0; i < 1000; i++) {
        Sampler sampler = sampler_start(3, i, 0, 0);
        Vec3 wo = random_direction(&sampler), wi = random_direction(&sampler);
        MetallicRoughness m = layered(i % 32, alphas[1 + i / 32 % 4], coats[i / 7 % 5]);
        m.tint = ramp(0.1f, 1);
        if (!(m.film.share > 0)) m.coating = &one_sided;
        wo.z = fmaxf(fabsf(wo.z), 1e-2f);
        wi.z = -fmaxf(fabsf(wi.z), 1e-2f);
        wo = vec3_normalize(wo);
        wi = vec3_normalize(wi);
        Spectrum a = across(m, wo, wi, false), b = across(m, wo, wi, true);
        for (int k = 0; k < SPECTRUM_LANES; k++) {
            assert_near(a[k], b[k], 1e-3 * (double)a[k] + 1e-6);
            assert_true(a[k] >= 0);
        }
        m.alpha = m.alpha_along = 0;
        Bsdf bsdf = {.kind = BSDF_METALLIC_ROUGHNESS, .metallic_roughness = m};
        Spectrum pass = bsdf_pass(&bsdf, wo);
        bsdf.metallic_roughness.seen_from_back = true;
        Spectrum back = bsdf_pass(&bsdf, wo);
        for (int k = 0; k < SPECTRUM_LANES; k++) assert_near(pass[k], back[k], 1e-6);
    }
}

TEST_PROGRAM(make_tables, drop_arena)
