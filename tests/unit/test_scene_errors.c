/* SPDX-License-Identifier: Apache-2.0 */
/* Everything that is wrong with a file is found, and said with its place. */
#include "fixture.h"
#include "base/count.h"
#include "gltf_maker.h"
#include "text/removed.h"

/* The bytes behind the cases: a triangle, its indices 0 1 9, and a triangle with a NaN. */
static const struct {
    float points[9];
    uint16_t indices[4];
    float broken[9];
} BYTES = {{0, 0, 0, 1, 0, 0, 0, 1, 0}, {0, 1, 9, 0}, {0, 0, 0, NAN, 0, 0, 0, 1, 0}};

#define VIEWS "'bufferViews':[" VIEW0(36) "," VIEW(36, 8) "," VIEW(44, 36) "],"
#define POINTS FLOATS(0, 3, "VEC3")
#define PRIMITIVE(body) VIEWS "'accessors':[" POINTS "],'meshes':[{'primitives':[{" body "}]}]"

#define PROFILE_PLACE "/extensions/EXT_lights_ies/lights/0"
#define PROFILES(body) \
    "'extensionsUsed':['EXT_lights_ies'],'extensions':{'EXT_lights_ies':{'lights':[{" body \
    "}]}},'scene':0,'scenes':[{'nodes':[0]}],'nodes':[{'extensions':{'EXT_lights_ies':" \
    "{'light':0}}}]"
#define PROFILED_NODE(body) \
    "'extensionsUsed':['EXT_lights_ies'],'nodes':[{'extensions':{'EXT_lights_ies':{" body "}}}]"

#define SKY_PLACE "/scenes/0/extensions/PARHELION_environment"
#define SKY(body) \
    "'extensionsUsed':['PARHELION_environment'],'scenes':[{'extensions':" \
    "{'PARHELION_environment':{" body "}}}]"
#define SHOWN_PLACE "/materials/0/extensions/PARHELION_display"
#define SHOWN(name, body) \
    "'extensionsUsed':['PARHELION_display'],'materials':[{" name "'extensions':" \
    "{'PARHELION_display':{" body "}}}]"

