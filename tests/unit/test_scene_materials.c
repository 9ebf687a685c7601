/* SPDX-License-Identifier: Apache-2.0 */
/* Materials, lights, cameras' light: every member has glTF's default and takes its value. */
#include "check.h"
#include "base/units.h"
#include "gltf_maker.h"

/* The material whose members are these. */
static const Material *load_material(const char *members) {
    return &maker_load(
                NULL, 0,
                maker_format(
                    PICTURE
                    "'extensionsUsed':['KHR_materials_ior',"
                    "'KHR_materials_specular','KHR_materials_transmission','KHR_materials_clearcoat',"
                    "'KHR_materials_volume','KHR_materials_unlit','KHR_materials_emissive_strength',"
                    "'PARHELION_glazing'],"
                    "'materials':[{%s}]",
                    members))
                ->materials[0];
}

TEST_WITH(an_empty_material_has_the_defaults, maker_reset, NULL) {
    const Material *m = load_material("");
    assert_string_equal(m->name, "material 0");
    for (int i = 0; i < 4; i++) assert_near(m->base_color[i], 1, 0);
    assert_near(m->metallic, 1, 0);
    assert_near(m->roughness, 1, 0);
    assert_near(m->emissive_cd_m2[0], 0, 0);
    assert_int_equal(m->base_color_texture.texture_id, NO_ID);
    assert_int_equal(m->alpha_mode, ALPHA_OPAQUE);
    assert_near(m->alpha_cutoff, 0.5, 0);
    assert_near(m->ior, 1.5, 0);
    assert_near(m->specular, 1, 0);
    assert_near(m->specular_color[2], 1, 0);
    assert_near(m->transmission, 0, 0);
    assert_near(m->clearcoat, 0, 0);
    assert_true(isinf(m->attenuation_distance_m));
    assert_false(m->is_solid || m->is_emitter || m->lets_light_through || m->double_sided);
}

/* A number of a material, and a text that sets it. */
typedef struct NumberCase {
    const char *members;
    size_t offset; /* of a float in Material */
    float value;
} NumberCase;

#define AT(member) offsetof(Material, member)
#define EXTENSION(name, body) "'extensions':{'" name "':{" body "}}"

static const NumberCase NUMBERS[] = {
    {"'pbrMetallicRoughness':{'baseColorFactor':[0.1,0.2,0.3,0.4]}", AT(base_color[3]), 0.4f},
    {"'pbrMetallicRoughness':{'metallicFactor':0.25}", AT(metallic), 0.25f},
    {"'pbrMetallicRoughness':{'roughnessFactor':0.75}", AT(roughness), 0.75f},
    {"'emissiveFactor':[0.1,0.2,0.3]", AT(emissive_cd_m2[1]), 0.2f},
    {"'alphaMode':'MASK','alphaCutoff':0.3", AT(alpha_cutoff), 0.3f},
    {"'normalTexture':{'index':0,'scale':0.6}", AT(normal_scale), 0.6f},
    {"'emissiveFactor':[0,0.5,0]," EXTENSION("KHR_materials_emissive_strength",
                                             "'emissiveStrength':4000"),
     AT(emissive_cd_m2[1]), 2000},
    {EXTENSION("KHR_materials_ior", "'ior':1.33"), AT(ior), 1.33f},
    {EXTENSION("KHR_materials_ior", ""), AT(ior), 1.5f},
    {EXTENSION("KHR_materials_specular", "'specularFactor':0.5"), AT(specular), 0.5f},
    {EXTENSION("KHR_materials_specular", "'specularColorFactor':[1,2,3]"), AT(specular_color[2]),
     3},
    {EXTENSION("KHR_materials_transmission", "'transmissionFactor':0.9"), AT(transmission), 0.9f},
    {EXTENSION("KHR_materials_clearcoat", "'clearcoatFactor':0.8"), AT(clearcoat), 0.8f},
    {EXTENSION("KHR_materials_clearcoat", "'clearcoatRoughnessFactor':0.2"),
     AT(clearcoat_roughness), 0.2f},
    {EXTENSION("KHR_materials_volume", "'attenuationDistance':0.01"), AT(attenuation_distance_m),
     0.01f},
    {EXTENSION("KHR_materials_volume", "'attenuationColor':[0.1,0.5,1]"), AT(attenuation_color[1]),
     0.5f},
};

