/* SPDX-License-Identifier: Apache-2.0 */
/* Brushed metal, thin films, sheen: every member of these extensions arrives. */
#include "check.h"
#include "gltf_maker.h"

#define TURNED \
    "{'index':0,'extensions':{'KHR_texture_transform':{'offset':[0.25,0.5],'scale':[2,3]}}}"

/* The material with one extension. */
static const Material *load_material(const char *extension, const char *members) {
    return &maker_load(NULL, 0,
                       maker_format(PICTURE "'extensionsUsed':['%s','KHR_texture_transform'],"
                                            "'materials':[{'extensions':{'%s':{%s}}}]",
                                    extension, extension, members))
                ->materials[0];
}

static void assert_transformed(const TextureSlot *slot) {
    assert_int_equal(slot->texture_id, 0);
    assert_near(slot->uv_from_uv[0], 2, 0);
    assert_near(slot->uv_from_uv[2], 0.25, 0);
    assert_near(slot->uv_from_uv[4], 3, 0);
    assert_near(slot->uv_from_uv[5], 0.5, 0);
}

#define ANISOTROPY "KHR_materials_anisotropy"

TEST_WITH(brushing_has_strength_and_direction, maker_reset, NULL) {
    const Brushing *b =
        load_material(ANISOTROPY, "'anisotropyStrength':0.6,'anisotropyRotation':0.5")->brushing;
    assert_close(b->strength, 0.6, 1e-6);
    assert_close(b->cosine, cos(0.5), 1e-6);
    assert_close(b->sine, sin(0.5), 1e-6);
    assert_int_equal(b->texture.texture_id, NO_ID);
    b = load_material(ANISOTROPY, "'anisotropyStrength':1,'anisotropyTexture':" TURNED)->brushing;
    assert_near(b->cosine, 1, 0);
    assert_transformed(&b->texture);
}

TEST_WITH(without_strength_nothing_is_brushed, maker_reset, NULL) {
    assert_null(load_material(ANISOTROPY, "'anisotropyRotation':1")->brushing);
    assert_null(load_material("KHR_materials_ior", "")->brushing);
}

#define IRIDESCENCE "KHR_materials_iridescence"

TEST_WITH(a_film_has_the_defaults_of_its_extension, maker_reset, NULL) {
    const MaterialFilm *film = load_material(IRIDESCENCE, "'iridescenceFactor':0.5")->film;
    assert_near(film->share, 0.5, 0);
    assert_close(film->ior, 1.3, 1e-6);
    assert_near(film->least_nm, 100, 0);
    assert_near(film->most_nm, 400, 0);
    assert_int_equal(film->texture.texture_id, NO_ID);
    assert_int_equal(film->thickness_texture.texture_id, NO_ID);
    assert_null(load_material(IRIDESCENCE, "'iridescenceIor':2")->film);
}

TEST_WITH(every_member_of_a_film_arrives, maker_reset, NULL) {
    const MaterialFilm *film =
        load_material(IRIDESCENCE, "'iridescenceFactor':1,'iridescenceIor':1.75,"
                                   "'iridescenceThicknessMinimum':50,"
                                   "'iridescenceThicknessMaximum':900,"
                                   "'iridescenceTexture':" TURNED)
            ->film;
    assert_near(film->ior, 1.75, 0);
    assert_near(film->least_nm, 50, 0);
    assert_near(film->most_nm, 900, 0);
    assert_transformed(&film->texture);
    film = load_material(IRIDESCENCE, "'iridescenceFactor':1,"
                                      "'iridescenceThicknessTexture':" TURNED)
               ->film;
    assert_transformed(&film->thickness_texture);
}

#define SHEEN "KHR_materials_sheen"

TEST_WITH(sheen_has_the_defaults_of_its_extension, maker_reset, NULL) {
    const MaterialOverlay *sheen = load_material(SHEEN, "'sheenColorFactor':[0,0.5,0]")->overlay;
    assert_near(sheen->color[1], 0.5, 0);
    assert_near(sheen->roughness, 0, 0);
    assert_int_equal(sheen->color_texture.texture_id, NO_ID);
    assert_int_equal(sheen->roughness_texture.texture_id, NO_ID);
    assert_null(load_material(SHEEN, "'sheenRoughnessFactor':0.5")->overlay);
    assert_null(load_material(SHEEN, "'sheenColorFactor':[0,0,0]")->overlay);
}

TEST_WITH(every_member_of_sheen_arrives, maker_reset, NULL) {
    const MaterialOverlay *sheen =
        load_material(SHEEN, "'sheenColorFactor':[0.25,0.5,1],'sheenRoughnessFactor':0.75,"
                             "'sheenColorTexture':" TURNED)
            ->overlay;
    assert_near(sheen->color[0], 0.25, 0);
    assert_near(sheen->color[2], 1, 0);
    assert_near(sheen->roughness, 0.75, 0);
    assert_transformed(&sheen->color_texture);
    assert_int_equal(sheen->roughness_texture.texture_id, NO_ID);
    sheen = load_material(SHEEN, "'sheenColorFactor':[1,1,1],"
                                 "'sheenRoughnessTexture':" TURNED)
                ->overlay;
    assert_transformed(&sheen->roughness_texture);
}

