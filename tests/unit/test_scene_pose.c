/* SPDX-License-Identifier: Apache-2.0 */
/* The laws of what a file can be: animations at a time, and variants of materials. */
#include "base/mathd.h"
#include "fixture.h"
#include "gltf_maker.h"

/* ---- a moving triangle ------------------------------------------------------------------- */

/* Buffer views: 0 the triangle, 1 times, 2 values, 3 displacements of a morph target. */
typedef struct Moving {
    float triangle[9];
    float times[4];
    float values[40];
    float change[9];
} Moving;

static const Moving STANDING = {.triangle = {0, 0, 0, 1, 0, 0, 0, 1, 0}};

#define VIEWS "'bufferViews':[" VIEW0(36) "," VIEW(36, 16) "," VIEW(52, 160) "," VIEW(212, 36) "],"
#define SCENE "'scene':0,'scenes':[{'nodes':[0]}],"

typedef struct Motion {
    const char *how;    /* interpolation */
    const char *type;   /* of the values: "VEC3" */
    int keys, values;   /* how many of each */
    const char *target; /* members of the channel's target */
    const char *node;   /* members of node 0 besides its mesh */
} Motion;

/* Node 0 is the triangle, whose mesh has one morph target, and moves as said. */
static const char *write_motion(const Moving *data, const Motion *motion) {
    return maker_gltf(
        data, sizeof *data,
        maker_format(
            VIEWS
            "'extensionsUsed':['KHR_animation_pointer','KHR_node_visibility'],"
            "'accessors':[" FLOATS(
                0, 3,
                "VEC3") ",{'bufferView':1,'componentType':5126,"
                        "'count':%d,'type':'SCALAR'},{'bufferView':2,'componentType':5126,'count':%d,"
                        "'type':'%s'}," FLOATS(
                            3, 3,
                            "VEC3") ",{'bufferView':2,'componentType':5121,"
                                    "'count':%d,'type':'SCALAR'}],"
                                    "'meshes':[{'primitives':[{'attributes':{'POSITION':0},"
                                    "'targets':[{'POSITION':3}]}]}]," SCENE
                                    "'nodes':[{'mesh':0%s},{}],"
                                    "'animations':[{'name':'wave','samplers':[{'input':1,'output':%d,"
                                    "'interpolation':'%s'}],'channels':[{'sampler':0,'target':{%s}}]}]",
            motion->keys, motion->values, motion->type, motion->values, motion->node,
            strcmp(motion->type, "BYTES") == 0 ? 4 : 2, motion->how, motion->target));
}

static Found survey_at(const char *path, double time_s) {
    return maker_survey(&(SceneOptions){
        .paths = &path, .path_count = 1, .state = {.has_time = true, .time_s = time_s}});
}

static const Scene *load_at(const char *path, double time_s) {
    Found found = survey_at(path, time_s);
    maker_expect_whole(&found);
    return found.scene;
}

static void assert_corner(const Scene *scene, int corner, const double at[3]) {
    Vec3 found = scene_corner(scene, 0, corner);
    assert_near(found.x, at[0], 2e-6);
    assert_near(found.y, at[1], 2e-6);
    assert_near(found.z, at[2], 2e-6);
}

/* ---- interpolation ----------------------------------------------------------------------- */

#define MOVES(path) "'node':0,'path':'" path "'"

static const Motion SLIDE = {"LINEAR", "VEC3", 3, 3, MOVES("translation"), ""};

static Moving sliding(void) {
    Moving data = STANDING;
    const float times[3] = {1, 2, 4}, values[9] = {1, 0, 0, 3, 0, 8, 3, 4, 0};
    memcpy(data.times, times, sizeof times);
    memcpy(data.values, values, sizeof values);
    return data;
}

TEST_WITH(lines_join_key_frames_and_the_ends_are_kept, maker_reset, NULL) {
    static const double AT[][4] = {{0, 1, 0, 0}, {1, 1, 0, 0},   {1.5, 2, 0, 4}, {2, 3, 0, 8},
                                   {3, 3, 2, 4}, {3.5, 3, 3, 2}, {4, 3, 4, 0},   {99, 3, 4, 0}};
    Moving data = sliding();
    const char *path = write_motion(&data, &SLIDE);
    for (size_t i = 0; i < sizeof AT / sizeof *AT; i++)
        assert_corner(load_at(path, AT[i][0]), 0, AT[i] + 1);
}

