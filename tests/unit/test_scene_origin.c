/* SPDX-License-Identifier: Apache-2.0 */
/* The laws of a scene's origin: wherever a scene stands and by whatever it is put there, its
 * coordinates are as fine as near the world's origin, and say where in the world they are. */
#include "base/count.h"
#include "check.h"
#include "gltf_maker.h"
#include "scene/load/scene_origin.h"

/* A triangle of a metre; the same 1,000 m off in its file; two instances' moves; a key's time
 * and its value. */
static const struct {
    float near[9], far[9], moves[6], time, key[3];
} BYTES = {{0, 0, 0, 1, 0, 0, 0, 1, 0},
           {1000, 0, 0, 1001, 0, 0, 1000, 1, 0},
           {1000.25f, 0, 0, 2000.5f, 0, 0},
           0,
           {1000.25f, 0, 0}};

#define HEAD \
    "'bufferViews':[" VIEW0(36) "," VIEW(36, 36) "," VIEW(72, 24) "," VIEW(96, 4) "," VIEW(100, 12) "],'accessors':[" FLOATS( \
        0, 3, \
        "VEC3") "," FLOATS(1, 3, \
                           "VEC3") "," FLOATS(2, 2, \
                                              "VEC3") "," FLOATS(3, 1, \
                                                                 "SCALAR") "," FLOATS(4, 1, \
                                                                                      "VEC3") "]," \
                                                                                              "'meshes':[{'primitives':[{'attributes':{'POSITION':0}}]}," \
                                                                                              "{'primitives':[{'attributes':{'POSITION':1}}]}],"
#define INSTANCED \
    ",'extensions':{'EXT_mesh_gpu_instancing':{'attributes':{'TRANSLATION':2}}}}]" \
    ",'extensionsUsed':['EXT_mesh_gpu_instancing']"
#define UPRIGHT_ROOT \
    "'scenes':[{'nodes':[0]}],'nodes':[{'children':[1],'rotation':" \
    "[-0.70710678118654757,0,0,0.70710678118654757]},"

static Found survey(const char *members) {
    const char *all = maker_format(HEAD "%s", members);
    return maker_survey_file(maker_gltf(&BYTES, sizeof BYTES, all));
}

static const Scene *load(const char *members) {
    Found found = survey(members);
    maker_expect_whole(&found);
    return found.scene;
}

static void assert_world(const Scene *scene, Vec3 p, const double wanted[3]) {
    double at[3];
    world_from_scene(scene->origin, p, at);
    for (int k = 0; k < 3; k++) assert_near(at[k], wanted[k], 2e-7);
    assert_true(vec3_length(p) < 3);
}

static void assert_origin(const Scene *scene, double x, double y, double z) {
    assert_near(scene->origin[0], x, 0);
    assert_near(scene->origin[1], y, 0);
    assert_near(scene->origin[2], z, 0);
}

/* ---- what puts it there ------------------------------------------------------------------ */

TEST(decimals_survive_whatever_puts_a_node_far_away) {
    static const char *const WAYS[] = {
        "'scenes':[{'nodes':[0]}],'nodes':[{'mesh':0,'translation':[1000.3,-2000.7,40.1]}]",
        "'scenes':[{'nodes':[0]}],'nodes':[{'mesh':0,'matrix':[1,0,0,0,0,1,0,0,0,0,1,0,"
        "1000.3,-2000.7,40.1,1]}]",
        "'scenes':[{'nodes':[0]}],'nodes':[{'children':[1],'translation':[3e5,1,40.1]},"
        "{'mesh':0,'translation':[-298999.7,-2001.7,0]}]",
        "'scenes':[{'nodes':[0]}],'nodes':[{'children':[1],'translation':[0.3,-0.7,0.1],"
        "'scale':[2,2,2]},{'mesh':0,'translation':[500,-1000,20],'scale':[0.5,0.5,0.5]}]"};
    for (int i = 0; i < COUNT_OF(WAYS); i++) {
        const Scene *scene = load(WAYS[i]);
        assert_origin(scene, 1001, -2000, 40);
        assert_world(scene, scene_corner(scene, 0, 0), (double[]){1000.3, -2000.7, 40.1});
        assert_world(scene, scene_corner(scene, 0, 1), (double[]){1001.3, -2000.7, 40.1});
        assert_world(scene, scene_corner(scene, 0, 2), (double[]){1000.3, -1999.7, 40.1});
    }
}

/* As files with +Z up are turned: (x, y, z) goes to (x, z, -y). */
TEST(a_turned_root_turns_the_distance_exactly) {
    const Scene *scene = load(UPRIGHT_ROOT "{'mesh':0,'translation':[1000.3,-2000.7,40.1]}]");
    assert_origin(scene, 1001, 40, 2000);
    assert_world(scene, scene_corner(scene, 0, 0), (double[]){1000.3, 40.1, 2000.7});
    assert_world(scene, scene_corner(scene, 0, 2), (double[]){1000.3, 40.1, 1999.7});
}

