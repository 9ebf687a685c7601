/* SPDX-License-Identifier: Apache-2.0 */
/* glTF's surface and displays among the models that obey all laws. */
#include "bsdf_laws.h"
#include "fixture.h"
#include "layer_fixture.h"

#include "panel/query/panel_open.h"
#include "shaders/bsdf.h"
#include "shaders/layers/coating_tables.h"
#include "shaders/facets/microfacet.h"

static Arena arena;
static const EnergyTable *glass, *diamond, *perfect, *nothing;
static const CoatTable *lacquer;
static Wavelengths wavelengths;

static MetallicRoughness *add_model(const char *name, float metallic, float alpha, bool lossless) {
    Model *model = &models[model_count++];
    *model = (Model){.name = name,
                     .bsdf.kind = BSDF_METALLIC_ROUGHNESS,
                     .lossless = lossless,
                     .width = alpha < SMOOTH_ALPHA ? 1 : alpha};
    MetallicRoughness *m = &model->bsdf.metallic_roughness;
    *m = metallic_roughness_default(glass);
    m->metallic = metallic;
    m->alpha = alpha;
    m->clearcoat_energy = glass;
    m->coat = lacquer;
    return m;
}

static void add_plastics(void) {
    add_model("white plastic, alpha 1", 0, 1, true);
    add_model("white plastic, alpha 0.3", 0, 0.3f, true);
    add_model("white plastic, alpha 0.05", 0, 0.05f, true);
    add_model("white plastic, alpha 0.01", 0, 0.01f, true);
    add_model("white smooth plastic", 0, 0, true);
    add_model("dark plastic", 0, 0.1f, false)->base_color = ramp(0.01f, 0.3f);
    add_model("white, no mirror", 0, 0.2f, true)->specular = 0;
    add_model("white, index 1", 0, 0.2f, true)->energy = nothing;
    add_model("white, index 2.4", 0, 0.2f, true)->energy = diamond;
    add_model("white, index 0", 0, 0.4f, false)->energy = perfect;
    MetallicRoughness *m = add_model("coloured mirror on plastic", 0, 0.15f, false);
    m->specular_color = ramp(0.1f, 40);
    m->specular = 0.7f;
    m->base_color = ramp(0.9f, 0.1f);
}

static void add_metals(void) {
    add_model("white metal, alpha 1", 1, 1, true);
    add_model("white metal, alpha 0.5", 1, 0.5f, true);
    add_model("white metal, alpha 0.1", 1, 0.1f, true);
    add_model("white metal, alpha 0.02", 1, 0.02f, true);
    add_model("white metal, alpha 0.002", 1, 0.002f, true);
    add_model("smooth gold", 1, 0, false)->base_color = ramp(0.3f, 0.97f);
    add_model("rough gold", 1, 0.4f, false)->base_color = ramp(0.3f, 0.97f);
    add_model("black metal", 1, 0.2f, false)->base_color = spectrum_all(0);
    add_model("half metal", 0.5f, 0.2f, true);
}

static void add_panes(void) {
    add_model("smooth clear sheet", 0, 0, true)->transmission = 1;
    add_model("smooth half clear sheet", 0, 0, true)->transmission = 0.5f;
    add_model("frosted sheet", 0, 0.3f, true)->transmission = 1;
    add_model("black frosted sheet", 0, 0.2f, false)->transmission = 1;
    models[model_count - 1].bsdf.metallic_roughness.tint = spectrum_all(0);
    add_model("smooth tinted sheet", 0, 0, false)->transmission = 0.9f;
    models[model_count - 1].bsdf.metallic_roughness.tint = ramp(0, 1);
    MetallicRoughness *m = add_model("coloured frosted sheet", 0.2f, 0.1f, false);
    m->transmission = 0.6f;
    m->base_color = m->tint = ramp(0.2f, 0.9f);
    m->clearcoat = 0.5f;
    m->clearcoat_alpha = 0.05f;
}

