/* SPDX-License-Identifier: Apache-2.0 */
/* The laws of files as other programs write them: cameras below scaled nodes, unlit vertex
 * colours, component types by name, extensions of other makers, Blender's units. */
#include <sys/stat.h>

#include "check.h"
#include "gltf_maker.h"
#include "light/emission.h"
#include "scene/gltf/accessor.h"
#include "scene/gltf/document.h"
#include "spectrum/wavelengths.h"

static Scene *load(const char *members) {
    return maker_load("", 0, members);
}

/* ---- cameras: glTF 2.0, 3.10.2 ----------------------------------------------------------- */

#define EYE "'cameras':[{'type':'perspective','perspective':{'yfov':1,'znear':0.1}}]"

static void assert_places(const Transform *a, const Transform *b, const char *what) {
    const Vec3 columns[2][4] = {{a->x, a->y, a->z, a->origin}, {b->x, b->y, b->z, b->origin}};
    for (int i = 0; i < 4; i++)
        if (!(vec3_length(vec3_sub(columns[0][i], columns[1][i])) < 2e-6f))
            fail_msg("%s: column %d is %g %g %g, required %g %g %g", what, i,
                     (double)columns[0][i].x, (double)columns[0][i].y, (double)columns[0][i].z,
                     (double)columns[1][i].x, (double)columns[1][i].y, (double)columns[1][i].z);
}

static Transform camera_of(const char *nodes) {
    return load(maker_format(EYE ",'scenes':[{'nodes':[0]}],'scene':0,'nodes':[%s]", nodes))
        ->cameras[0]
        .world_from_camera;
}

static const char *const SCALES[] = {"2,2,2",   "-1,1,1",  "1,-1,1",   "1,1,-1",  "-1,-1,1",
                                     "-1,1,-1", "1,-1,-1", "-1,-1,-1", "3,0.5,7", "-3,0.5,7",
                                     "0,1,1",   "1,0,1",   "1,1,0",    "0,0,0",   "1e-6,-1e5,1"};

/* Whatever the node's own scale is, the camera stands and looks as without one. */
TEST_WITH(a_camera_ignores_its_node_s_scale, maker_reset, NULL) {
    static const char *const TURNS[] = {"0,0,0,1", "0.5,0.5,0.5,0.5", "0.6,0,0,0.8",
                                        "0.1,0.7,-0.1,0.7"};
    for (size_t t = 0; t < sizeof TURNS / sizeof *TURNS; t++) {
        const char *node = "{'camera':0,'translation':[1,2,3],'rotation':[%s],'scale':[%s]}";
        Transform plain = camera_of(maker_format(node, TURNS[t], "1,1,1"));
        for (size_t s = 0; s < sizeof SCALES / sizeof *SCALES; s++) {
            maker_reset(NULL);
            Transform own = camera_of(maker_format(node, TURNS[t], SCALES[s]));
            assert_places(&own, &plain, SCALES[s]);
        }
    }
}

/* A parent moves and turns the camera; its scale moves where the camera stands, and turns or
 * mirrors nothing: the turns alone, one after the other. */
TEST_WITH(a_camera_ignores_its_parents_scales, maker_reset, NULL) {
    static const char *const LINE =
        "{'children':[1],'rotation':[0,0.6,0,0.8],'scale':[%s]},{'children':[2],'rotation':"
        "[0,0,0.70710678,0.70710678],'scale':[%s]},{'camera':0,'rotation':[0.6,0,0,0.8],"
        "'scale':[%s]}";
    Transform plain = camera_of(maker_format(LINE, "1,1,1", "1,1,1", "1,1,1"));
    for (size_t s = 0; s < sizeof SCALES / sizeof *SCALES; s++)
        for (int level = 0; level < 3; level++) {
            const char *of[3] = {"1,1,1", "1,1,1", "1,1,1"};
            maker_reset(NULL);
            of[level] = SCALES[s];
            Transform own = camera_of(maker_format(LINE, of[0], of[1], of[2]));
            assert_places(&own, &plain, maker_format("scale %s of node %d", SCALES[s], level));
        }
}

