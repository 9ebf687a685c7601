/* SPDX-License-Identifier: Apache-2.0 */
/* What `parhelion check` prints, for people and for scripts. */
#include "check.h"

#include <fcntl.h>
#include <jansson.h>

#include "cli/commands.h"
#include "gltf_maker.h"

typedef struct Checked {
    bool is_ok;
    Error err;
    char text[8192]; /* what went to stdout */
} Checked;

/* Runs the command with stdout led into a file of the test's folder. */
static Checked run(const char *path, const char *option) {
    Checked outcome = {0};
    char log[300], *argv[3] = {"check", (char *)(uintptr_t)path, (char *)(uintptr_t)option};
    snprintf(log, sizeof log, "%s/log", maker.folder);
    fflush(stdout);
    int shown = dup(STDOUT_FILENO), file = open(log, O_RDWR | O_CREAT | O_TRUNC, 0600);
    dup2(file, STDOUT_FILENO);
    Arena arena = arena_reserve((size_t)1 << 30);
    outcome.is_ok = command_check.run(option ? 3 : 2, argv, &arena, &outcome.err);
    arena_release(&arena);
    fflush(stdout);
    dup2(shown, STDOUT_FILENO);
    close(shown);
    ssize_t size = pread(file, outcome.text, sizeof outcome.text - 1, 0);
    outcome.text[size > 0 ? size : 0] = '\0';
    close(file);
    unlink(log);
    return outcome;
}

static const float TRIANGLE[9] = {0, 0, 0, 1, 0, 0, 0, 1, 0};

static const char *lit_scene(void) {
    return maker_gltf(
        TRIANGLE, sizeof TRIANGLE,
        "'extensionsUsed':['KHR_lights_punctual','PARHELION_environment'],"
        "'extensions':{'KHR_lights_punctual':{'lights':[{'type':'point','name':'bulb',"
        "'intensity':80}]}},'bufferViews':[{'buffer':0,'byteLength':36}],'accessors':["
        "{'bufferView':0,'componentType':5126,'count':3,'type':'VEC3','min':[0,0,0],"
        "'max':[1,1,0]}],"
        "'materials':[{'name':'lamp','emissiveFactor':[1,1,0]}],"
        "'cameras':[{'type':'perspective','perspective':{'yfov':1,'znear':1}}],"
        "'meshes':[{'primitives':[{'attributes':{'POSITION':0},'material':0}]}],"
        "'scenes':[{'nodes':[0,1,2],'extensions':{'PARHELION_environment':{'type':'constant',"
        "'luminance':500}}}],'nodes':[{'mesh':0},{'camera':0,'name':'eye'},{'extensions':"
        "{'KHR_lights_punctual':{'light':0}}}]");
}

TEST_WITH(people_read_everything_with_its_unit, maker_reset, NULL) {
    Checked outcome = run(lit_scene(), NULL);
    static const char *const LINES[] = {
        "triangles                 1\n",
        "size                      1.000, 1.000, 0.000 m\n",
        "bulb   point     80, 80, 80  cd\n",
        "lamp   emissive  1, 1, 0     cd/m2\n",
        "environment               constant\nits luminance             500 cd/m2\n",
        "eye           –     perspective                     57.30\n",
        "KHR_lights_punctual, PARHELION_environment\n",
        "ok: 0 errors, 0 warnings"};
    assert_true(outcome.is_ok);
    for (size_t i = 0; i < sizeof LINES / sizeof *LINES; i++)
        if (!strstr(outcome.text, LINES[i])) fail_msg("no \"%s\" in\n%s", LINES[i], outcome.text);
}