TEST_WITH(steps_hold_until_the_next_key_frame, maker_reset, NULL) {
    static const double AT[][4] = {{0, 1, 0, 0},     {1.999, 1, 0, 0}, {2, 3, 0, 8},
                                   {3.999, 3, 0, 8}, {4, 3, 4, 0},     {5, 3, 4, 0}};
    Moving data = sliding();
    Motion motion = SLIDE;
    motion.how = "STEP";
    const char *path = write_motion(&data, &motion);
    for (size_t i = 0; i < sizeof AT / sizeof *AT; i++)
        assert_corner(load_at(path, AT[i][0]), 0, AT[i] + 1);
}

static double cubic(double t, int axis) {
    return axis == 0 ? t * t * t - 2 * t : axis == 1 ? 3 - t * t : 0.5 * t * t * t + t;
}

static double slope(double t, int axis) {
    return axis == 0 ? 3 * t * t - 2 : axis == 1 ? -2 * t : 1.5 * t * t + 1;
}

/* Between keys of any distance a spline is the cubic that its values and tangents come from. */
TEST_WITH(a_spline_reproduces_a_cubic, maker_reset, NULL) {
    static const float TIMES[3] = {0.25f, 1, 3};
    Moving data = STANDING;
    memcpy(data.times, TIMES, sizeof TIMES);
    for (int k = 0; k < 3; k++)
        for (int axis = 0; axis < 3; axis++) {
            double t = (double)TIMES[k];
            data.values[9 * k + axis] = data.values[9 * k + 6 + axis] = (float)slope(t, axis);
            data.values[9 * k + 3 + axis] = (float)cubic(t, axis);
        }
    Motion motion = {"CUBICSPLINE", "VEC3", 3, 9, MOVES("translation"), ""};
    const char *path = write_motion(&data, &motion);
    for (double t = 0; t < 4; t += 0.125) {
        double inside = fmin(fmax(t, 0.25), 3);
        assert_corner(load_at(path, t), 0,
                      (double[]){cubic(inside, 0), cubic(inside, 1), cubic(inside, 2)});
    }
}

/* Half of a turn by `angle` about the axis is the turn by half of it, whichever of q and -q
 * stands there. */
static void check_half_turn(double angle, float sign) {
    Moving data = STANDING;
    const double axis[3] = {2.0 / 3, -1.0 / 3, 2.0 / 3};
    data.times[1] = 2;
    data.values[3] = 1;
    for (int i = 0; i < 3; i++) data.values[4 + i] = sign * (float)(axis[i] * sin_d(angle / 2));
    data.values[7] = sign * (float)cos_d(angle / 2);
    Motion motion = {"LINEAR", "VEC4", 2, 2, MOVES("rotation"), ""};
    const char *path = write_motion(&data, &motion);
    for (int quarter = 0; quarter <= 4; quarter++) {
        double turn = angle * quarter / 4, c = cos_d(turn), s = sin_d(turn);
        /* Rodrigues: x turned about the axis. */
        double x[3] = {c + axis[0] * axis[0] * (1 - c), axis[2] * s + axis[1] * axis[0] * (1 - c),
                       -axis[1] * s + axis[2] * axis[0] * (1 - c)};
        assert_corner(load_at(path, quarter * 0.5), 1, x);
    }
}

TEST_WITH(a_turn_goes_along_the_shorter_arc_at_an_even_pace, maker_reset, NULL) {
    static const double ANGLES[] = {0, 1e-7, 0.001, 0.5, 1.5707963, 3, 3.14};
    for (size_t i = 0; i < sizeof ANGLES / sizeof *ANGLES; i++) {
        check_half_turn(ANGLES[i], 1);
        check_half_turn(ANGLES[i], -1);
    }
}

