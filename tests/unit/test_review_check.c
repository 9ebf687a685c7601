/* SPDX-License-Identifier: Apache-2.0 */
/* test_review_check.c -- a request against its scene, the file to start from, and the reviews
 * that are shipped. */
#include "review_fixture.h"

#include "review/request/request_check.h"
#include "review/request/request_start.h"
#include "scene/load/scene_load.h"

static int start(void **state) {
    if (make_folder(state)) return -1;
    review_files();
    return 0;
}

/* ---- a scene of names -------------------------------------------------------------------- */

enum { PLAIN, CLUSTER, SCREEN, BARE, MATERIALS };

/* The right screen shows the upper half of its content's right half. */
static void show_a_corner(Scene *scene, Arena *arena) {
    static const Vec2 uv[3] = {{0.5f, 0}, {1, 0}, {1, 0.5f}};
    Part *part = &scene->parts[3];
    scene->positions = ARENA_NEW(arena, Vec3, 3); /* of no size: nothing can be odd of it */
    scene->triangles = ARENA_NEW(arena, Triangle, 1);
    scene->triangles[0] = (Triangle){{0, 1, 2}, 3};
    scene->triangle_count = part->triangle_count = 1;
    part->uv[0] = ARENA_NEW(arena, Vec2, 3);
    memcpy(part->uv[0], uv, sizeof uv);
}

/* Cluster: one node. Screen: two nodes. Bare: a display without content and panel. */
static Scene *make_scene(Arena *arena) {
    static const char panel;
    static const char *const materials[MATERIALS] = {"plain", "cluster", "screen", "bare"};
    static const struct {
        const char *name;
        int material;
    } parts[] = {{"seat", PLAIN},          {"dial", CLUSTER},       {"screen left", SCREEN},
                 {"screen right", SCREEN}, {"screen left", SCREEN}, {"bare node", BARE}};
    static const char *inputs[] = {"a.gltf"};
    const Panel *solid = (const Panel *)(const void *)&panel; /* nobody looks into it */
    Scene *scene = ARENA_NEW(arena, Scene, 1);
    scene->materials = ARENA_NEW(arena, Material, MATERIALS);
    scene->displays = ARENA_NEW(arena, Display, MATERIALS);
    scene->parts = ARENA_NEW(arena, Part, 6);
    scene->cameras = ARENA_NEW(arena, SceneCamera, 3);
    for (int i = 0; i < MATERIALS; i++) {
        scene->materials[i].name = materials[i];
        scene->materials[i].display_id = i == PLAIN ? NO_ID : scene->display_count;
        if (i != PLAIN)
            scene->displays[scene->display_count++] = (Display){
                .name = materials[i],
                .material_id = i,
                .panel = i == BARE ? NULL : solid,
                .content = {.texture_id = i == BARE ? NO_ID : 0, .uv_from_uv = {1, 0, 0, 0, 1, 0}}};
    }
    for (int i = 0; i < 6; i++)
        scene->parts[i] = (Part){.name = parts[i].name, .material_id = parts[i].material};
    scene->cameras[0] = (SceneCamera){"eye", "", .is_perspective = true};
    scene->cameras[1] = (SceneCamera){"", "", .is_perspective = true};
    scene->cameras[2] = (SceneCamera){"plan", "", .is_perspective = false};
    show_a_corner(scene, arena);
    scene->material_count = MATERIALS, scene->part_count = 6, scene->camera_count = 3;
    scene->environment.forward = vec3(0, 0, -1);
    scene->inputs = inputs, scene->input_count = 1;
    return scene;
}

/* ---- displays and cameras ---------------------------------------------------------------- */

ARENA_TEST(displays_are_found_by_material_and_node) {
    ReviewDisplay found;
    const Scene *scene = make_scene(&arena);
    assert_done(review_display_find(scene, "cluster", &arena, &found, &err));
    assert_true(found.display_id == 0 && found.part_count == 1 && found.part_ids[0] == 1);
    assert_done(review_display_find(scene, "node:dial", &arena, &found, &err));
    assert_true(found.display_id == 0 && found.part_count == 1);
    assert_done(review_display_find(scene, "node:screen left", &arena, &found, &err));
    assert_true(found.display_id == 1 && found.part_count == 2 && found.part_ids[1] == 4);
}

TEST(displays_that_are_none_are_told) {
    static const struct {
        const char *name, *words;
    } wrong[] = {
        {"clustr", "there is no display 'clustr': did you mean cluster?"},
        {"node:dail", "there is no display 'node:dail': did you mean node:dial?"},
        {"node:seat", "there is no display 'node:seat'"},
        {"plain", "'plain' has no panel, required: a display: "},
        {"bare", "'bare' has no panel, required: a measured display"},
        {"screen", "'screen' is worn by several nodes, required: one of them: 'node:screen "
                   "left', 'node:screen right'"},
    };
    for (size_t i = 0; i < sizeof wrong / sizeof *wrong; i++) {
        Arena arena = test_arena(state);
        ReviewDisplay found;
        assert_fails_as(
            review_display_find(make_scene(&arena), wrong[i].name, &arena, &found, &err),
            ERROR_INPUT, wrong[i].words);
    }
    Arena arena = test_arena(state);
    ReviewDisplay found;
    assert_fails_as(review_display_find(&(Scene){0}, "x", &arena, &found, &err), ERROR_INPUT,
                    "the scene has no display, required: a material with a panel");
}