static const FaultCase FAULTS[] = {
    /* kinds and ranges */
    {"'nodes':{}", "/nodes", "is an object, an array is required"},
    {"'nodes':[3]", "/nodes/0", "is 3, an object is required"},
    {"'nodes':[{'name':7}]", "/nodes/0/name", "is 7, a text is required"},
    {"'nodes':[{'rotation':[0,1]}]", "/nodes/0/rotation", "is an array of 2, an array of 4"},
    {"'materials':[{'pbrMetallicRoughness':{'baseColorFactor':'red'}}]",
     "/materials/0/pbrMetallicRoughness/baseColorFactor", "is \"red\", an array is required"},
    {"'materials':[{'pbrMetallicRoughness':{'metallicFactor':2}}]",
     "/materials/0/pbrMetallicRoughness/metallicFactor", "is 2, a number from 0 to 1 is required"},
    {"'materials':[{'alphaMode':'CUTOUT'}]", "/materials/0/alphaMode",
     "is \"CUTOUT\", one of OPAQUE|MASK|BLEND is required"},
    {"'accessors':[{'componentType':5124,'count':1,'type':'SCALAR'}]", "/accessors/0/componentType",
     "is INT (5124), one of BYTE (5120)|UNSIGNED_BYTE (5121)|"},
    {"'accessors':[{'componentType':5126,'count':-1,'type':'SCALAR'}]", "/accessors/0/count",
     "is -1, an integer from 1 to"},
    {"'accessors':[{'componentType':5126,'count':1.5,'type':'SCALAR'}]", "/accessors/0/count",
     "is 1.5, an integer"},
    {"'accessors':[{'componentType':5126,'count':100000000,'type':'SCALAR'}]", "/accessors/0/count",
     "without a buffer view"},
    {"'accessors':[{'count':1,'type':'SCALAR'}]", "/accessors/0", "\"componentType\" is missing"},
    {"'nodes':[{'mehs':0}]", "/nodes/0/mehs", "is skipped; is \"mesh\" meant?"},
    /* references */
    {"'nodes':[{'mesh':5}]", "/nodes/0/mesh", "is 5, but there are 0 in meshes"},
    {"'scene':2,'scenes':[{}]", "/scene", "is 2, but there is 1 in scenes"},
    {"'textures':[{'source':1}]", "/textures/0/source", "there are 0 in images"},
    {"'materials':[{'normalTexture':{'index':0}}]", "/materials/0/normalTexture/index",
     "there are 0 in textures"},
    {VIEWS "'accessors':[" FLOATS(9, 1, "SCALAR") "]", "/accessors/0/bufferView",
     "is 9, but there are 3 in bufferViews"},
    /* the tree of nodes */
    {"'nodes':[{'children':[1]},{'children':[0]}]", "/nodes/0", "is its own descendant"},
    {"'nodes':[{'children':[2]},{'children':[2]},{}]", "/nodes/1/children/0",
     "node 2 has two parents, nodes 0 and 1"},
    {"'nodes':[{'children':[1]},{}],'scenes':[{'nodes':[1]}]", "/scenes/0/nodes/0",
     "node 1 is a child of node 0"},
    {"'nodes':[{'matrix':[1,0,0,1,0,1,0,0,0,0,1,0,0,0,0,1]}]", "/nodes/0/matrix",
     "the last row is (1, 0, 0, 1)"},
    {"'nodes':[{'matrix':[1,0,0,0,0,1,0,0,0,0,1,0,0,0,0,1],'scale':[1,1,1]}]", "/nodes/0",
     "has \"matrix\" and \"scale\""},
    {"'nodes':[{'rotation':[0,0,0.5,0.5]}]", "/nodes/0/rotation", "length is 0.707107"},
    /* bytes */
    {"'bufferViews':[" VIEW(70, 36) "]", "/bufferViews/0",
     "takes bytes 70 to 106 of a buffer of 80 bytes"},
    {VIEWS "'accessors':[" FLOATS(0, 4, "VEC3") "]", "/accessors/0",
     "needs bytes 0 to 48 of a buffer view of 36 bytes"},
    {VIEWS "'accessors':[{'bufferView':0,'byteOffset':2,'componentType':5126,'count':1,"
           "'type':'VEC3'}]",
     "/accessors/0", "starts at byte 2 of the buffer, a multiple of 4"},
    {"'bufferViews':[{'buffer':0,'byteLength':36,'byteStride':8}],'accessors':[" POINTS "]",
     "/accessors/0", "elements of 12 bytes in a buffer view whose byteStride is 8"},
    {VIEWS "'accessors':[" FLOATS(2, 3, "VEC3") "]", "/accessors/0",
     "element 1 has the component nan"},
    {VIEWS "'accessors':[{'componentType':5126,'count':2,'type':'SCALAR','sparse':{'count':3,"
           "'indices':{'bufferView':1,'componentType':5123},'values':{'bufferView':0}}}]",
     "/accessors/0/sparse/count", "is 3, the accessor has 2 elements"},
    {"'buffers ':0", "/buffers ", "is skipped; is \"buffers\" meant?"},
    /* shapes */
    {PRIMITIVE("'attributes':{'POSITION':0,'NORMAL':0},'indices':0"),
     "/meshes/0/primitives/0/indices", "VEC3 of component type FLOAT (5126), SCALAR"},
    {VIEWS
     "'accessors':[" POINTS ",{'bufferView':1,'componentType':5123,'count':3,"
     "'type':'SCALAR'}],'meshes':[{'primitives':[{'attributes':{'POSITION':0},'indices':1}]}]",
     "/meshes/0/primitives/0/indices", "index 2 is 9, the primitive has 3 vertices"},
    {VIEWS "'accessors':[" POINTS "," FLOATS(
         0, 2, "VEC3") "],"
                       "'meshes':[{'primitives':[{'attributes':{'POSITION':0,'NORMAL':1}}]}]",
     "/meshes/0/primitives/0/attributes/NORMAL", "NORMAL has 2 elements, POSITION has 3"},
    {PRIMITIVE("'attributes':{'POSITION':0,'TEXCOORD_0':0}"),
     "/meshes/0/primitives/0/attributes/TEXCOORD_0", "(VEC2 is required)"},
    {PRIMITIVE("'attributes':{'POSITION':0,'NORMALS':0}"),
     "/meshes/0/primitives/0/attributes/NORMALS", "\"NORMALS\" is no attribute"},
    {PRIMITIVE("'attributes':{}"), "/meshes/0/primitives/0/attributes", "has no POSITION"},
    {VIEWS "'accessors':[" POINTS "],'meshes':[{'weights':[1,2],'primitives':[{'attributes':"
           "{'POSITION':0},'targets':[{'POSITION':0}]}]}]",
     "/meshes/0/weights", "has 2 weights, the mesh has 1 morph targets"},
    /* files */
    {"'images':[{'uri':'http://example.com/a.png'}]", "/images/0/uri", "scheme is \"http:\""},
    {"'images':[{'uri':'/etc/passwd'}]", "/images/0/uri", "an absolute path"},
    {"'images':[{'uri':'../../a.png'}]", "/images/0/uri", "leaves the parent"},
    {"'images':[{'uri':'%2e%2e/%2e%2e/a.png'}]", "/images/0/uri", "leaves the parent"},
    {"'images':[{'uri':'a%zz.png'}]", "/images/0/uri", "broken escape \"%zz\""},
    {"'images':[{'uri':'none.png'}]", "/images/0/uri", "cannot be opened: No such file"},
    {"'images':[{}]", "/images/0", "has neither; either \"uri\" or \"bufferView\""},
    /* cameras and lights */
    {"'cameras':[{'type':'perspective'}]", "/cameras/0", "\"perspective\" is missing"},
    {"'cameras':[{'type':'perspective','perspective':{'yfov':0,'znear':1}}]",
     "/cameras/0/perspective/yfov", "is 0, a number above 0"},
    {"'cameras':[{'type':'orthographic','orthographic':{'xmag':0,'ymag':1,'znear':0,'zfar':1}}"
     "]",
     "/cameras/0/orthographic/xmag", "is 0, half the picture's size"},
    {"'cameras':[{'type':'perspective','perspective':{'yfov':1,'znear':2,'zfar':1}}]",
     "/cameras/0/perspective/zfar", "is 1, more than znear (2)"},
    {"'extensionsUsed':['KHR_lights_punctual'],'extensions':{'KHR_lights_punctual':{'lights':"
     "[{'type':'point','intensity':-1}]}}",
     "/extensions/KHR_lights_punctual/lights/0/intensity", "is -1, a number of at least 0"},
    {PROFILES("'uri':'none.ies'"), PROFILE_PLACE "/uri", "none.ies: cannot be opened"},
    {PROFILES("'uri':'../../../none.ies'"), PROFILE_PLACE "/uri", "--root"},
    {PROFILES("'uri':'/none.ies'"), PROFILE_PLACE "/uri", "is an absolute path"},
    {PROFILES("'uri':'a%zz.ies'"), PROFILE_PLACE "/uri", "broken escape \"%zz\""},
    {PROFILES("'uri':'lamp.ldt'"), PROFILE_PLACE "/uri", "is EULUMDAT"},
    {PROFILES("'uri':'data:application/x-ies-lm-63,TILT=NONE%0Abright'"), PROFILE_PLACE "/uri",
     "line 2: the number of lamps is 'bright'"},
    {PROFILES("'uri':'data:text/plain,TILT=NONE'"), PROFILE_PLACE "/uri",
     "application/x-ies-lm-63 is required"},
    {PROFILES("'name':'spot'"), PROFILE_PLACE, "has neither; either \"uri\" or \"bufferView\""},
    {PROFILES("'uri':'a.ies','bufferView':0"), PROFILE_PLACE, "has both"},
    {PROFILES("'bufferView':7"), PROFILE_PLACE "/bufferView", "is 7, but there are 0 in"},
    {PROFILES("'uri':'a.ies','mimeType':'text/plain'"), PROFILE_PLACE "/mimeType",
     "one of application/x-ies-lm-63"},
    {PROFILED_NODE("'light':3"), "/nodes/0/extensions/EXT_lights_ies/light",
     "is 3, but there are 0 in lights"},
    {PROFILED_NODE("'multiplier':1"), "/nodes/0/extensions/EXT_lights_ies", "\"light\" is missing"},
    {PROFILED_NODE("'light':0,'multiplier':-2"), "/nodes/0/extensions/EXT_lights_ies/multiplier",
     "is -2, a number of at least 0"},
    {PROFILED_NODE("'light':0,'color':[0,2,0]"), "/nodes/0/extensions/EXT_lights_ies/color/1",
     "is 2, a number from 0 to 1"},
    /* extensions */
    {"'extensionsRequired':['ACME_magic']", "/extensionsRequired/0",
     "requires the extension \"ACME_magic\", which is not supported"},
    {"'extensionsUsed':['ACME_magic']", "/extensionsUsed/0", "\"ACME_magic\" is not supported"},
    {"'materials':[{'extensions':{'KHR_materials_ior':{'ior':1.4}}}]",
     "/materials/0/extensions/KHR_materials_ior", "not listed in extensionsUsed"},
    {SHOWN("'name':'cluster',", "'panel':'none.panel','level':-1"), SHOWN_PLACE "/level",
     "is -1, a number of at least 0"},
    {SHOWN("", "'panell':'x'"), SHOWN_PLACE "/panell",
     "unknown key; the nearest known one is 'panel'"},
    {SHOWN("'name':'cluster',", "'panel':'none.panel'"), SHOWN_PLACE "/panel",
     "display \"cluster\": "},
    {SHOWN("", ""), SHOWN_PLACE, "\"panel\" is missing, and --panel names none"},
    {SKY("'type':'hdri'"), SKY_PLACE, "\"uri\" is missing in an environment of type \"hdri\""},
    {SKY("'type':'fog'"), SKY_PLACE "/type", "is \"fog\", one of constant|hdri|cie|perez|sky"},
    {SKY("'type':'constant','luminance':1,'sky':3"), SKY_PLACE "/sky",
     "no meaning for an environment of type"},
    {SKY("'type':'sky','when':'2026-06-21T08:30+02:00','where':[48,11],'moon':'new'"),
     SKY_PLACE "/moon", "is \"new\", true or false is required"},
    {SKY("'type':'sky','when':'2026-06-21T08:30Z','where':[48,11],'cloud_relief_m':2000"),
     SKY_PLACE "/cloud_relief_m", "is 2000, a number from 0 to 1000"},
    {SKY("'type':'sky','when':'2026-06-21T08:30Z','where':[48,11],'cloud_relief_m':300"),
     SKY_PLACE "/cloud_relief_m", "has no meaning unless \"ground\" is \"cloud\""},
    {SKY("'type':'sky','when':'2026-06-21T08:30Z','where':[48,11],'cloud_relief':300"),
     SKY_PLACE "/cloud_relief", "unknown key; the nearest known one is 'cloud_relief_m'"},
    {SKY("'type':'sky','when':'yesterday','where':[95,0]"), SKY_PLACE "/when",
     "is \"yesterday\", a time like"},
    {SKY("'type':'sky','when':'2026-06-21T08:30+02:00','where':[95,0]"), SKY_PLACE "/where/0",
     "is 95, a latitude"},
    {"'extensionsUsed':['PARHELION_spectrum'],'materials':[{'extensions':{'PARHELION_spectrum':"
     "{'baseColor':'none.csv'}}}]",
     "/materials/0/extensions/PARHELION_spectrum/baseColor", "No such file"},
};