/* White in all: what does not go back goes across. */
static MetallicRoughness *add_translucent(const char *name, float alpha, float across,
                                          bool lossless) {
    MetallicRoughness *m = add_model(name, 0, alpha, lossless);
    m->across = across;
    m->across_color[0] = m->across_color[1] = m->across_color[2] = 1;
    m->wavelengths = &wavelengths;
    return m;
}

static void add_translucents(void) {
    add_translucent("white paper", 1, 0.4f, true)->specular = 0;
    add_translucent("opal plastic, alpha 0.3", 0.3f, 0.5f, true);
    add_translucent("smooth opal plastic", 0, 1, true);
    add_translucent("opal under lacquer", 0.3f, 0.5f, true)->clearcoat = 1;
    MetallicRoughness *m = add_translucent("opal under rough lacquer", 0.5f, 0.7f, true);
    m->clearcoat = 0.6f;
    m->clearcoat_alpha = 0.3f;
    models[model_count - 1].width = 0.3f;
    m = add_translucent("leaf", 0.2f, 0.6f, false);
    m->base_color = ramp(0.02f, 0.2f);
    m->across_color[0] = 0.1f;
    m->across_color[2] = 0;
    m = add_translucent("leaf and frosted sheet and metal", 0.3f, 0.6f, false);
    m->metallic = 0.2f;
    m->transmission = 0.4f;
    m->clearcoat = 0.3f;
    m->across_color[1] = 0.5f;
}

static void add_lacquers(void) {
    MetallicRoughness *m = add_model("piano lacquer", 0, 0.5f, false);
    m->base_color = ramp(0.01f, 0.03f);
    m->clearcoat = 1;
    m = add_model("white under smooth lacquer", 0, 0.3f, true);
    m->clearcoat = 1;
    m = add_model("white smooth chrome under lacquer", 1, 0, true);
    m->clearcoat = 1;
    m = add_model("half metal under rough lacquer", 0.5f, 0.5f, true);
    m->clearcoat = 1;
    m->clearcoat_alpha = 0.5f;
    models[model_count - 1].width = 0.5f;
    m = add_model("gold under lacquer", 1, 0.3f, false);
    m->base_color = ramp(0.3f, 0.97f);
    m->clearcoat = 1;
    m = add_model("white under rough lacquer", 0, 0.3f, true);
    m->clearcoat = 0.8f;
    m->clearcoat_alpha = 0.1f;
    models[model_count - 1].width = 0.1f;
    m = add_model("chrome under tilted lacquer", 1, 0.2f, false);
    m->clearcoat = 1;
    m->clearcoat_alpha = 0.2f;
    m->clearcoat_normal = vec3_normalize(vec3(0.3f, -0.2f, 1));
    m = add_model("plastic under tilted smooth lacquer", 0, 0.2f, false);
    m->clearcoat = 1;
    m->clearcoat_normal = vec3_normalize(vec3(-0.4f, 0.1f, 1));
}

/* ---- coated ---------------------------------------------------------------------------- */

static SurfaceCoating mirror_metal, silver_metal, plastic, frosted;

static MetallicRoughness *add_coated(const char *name, float metallic, float alpha, bool lossless,
                                     const SurfaceCoating *coating) {
    MetallicRoughness *m = add_model(name, metallic, alpha, lossless);
    m->coating = coating;
    m->wavelengths = &wavelengths;
    return m;
}

