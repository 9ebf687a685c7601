/* SPDX-License-Identifier: Apache-2.0 */
/* khr_models.h -- more rows for test_shaders.c: surfaces of glTF's later extensions. It stands
 * behind that file's add_model. */
#pragma once

static void add_brushed(void) {
    add_model("brushed white metal", 1, 0.05f, true)->alpha_along = 0.4f;
    add_model("brushed white metal, across x", 1, 0.6f, true)->alpha_along = 0.1f;
    models[model_count - 1].width = 0.1f;
    MetallicRoughness *m = add_model("finely brushed gold", 1, 0.02f, false);
    m->alpha_along = 0.5f;
    m->base_color = ramp(0.3f, 0.97f);
    add_model("brushed white plastic", 0, 0.1f, true)->alpha_along = 0.5f;
    m = add_model("brushed frosted sheet", 0, 0.1f, true);
    m->alpha_along = 0.3f;
    m->transmission = 1;
    m = add_model("brushed half metal under lacquer", 0.5f, 0.1f, true);
    m->alpha_along = 0.5f;
    m->clearcoat = 1;
    m = add_coated("coated brushed half metal", 0.5f, 0.1f, true, &plastic);
    m->alpha_along = 0.5f;
}

static MetallicRoughness *add_filmed(const char *name, float metallic, float alpha, bool lossless) {
    MetallicRoughness *m = add_model(name, metallic, alpha, lossless);
    m->film = (ThinFilm){.share = 1, .ior = 1.8f, .thickness_nm = 350};
    m->wavelengths = &wavelengths;
    return m;
}

static void add_films(void) {
    add_filmed("filmed white metal, alpha 0.3", 1, 0.3f, true);
    add_filmed("smooth filmed gold", 1, 0, false)->base_color = ramp(0.3f, 0.97f);
    add_filmed("filmed white plastic, alpha 0.3", 0, 0.3f, true);
    add_filmed("filmed white plastic, alpha 0.02", 0, 0.02f, true);
    add_filmed("smooth filmed plastic", 0, 0, true)->specular_color = ramp(0.5f, 3);
    add_filmed("half filmed half metal", 0.5f, 0.2f, true)->film.share = 0.5f;
    add_filmed("filmed frosted sheet", 0, 0.3f, true)->transmission = 1;
    add_filmed("filmed smooth sheet", 0, 0, true)->transmission = 0.8f;
    add_filmed("brushed filmed plastic", 0, 0.1f, true)->alpha_along = 0.5f;
    add_filmed("filmed plastic under lacquer", 0, 0.3f, true)->clearcoat = 1;
}

static MetallicRoughness *add_sheen(const char *name, float metallic, float alpha, float roughness,
                                    bool lossless) {
    MetallicRoughness *m = add_model(name, metallic, alpha, lossless);
    m->overlay.color[0] = m->overlay.color[1] = m->overlay.color[2] = 1;
    m->overlay.alpha = roughness * roughness;
    m->wavelengths = &wavelengths;
    return m;
}

static void add_cloths(void) {
    add_sheen("white cloth, sheen 1", 0, 1, 1, true);
    add_sheen("white cloth, sheen 0.5", 0, 0.5f, 0.5f, true);
    add_sheen("white cloth, sheen 0.2", 0, 0.3f, 0.2f, true)->specular = 0;
    add_sheen("white cloth, sheen 0.07", 0, 0.8f, 0.07f, true);
    add_sheen("white metal, sheen 0.4", 1, 0.2f, 0.4f, true);
    add_sheen("smooth gold, sheen 0.6", 1, 0, 0.6f, false)->base_color = ramp(0.3f, 0.97f);
    add_sheen("smooth plastic, sheen 0.3", 0, 0, 0.3f, true);
    add_sheen("frosted sheet, sheen 0.7", 0, 0.3f, 0.7f, true)->transmission = 1;
    add_sheen("smooth sheet, sheen 0.7", 0, 0, 0.7f, true)->transmission = 0.8f;
    add_sheen("brushed plastic, sheen 0.7", 0, 0.1f, 0.7f, true)->alpha_along = 0.5f;
    add_sheen("cloth under lacquer, sheen 0.7", 0, 0.5f, 0.7f, true)->clearcoat = 1;
    MetallicRoughness *m =
        add_sheen("brushed filmed half metal, sheen 0.4, under lacquer", 0.5f, 0.2f, 0.4f, true);
    m->alpha_along = 0.4f;
    m->film = (ThinFilm){.share = 1, .ior = 1.8f, .thickness_nm = 350};
    m->clearcoat = 0.7f;
    m->clearcoat_alpha = 0.2f;
    m = add_sheen("curtain, sheen 0.5", 0, 0.6f, 0.5f, true);
    m->across = 0.4f;
    m->across_color[0] = m->across_color[1] = m->across_color[2] = 1;
    m = add_sheen("brushed curtain under tilted lacquer", 0.2f, 0.3f, 0.5f, false);
    m->base_color = ramp(0.2f, 0.9f);
    m->alpha_along = 0.6f;
    m->across = 0.4f;
    m->across_color[0] = 1;
    m->clearcoat = 1;
    m->clearcoat_normal = vec3_normalize(vec3(0.3f, -0.2f, 1));
    m = add_sheen("filmed half metal, sheen 0.6", 0.5f, 0.2f, 0.6f, true);
    m->film = (ThinFilm){.share = 0.5f, .ior = 1.8f, .thickness_nm = 350};
    m = add_sheen("red sheen on a dark cloth", 0.2f, 0.6f, 0.3f, false);
    m->base_color = ramp(0.02f, 0.1f);
    m->overlay.color[1] = 0.1f;
    m->overlay.color[2] = 0;
    m = add_sheen("coated plastic, sheen 0.5", 0, 0.3f, 0.5f, true);
    m->coating = &plastic;
}

/* Sheets that a coat lies on, on both sides. */
static void add_lacquered_sheets(void) {
    MetallicRoughness *m = add_model("frosted sheet under lacquer", 0, 0.3f, true);
    m->transmission = 1;
    m->clearcoat = 1;
    m = add_model("smooth sheet under lacquer", 0, 0, true);
    m->transmission = 0.7f;
    m->clearcoat = 1;
    m = add_model("smooth sheet without a mirror under rough lacquer", 0, 0, true);
    m->transmission = 1;
    m->specular = 0;
    m->clearcoat = 1;
    m->clearcoat_alpha = 0.3f;
    models[model_count - 1].width = 0.3f;
    m = add_sheen("smooth sheet, sheen 0.5, under lacquer", 0, 0, 0.5f, true);
    m->transmission = 1;
    m->clearcoat = 1;
    m = add_sheen("frosted sheet, sheen 0.5, under lacquer", 0, 0.2f, 0.5f, true);
    m->transmission = 0.8f;
    m->specular = 0;
    m->clearcoat = 1;
    m = add_filmed("filmed brushed frosted sheet under rough lacquer", 0.3f, 0.2f, true);
    m->alpha_along = 0.5f;
    m->transmission = 0.8f;
    m->clearcoat = 0.7f;
    m->clearcoat_alpha = 0.2f;
    m = add_sheen("curtain with holes under lacquer", 0.4f, 0.36f, 0.5f, true);
    m->transmission = 0.5f;
    m->across = 0.3f;
    m->across_color[0] = m->across_color[1] = m->across_color[2] = 1;
    m->clearcoat = 1;
    m = add_coated("coated frosted sheet under lacquer", 0, 0.3f, true, &frosted);
    m->transmission = 1;
    m->clearcoat = 1;
}