TEST_WITH(every_fault_is_named_with_its_place, maker_reset, NULL) {
    maker_expect_faults(FAULTS, COUNT_OF(FAULTS), &BYTES, sizeof BYTES);
}

/* An extension of materials; "PARHELION_environment" is a scene's. */
static void expect_removed_key(const RemovedWord *row) {
    bool is_sky = !strcmp(row->where, "PARHELION_environment");
    const char *host = is_sky ? "scenes" : "materials";
    char members[512], place[256];
    snprintf(members, sizeof members,
             "'extensionsUsed':['%s'],'%s':[{'extensions':{'%s':{'%s':null}}}]", row->where, host,
             row->where, row->word);
    snprintf(place, sizeof place, "/%s/0/extensions/%s/%s", host, row->where, row->word);
    maker_expect_faults(&(FaultCase){members, place, row->instead}, 1, &BYTES, sizeof BYTES);
}

TEST_WITH(removed_keys_of_extensions_are_refused_with_what_to_do_instead, maker_reset, NULL) {
    int count = 0;
    for (const RemovedWord *row = removed_words; row->word; row++) {
        if (strncmp(row->where, "PARHELION_", 10) != 0) continue;
        expect_removed_key(row);
        count++;
    }
    assert_true(count > 0);
}

static void assert_text(const char *text, const char *place, const char *message) {
    Found found = maker_survey_file(maker_file(text, strlen(text), ".gltf"));
    if (!maker_find(&found, place, message))
        fail_msg("%s: found \"%s\"", text,
                 found.problems.count ? found.problems.list[0].message : "nothing");
}