TEST(instances_and_their_node_add_up_exactly) {
    const Scene *scene = load("'scenes':[{'nodes':[0]}],'nodes':[{'mesh':0,"
                              "'translation':[1000.3,0,0]" INSTANCED);
    assert_int_equal(scene->part_count, 2);
    assert_origin(scene, 2501, 1, 0); /* between the two */
    double at[3];
    world_from_scene(scene->origin, scene_corner(scene, 0, 0), at);
    assert_near(at[0], 2000.55, 4e-5); /* a float from the middle */
    world_from_scene(scene->origin, scene_corner(scene, 1, 0), at);
    assert_near(at[0], 3000.8, 4e-5);
}

TEST(an_animation_that_moves_it_there_counts) {
    const char *path =
        maker_gltf(&BYTES, sizeof BYTES,
                   HEAD "'scenes':[{'nodes':[0]}],'nodes':[{'mesh':0}],'animations':[{'samplers':["
                        "{'input':3,'output':4}],'channels':[{'sampler':0,'target':{'node':0,"
                        "'path':'translation'}}]}]");
    SceneOptions options = {.paths = &path, .path_count = 1, .state = {.has_time = true}};
    Found found = maker_survey(&options);
    maker_expect_whole(&found);
    assert_origin(found.scene, 1001, 1, 0);
    assert_world(found.scene, scene_corner(found.scene, 0, 0), (double[]){1000.25, 0, 0});
}

/* ---- the rule ---------------------------------------------------------------------------- */

static const Scene *load_at(double x) {
    return load(maker_format("'scenes':[{'nodes':[0]}],'nodes':[{'mesh':0,"
                             "'translation':[%.17g,0,0]}]",
                             x));
}

TEST(near_scenes_keep_the_worlds_origin) {
    double most = ORIGIN_IN_SIZES * sqrt(0.5); /* from the middle of the triangle's box */
    assert_origin(load_at(most - 0.6), 0, 0, 0);
    assert_true(load_at(most)->origin[0] > 0);
}

TEST(a_tiny_scene_counts_in_parts_of_a_metre) {
    const Scene *scene = load("'scenes':[{'nodes':[0]}],'nodes':[{'mesh':0,'scale':"
                              "[0.0001,0.0001,0.0001],'translation':[0.3,0,0]}]");
    assert_true(fabs(scene->origin[0] - 0.3) < 0.004);
    assert_near(fmod(scene->origin[0], 1.0 / 256), 0, 0);
}

/* The middle of all boxes together would be near the world's origin. */
TEST(a_wide_ground_does_not_hide_the_distance) {
    const Scene *scene =
        load("'scenes':[{'nodes':[0,1,2,3]}],'nodes':[{'mesh':0,'scale':[4000,4000,4000],"
             "'translation':[-2000,-2000,0]},{'mesh':0,'translation':[1000,0,0]},"
             "{'mesh':0,'translation':[1002,0,0]},{'mesh':0,'translation':[1001,0,3]}]");
    assert_near(scene->origin[0], 1001, 1);
}

TEST(all_files_count_from_the_first_that_shows_something) {
    const char *paths[] = {
        maker_gltf(NULL, 0,
                   "'scenes':[{'nodes':[0]}],'nodes':[{'camera':0,"
                   "'translation':[1000.3,1,2]}],'cameras':[{'type':'perspective',"
                   "'perspective':{'yfov':1,'znear':0.1}}]"),
        maker_gltf(&BYTES, sizeof BYTES,
                   HEAD "'scenes':[{'nodes':[0]}],'nodes':[{'mesh':0,"
                        "'translation':[1000,0,0]}]"),
        maker_gltf(&BYTES, sizeof BYTES,
                   HEAD "'scenes':[{'nodes':[0]}],'nodes':[{'mesh':0,"
                        "'translation':[999.9,1,0]}]")};
    Found found = maker_survey(&(SceneOptions){.paths = paths, .path_count = 3});
    maker_expect_whole(&found);
    assert_origin(found.scene, 1001, 1, 0);
    assert_world(found.scene, found.scene->cameras[0].world_from_camera.origin,
                 (double[]){1000.3, 1, 2});
    assert_world(found.scene, scene_corner(found.scene, 1, 0), (double[]){999.9, 1, 0});
}

TEST(vertices_that_are_far_in_their_file_are_taken_near_and_said_to_be_coarse) {
    Found found = survey("'scenes':[{'nodes':[0]}],'nodes':[{'mesh':1}]");
    assert_origin(found.scene, 1001, 1, 0);
    assert_world(found.scene, scene_corner(found.scene, 0, 1), (double[]){1001, 0, 0});
    const Problem *said = maker_find(&found, "", "give the distance to the node");
    assert_non_null(said);
    assert_int_equal(said->severity, SEVERITY_WARNING);
    found = survey("'scenes':[{'nodes':[0]}],'nodes':[{'mesh':0,'translation':[1e6,0,0]}]");
    assert_null(maker_find(&found, "", "give the distance to the node"));
}

TEST_PROGRAM(maker_start, maker_end)