/* Of a mirror one cannot see which axis it was: as a matrix it means what a scale means. */
TEST_WITH(a_mirror_in_a_matrix_is_ignored_too, maker_reset, NULL) {
    static const float SIGNS[3][3] = {{-2, 2, 2}, {1, -3, 1}, {1, 1, -0.5f}};
    const char *matrix = "{'camera':0,'matrix':[%g,0,0,0,0,%g,0,0,0,0,%g,0,4,5,6,1]}";
    Transform plain = camera_of(maker_format(matrix, 1.0, 1.0, 1.0));
    for (int i = 0; i < 3; i++) {
        Transform own = camera_of(
            maker_format(matrix, (double)SIGNS[i][0], (double)SIGNS[i][1], (double)SIGNS[i][2]));
        assert_places(&own, &plain, maker_format("matrix %d", i));
    }
}

/* ---- unlit ------------------------------------------------------------------------------- */

/* Three corners and their colours. */
static const float UNLIT[18] = {0, 0, 0, 1, 0, 0, 0, 1, 0, 1, 0.5f, 0, 0, 1, 0.25f, 0.5f, 0.5f, 1};

static void assert_glow(const Scene *scene, float u, float v, const float wanted[3]) {
    float rgb[3];
    TrianglePoint point = triangle_point(scene, 0, u, v);
    emitted_rgb(scene, 0, &point, rgb);
    for (int i = 0; i < 3; i++) assert_near(rgb[i], wanted[i], 2e-5f);
}

/* KHR_materials_unlit: the factor times the vertices' colours; emission has none of them. */
TEST_WITH(unlit_shines_by_its_vertices_colours, maker_reset, NULL) {
    const char *members = "'bufferViews':[" VIEW(0, 36) "," VIEW(36, 36) "],'accessors':[" FLOATS(
        0, 3,
        "VEC3") "," FLOATS(1, 3,
                           "VEC3") "],'materials':[{%s}],"
                                   "'meshes':[{'primitives':[{'attributes':{'POSITION':0,'COLOR_0':1},"
                                   "'material':0}]}],'scene':0," ONE_NODE
                                   ",'extensionsUsed':['KHR_materials_unlit']";
    Scene *unlit = maker_load(
        UNLIT, 72,
        maker_format(members,
                     "'pbrMetallicRoughness':{'baseColorFactor':[0.5,0.8,1,1]},'extensions':{"
                     "'KHR_materials_unlit':{}}"));
    Scene *glows = maker_load(UNLIT, 72, maker_format(members, "'emissiveFactor':[1,0.5,0.25]"));
    assert_glow(unlit, 0, 0, (float[3]){0.5f, 0.4f, 0});
    assert_glow(unlit, 1, 0, (float[3]){0, 0.8f, 0.25f});
    assert_glow(unlit, 0, 1, (float[3]){0.25f, 0.4f, 1});
    assert_glow(unlit, 0.25f, 0.25f, (float[3]){0.3125f, 0.5f, 0.3125f});
    assert_glow(glows, 1, 0, (float[3]){1, 0.5f, 0.25f});
}

/* ---- words of messages ------------------------------------------------------------------- */

#define ONE_VIEW "'bufferViews':[" VIEW0(72) "],"
#define OF(code, count, type) \
    "{'bufferView':0,'componentType':" #code ",'count':" #count ",'type':'" type "'}"