TEST_WITH(scales_move_and_a_node_keeps_what_is_not_moved, maker_reset, NULL) {
    Moving data = STANDING;
    const float values[6] = {1, 1, 1, 3, 5, 1};
    data.times[1] = 1;
    memcpy(data.values, values, sizeof values);
    Motion motion = {"LINEAR", "VEC3",         2,
                     2,        MOVES("scale"), ",'translation':[0,0,7],'scale':[9,9,9]"};
    const Scene *scene = load_at(write_motion(&data, &motion), 0.5);
    assert_corner(scene, 0, (double[]){0, 0, 7});
    assert_corner(scene, 1, (double[]){2, 0, 7});
    assert_corner(scene, 2, (double[]){0, 3, 7});
}

/* ---- morph targets ----------------------------------------------------------------------- */

TEST_WITH(a_morph_of_weight_one_is_the_target, maker_reset, NULL) {
    Moving data = STANDING;
    const float change[9] = {0, 0, 1, 0, 2, 0, 5, 0, 0};
    data.times[1] = 1;
    data.values[1] = 1;
    memcpy(data.change, change, sizeof change);
    Motion motion = {"LINEAR", "SCALAR", 2, 2, MOVES("weights"), ",'weights':[0.75]"};
    const char *path = write_motion(&data, &motion);
    for (double weight = 0; weight <= 1; weight += 0.25)
        for (int corner = 0; corner < 3; corner++) {
            double at[3];
            for (int i = 0; i < 3; i++)
                at[i] =
                    (double)data.triangle[3 * corner + i] + weight * (double)change[3 * corner + i];
            assert_corner(load_at(path, weight), corner, at);
        }
    const Found rest = maker_survey_file(path);
    assert_corner(rest.scene, 0, (double[]){0, 0, 0.75});
}

/* ---- what is played ---------------------------------------------------------------------- */

TEST_WITH(without_a_time_the_pose_at_rest_is_shown, maker_reset, NULL) {
    Moving data = sliding();
    Motion motion = SLIDE;
    motion.node = ",'translation':[7,7,7]";
    Found found = maker_survey_file(write_motion(&data, &motion));
    assert_corner(found.scene, 0, (double[]){7, 7, 7});
    assert_non_null(maker_find(&found, "/animations", "--time plays them"));
    assert_int_equal(found.scene->animation_count, 1);
    assert_string_equal(found.scene->animations[0].name, "wave");
    assert_near(found.scene->animations[0].end_s, 4, 0);
}

#define POINTS(pointer) \
    "'path':'pointer','extensions':{'KHR_animation_pointer':{'pointer':'" pointer "'}}"

TEST_WITH(a_pointer_to_a_node_is_the_node, maker_reset, NULL) {
    Moving data = sliding();
    Motion motion = SLIDE;
    motion.target = POINTS("/nodes/0/translation");
    assert_corner(load_at(write_motion(&data, &motion), 1.5), 0, (double[]){2, 0, 4});
}

TEST_WITH(a_pointer_shows_and_hides, maker_reset, NULL) {
    Moving data = sliding();
    memcpy(data.values, (unsigned char[3]){1, 0, 1}, 3);
    Motion motion = {"STEP",
                     "BYTES",
                     3,
                     3,
                     POINTS("/nodes/0/extensions/KHR_node_visibility/visible"),
                     ",'extensions':{'KHR_node_visibility':{'visible':false}}"};
    char *path = (char *)write_motion(&data, &motion);
    /* The unused accessor of values would be of no type: it is one of bytes, too. */
    FileBytes text;
    assert_done(file_read(path, 1 << 20, &maker.arena, &text, &err));
    char *type = strstr((char *)text.data, "\"BYTES\"");
    memcpy(type, "\"VEC2\" ", 7);
    path = (char *)maker_file(text.data, text.size, ".gltf");
    assert_int_equal(load_at(path, 0)->triangle_count, 1);
    assert_int_equal(load_at(path, 2)->triangle_count, 0);
    assert_int_equal(load_at(path, 4)->triangle_count, 1);
}

TEST_WITH(a_pointer_elsewhere_is_told_by_name, maker_reset, NULL) {
    Moving data = sliding();
    Motion motion = SLIDE;
    motion.target = POINTS("/cameras/0/perspective/yfov");
    Found found = survey_at(write_motion(&data, &motion), 1);
    assert_int_equal(found.problems.error_count, 0);
    assert_non_null(maker_find(&found, "/animations/0/channels/0",
                               "moves \"/cameras/0/perspective/yfov\", which is not played"));
}