static const struct {
    const char *extension, *members, *place, *text;
} WRONG[] = {
    {SHEEN, "'sheenColorFactor':0.5", "/sheenColorFactor", "array"},
    {SHEEN, "'sheenColorFactor':[1,1]", "/sheenColorFactor", "3"},
    {SHEEN, "'sheenColorFactor':[1,'1',1]", "/sheenColorFactor/1", "number"},
    {SHEEN, "'sheenColorFactor':[1,1,1.5]", "/sheenColorFactor/2", "1.5"},
    {SHEEN, "'sheenColorFactor':[-0.5,1,1]", "/sheenColorFactor/0", "-0.5"},
    {SHEEN, "'sheenRoughnessFactor':'1'", "/sheenRoughnessFactor", "number"},
    {SHEEN, "'sheenRoughnessFactor':1.25", "/sheenRoughnessFactor", "1.25"},
    {SHEEN, "'sheenRoughnessFactor':-1", "/sheenRoughnessFactor", "-1"},
    {SHEEN, "'sheenColorTexture':1", "/sheenColorTexture", "object"},
    {SHEEN, "'sheenRoughnessTexture':{}", "/sheenRoughnessTexture", "index"},
    {IRIDESCENCE, "'iridescenceIor':100001", "/iridescenceIor", "1 to 100000"},
    {IRIDESCENCE, "'iridescenceThicknessMaximum':1e7", "/iridescenceThicknessMaximum",
     "0 to 1000000"},
    {IRIDESCENCE, "'iridescenceThicknessMinimum':1e7", "/iridescenceThicknessMinimum",
     "0 to 1000000"},
    {"KHR_materials_ior", "'ior':100001", "/ior", "from 1 to 100000"},
    {"KHR_materials_ior", "'ior':0.5", "/ior", "0 (which means infinite)"},
};

TEST_WITH(each_wrong_member_is_told, maker_reset, NULL) {
    for (size_t i = 0; i < sizeof WRONG / sizeof *WRONG; i++) {
        char text[1024], place[128];
        snprintf(text, sizeof text,
                 "'extensionsUsed':['%s'],'materials':[{'extensions':{'%s':{%s}}}]",
                 WRONG[i].extension, WRONG[i].extension, WRONG[i].members);
        snprintf(place, sizeof place, "/materials/0/extensions/%s%s", WRONG[i].extension,
                 WRONG[i].place);
        Found found = maker_survey_file(maker_gltf(NULL, 0, text));
        if (!maker_find(&found, place, WRONG[i].text))
            fail_msg("%s is not told as \"%s\"", place, WRONG[i].text);
    }
}

/* What is not shown beside something else is reported once, by what hides it. */
static const struct {
    const char *extensions, *place, *text;
} HIDDEN[] = {
    {"'KHR_materials_sheen':{'sheenColorFactor':[0,0,1]},'KHR_materials_unlit':{}",
     "KHR_materials_sheen", "has no effect beside KHR_materials_unlit"},
    {"'KHR_materials_sheen':{'sheenColorFactor':[1,0,0]},"
     "'KHR_materials_transmission':{'transmissionFactor':1},"
     "'KHR_materials_volume':{'thicknessFactor':1}",
     "KHR_materials_sheen", "closed solid, on which sheen is not shown"},
    {"'KHR_materials_iridescence':{'iridescenceFactor':1},'KHR_materials_unlit':{}",
     "KHR_materials_iridescence", "has no effect beside KHR_materials_unlit"},
    {"'KHR_materials_anisotropy':{'anisotropyStrength':1},'KHR_materials_unlit':{}",
     "KHR_materials_anisotropy", "has no effect beside KHR_materials_unlit"},
    {"'KHR_materials_clearcoat':{'clearcoatFactor':0.1},'PARHELION_display':{}",
     "KHR_materials_clearcoat", "the panel was measured with all that lies on it"},
};

TEST_WITH(what_has_no_effect_is_told, maker_reset, NULL) {
    for (size_t i = 0; i < sizeof HIDDEN / sizeof *HIDDEN; i++) {
        char text[1024], place[128];
        snprintf(text, sizeof text, "'materials':[{'extensions':{%s}}]", HIDDEN[i].extensions);
        snprintf(place, sizeof place, "/materials/0/extensions/%s", HIDDEN[i].place);
        Found found = maker_survey_file(maker_gltf(NULL, 0, text));
        assert_non_null(maker_find(&found, place, HIDDEN[i].text));
    }
}

TEST_WITH(solids_of_glass_are_filmed_and_brushed_without_a_word, maker_reset, NULL) {
    Found found = maker_survey_file(maker_gltf(
        NULL, 0,
        "'extensionsUsed':['" IRIDESCENCE "','" ANISOTROPY "','KHR_materials_transmission',"
        "'KHR_materials_volume'],"
        "'materials':[{'pbrMetallicRoughness':{'metallicFactor':0},"
        "'extensions':{'" IRIDESCENCE "':{'iridescenceFactor':1},'" ANISOTROPY
        "':{'anisotropyStrength':1},"
        "'KHR_materials_transmission':{'transmissionFactor':1},"
        "'KHR_materials_volume':{'thicknessFactor':1}}}]"));
    assert_int_equal(found.problems.count, 0);
}