/* Every message with a component type says its name and its number. */
TEST_WITH(component_types_are_named, maker_reset, NULL) {
    static const char *const NAMES[] = {
        "BYTE (5120)", "UNSIGNED_BYTE (5121)", "SHORT (5122)", "UNSIGNED_SHORT (5123)",
        "INT (5124)",  "UNSIGNED_INT (5125)",  "FLOAT (5126)"};
    static const float bytes[18] = {0};
    for (int code = 5120; code <= 5126; code++) {
        maker_reset(NULL);
        assert_string_equal(component_name(code), NAMES[code - 5120]);
        FaultCase position = {
            maker_format(ONE_VIEW "'accessors':[{'bufferView':0,'componentType':%d,'count':2,"
                                  "'type':'VEC2'}]," MESH_OF("'POSITION':0") ONE_NODE,
                         code),
            "/meshes/0/primitives/0/attributes/POSITION",
            maker_format("POSITION is VEC2 of component type %s", NAMES[code - 5120])};
        maker_expect_fault(&position, bytes, sizeof bytes);
    }
    assert_string_equal(component_name(5119), "unknown");
    assert_string_equal(component_name(5127), "unknown");
    static const FaultCase CASES[] = {
        {ONE_VIEW "'accessors':[" OF(5124, 2, "SCALAR") "]", "/accessors/0/componentType",
         "is INT (5124), one of BYTE (5120)|UNSIGNED_BYTE (5121)|SHORT (5122)|UNSIGNED_SHORT "
         "(5123)|UNSIGNED_INT (5125)|FLOAT (5126) is required"},
        {ONE_VIEW "'accessors':[" FLOATS(0, 3, "VEC3") "," OF(
             5122, 3,
             "SCALAR") "],"
                       "'meshes':[{'primitives':[{'attributes':{'POSITION':0},'indices':1}]}]," ONE_NODE,
         "/meshes/0/primitives/0/indices",
         "SCALAR of component type SHORT (5122), SCALAR of "
         "UNSIGNED_BYTE (5121), UNSIGNED_SHORT (5123) or UNSIGNED_INT (5125)"},
        {ONE_VIEW "'accessors':[" OF(5122, 1, "MAT4") "],'skins':[{'joints':[0],"
                                                      "'inverseBindMatrices':0}],'nodes':[{}]",
         "/skins/0/inverseBindMatrices",
         "MAT4 of component type SHORT (5122), MAT4 of FLOAT (5126)"},
        {ONE_VIEW "'accessors':[" OF(
             5123, 1, "VEC3") "],'nodes':[{'extensions':{"
                              "'EXT_mesh_gpu_instancing':{'attributes':{'TRANSLATION':0}}}}]",
         "/nodes/0/extensions/EXT_mesh_gpu_instancing/attributes/TRANSLATION",
         "VEC3 of component type UNSIGNED_SHORT (5123), VEC3 of FLOAT (5126)"},
        {ONE_VIEW "'accessors':[" OF(
             5121, 1,
             "SCALAR") "],'nodes':[{}],'animations':[{"
                       "'channels':[{'sampler':0,'target':{'node':0,'path':'scale'}}],'samplers':[{'input':0,"
                       "'output':0}]}]",
         "/animations/0/samplers/0",
         "the times are SCALAR of component type "
         "UNSIGNED_BYTE (5121), SCALAR of FLOAT (5126)"},
        {ONE_VIEW "'accessors':[" FLOATS(0, 1, "SCALAR") "," OF(
             5120, 1,
             "VEC3") "],"
                     "'nodes':[{}],'animations':[{'channels':[{'sampler':0,'target':{'node':0,"
                     "'path':'scale'}}],'samplers':[{'input':0,'output':1}]}]",
         "/animations/0/channels/0", "VEC3 of component type BYTE (5120)"}};
    maker_expect_faults(CASES, sizeof CASES / sizeof *CASES, bytes, sizeof bytes);
}