static void add_coated_surfaces(void) {
    const LayerStack *four = stack_four(&arena);
    const OpticalConstants *ideal = constants_of(0, 4, &arena);
    const OpticalConstants *real = constants_of(0.06, 3.6, &arena);
    mirror_metal.metal = coating_of_metal(four, ideal, &arena);
    silver_metal.metal = coating_of_metal(NULL, real, &arena);
    plastic.metal = mirror_metal.metal;
    plastic.face = coating_of_face(four, 1.5, ALPHA_ALL, &arena);
    frosted.sheet = coating_of_sheet(four, 1.52, &arena);
    add_coated("ideal metal, coated, alpha 0.5", 1, 0.5f, true, &mirror_metal);
    add_coated("ideal metal, coated, alpha 0.05", 1, 0.05f, true, &mirror_metal);
    add_coated("smooth silver", 1, 0, false, &silver_metal);
    add_coated("silver under lacquer", 1, 0.2f, false, &silver_metal)->clearcoat = 1;
    add_coated("coated plastic, alpha 0.3", 0, 0.3f, true, &plastic);
    add_coated("coated plastic, alpha 0.02", 0, 0.02f, true, &plastic);
    add_coated("coated half metal", 0.5f, 0.2f, true, &plastic);
    MetallicRoughness *opal = add_coated("coated opal plastic", 0, 0.3f, true, &plastic);
    opal->across = 0.5f;
    opal->across_color[0] = opal->across_color[1] = opal->across_color[2] = 1;
    add_coated("coated frosted sheet", 0, 0.3f, true, &frosted)->transmission = 1;
    add_coated("coated smooth sheet, mixed", 0.3f, 0, false, &frosted)->transmission = 1;
    MetallicRoughness *smoked = add_coated("coated smoked sheet", 0, 0.2f, false, &frosted);
    smoked->transmission = 1;
    smoked->tint = ramp(0.1f, 0.7f);
}

#include "khr_models.h"
static int make_models(void **state) {
    make_arena(state);
    arena = test_arena(state);
    glass = energy_table_build(1.5f, &arena);
    diamond = energy_table_build(2.4f, &arena);
    perfect = energy_table_build(0, &arena);
    nothing = energy_table_build(1, &arena);
    lacquer = coat_table_build(glass, glass, &arena);
    add_plastics();
    add_metals();
    wavelengths_sample(0.3f, &wavelengths);
    add_panes();
    add_translucents();
    add_lacquers();
    add_coated_surfaces();
    add_brushed();
    add_films();
    add_cloths();
    add_lacquered_sheets();
    return 0;
}

/* Roughness just above and just below the threshold must look alike. */
TEST(a_narrow_lobe_sends_what_a_mirror_sends) {
    for (int metallic = 0; metallic < 2; metallic++)
        for (int i = 0; i < 4; i++) {
            Model mirror = {.bsdf.kind = BSDF_METALLIC_ROUGHNESS}, narrow;
            mirror.bsdf.metallic_roughness = metallic_roughness_default(glass);
            mirror.bsdf.metallic_roughness.metallic = (float)metallic;
            mirror.bsdf.metallic_roughness.alpha = 0;
            mirror.bsdf.metallic_roughness.base_color = ramp(0, 0.5f);
            narrow = mirror;
            narrow.bsdf.metallic_roughness.alpha = 0.0011f;
            Spectrum a = furnace(&mirror, eye(i), 8192), b = furnace(&narrow, eye(i), 8192);
            for (int k = 0; k < SPECTRUM_LANES; k++) assert_near(a[k], b[k], 4e-3);
        }
}

/* ---- measured displays --------------------------------------------------------------- */

static void mirror_is_where_it_belongs(const Model *model, Vec3 wo) {
    int mirrors = 0;
    for (uint32_t i = 0; i < 500; i++) {
        Sampler sampler = sampler_start(3, 4, 5, i);
        BsdfSample s;
        float u[3];
        draw(&sampler, u);
        if (!bsdf_sample(&model->bsdf, wo, u, &s) || !s.is_delta) continue;
        assert_near(vec3_length(vec3_sub(s.wi, vec3(-wo.x, -wo.y, wo.z))), 0, 1e-6);
        assert_false(s.passes);
        mirrors++;
    }
    assert_true(mirrors > 0 || !strstr(model->name, "oled"));
}

