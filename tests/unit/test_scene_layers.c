/* Brushed metal, thin films: every member of these extensions arrives. */
#include "check.h"
#include "base/units.h"
#include "gltf_maker.h"

#define PICTURE                                                                                \
    "'images':[{'uri':'data:image/png;base64,iVBORw0KGgoAAAANSUhEUgAAAAEAAAABCAIAAACQd1Pe"     \
    "AAAADElEQVR4nGNgYGAAAAAEAAH2FzhVAAAAAElFTkSuQmCC'}],'textures':[{'source':0}],"
#define TURNED                                                                                 \
    "{'index':0,'extensions':{'KHR_texture_transform':{'offset':[0.25,0.5],'scale':[2,3]}}}"

/* The material with one extension. */
static const Material *load_material(const char *extension, const char *members)
{
    char text[2048];
    snprintf(text, sizeof text,
             PICTURE "'extensionsUsed':['%s','KHR_texture_transform'],"
                     "'materials':[{'extensions':{'%s':{%s}}}]",
             extension, extension, members);
    return &maker_load(NULL, 0, text)->materials[0];
}

static void assert_transformed(const TextureSlot *slot)
{
    assert_int_equal(slot->texture_id, 0);
    assert_near(slot->uv_from_uv[0], 2, 0);
    assert_near(slot->uv_from_uv[2], 0.25, 0);
    assert_near(slot->uv_from_uv[4], 3, 0);
    assert_near(slot->uv_from_uv[5], 0.5, 0);
}

#define ANISOTROPY "KHR_materials_anisotropy"

TEST_WITH(brushing_has_strength_and_direction, maker_reset, NULL)
{
    (void)state;
    const Brushing *b = load_material(
        ANISOTROPY, "'anisotropyStrength':0.6,'anisotropyRotation':0.5")->brushing;
    assert_close(b->strength, 0.6, 1e-6);
    assert_close(b->cosine, cos(0.5), 1e-6);
    assert_close(b->sine, sin(0.5), 1e-6);
    assert_int_equal(b->texture.texture_id, NO_ID);
    b = load_material(ANISOTROPY,
                      "'anisotropyStrength':1,'anisotropyTexture':" TURNED)->brushing;
    assert_near(b->cosine, 1, 0);
    assert_transformed(&b->texture);
}

TEST_WITH(without_strength_nothing_is_brushed, maker_reset, NULL)
{
    (void)state;
    assert_null(load_material(ANISOTROPY, "'anisotropyRotation':1")->brushing);
    assert_null(load_material("KHR_materials_ior", "")->brushing);
}

int main(void)
{
    return run_cases(maker_start, maker_end);
}