/* Once a lamp, by its name. */
TEST_WITH(the_range_of_a_lamp_is_warned_of, maker_reset, NULL) {
    Found found = maker_survey_file(maker_gltf(
        "", 0,
        "'extensionsUsed':['KHR_lights_punctual'],'scene':0,'scenes':[{'nodes':[0,1,2]}],"
        "'nodes':[{'extensions':{'KHR_lights_punctual':{'light':0}}},"
        "{'extensions':{'KHR_lights_punctual':{'light':0}}},"
        "{'extensions':{'KHR_lights_punctual':{'light':2}}}],"
        "'extensions':{'KHR_lights_punctual':{'lights':[{'type':'point','name':'dome','range':"
        "2.5},{'type':'point','name':'plain'},{'type':'directional','range':7}]}}"));
    assert_int_equal(found.problems.count, 2);
    assert_non_null(maker_find(&found, "/extensions/KHR_lights_punctual/lights/0/range",
                               "the range of \"dome\" (2.5 m) is not used: its light"));
    assert_non_null(maker_find(&found, "/extensions/KHR_lights_punctual/lights/2/range",
                               "(7 m) is not used: a directional light has none"));
    assert_int_equal(found.scene->light_count, 3);
}

/* ---- other makers' extensions ------------------------------------------------------------ */

TEST_WITH(extensions_of_other_makers_are_named, maker_reset, NULL) {
    static const struct {
        const char *name, *note;
    } CASES[] = {
        {"ASOBO_primitive", "(Asobo Studio's, for Microsoft Flight Simulator: slices of"},
        {"ASOBO_asset_optimized", "Flight Simulator: geometry as the simulator packs it"},
        {"ASOBO_material_windshield_v3", "Flight Simulator: a windscreen with rain"},
        {"ASOBO_material_glass", "Flight Simulator: glass"},
        {"ASOBO_material_of_tomorrow", "Flight Simulator: a material of the simulator's own)"},
        {"ASOBO_tomorrow", "Flight Simulator: what the simulator alone reads)"},
        {"MSFT_texture_dds", "(Microsoft's: pictures in DDS)"},
        {"MSFT_lod", "(Microsoft's: coarser models"},
        {"AGI_articulations", "(Analytical Graphics', for Systems Tool Kit: parts that move)"},
        {"VRM", "(the VRM Consortium's: avatars)"},
        {"MPEG_media", "(MPEG's)"},
        {"ACME_unknown", "\"ACME_unknown\""}};
    for (size_t i = 0; i < sizeof CASES / sizeof *CASES; i++)
        for (int is_required = 0; is_required < 2; is_required++) {
            maker_reset(NULL);
            Found found = maker_survey_file(maker_gltf(
                "", 0,
                maker_format("'extensionsUsed':['%s']%s", CASES[i].name,
                             is_required
                                 ? maker_format(",'extensionsRequired':['%s']", CASES[i].name)
                                 : "")));
            assert_int_equal(found.problems.count, 1);
            assert_int_equal(found.problems.error_count, is_required);
            const char *said = found.problems.list[0].message;
            if (!strstr(said, CASES[i].note) || !strstr(said, CASES[i].name))
                fail_msg("\"%s\" does not say %s", said, CASES[i].note);
        }
}

/* The simulator's packing shows in extras, whatever the file lists. */
TEST_WITH(slices_of_packed_meshes_are_warned_of, maker_reset, NULL) {
    static const struct {
        const char *slice;
        bool is_told;
    } CASES[] = {{"'PrimitiveCount':1", false},
                 {"'PrimitiveCount':1,'StartIndex':0,'BaseVertexIndex':0", false},
                 {"'PrimitiveCount':2", true},
                 {"'PrimitiveCount':1,'StartIndex':3", true},
                 {"'BaseVertexIndex':8", true}};
    static const float corners[12] = {0, 0, 0, 1, 0, 0, 0, 1, 0};
    for (size_t i = 0; i < sizeof CASES / sizeof *CASES; i++) {
        Found found = maker_survey_file(maker_gltf(
            corners, 48,
            maker_format(
                "'bufferViews':[" VIEW(0, 36) "," VIEW(36, 12) "],'accessors':[" FLOATS(
                    0, 3,
                    "VEC3") ",{'bufferView':1,'componentType':5125,'count':3,"
                            "'type':'SCALAR'}],'meshes':[{'primitives':[{'attributes':{'POSITION':0},"
                            "'indices':1,'extras':{'ASOBO_primitive':{%s}}}]}]," ONE_NODE,
                CASES[i].slice)));
        assert_int_equal(maker_find(&found, "/meshes/0/primitives/0/extras/ASOBO_primitive",
                                    "Microsoft Flight Simulator") != NULL,
                         CASES[i].is_told);
    }
}