/* Of GGX facets that spread a mirror to so wide a lobe. */
static float alpha_of(float width_deg) {
    return (float)(tan((double)(width_deg * PI_F / 720)) / sqrt(sqrt(2.0) - 1));
}

static void finish_is_reciprocal(const Model *model, Vec3 wo) {
    Model only = *model; /* haze is so only as far as it was measured */
    float pdf;
    Vec3 wi = vec3_normalize(vec3(0.1f - wo.x, 0.05f - wo.y, wo.z));
    only.bsdf.display.matte = 0;
    Spectrum there = bsdf_eval(&model->bsdf, wo, wi, &pdf) - bsdf_eval(&only.bsdf, wo, wi, &pdf);
    Spectrum back = bsdf_eval(&model->bsdf, wi, wo, &pdf) - bsdf_eval(&only.bsdf, wi, wo, &pdf);
    for (int i = 0; i < SPECTRUM_LANES; i++)
        assert_near(there[i], back[i], 1e-3f * there[i] + 1e-6f);
}

/* A matte finish spreads the mirror: up to 60 degrees as much comes back as before, and never
 * more. */
static void finish_keeps_energy(Model model) {
    static const struct {
        float width_deg, matte, doubt;
    } FINISH[] = {{2, 0.6f, 0.01f}, {8, 1, 0.01f}, {20, 0.6f, 0.045f}};
    for (int w = 0; w < 3; w++)
        for (int k = 0; k < EYE_COUNT; k++) {
            model.bsdf.display.matte = 0;
            Spectrum clear = furnace(&model, eye(k), 8192);
            model.bsdf.display.matte = FINISH[w].matte;
            model.bsdf.display.matte_alpha = alpha_of(FINISH[w].width_deg);
            sample_agrees(&model, eye(k));
            finish_is_reciprocal(&model, eye(k));
            Spectrum matte = furnace(&model, eye(k), 8192);
            for (int i = 0; i < SPECTRUM_LANES; i++) {
                if (eye(k).z >= 0.499f) assert_near(matte[i], clear[i], FINISH[w].doubt * clear[i]);
                assert_true(matte[i] <= 1.01f * clear[i]);
            }
        }
}

TEST(shipped_displays_obey_the_same_laws) {
    static const char *const names[] = {"ips_cluster", "oled_centre"};
    int found = 0;
    for (int i = 0; i < 2; i++) {
        char path[1024];
        Panel *panel;
        snprintf(path, sizeof path, "%s/assets/panels/%s.panel", PROJECT_DIR, names[i]);
        FILE *file = fopen(path, "rb");
        if (!file) continue;
        fclose(file);
        assert_done(panel_open(path, &arena, &panel, &err));
        Model model = {.name = names[i],
                       .width = 0.05f,
                       .bsdf.kind = BSDF_DISPLAY,
                       .bsdf.display.panel = panel};
        panel_lanes(panel, &wavelengths, &model.bsdf.display.lanes);
        for (int k = 0; k < EYE_COUNT; k++) {
            sample_agrees(&model, eye(k));
            mirror_is_where_it_belongs(&model, eye(k));
            energy_holds(&model, eye(k));
            albedo_is_near(&model, eye(k));
        }
        finish_keeps_energy(model);
        model.bsdf.display.cover = coating_of_cover(stack_silver(&arena), 1.5, &arena)->front;
        model.bsdf.display.wavelengths = &wavelengths;
        for (int k = 0; k < EYE_COUNT; k++) {
            sample_agrees(&model, eye(k));
            energy_holds(&model, eye(k));
            albedo_is_near(&model, eye(k));
        }
        assert_true(bsdf_scatters(&model.bsdf));
        assert_true(spectrum_is_zero(bsdf_pass(&model.bsdf, eye(1))));
        panel_close(panel);
        found++;
    }
    if (!found) skip();
}
TEST_PROGRAM(make_models, drop_arena)