TEST_WITH(documents_that_are_none_are_refused, maker_reset, NULL) {
    assert_text("", "", "not valid JSON: parse error at line 1, column 1");
    assert_text("{\"asset\":", "", "not valid JSON: parse error at line 1, column 10");
    assert_text("[]", "", "the document is no JSON object");
    assert_text("{}", "", "\"asset\" is missing");
    assert_text("{\"asset\":{\"version\":\"1.0\"}}", "/asset/version", "is \"1.0\", version 2.0");
    assert_text("{\"asset\":{\"version\":\"2.0\"},\"asset\":{}}", "", "stands twice in one object");
    assert_text("{\"asset\":{\"version\":\"2.0\"},\"a\":1e999}", "",
                "not valid JSON: number overflow");
}

TEST_WITH(a_buffer_without_bytes_is_told, maker_reset, NULL) {
    static const char TEXT[] =
        "{\"asset\":{\"version\":\"2.0\"},\"buffers\":[{\"byteLength\":36}],"
        "\"bufferViews\":[{\"buffer\":0,\"byteLength\":36}],\"accessors\":[{\"bufferView\":0,"
        "\"componentType\":5126,\"count\":3,\"type\":\"VEC3\"}],\"meshes\":[{\"primitives\":"
        "[{\"attributes\":{\"POSITION\":0}}]}],\"scenes\":[{\"nodes\":[0]}],"
        "\"nodes\":[{\"mesh\":0}]}";
    assert_text(TEXT, "/bufferViews/0", "its buffer has no \"uri\"");
    assert_text(TEXT, "/meshes/0/primitives/0", "the bytes of POSITION are missing");
}