ARENA_TEST(cameras_are_found_by_name_and_index) {
    int id = NO_ID;
    const Scene *scene = make_scene(&arena);
    ReviewEye named = {.kind = EYE_CAMERA, .camera = "plan", .camera_id = NO_ID};
    ReviewEye counted = {.kind = EYE_CAMERA, .camera_id = 1};
    assert_true(review_camera_find(scene, &named, arena, &id, why()) && id == 2);
    assert_true(review_camera_find(scene, &counted, arena, &id, why()) && id == 1);
    named.camera = "eey", counted.camera_id = 3;
    assert_fails_as(review_camera_find(scene, &named, arena, &id, &err), ERROR_INPUT,
                    "there is no camera 'eey': did you mean eye?");
    assert_fails_as(review_camera_find(scene, &counted, arena, &id, &err), ERROR_INPUT,
                    "there is no camera 3, required: one of the scene's 3, counted from 0");
    assert_fails_as(review_camera_find(&(Scene){0}, &named, arena, &id, &err), ERROR_INPUT,
                    "the scene has no camera, required: 'position_m'");
}

/* ---- a whole request --------------------------------------------------------------------- */

static void check(const char *from, const char *to, Problems *problems, Arena *arena) {
    ReviewRequest request;
    char *text = review_changed(review_good, from, to, arena);
    assert_done(review_read(review_changed(text, "node:screen", "node:screen right", arena), arena,
                            &request, &err));
    *problems = problems_start(arena);
    bool ok = review_request_check(&request, make_scene(arena), problems);
    assert_int_equal(ok, problems->error_count == 0);
}

ARENA_TEST(a_request_that_fits_its_scene_has_no_problem) {
    Problems problems;
    check(NULL, NULL, &problems, &arena);
    assert_int_equal(problems.count, 0);
}

TEST(what_does_not_fit_is_told_with_its_place) {
    static const struct {
        const char *from, *to, *place, *words;
    } wrong[] = {
        {"'camera':'eye'", "'camera':'ear'", "/eyes/driver/camera", "there is no camera 'ear'"},
        {"'camera':1", "'camera':7", "/eyes/second/camera", "there is no camera 7"},
        {"'camera':1", "'camera':2", "/eyes/second/camera",
         "is an orthographic camera, required: a perspective one"},
        {"'display':'cluster'", "'display':'clutter'", "/symbols/speed/display",
         "there is no display 'clutter': did you mean cluster?"},
        {"'cluster':0.1", "'bare':0.1", "/levels/night/bare", "'bare' has no panel"},
        {"'contents':{'cluster'", "'contents':{'plain'", "/conditions/0/contents/plain",
         "'plain' has no panel"},
    };
    for (size_t i = 0; i < sizeof wrong / sizeof *wrong; i++) {
        Arena arena = test_arena(state);
        Problems problems;
        check(wrong[i].from, wrong[i].to, &problems, &arena);
        assert_int_equal(problems.error_count, 1);
        assert_text_has(problems.list[0].file, "t.review.json");
        assert_string_equal(problems.list[0].path, wrong[i].place);
        assert_text_has(problems.list[0].message, wrong[i].words);
    }
}

ARENA_TEST(a_symbol_wants_content) {
    ReviewRequest request;
    Scene *scene = make_scene(&arena);
    Problems problems = problems_start(&arena);
    char *text = review_changed(review_good, "node:screen", "node:screen right", &arena);
    assert_done(review_read(text, &arena, &request, &err));
    for (int i = 0; i < scene->display_count; i++) scene->displays[i].content.texture_id = NO_ID;
    assert_false(review_request_check(&request, scene, &problems));
    assert_int_equal(problems.error_count, 2); /* speed has a content of its own */
    assert_string_equal(problems.list[0].path, "/symbols/text/display");
    assert_text_has(problems.list[0].message, "shows no content in the scene, required: 'content'");
}

/* ---- a file to start from ---------------------------------------------------------------- */

static bool begin_with_root(const Scene *scene, const char *output, const char *root, Arena *arena,
                            Error *err) {
    const char *scenes[] = {in_folder("b c.gltf"), in_folder("a.gltf")};
    ReviewStart request = {scenes, 2, output, root, NULL, false};
    return review_request_start(&request, scene, arena, err);
}

static bool begin(const Scene *scene, const char *output, Arena *arena, Error *err) {
    return begin_with_root(scene, output, NULL, arena, err);
}