/* A packed model's textures are DDS files in another folder: nobody looks for them. */
TEST_WITH(pictures_that_are_not_read_need_not_be_there, maker_reset, NULL) {
    Found found = maker_survey_file(maker_gltf(
        "", 0,
        "'extensionsUsed':['MSFT_texture_dds'],'images':[{'uri':'GLASS.PNG.DDS'}],'textures':[{"
        "'extensions':{'MSFT_texture_dds':{'source':0}}}],'materials':[{'emissiveTexture':{"
        "'index':0}}],'meshes':[{'primitives':[{'attributes':{},'material':0}]}]"));
    assert_int_equal(found.problems.error_count, 0);
    assert_non_null(maker_find(&found, "/extensionsUsed/0", "pictures in DDS"));
    assert_non_null(maker_find(&found, "/images/0/uri", "No such file"));
}

/* DirectX's normal maps are green where a normal leans down. */
TEST_WITH(the_simulator_s_normal_maps_lean_its_way, maker_reset, NULL) {
    static const char MATERIAL[] =
        "'materials':[{'normalTexture':{'index':0,'scale':0.5},'extensions':{"
        "'KHR_materials_clearcoat':{'clearcoatFactor':1,"
        "'clearcoatNormalTexture':{'index':0}}}}]";
    static const struct {
        const char *members;
        float side;
    } CASES[] = {{"'extensions':{'" NORMAL_CONVENTION_EXTENSION "':{'tangent_space_convention':"
                  "'DirectX'}},",
                  -1},
                 {"'extensions':{'" NORMAL_CONVENTION_EXTENSION "':{'tangent_space_convention':"
                  "'OpenGL'}},",
                  1},
                 {"", 1}};
    for (size_t i = 0; i < sizeof CASES / sizeof *CASES; i++) {
        Found found = maker_survey_file(maker_gltf(
            "", 0,
            maker_format("'extensionsUsed':['KHR_materials_clearcoat','" NORMAL_CONVENTION_EXTENSION
                         "'],"
                         "%s" PICTURE "%s",
                         CASES[i].members, MATERIAL)));
        const Material *m = &found.scene->materials[0];
        assert_int_equal(found.problems.count, 0);
        assert_near(m->normal_scale.x, 0.5f, 0);
        assert_near(m->normal_scale.y, 0.5f * CASES[i].side, 0);
        assert_near(m->clearcoat_normal_scale.x, 1, 0);
        assert_near(m->clearcoat_normal_scale.y, CASES[i].side, 0);
    }
}

/* ---- names of files ---------------------------------------------------------------------- */

static void put_file(const char *folder, const char *name) {
    FILE *file = fopen(maker_format("%s/%s", folder, name), "wb");
    assert_true(file && fclose(file) == 0);
}

/* Each kind of file that a scene names; %s is the uri. */
static const char *const NAMERS[] = {
    "'buffers':[{'byteLength':4,'uri':'%s'}]",
    ("'images':[{'uri':'%s'}],'textures':[{'source':0}],'materials':[{'emissiveTexture':{"
     "'index':0}}],'meshes':[{'primitives':[{'attributes':{},'material':0}]}]"),
    "'materials':[{'name':'m','extensions':{'PARHELION_display':{'panel':'%s'}}}]",
    "'materials':[{'extensions':{'PARHELION_spectrum':{'baseColor':'%s'}}}]",
    "'scene':0,'scenes':[{'extensions':{'PARHELION_environment':{'type':'hdri','uri':'%s'}}}]",
    "'extensions':{'EXT_lights_ies':{'lights':[{'uri':'%s'}]}}"};