/* ---- faults: at rest they warn, played they fail ----------------------------------------- */

typedef struct Fault {
    Motion motion;
    const char *place, *text;
} Fault;

static const Fault FAULTS[] = {
    {{"LINEAR", "VEC3", 3, 3, MOVES("translation"), ",'matrix':[1,0,0,0,0,1,0,0,0,0,1,0,0,0,0,1]"},
     "/animations/0/channels/0/target",
     "moves a node that has a matrix"},
    {{"LINEAR", "VEC3", 3, 4, MOVES("translation"), ""},
     "/animations/0/channels/0",
     "4 values for 3 key frames, 3 are required"},
    {{"CUBICSPLINE", "VEC3", 3, 3, MOVES("translation"), ""},
     "/animations/0/channels/0",
     "3 values for 3 key frames, 9 are required"},
    {{"LINEAR", "VEC4", 3, 3, MOVES("scale"), ""},
     "/animations/0/channels/0",
     "the values of a scale are VEC4"},
    {{"LINEAR", "VEC4", 3, 3, MOVES("rotation"), ""},
     "/animations/0/channels/0",
     "is not of length 1"},
    {{"LINEAR", "VEC3", 4, 4, MOVES("translation"), ""},
     "/animations/0/samplers/0",
     "time 3 is 0 after 4; times that rise are required"},
    {{"linear", "VEC3", 3, 3, MOVES("translation"), ""},
     "/animations/0/samplers/0/interpolation",
     "one of LINEAR|STEP|CUBICSPLINE"},
    {{"LINEAR", "VEC3", 3, 3, "'node':5,'path':'translation'", ""},
     "/animations/0/channels/0/target/node",
     "is 5, but there are 2 in nodes"},
    {{"LINEAR", "SCALAR", 3, 3, POINTS("/nodes/0/extensions/KHR_node_visibility/visible"),
      ",'extensions':{'KHR_node_visibility':{}}"},
     "/animations/0/channels/0",
     "the interpolation of visible is LINEAR, STEP is required"},
};

TEST_WITH(faults_of_animations_fail_when_they_are_played, maker_reset, NULL) {
    Moving data = sliding();
    for (size_t i = 0; i < sizeof FAULTS / sizeof *FAULTS; i++) {
        const Fault *fault = &FAULTS[i];
        const char *path = write_motion(&data, &fault->motion);
        Found rest = maker_survey_file(path), played = survey_at(path, 1);
        const Problem *at_rest = maker_find(&rest, fault->place, fault->text);
        const Problem *found = maker_find(&played, fault->place, fault->text);
        if (!at_rest || !found) fail_msg("%s is not told", fault->text);
        assert_int_equal(rest.problems.error_count, 0);
        assert_int_equal(found->severity, SEVERITY_ERROR);
    }
}

/* ---- several animations ------------------------------------------------------------------ */

/* "up" moves node 0 and "side", too; "away" moves node 1, which has the mesh as well. */
static const char *write_three(void) {
    Moving data = STANDING;
    const float values[18] = {0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 0, 0, 0, 1};
    data.times[1] = 1;
    memcpy(data.values, values, sizeof values);
    return maker_gltf(
        &data, sizeof data,
        VIEWS "'accessors':[" FLOATS(0, 3, "VEC3") "," FLOATS(1, 2, "SCALAR") "," FLOATS(
            2, 2,
            "VEC3") ",{'bufferView':2,'byteOffset':24,'componentType':5126,"
                    "'count':2,'type':'VEC3'},{'bufferView':2,'byteOffset':48,'componentType':5126,"
                    "'count':2,'type':'VEC3'}]," MESH_OF(
                        "'POSITION':0") "'scene':0,"
                                        "'scenes':[{'nodes':[0,1]}],'nodes':[{'mesh':0},{'mesh':0}],"
                                        "'animations':[{'name':'up','samplers':[{'input':1,'output':2}],"
                                        "'channels':[{'sampler':0,'target':{'node':0,'path':'translation'}}]},{'name':'side',"
                                        "'samplers':[{'input':1,'output':3}],'channels':[{'sampler':0,'target':{'node':0,"
                                        "'path':'translation'}}]},{'samplers':[{'input':1,'output':4}],"
                                        "'channels':[{'sampler':0,'target':{'node':1,'path':'translation'}}]}]");
}