/* What is written is taken, and fits the scene. */
ARENA_TEST(a_file_to_start_from_is_read_back) {
    ReviewRequest r;
    const Scene *scene = make_scene(&arena);
    const char *output = in_folder("new.review.json");
    Problems problems = problems_start(&arena);
    assert_done(begin(scene, output, &arena, &err));
    assert_done(review_request_read(output, NULL, &arena, &problems, &r, &err));
    assert_true(review_request_check(&r, scene, &problems));
    assert_string_equal(r.title, "b c");
    assert_string_equal(r.scenes[0], in_folder("b c.gltf"));
    assert_int_equal(r.eye_count, 2);
    assert_true(!strcmp(r.eyes[0].camera, "eye") && r.eyes[1].camera_id == 1);
    assert_int_equal(r.symbol_count, 3); /* the bare display shows nothing */
    assert_string_equal(r.symbols[0].display, "cluster");
    assert_string_equal(r.symbols[1].display, "node:screen left");
    assert_string_equal(r.symbols[2].name, "screen right");
    for (int i = 0; i < 3; i++) {
        assert_true(r.symbols[i].find_text);
        assert_int_equal(r.symbols[i].has_uv, i == 2);
    }
    assert_true(r.symbols[2].uv[0] == 0.5 && r.symbols[2].uv[1] == 0 && r.symbols[2].uv[2] == 1 &&
                r.symbols[2].uv[3] == 0.5);
    assert_int_equal(r.condition_count, 3);
    assert_int_equal(r.conditions[2].kind, CONDITION_YEAR_SWEEP);
    for (const char *line = read_text(output, &arena); line; line = strchr(line, '\n')) {
        line += *line == '\n';
        assert_true(strcspn(line, "\n") <= 96);
    }
    assert_false(begin(scene, output, &arena, why())); /* nothing is overwritten */
    assert_int_equal(why()->code, ERROR_OUTPUT);
    assert_error_has(why(), "is there already, required: the name of a new file");
    unlink(output);
}

ARENA_TEST(a_folder_beside_the_scenes_will_do) {
    ReviewRequest r;
    Problems problems = problems_start(&arena);
    mkdir(in_folder("one"), 0700);
    mkdir(in_folder("one/two"), 0700);
    const char *near = in_folder("one/n.json");
    const char *far = arena_format(&arena, "%s", in_folder("one/two/f.json"));
    assert_done(begin(make_scene(&arena), near, &arena, &err));
    assert_done(review_request_read(near, NULL, &arena, &problems, &r, &err));
    assert_fails_as(begin(make_scene(&arena), far, &arena, &err), ERROR_INPUT,
                    "lies outside the parent of the new file's folder, required:");
    assert_false(file_exists(far));
    assert_false(begin_with_root(make_scene(&arena), far, in_folder("one"), &arena, why()));
    assert_false(file_exists(far));
    assert_done(begin_with_root(make_scene(&arena), far, in_folder("."), &arena, &err));
    assert_false(review_request_read(far, NULL, &arena, &problems, &r, why()));
    assert_done(review_request_read(far, in_folder("."), &arena, &problems, &r, &err));
    assert_int_equal(r.scene_count, 2);
    unlink(far);
    assert_fails_as(begin(make_scene(&arena), in_folder("none/f.json"), &arena, &err), ERROR_OUTPUT,
                    "its folder cannot be found");
}

ARENA_TEST(a_scene_without_eyes_or_displays_has_no_start) {
    Scene *scene = make_scene(&arena);
    const char *output = in_folder("none.review.json");
    scene->display_count = 0;
    assert_fails_as(begin(scene, output, &arena, &err), ERROR_INPUT,
                    "has no display that shows content, required: one to review");
    scene->camera_count = 0;
    assert_fails_as(begin(scene, output, &arena, &err), ERROR_INPUT,
                    "has no perspective camera, required: one where an eye is");
    assert_false(file_exists(output));
}

/* ---- what is shipped --------------------------------------------------------------------- */

TEST(shipped_reviews_fit_their_scenes) {
    static const char *const files[] = {PROJECT_DIR "/scenes/car_dashboard.review.json",
                                        PROJECT_DIR "/scenes/cockpit.review.json"};
    for (int i = 0; i < 2; i++) {
        Arena arena = test_arena(state);
        ReviewRequest r;
        Scene *scene;
        Problems problems = problems_start(&arena);
        if (!review_request_read(files[i], NULL, &arena, &problems, &r, why()))
            fail_msg("%s: %s: %s", files[i], why()->path, why()->text);
        SceneOptions options = {.paths = r.scenes, .path_count = r.scene_count};
        assert_done(scene_load(&options, &arena, &problems, &scene, &err));
        if (!review_request_check(&r, scene, &problems))
            fail_msg("%s", problems.list[problems.count - 1].message);
        assert_int_equal(problems.count, 0);
        scene_close(scene);
    }
}

TEST_PROGRAM(start, clear_folder)