TEST_WITH(every_factor_arrives, maker_reset, NULL) {
    for (size_t i = 0; i < sizeof NUMBERS / sizeof *NUMBERS; i++) {
        const Material *m = load_material(NUMBERS[i].members);
        assert_close(*(const float *)((const char *)m + NUMBERS[i].offset), NUMBERS[i].value, 1e-6);
    }
}

/* A layer that lets all light through has no say in the index that light is absorbed by. */
TEST_WITH(a_pane_absorbs_by_the_index_of_what_absorbs, maker_reset, NULL) {
    const Material *m = load_material(
        EXTENSION("PARHELION_glazing", "'layers':[{'thickness_m':0.002,'ior':1.9},"
                                       "{'thickness_m':0.001,'ior':1.6,'transmission':0.25},"
                                       "{'thickness_m':0.002,'ior':1.3,'transmission':0.5}]"));
    assert_close(m->glazing->absorbing_ior, (2 * 1.6 + 1.3) / 3, 1e-6);
    assert_close(m->glazing->absorbance.value[0], log(8), 1e-6);
}

/* A texture of a material, and where it is named. */
static const struct {
    const char *members;
    size_t offset;
} SLOTS[] = {
    {"'pbrMetallicRoughness':{'baseColorTexture':{'index':0}}", AT(base_color_texture)},
    {"'pbrMetallicRoughness':{'metallicRoughnessTexture':{'index':0}}",
     AT(metallic_roughness_texture)},
    {"'normalTexture':{'index':0}", AT(normal_texture)},
    {"'emissiveTexture':{'index':0}", AT(emissive_texture)},
    {EXTENSION("KHR_materials_specular", "'specularTexture':{'index':0}"), AT(specular_texture)},
    {EXTENSION("KHR_materials_specular", "'specularColorTexture':{'index':0}"),
     AT(specular_color_texture)},
    {EXTENSION("KHR_materials_transmission", "'transmissionTexture':{'index':0}"),
     AT(transmission_texture)},
    {EXTENSION("KHR_materials_clearcoat", "'clearcoatTexture':{'index':0}"), AT(clearcoat_texture)},
    {EXTENSION("KHR_materials_clearcoat", "'clearcoatRoughnessTexture':{'index':0}"),
     AT(clearcoat_roughness_texture)},
    {EXTENSION("KHR_materials_clearcoat", "'clearcoatNormalTexture':{'index':0}"),
     AT(clearcoat_normal_texture)},
};

TEST_WITH(every_texture_arrives_in_its_own_slot, maker_reset, NULL) {
    const size_t count = sizeof SLOTS / sizeof *SLOTS;
    for (size_t i = 0; i < count; i++) {
        const char *m = (const char *)load_material(SLOTS[i].members);
        for (size_t k = 0; k < count; k++)
            assert_int_equal(((const TextureSlot *)(m + SLOTS[k].offset))->texture_id,
                             k == i ? 0 : NO_ID);
    }
}