static Found survey_chosen(const char *path, const char *const *names, int count) {
    return maker_survey(&(SceneOptions){
        .paths = &path,
        .path_count = 1,
        .state = {.has_time = true, .time_s = 1, .animations = names, .animation_count = count}});
}

TEST_WITH(animations_are_played_together_unless_they_move_the_same, maker_reset, NULL) {
    const char *path = write_three();
    Found both = survey_chosen(path, (const char *const[]){"side", "animation 2"}, 2);
    assert_int_equal(both.problems.error_count, 0);
    assert_corner(both.scene, 0, (double[]){1, 0, 0});
    assert_near(scene_corner(both.scene, 1, 0).z, 1, 0);
    Found all = survey_chosen(path, NULL, 0);
    const Problem *told = maker_find(&all, "/animations/1/channels/0",
                                     "animations \"up\" and \"side\" both move the "
                                     "translation of node 0: --animation chooses one");
    assert_non_null(told);
    assert_int_equal(told->severity, SEVERITY_ERROR);
    Found none = survey_chosen(path, (const char *const[]){"sides"}, 1);
    assert_non_null(maker_find(&none, "",
                               "no animation is named \"sides\" — did you mean side? There "
                               "are up, side, \"animation 2\""));
}

TEST_WITH(a_time_needs_an_animation, maker_reset, NULL) {
    Found found = survey_at(maker_gltf(STANDING.triangle, 36, ""), 2);
    assert_non_null(maker_find(&found, "", "2 s, but no file of the scene has an animation"));
}

/* ---- skins ------------------------------------------------------------------------------- */

/* The triangle hangs on two joints whose inverse bind matrices undo where they stand: at rest
 * it is where it would be without a skin, and joint 1 takes its corners along. */
TEST_WITH(a_skin_at_bind_pose_changes_nothing_and_joints_take_along, maker_reset, NULL) {
    struct {
        float triangle[9];
        unsigned char joints[12];
        float weights[12];
        float inverse[32];
        float times[2];
        float values[6];
    } data = {{0, 0, 0, 1, 0, 0, 0, 1, 0},
              {0, 1, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0},
              {1, 0, 0, 0, 0, 1, 0, 0, 0.5f, 0.5f, 0, 0},
              {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, -2, -3, -4, 1,
               1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, -2, -3, -9, 1},
              {0, 1},
              {0, 0, 5, 0, 6, 5}};
    const char *path = maker_gltf(
        &data, sizeof data,
        "'bufferViews':[" VIEW0(36) "," VIEW(36, 12) "," VIEW(48, 48) "," VIEW(96, 128) "," VIEW(224, 32) "],'accessors':[" FLOATS(
            0, 3,
            "VEC3") ",{'bufferView':1,"
                    "'componentType':5121,'count':3,'type':'VEC4'}," FLOATS(2, 3, "VEC4") "," FLOATS(3, 2, "MAT4") "," FLOATS(
                        4, 2,
                        "SCALAR") ",{'bufferView':4,'byteOffset':8,"
                                  "'componentType':5126,'count':2,'type':'VEC3'}]," MESH_OF(
                                      "'POSITION':0,'JOINTS_0':1,'WEIGHTS_0':2") "'skins':[{'joints':[1,2],"
                                                                                 "'inverseBindMatrices':3}],'scene':0,'scenes':[{'nodes':[0,1]}],'nodes':[{'mesh':0,"
                                                                                 "'skin':0},{'translation':[2,3,4],'children':[2]},{'translation':[0,0,5]}],"
                                                                                 "'animations':[{'samplers':[{'input':4,'output':5}],'channels':[{'sampler':0,"
                                                                                 "'target':{'node':2,'path':'translation'}}]}]");
    Found rest = maker_survey_file(path);
    assert_int_equal(rest.problems.error_count, 0);
    const Scene *shown[2] = {rest.scene, load_at(path, 0)};
    for (int i = 0; i < 2; i++) {
        assert_corner(shown[i], 0, (double[]){0, 0, 0});
        assert_corner(shown[i], 1, (double[]){1, 0, 0});
        assert_corner(shown[i], 2, (double[]){0, 1, 0});
    }
    const Scene *moved = load_at(path, 0.5);
    assert_corner(moved, 0, (double[]){0, 0, 0});
    assert_corner(moved, 1, (double[]){1, 3, 0});
    assert_corner(moved, 2, (double[]){0, 2.5, 0});
}

