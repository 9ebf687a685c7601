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