TEST_WITH(flags_follow_from_the_numbers, maker_reset, NULL) {
    assert_true(load_material("'emissiveFactor':[0,0,0.1]")->is_emitter);
    static const char HALF[] = ",'pbrMetallicRoughness':{'baseColorFactor':[1,1,1,0.5]}";
    char blend[128], mask[128];
    snprintf(blend, sizeof blend, "'alphaMode':'BLEND'%s", HALF);
    snprintf(mask, sizeof mask, "'alphaMode':'MASK'%s", HALF);
    assert_true(load_material(blend)->lets_light_through);
    assert_true(load_material(mask)->lets_light_through);
    assert_true(load_material("'doubleSided':true")->double_sided);
    assert_true(load_material(EXTENSION("KHR_materials_unlit", ""))->unlit);
    assert_true(load_material(EXTENSION("KHR_materials_transmission", "'transmissionFactor':1"))
                    ->lets_light_through);
    const Material *glass =
        load_material("'extensions':{'KHR_materials_transmission':{'transmissionFactor':1},"
                      "'KHR_materials_volume':{'thicknessFactor':0.1}}");
    assert_true(glass->is_solid);
    assert_false(glass->lets_light_through);
}

/* ---- lights ---------------------------------------------------------------------------- */

TEST_WITH(punctual_lights_keep_their_units_and_place, maker_reset, NULL) {
    Scene *scene = maker_load(
        NULL, 0,
        "'extensionsUsed':['KHR_lights_punctual'],'extensions':{'KHR_lights_punctual':{'lights'"
        ":["
        "{'type':'point','intensity':100,'color':[1,0.5,0],'name':'bulb'},{'type':'directional'"
        "},"
        "{'type':'spot','intensity':10,'spot':{'innerConeAngle':0.1,'outerConeAngle':0.2}},"
        "{'type':'spot','spot':{}}]}},'scenes':[{'nodes':[0,1,2,3]}],'nodes':["
        "{'translation':[1,2,3],'scale':[5,5,5],'extensions':{'KHR_lights_punctual':{'light':0}"
        "}},"
        "{'rotation':[-0.70710678,0,0,0.70710678],'extensions':{'KHR_lights_punctual':"
        "{'light':1}}},{'extensions':{'KHR_lights_punctual':{'light':2}}},"
        "{'extensions':{'KHR_lights_punctual':{'light':3}}}]");
    assert_int_equal(scene->light_count, 4);
    const PunctualLight *bulb = &scene->lights[0], *sun = &scene->lights[1];
    assert_string_equal(bulb->name, "bulb");
    assert_int_equal(bulb->kind, LIGHT_POINT);
    assert_near(bulb->position.y, 2, 0);
    assert_close(bulb->intensity[0], 100, 1e-6); /* a node's scale does not make it brighter */
    assert_close(bulb->intensity[1], 50, 1e-6);
    assert_int_equal(sun->kind, LIGHT_DIRECTIONAL);
    assert_near(sun->direction.y, -1, 1e-6); /* -Z turned down by 90 degrees about X */
    assert_near(sun->intensity[2], 1, 0);
    assert_close(scene->lights[2].cos_inner, cos(0.1), 1e-6);
    assert_close(scene->lights[2].cos_outer, cos(0.2), 1e-6);
    assert_close(scene->lights[3].cos_inner, 1, 1e-6);
    assert_close(scene->lights[3].cos_outer, cos(PI / 4), 1e-6);
}

/* ---- environment ----------------------------------------------------------------------- */

#define ENVIRONMENT(body) \
    "'extensionsUsed':['PARHELION_environment'],'scenes':[{'extensions':" \
    "{'PARHELION_environment':{" body "}}}]"

TEST_WITH(a_constant_sky_has_its_luminance, maker_reset, NULL) {
    const Environment *e =
        &maker_load(
             NULL, 0,
             ENVIRONMENT("'type':'constant','luminance':1000,'color':[2,1,0.5],'heading_deg':90,"
                         "'forward':[2,0,0],'sun':{'azimuth_deg':180,'elevation_deg':30,'"
                         "illuminance_lx':90000}"))
             ->environment;
    assert_int_equal(e->kind, ENVIRONMENT_CONSTANT);
    assert_near(e->luminance_cd_m2, 1000, 0);
    assert_close(0.2126 * (double)e->color[0] + 0.7152 * (double)e->color[1] +
                     0.0722 * (double)e->color[2],
                 1, 1e-3);
    assert_close(e->color[0], 2 * e->color[1], 1e-6);
    assert_close(e->heading, PI / 2, 1e-6);
    assert_near(e->forward.x, 1, 0);
    assert_true(e->has_sun);
    assert_close(e->sun_azimuth, PI, 1e-6);
    assert_close(e->sun_elevation, PI / 6, 1e-6);
    assert_near(e->sun_illuminance_lx, 90000, 0);
    assert_close(e->sun_angular_radius, radians_from_degrees(0.26645), 1e-6);
}