TEST_WITH(scripts_read_one_document, maker_reset, NULL) {
    Checked outcome = run(lit_scene(), "--json");
    json_auto_t *document = json_loads(outcome.text, 0, NULL);
    assert_true(outcome.is_ok);
    assert_non_null(document);
    assert_true(json_is_true(json_object_get(document, "ok")));
    assert_int_equal(json_integer_value(json_object_get(document, "materials")), 1);
    json_t *list = json_object_get(document, "material_list");
    json_t *lamp = json_array_get(list, 0);
    assert_int_equal(json_array_size(list), 1);
    assert_string_equal(json_string_value(json_object_get(lamp, "name")), "lamp");
    assert_close(json_real_value(json_object_get(lamp, "area_m2")), 0.5, 1e-7);
    assert_true(json_is_true(json_object_get(lamp, "is_flat")));
    assert_true(json_is_false(json_object_get(lamp, "looks_like_screen")));
    assert_int_equal(json_integer_value(json_object_get(document, "triangles")), 1);
    assert_int_equal(json_array_size(json_object_get(document, "problems")), 0);
    assert_int_equal(json_array_size(json_object_get(document, "displays")), 0);
    assert_int_equal(json_array_size(json_object_get(document, "lights")), 2);
    assert_int_equal(json_array_size(json_object_get(document, "extensions")), 2);
}

/* Three sheets: one-sided by glTF's default, two-sided, and a material that nothing wears. */
TEST_WITH(materials_whose_backs_other_viewers_leave_out_are_named, maker_reset, NULL) {
    const char *path = maker_gltf(
        TRIANGLE, sizeof TRIANGLE,
        "'bufferViews':[{'buffer':0,'byteLength':36}],'accessors':[{'bufferView':0,"
        "'componentType':5126,'count':3,'type':'VEC3','min':[0,0,0],'max':[1,1,0]}],"
        "'materials':[{'name':'lining'},{'name':'wall','doubleSided':true},{'name':'unworn'}],"
        "'meshes':[{'primitives':[{'attributes':{'POSITION':0},'material':0},"
        "{'attributes':{'POSITION':0},'material':1}]}],'scenes':[{'nodes':[0]}],"
        "'nodes':[{'mesh':0}]");
    Checked plain = run(path, NULL);
    assert_non_null(strstr(plain.text, "one-sided, back seen too  lining\n"));
    Checked outcome = run(path, "--json");
    json_auto_t *document = json_loads(outcome.text, 0, NULL);
    json_t *list = json_object_get(document, "material_list");
    for (size_t i = 0; i < 3; i++)
        assert_int_equal(json_is_true(json_object_get(json_array_get(list, i), "is_one_sided")),
                         i == 0);
}

TEST_WITH(all_problems_are_told_and_the_status_is_3, maker_reset, NULL) {
    const char *path = maker_gltf(NULL, 0, "'nodes':[{'mesh':5},{'camera':1,'colour':2}]");
    Checked plain = run(path, NULL);
    assert_false(plain.is_ok);
    assert_int_equal(error_exit_status(plain.err.code), 3);
    assert_string_equal(plain.err.text, ""); /* nothing is said twice */
    assert_non_null(strstr(plain.text, "is 5, but there are 0 in meshes (/nodes/0/mesh)"));
    assert_non_null(strstr(plain.text, "(/nodes/1/camera)"));
    assert_non_null(strstr(plain.text, "NOT OK: 2 errors, 1 warnings"));
    Checked materials = run(path, "--materials"); /* of which there are none */
    assert_false(materials.is_ok);
    assert_non_null(strstr(materials.text, "NOT OK: 2 errors, 1 warnings"));
    Checked outcome = run(path, "--json");
    json_auto_t *document = json_loads(outcome.text, 0, NULL);
    json_t *first = json_array_get(json_object_get(document, "problems"), 0);
    assert_true(json_is_false(json_object_get(document, "ok")));
    assert_string_equal(json_string_value(json_object_get(first, "file")), path);
    assert_string_equal(json_string_value(json_object_get(first, "path")), "/nodes/0/mesh");
    assert_string_equal(json_string_value(json_object_get(first, "severity")), "error");
    assert_int_equal(json_array_size(json_object_get(document, "problems")), 3);
}

TEST_PROGRAM(maker_start, maker_end)