/* What is requested, what is there, and what is said. */
static const struct {
    const char *uri, *name, *text;
} NAMES[] = {
    {"dash.png", "Dash.PNG", "\"Dash.PNG\" is there: its letter case differs"},
    {"caf%C3%A9.png", "CAF\xC3\xA9.PNG", "is there: its letter case differs"},
    {"my%20dash.png", "my%20dash.png", "\"my%20dash.png\" is there: only its percent escapes"},
    {"my%2520dash.png", "my dash.png", "\"my dash.png\" is there: only its percent escapes"},
    {"SUB/dash.png", "sub/dash.png", "\"sub/dash.png\" is there: its letter case differs"},
    {"dash.png", "dashes.png", NULL},
    {"dash.png", "sub/dash.png", NULL}};

TEST_WITH(names_that_are_almost_there_are_hinted_at, maker_reset, NULL) {
    const char *folder = maker_format("%s/names", maker.folder);
    const char *sub = maker_format("%s/sub", folder);
    for (size_t i = 0; i < sizeof NAMES / sizeof *NAMES; i++) {
        const char *path = maker_format("%s/%s", folder, NAMES[i].name);
        assert_true(mkdir(folder, 0777) == 0 && mkdir(sub, 0777) == 0);
        put_file(folder, NAMES[i].name);
        for (size_t k = 0; k < sizeof NAMERS / sizeof *NAMERS; k++) {
            char *at = strstr(NAMERS[k], "%s");
            const char *members =
                maker_format("%.*s%s%s", (int)(at - NAMERS[k]), NAMERS[k], NAMES[i].uri, at + 2);
            char *text = maker_text("", 0, members);
            const char *scene = maker_format("%s/scene.gltf", folder);
            FILE *file = fopen(scene, "wb");
            assert_true(file && fputs(text, file) >= 0 && fclose(file) == 0);
            Found found = maker_survey_file(scene);
            bool is_hinted = false;
            for (int p = 0; p < found.problems.count; p++) {
                const char *said = found.problems.list[p].message;
                is_hinted |= NAMES[i].text ? strstr(said, NAMES[i].text) != NULL
                                           : strstr(said, "is there") != NULL;
            }
            if (is_hinted != (NAMES[i].text != NULL))
                fail_msg("%s: %s", members, found.problems.list[0].message);
            assert_true(found.problems.error_count > 0);
            unlink(scene);
        }
        assert_true(unlink(path) == 0 && rmdir(sub) == 0 && rmdir(folder) == 0);
    }
}

/* ---- the inputs that were handed in ------------------------------------------------------ */

#define CASES_DIR SHARED_DATA_DIR "/cases/light/"

static Found survey_case(const char *name) {
    return maker_survey_file(maker_format(CASES_DIR "%s", name));
}

TEST_WITH(cases_of_others_are_as_they_are_to_be, maker_reset, NULL) {
    struct stat info;
    if (stat(CASES_DIR, &info) != 0) skip();
    const Transform plain = survey_case("13_camera_plain.gltf").scene->cameras[0].world_from_camera;
    const Transform mirrored =
        survey_case("13_camera_scale_-1_1_1.gltf").scene->cameras[0].world_from_camera;
    assert_places(&mirrored, &plain, "13");
    Found packed = survey_case("08_draco_accessor_counts_3_less.gltf");
    assert_int_equal(packed.problems.error_count, 0);
    assert_true(packed.scene->triangle_count > 0 && packed.problems.count > 0);
    const Scene *unlit = survey_case("01_unlit_vertex_colour.gltf").scene;
    assert_glow(unlit, 0, 0, (float[3]){1, 0, 0});
    assert_glow(unlit, 1, 0, (float[3]){0, 1, 0});
    assert_glow(unlit, 0, 1, (float[3]){0, 0, 1});
}

TEST_PROGRAM(maker_start, maker_end)