TEST_WITH(a_scene_without_environment_is_dark, maker_reset, NULL) {
    const Environment *e = &maker_load(NULL, 0, "'scenes':[{}]")->environment;
    assert_int_equal(e->kind, ENVIRONMENT_NONE);
    assert_false(e->has_sun);
    assert_near(e->forward.z, -1, 0);
}

/* Two pixels of a Radiance picture: 1 and 2 in all channels (mantissa 128 1/2, exponent + 128),
 * of 179 lm/W. */
TEST_WITH(a_picture_of_the_sky_is_read_beside_the_scene, maker_reset, NULL) {
    static const char PIXELS[] =
        "#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y 1 +X 2\n\x80\x80\x80\x81\x80\x80\x80\x82";
    const char *picture = maker_file(PIXELS, sizeof PIXELS - 1, ".hdr");
    const Environment *e =
        &maker_load(NULL, 0,
                    maker_format(ENVIRONMENT("'type':'hdri','uri':'%s','rotation_deg':45,"
                                             "'horizontal_illuminance_lx':20000"),
                                 path_name(picture)))
             ->environment;
    assert_int_equal(e->kind, ENVIRONMENT_HDRI);
    assert_string_equal(e->hdri_path, picture);
    assert_int_equal(e->hdri.width, 2);
    assert_close(((const float *)e->hdri.pixels)[4], 2 * 179 * 128.5 / 128, 1e-5);
    assert_close(e->hdri_rotation, PI / 4, 1e-6);
    assert_near(e->horizontal_illuminance_lx, 20000, 0);
}

/* ---- several files
 * --------------------------------------------------------------------------- */

static const float TRIANGLE[9] = {0, 0, 0, 1, 0, 0, 0, 1, 0};

#define SHAPE \
    "'bufferViews':[{'buffer':0,'byteLength':36}],'accessors':[{'bufferView':0," \
    "'componentType':5126,'count':3,'type':'VEC3'}]," \
    "'meshes':[{'primitives':[{'attributes':{'POSITION':0}%s}]}]," \
    "'nodes':[{'mesh':0,'name':'%s'}],"

TEST_WITH(several_files_are_one_scene, maker_reset, NULL) {
    char first[2048], second[2048];
    snprintf(first, sizeof first,
             SHAPE "'materials':[{'name':'a'}]," ENVIRONMENT("'type':'constant','luminance':1"),
             ",'material':0", "one");
    snprintf(second, sizeof second,
             SHAPE "'materials':[{'name':'b','alphaMode':'BLEND'},"
                   "{'name':'c'}],'scenes':[{'nodes':[0]}]",
             ",'material':1", "two");
    char *shown = strstr(first, "'scenes':[{");
    memmove(shown + 11 + 13, shown + 11, strlen(shown + 11) + 1);
    memcpy(shown + 11, "'nodes':[0], ", 13);
    const char *paths[3] = {maker_gltf(TRIANGLE, sizeof TRIANGLE, first),
                            maker_gltf(TRIANGLE, sizeof TRIANGLE, second),
                            maker_gltf(NULL, 0, ENVIRONMENT("'type':'constant','luminance':7"))};
    Found found = maker_survey(&(SceneOptions){.paths = paths, .path_count = 3});
    const Scene *scene = found.scene;
    assert_int_equal(found.problems.error_count, 0);
    assert_int_equal(scene->material_count, 3);
    assert_int_equal(scene->triangle_count, 2);
    assert_string_equal(scene->parts[1].name, "two");
    assert_string_equal(scene->materials[scene->parts[1].material_id].name, "c");
    assert_near(scene->environment.luminance_cd_m2, 7, 0); /* the last one holds */
    assert_int_equal(scene->input_count, 3);
    assert_int_not_equal(scene->input_hashes[0], scene->input_hashes[1]);
    assert_int_equal(scene->extension_count, 1);
}