/* ---- instances --------------------------------------------------------------------------- */

static const char *write_instances(const void *data, size_t size, const char *more) {
    return maker_gltf(
        data, size,
        arena_format(
            &maker.arena,
            "'bufferViews':[" VIEW0(36) "," VIEW(36, 80) "],'accessors':[" FLOATS(0, 3, "VEC3") "," FLOATS(
                1, 2,
                "VEC3") ",{'bufferView':1,"
                        "'byteOffset':24,'componentType':5126,'count':2,'type':'VEC4'},"
                        "{'bufferView':1,'byteOffset':56,'componentType':5126,'count':2,"
                        "'type':'VEC3'},{'componentType':5126,'count':3,'type':'VEC3'}]," MESH_OF(
                            "'POSITION':0") SCENE
            "'nodes':[{'mesh':0,'translation':[0,0,9],"
            "'extensions':{'EXT_mesh_gpu_instancing':{'attributes':{%s}}}}],"
            "'extensionsUsed':['EXT_mesh_gpu_instancing'],"
            "'extensionsRequired':['EXT_mesh_gpu_instancing']",
            more));
}

TEST_WITH(instances_stand_in_their_places_below_the_node, maker_reset, NULL) {
    const float half = sqrtf(0.5f);
    struct {
        float triangle[9], moves[6], turns[8], scales[6];
    } data = {{0, 0, 0, 1, 0, 0, 0, 1, 0},
              {1, 2, 3, 4, 5, 6},
              {0, 0, 0, 1, 0, 0, half, half}, /* the second: a right angle about z */
              {2, 1, 1, 1, 3, 1}};
    Found found = maker_survey_file(
        write_instances(&data, sizeof data, "'TRANSLATION':1,'ROTATION':2,'SCALE':3,'_ID':1"));
    assert_int_equal(found.problems.error_count, 0);
    assert_int_equal(found.scene->part_count, 2);
    assert_corner(found.scene, 1, (double[]){3, 2, 12});
    assert_near(scene_corner(found.scene, 1, 1).x, 4, 1e-5);
    assert_near(scene_corner(found.scene, 1, 1).y, 6, 1e-5);
    assert_near(scene_corner(found.scene, 1, 2).x, 1, 1e-5);
    Found turned = maker_survey_file(write_instances(&data, sizeof data, "'ROTATION':2"));
    assert_int_equal(turned.scene->part_count, 2);
    assert_near(scene_corner(turned.scene, 1, 1).y, 1, 1e-6);
    Found wrong =
        maker_survey_file(write_instances(&data, sizeof data, "'TRANSLATION':2,'SCALE':4"));
    assert_int_equal(wrong.problems.error_count, 2);
    const char *place = "/nodes/0/extensions/EXT_mesh_gpu_instancing/attributes/SCALE";
    assert_non_null(maker_find(&wrong, place, "SCALE has 3 elements, others have 2"));
}

TEST_WITH(turns_of_instances_that_are_none_are_named, maker_reset, NULL) {
    struct {
        float triangle[9], moves[6], turns[8], scales[6];
    } data = {{0, 0, 0, 1, 0, 0, 0, 1, 0}, {0}, {0, 0, 0, 1, 0, 0, 0.7f, 0.7f}, {0}};
    const char *place = "/nodes/0/extensions/EXT_mesh_gpu_instancing/attributes/ROTATION";
    Found wrong = maker_survey_file(write_instances(&data, sizeof data, "'ROTATION':2"));
    assert_int_equal(wrong.problems.error_count, 1);
    assert_non_null(maker_find(&wrong, place,
                               "the turn of instance 1 is (0, 0, 0.7, 0.7); a "
                               "quaternion of length 1 is required"));
    data.turns[6] = 0.7072f; /* rounded: as far as signed bytes are */
    data.turns[7] = 0.7125f;
    Found rounded = maker_survey_file(write_instances(&data, sizeof data, "'ROTATION':2"));
    assert_int_equal(rounded.problems.error_count, 0);
    data.turns[3] = 0;
    Found none = maker_survey_file(write_instances(&data, sizeof data, "'ROTATION':2"));
    assert_non_null(maker_find(&none, place, "the turn of instance 0 is (0, 0, 0, 0)"));
}

