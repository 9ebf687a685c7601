/* khr_models.h -- more rows for test_shaders.c: surfaces of glTF's later extensions. It stands
 * behind that file's add_model. */
#pragma once

static void add_brushed(void)
{
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
    m = add_model("brushed half metal under lacquer", 0.5f, 0.1f, false);
    m->alpha_along = 0.5f;
    m->clearcoat = 1;
    m = add_coated("coated brushed half metal", 0.5f, 0.1f, true, &plastic);
    m->alpha_along = 0.5f;
}

static MetallicRoughness *add_filmed(const char *name, float metallic, float alpha,
                                     bool lossless)
{
    MetallicRoughness *m = add_model(name, metallic, alpha, lossless);
    m->film = (ThinFilm){.share = 1, .ior = 1.8f, .thickness_nm = 350};
    m->wavelengths = &wavelengths;
    return m;
}

static void add_films(void)
{
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