/* ---- the arrays
 * ------------------------------------------------------------------------------- */

TEST_WITH(opaque_triangles_come_first, maker_reset, NULL) {
    const Scene *scene = maker_load(
        TRIANGLE, sizeof TRIANGLE,
        "'bufferViews':[" VIEW0(36) "],'accessors':[" FLOATS(
            0, 3,
            "VEC3") "],"
                    "'materials':[{'alphaMode':'BLEND','pbrMetallicRoughness':{'baseColorFactor':[1,1,1,"
                    "0.5]}},{}],'meshes':[{'primitives':[{'attributes':{'POSITION':0},'material':0},"
                    "{'attributes':{'POSITION':0},'material':1},{'attributes':{'POSITION':0}}]}],"
                    "'scenes':[{'nodes':[0]}],'nodes':[{'mesh':0,'translation':[0,0,2]}]");
    assert_int_equal(scene->triangle_count, 3);
    assert_int_equal(scene->opaque_count, 2);
    for (uint32_t t = 0; t < 3; t++) {
        const Part *part = &scene->parts[scene->triangles[t].part_id];
        assert_true(t >= part->first_triangle && t < part->first_triangle + part->triangle_count);
        assert_int_equal(scene->materials[part->material_id].lets_light_through, t == 2);
    }
    assert_near(scene->bounds_min.z, 2, 0);
    assert_near(scene->bounds_max.x, 1, 0);
    assert_int_equal((uintptr_t)scene->positions % 64, 0);
}

/* BLEND with an alpha of 1 everywhere needs no test; a vertex that is not full does. */
TEST_WITH(what_is_opaque_everywhere_is_opaque, maker_reset, NULL) {
    struct {
        float points[9];
        uint8_t colors[12];
    } data = {{0, 0, 0, 1, 0, 0, 0, 1, 0},
              {255, 255, 255, 255, 255, 255, 255, 255, 255, 255, 255, 255}};
    for (int alpha = 255; alpha >= 254; alpha--) {
        data.colors[11] = (uint8_t)alpha;
        const Scene *scene = maker_load(
            &data, sizeof data,
            "'bufferViews':[" VIEW0(36) "," VIEW(36, 12) "],'accessors':[" FLOATS(
                0, 3, "VEC3") ",{'bufferView':1,'componentType':5121,'normalized':true,"
                              "'count':3,'type':'VEC4'}],'materials':[{'alphaMode':'BLEND'}],"
                              "'meshes':[{'primitives':[{'attributes':{'POSITION':0,'COLOR_0':1},"
                              "'material':0}]}]," ONE_NODE);
        assert_int_equal(scene->opaque_count, alpha == 255);
    }
}

TEST_WITH(triangles_without_area_are_dropped_and_counted, maker_reset, NULL) {
    static const float POINTS[18] = {0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 0, 1, 1, 1, 2, 2, 2};
    Found found = maker_survey_file(
        maker_gltf(POINTS, sizeof POINTS,
                   "'bufferViews':[" VIEW0(72) "],'accessors':[" FLOATS(
                       0, 6, "VEC3") "],"
                                     "'meshes':[{'primitives':[{'attributes':{'POSITION':0}},"
                                     "{'attributes':{'POSITION':0},'mode':0}]}]," ONE_NODE));
    assert_int_equal(found.scene->triangle_count, 1);
    assert_non_null(maker_find(&found, "/meshes", "1 triangle without area dropped"));
    assert_non_null(maker_find(&found, "/meshes", "1 primitive of points or lines skipped"));
}

TEST_PROGRAM(maker_start, maker_end)