TEST_WITH(deep_nesting_is_refused, maker_reset, NULL) {
    const int depth = 200000;
    char *text = ARENA_NEW(&maker.arena, char, depth + 1);
    memset(text, '[', (size_t)depth);
    assert_text(text, "", "JSON nested deeper than 256 levels");
}

TEST_WITH(all_problems_are_reported_not_the_first, maker_reset, NULL) {
    Found found = maker_survey_file(
        maker_gltf(NULL, 0,
                   "'nodes':[{'mesh':5},{'camera':1}],'scene':3,'materials':[{'alphaMode':1}],"
                   "'images':[{'uri':'none.png'}]"));
    assert_int_equal(found.problems.error_count, 4);
}

TEST_WITH(the_first_error_reaches_the_command_line, maker_reset, NULL) {
    Scene *scene = NULL;
    Problems problems = problems_start(&maker.arena);
    const char *path = maker_gltf(NULL, 0, "'nodes':[{'mesh':5},{'camera':1}]");
    const SceneOptions options = {.paths = &path, .path_count = 1};
    assert_false(scene_load(&options, &maker.arena, &problems, &scene, why()));
    assert_null(scene);
    assert_int_equal(why()->code, ERROR_INPUT);
    assert_string_equal(why()->file, path);
    assert_string_equal(why()->path, "/nodes/0/mesh");
    assert_non_null(strstr(why()->text, "and 1 more"));
}

/* ---- displays and the command line's overrides
 * -------------------------------------------------- */