/* Beside a clear solid: what is requested, where it stands, and what is said of it. */
static const struct {
    const char *core, *extension, *members, *place, *text;
} NOT_ON_SOLIDS[] = {
    {"'metallicFactor':0", SHEEN, "'sheenColorFactor':[0,0.5,0]", "/extensions/" SHEEN,
     "sheen is not shown"},
    {"'metallicFactor':0", "KHR_materials_clearcoat", "'clearcoatFactor':0.5",
     "/extensions/KHR_materials_clearcoat", "no coat is shown"},
    {"'metallicFactor':0", "KHR_materials_specular", "'specularFactor':0.5",
     "/extensions/KHR_materials_specular", "as its index says"},
    {"'metallicFactor':0", "KHR_materials_specular", "'specularColorFactor':[1,0.5,1]",
     "/extensions/KHR_materials_specular", "as its index says"},
    {"'metallicFactor':0", "KHR_materials_diffuse_transmission", "'diffuseTransmissionFactor':0.5",
     "/extensions/KHR_materials_diffuse_transmission", "makes the solid clear"},
    {"'metallicFactor':0.5", "KHR_materials_ior", "'ior':1.5",
     "/pbrMetallicRoughness/metallicFactor", "is 0.5 of metal"},
    {"'roughnessFactor':0.5", "KHR_materials_ior", "'ior':1.5", "/pbrMetallicRoughness",
     "is 1 of metal (metallicFactor's default)"},
};

TEST_WITH(what_clear_solids_do_not_show_is_told, maker_reset, NULL) {
    for (size_t i = 0; i < sizeof NOT_ON_SOLIDS / sizeof *NOT_ON_SOLIDS; i++) {
        char text[1024], place[128];
        snprintf(text, sizeof text,
                 "'extensionsUsed':['%s','KHR_materials_transmission','KHR_materials_volume'],"
                 "'materials':[{'pbrMetallicRoughness':{%s},'extensions':{'%s':{%s},"
                 "'KHR_materials_transmission':{'transmissionFactor':1},"
                 "'KHR_materials_volume':{'thicknessFactor':1}}}]",
                 NOT_ON_SOLIDS[i].extension, NOT_ON_SOLIDS[i].core, NOT_ON_SOLIDS[i].extension,
                 NOT_ON_SOLIDS[i].members);
        snprintf(place, sizeof place, "/materials/0%s", NOT_ON_SOLIDS[i].place);
        Found found = maker_survey_file(maker_gltf(NULL, 0, text));
        assert_int_equal(found.problems.count, 1);
        if (!maker_find(&found, place, NOT_ON_SOLIDS[i].text))
            fail_msg("%s is not told as \"%s\"", place, NOT_ON_SOLIDS[i].text);
    }
}

TEST_WITH(a_solid_that_is_half_clear_is_told, maker_reset, NULL) {
    Found found = maker_survey_file(
        maker_gltf(NULL, 0,
                   "'extensionsUsed':['KHR_materials_transmission','KHR_materials_volume'],"
                   "'materials':[{'pbrMetallicRoughness':{'metallicFactor':0},'extensions':{"
                   "'KHR_materials_transmission':{'transmissionFactor':0.5},"
                   "'KHR_materials_volume':{'thicknessFactor':1}}}]"));
    assert_int_equal(found.problems.count, 1);
    assert_true(maker_find(&found,
                           "/materials/0/extensions/KHR_materials_transmission"
                           "/transmissionFactor",
                           "transmissionFactor 1 is required"));
}

/* A triangle, and whether it has texture coordinates. */
static Found survey_brushed(const char *attributes) {
    static const float points[9] = {0, 0, 0, 1, 0, 0, 0, 1, 0};
    return maker_survey_file(maker_gltf(
        points, sizeof points,
        maker_format(
            "'bufferViews':[" VIEW0(
                36) "],'accessors':[{'bufferView':0,"
                    "'componentType':5126,'count':3,'type':'VEC3','min':[0,0,0],'max':[1,1,0]}," FLOATS(
                        0, 3,
                        "VEC2") "],'materials':[{'extensions':{'" ANISOTROPY
                                "':{'anisotropyStrength':1}}}],"
                                "'meshes':[{'primitives':[{'attributes':{'POSITION':0%s},'material':0}]}]," ONE_NODE,
            attributes)));
}

TEST_WITH(brushing_without_tangents_tells_what_is_taken, maker_reset, NULL) {
    const char *place = "/meshes/0/primitives/0";
    Found found = survey_brushed(",'TEXCOORD_0':1");
    assert_non_null(maker_find(&found, place, "its texture's coordinates are taken"));
    assert_non_null(found.scene->parts[0].tangents);
    found = survey_brushed("");
    assert_non_null(maker_find(&found, place, "nor texture coordinates, it is not brushed"));
    assert_null(found.scene->parts[0].tangents);
}

TEST_PROGRAM(maker_start, maker_end)