/* ---- variants ---------------------------------------------------------------------------- */

#define PLAIN "{'attributes':{'POSITION':0},'material':2}"
#define MAPPED \
    "{'attributes':{'POSITION':0},'material':0,'extensions':{'KHR_materials_variants':{" \
    "'mappings':[{'variants':[1,2],'material':1},{'variants':[0],'material':2}]}}}"

static const char *write_variants(const char *names) {
    return maker_gltf(
        STANDING.triangle, 36,
        arena_format(
            &maker.arena,
            "'bufferViews':[" VIEW0(36) "],'accessors':[" FLOATS(
                0, 3, "VEC3") "],"
                              "'extensionsUsed':['KHR_materials_variants'],"
                              "'extensionsRequired':['KHR_materials_variants'],"
                              "'extensions':{'KHR_materials_variants':{'variants':[%s]}},"
                              "'materials':[{'name':'steel'},{'name':'wood'},{'name':'cloth'}],"
                              "'meshes':[{'primitives':[" MAPPED "," PLAIN "]}]," SCENE
                              "'nodes':[{'mesh':0}]",
            names));
}

#define NAMES "{'name':'soft'},{'name':'warm'},{'name':'old'},{'name':'bare'}"

static Found survey_worn(const char *path, const char *const *names, int count) {
    return maker_survey(&(SceneOptions){
        .paths = &path, .path_count = 1, .state = {.variants = names, .variant_count = count}});
}

static const char *worn(const Scene *scene, int part) {
    return scene->materials[scene->parts[part].material_id].name;
}

TEST_WITH(a_variant_changes_the_materials_that_it_maps_alone, maker_reset, NULL) {
    static const char *const WORN[][2] = {
        {"soft", "cloth"}, {"warm", "wood"}, {"old", "wood"}, {"bare", "steel"}};
    const char *path = write_variants(NAMES);
    Found none = maker_survey_file(path);
    assert_int_equal(none.problems.error_count, 0);
    assert_string_equal(worn(none.scene, 0), "steel");
    assert_int_equal(none.scene->variant_count, 4);
    for (int i = 0; i < 4; i++) {
        Found found = survey_worn(path, &WORN[i][0], 1);
        assert_int_equal(found.problems.error_count, 0);
        assert_string_equal(worn(found.scene, 0), WORN[i][1]);
        assert_string_equal(worn(found.scene, 1), "cloth");
    }
}

TEST_WITH(variants_that_cannot_be_worn_are_told, maker_reset, NULL) {
    const char *path = write_variants(NAMES);
    Found unknown = survey_worn(path, (const char *const[]){"worm"}, 1);
    assert_non_null(maker_find(&unknown, "",
                               "no variant is named \"worm\" — did you mean warm? There are "
                               "soft, warm, old, bare"));
    Found two = survey_worn(path, (const char *const[]){"soft", "old"}, 2);
    assert_non_null(maker_find(&two, "/extensions/KHR_materials_variants/variants",
                               "--variant chooses \"soft\" and \"old\" of this file"));
    Found without =
        survey_worn(maker_gltf(STANDING.triangle, 36, ""), (const char *const[]){"soft"}, 1);
    assert_non_null(maker_find(&without, "", "no file of the scene has a variant"));
    Found twins = maker_survey_file(write_variants("{'name':'a'},{'name':'b'},{'name':'a'}"));
    assert_non_null(maker_find(&twins, "/extensions/KHR_materials_variants/variants/2/name",
                               "is \"a\", as variant 0 is called already"));
}

TEST_PROGRAM(maker_start, maker_end)