/* A display with these texture coordinates (two triangles would say the same of each). */
static Found survey_display(const float uv[6], const SceneOptions *more) {
    struct {
        float points[9], uv[6];
    } data = {{0, 0, 0, 1, 0, 0, 0, 1, 0}, {0}};
    memcpy(data.uv, uv, sizeof data.uv);
    const char *path = maker_gltf(
        &data, sizeof data,
        "'bufferViews':[" VIEW0(36) "," VIEW(36, 24) "],'accessors':[" FLOATS(0, 3, "VEC3") "," FLOATS(
            1, 3,
            "VEC2") "],'extensionsUsed':['PARHELION_display'],"
                    "'materials':[{'name':'cluster',"
                    "'extensions':{'PARHELION_display':{'panel':'none.panel'}}},{'name':'trim'}],"
                    "'meshes':[{'primitives':[{'material':0,'attributes':{'POSITION':0,"
                    "'TEXCOORD_0':1}}]}]," ONE_NODE);
    SceneOptions options = *more;
    options.paths = &path;
    options.path_count = 1;
    return maker_survey(&options);
}

TEST_WITH(mirrored_displays_are_errors, maker_reset, NULL) {
    static const float UPRIGHT[6] = {0, 1, 1, 1, 0, 0}, MIRRORED[6] = {1, 1, 0, 1, 1, 0};
    static const float NOWHERE[6] = {0, 0, 0, 0, 0, 0};
    const SceneOptions none = {0};
    const char *place = "/meshes/0/primitives/0";
    Found found = survey_display(UPRIGHT, &none);
    assert_null(maker_find(&found, place, ""));
    found = survey_display(MIRRORED, &none);
    assert_non_null(maker_find(&found, place, "1 triangles are mirrored"));
    found = survey_display(NOWHERE, &none);
    assert_non_null(maker_find(&found, place, "span no area"));
}

TEST_WITH(overrides_reach_displays_by_the_material_s_name, maker_reset, NULL) {
    static const float UPRIGHT[6] = {0, 1, 1, 1, 0, 0};
    const SceneOverride levels[] = {{"cluster", "30", NULL},
                                    {"dash", "30", NULL},
                                    {"trim", "5", NULL},
                                    {"cluster", "dim", NULL}};
    const SceneOverride panels[] = {{"trim", "other.panel", NULL}};
    Found found = survey_display(
        UPRIGHT,
        &(SceneOptions){.levels = levels, .level_count = 4, .panels = panels, .panel_count = 1});
    assert_int_equal(found.scene->display_count, 2);
    assert_close(found.scene->displays[0].level, 0.3, 1e-6);
    assert_close(found.scene->displays[1].level, 0.05, 1e-6);
    assert_string_equal(found.scene->displays[1].name, "trim");
    assert_non_null(maker_find(&found, "",
                               "no display is named \"dash\" — there are "
                               "cluster, trim; --panel makes a material one"));
    assert_non_null(maker_find(&found, "", "\"dim\" is no percentage"));
    assert_non_null(maker_find(&found, "", "other.panel: cannot be opened"));
}

/* Two nodes and a third of another mesh wear one material; "both" wears two. */
static Found survey_shared(const SceneOptions *more) {
    struct {
        float points[9], uv[6];
    } data = {{0, 0, 0, 1, 0, 0, 0, 1, 0}, {0, 1, 1, 1, 0, 0}};
    const char *path = maker_gltf(
        &data, sizeof data,
        "'bufferViews':[" VIEW0(36) "," VIEW(
            36,
            24) "],'accessors':[{'bufferView':0,"
                "'componentType':5126,'count':3,'type':'VEC3','min':[0,0,0],'max':[1,1,0]}," FLOATS(
                    1, 3,
                    "VEC2") "],'materials':[{'name':'glass'},{'name':'trim'}],"
                            "'meshes':[{'name':'sheet','primitives':[{'material':0,'attributes':{'POSITION':0,"
                            "'TEXCOORD_0':1}}]},{'name':'frame','primitives':[{'material':0,"
                            "'attributes':{'POSITION':0,'TEXCOORD_0':1}},{'material':1,"
                            "'attributes':{'POSITION':0,'TEXCOORD_0':1}}]}],'scenes':[{'nodes':[0,1,2,3,4]}],"
                            "'nodes':[{'mesh':0,'name':'left'},{'mesh':0,'name':'right'},{'mesh':1,"
                            "'name':'both'},{'mesh':0,'name':'twin'},{'mesh':0,'name':'twin'}]");
    SceneOptions options = *more;
    options.paths = &path;
    options.path_count = 1;
    return maker_survey(&options);
}

static int parts_wearing(const Scene *scene, const char *name) {
    int count = 0;
    for (int i = 0; i < scene->part_count; i++)
        count += !strcmp(scene->materials[scene->parts[i].material_id].name, name);
    return count;
}

TEST_WITH(a_screen_is_named_by_its_node_where_two_share_a_material, maker_reset, NULL) {
    const SceneOverride panels[] = {{"node:left", "a.panel", NULL},
                                    {"node:right", "b.panel", NULL}};
    const SceneOverride levels[] = {{"node:right", "30", NULL}};
    Found found = survey_shared(
        &(SceneOptions){.panels = panels, .panel_count = 2, .levels = levels, .level_count = 1});
    const Scene *scene = found.scene;
    assert_int_equal(scene->display_count, 2);
    assert_string_equal(scene->displays[0].name, "left");
    assert_string_equal(scene->displays[0].panel_path, "a.panel");
    assert_string_equal(scene->displays[1].name, "right");
    assert_close(scene->displays[0].level, 1, 0);
    assert_close(scene->displays[1].level, 0.3, 1e-6);
    assert_int_equal(parts_wearing(scene, "left"), 1);
    assert_int_equal(parts_wearing(scene, "right"), 1);
    assert_int_equal(parts_wearing(scene, "glass"), 3);
    assert_int_equal(scene->materials[0].display_id, NO_ID);
}

TEST_WITH(a_shared_display_is_split_by_what_one_node_shows, maker_reset, NULL) {
    const SceneOverride panels[] = {{"glass", "a.panel", NULL}};
    const SceneOverride levels[] = {{"node:left", "50", NULL}};
    Found found = survey_shared(
        &(SceneOptions){.panels = panels, .panel_count = 1, .levels = levels, .level_count = 1});
    assert_int_equal(found.scene->display_count, 2);
    assert_close(found.scene->displays[0].level, 1, 0);
    assert_close(found.scene->displays[1].level, 0.5, 1e-6);
    assert_string_equal(found.scene->displays[1].panel_path, "a.panel");
    assert_non_null(maker_find(&found, "",
                               "\"glass\" is worn by several nodes, which become "
                               "one display: \"left\", \"right\""));
}

TEST_WITH(what_a_node_s_name_leaves_open_is_told, maker_reset, NULL) {
    static const struct {
        const char *word, *text;
    } CASES[] = {
        {"node:center", "no node with triangles is named \"center\"; there are \"left\""},
        {"mesh:none", "no mesh with triangles is named \"none\"; there are \"sheet\", \"frame\""},
        {"node:both", "node:both wears the materials \"glass\", \"trim\""},
        {"node:twin", "several nodes are named \"twin\"; mesh:NAME"},
    };
    for (size_t i = 0; i < sizeof CASES / sizeof *CASES; i++) {
        const SceneOverride panels[] = {{CASES[i].word, "a.panel", NULL}};
        Found found = survey_shared(&(SceneOptions){.panels = panels, .panel_count = 1});
        if (!maker_find(&found, "", CASES[i].text)) fail_msg("%s", CASES[i].text);
        assert_int_equal(found.scene->display_count, 0);
    }
    const SceneOverride panels[] = {{"mesh:sheet", "a.panel", NULL}};
    Found found = survey_shared(&(SceneOptions){.panels = panels, .panel_count = 1});
    assert_int_equal(parts_wearing(found.scene, "sheet"), 4);
    assert_int_equal(parts_wearing(found.scene, "glass"), 1);
}

/* ---- damaged files
 * ------------------------------------------------------------------------------- */

static const char SMALL[] =
    "{\"asset\":{\"version\":\"2.0\"},\"buffers\":[{\"byteLength\":36}],"
    "\"bufferViews\":[{\"buffer\":0,\"byteLength\":36}],\"accessors\":[{\"bufferView\":0,"
    "\"componentType\":5126,\"count\":3,\"type\":\"VEC3\"}],\"meshes\":[{\"primitives\":"
    "[{\"attributes\":{\"POSITION\":0}}]}],\"nodes\":[{\"mesh\":0}],"
    "\"scenes\":[{\"nodes\":[0]}],\"scene\":0} ";

static void put_u32(unsigned char *at, uint32_t value) {
    for (int i = 0; i < 4; i++) at[i] = (unsigned char)(value >> 8 * i);
}

/* SMALL and BYTES.points as a .glb. */
static size_t small_glb(unsigned char out[1024]) {
    uint32_t json = (uint32_t)(sizeof SMALL - 1) / 4 * 4 + 4, at = 20;
    memset(out, ' ', 1024);
    memcpy(out + at, SMALL, sizeof SMALL - 1);
    at += json;
    put_u32(out + at, 36);
    put_u32(out + at + 4, 0x004E4942);
    memcpy(out + at + 8, BYTES.points, 36);
    at += 44;
    memcpy(out, "glTF", 4);
    put_u32(out + 4, 2);
    put_u32(out + 8, at);
    put_u32(out + 12, json);
    put_u32(out + 16, 0x4E4F534A);
    return at;
}

TEST_WITH(every_prefix_of_a_glb_is_refused, maker_reset, NULL) {
    unsigned char bytes[1024];
    size_t size = small_glb(bytes);
    for (size_t length = 0; length <= size; length++) {
        maker_reset(state);
        Found found = maker_survey_file(maker_file(bytes, length, ".glb"));
        assert_int_equal(found.problems.error_count == 0, length == size);
    }
}

TEST_WITH(every_prefix_of_a_gltf_is_refused, maker_reset, NULL) {
    char *whole =
        maker_text(BYTES.points, 36,
                   "'bufferViews':[" VIEW0(36) "],'accessors':[" FLOATS(0, 3, "VEC3") "]," MESH_OF(
                       "'POSITION':0") "'nodes':[{'mesh':0}],'scenes':[{'nodes':[0]}]");
    char text[1024];
    size_t size = strlen(whole);
    assert_true(size < sizeof text);
    memcpy(text, whole, size);
    for (size_t length = 0; length <= size; length++) {
        maker_reset(state);
        Found found = maker_survey_file(maker_file(text, length, ".gltf"));
        assert_int_equal(found.problems.error_count == 0, length == size);
    }
}

/* Any byte may be anything: refused or read, never a crash (the sanitizers watch). */
TEST_WITH(damaged_bytes_do_no_harm, maker_reset, NULL) {
    unsigned char bytes[1024];
    size_t size = small_glb(bytes);
    uint32_t random = 1;
    for (int i = 0; i < 1000; i++) {
        unsigned char damaged[1024];
        memcpy(damaged, bytes, size);
        for (int k = 0; k < 1 + i % 3; k++) {
            random = random * 1664525u + 1013904223u;
            damaged[20 + (random >> 8) % (size - 20)] = (unsigned char)(random >> 24);
        }
        maker_reset(state);
        maker_survey_file(maker_file(damaged, size, ".glb"));
    }
}

static jmp_buf memory_is_out;

static void jump_when_full(size_t bytes_wanted, size_t bytes_left) {
    assert_true(bytes_wanted + 64 > bytes_left); /* alignment may need some */
    longjmp(memory_is_out, 1);
}

/* With ever more memory for the scene, up to what it needs: either it loads or the one exit is
 * taken. (The loader's own scratch is left mapped each time, which is why there are few.) */
TEST_WITH(running_out_of_memory_takes_the_one_exit, maker_reset, NULL) {
    unsigned char bytes[1024];
    const char *path = maker_file(bytes, small_glb(bytes), ".glb");
    volatile int refused = 0, loaded = 0;
    volatile size_t left = 16;
    for (; left < 1 << 16 && !loaded; left += left / 4 + 16) {
        Arena arena = maker.arena;
        arena.end = arena.next + left;
        arena.on_full = jump_when_full;
        if (setjmp(memory_is_out)) {
            refused++;
            continue;
        }
        Problems problems = problems_start(&arena);
        scene_survey(&(SceneOptions){.paths = &path, .path_count = 1}, PROGRESS_NONE, &arena,
                     &problems);
        loaded++;
    }
    assert_int_equal(loaded, 1);
    assert_true(refused > 3);
}

TEST_PROGRAM(maker_start, maker_end)
