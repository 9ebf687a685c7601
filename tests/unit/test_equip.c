/* SPDX-License-Identifier: Apache-2.0 */
/* test_equip.c -- what is put into a model is found in the scene that comes of it, where the
 * file said; a file that is wrong is refused with its place, and leaves nothing behind. */
#include "fixture.h"

#include "equip/equip_apply.h"
#include "equip/equip_page.h"
#include "equip/equip_shipped.h"
#include "equip/usual_material.h"
#include "scene/check/display_frame.h"
#include "scene/load/scene_load.h"
#include "text/text.h"

#define OFF 1e-5 /* m, and of unit vectors */

/* A triangle of 1 m at the origin, twice; the second wears no material. "%s" is the buffer's
 * uri, if any. */
static const char model_json[] =
    "{\"asset\": {\"version\": \"2.0\", \"generator\": \"a test\"}, \"scene\": 0,\n"
    " \"scenes\": [{\"nodes\": [0, 1]}], \"cameras\": [{\"type\": \"perspective\", \"name\": "
    "\"outside\", \"perspective\": {\"yfov\": 0.7, \"znear\": 0.1}}],\n"
    " \"nodes\": [{\"name\": \"wall\", \"mesh\": 0}, {\"name\": \"door\", \"mesh\": 1,"
    " \"translation\": [2, 0, 0]}, {\"name\": \"hidden\"}],\n"
    " \"materials\": [{\"name\": \"paint\", \"doubleSided\": true}],\n"
    " \"meshes\": [{\"primitives\": [{\"attributes\": {\"POSITION\": 0}, \"material\": 0}]},"
    " {\"primitives\": [{\"attributes\": {\"POSITION\": 0}}]}],\n"
    " \"accessors\": [{\"bufferView\": 0, \"componentType\": 5126, \"count\": 3, \"type\": "
    "\"VEC3\", \"min\": [0, 0, 0], \"max\": [1, 1, 0]}],\n"
    " \"bufferViews\": [{\"buffer\": 0, \"byteLength\": 36}],\n"
    " \"buffers\": [{\"byteLength\": 36%s}]}";
static const float corners[9] = {0, 0, 0, 1, 0, 0, 0, 1, 0};

/* right is (0.8, 0, -0.6), up (0.36, 0.8, 0.48): it leans back and is turned. */
static const char good[] =
    "{\"equip\": 1, \"model\": \"m.glb\",\n"
    " \"displays\": [{\"name\": \"speed\", \"on\": \"wall\", \"centre_m\": [0.3, 0.25, -0.5],"
    " \"right\": [0.8, 0, -0.6], \"up\": [0.36, 0.8, 0.48], \"width_m\": 0.3,"
    " \"height_m\": 0.12, \"before_mm\": 2, \"panel\": \"ips_cluster\","
    " \"content\": \"cluster\", \"level\": 0.5}],\n"
    " \"eyes\": [{\"name\": \"driver\", \"position_m\": [-0.37, 1.21, 0.11],"
    " \"looks_at\": \"speed\"}, {\"name\": \"down\", \"position_m\": [0, 2, 0],"
    " \"target_m\": [0, 1, 0]}],\n"
    " \"materials\": [{\"index\": 0, \"name\": \"paint\", \"as\": \"glass, clear\"},"
    " {\"index\": 1, \"base_color\": [0.1, 0.2, 0.3], \"roughness\": 0.25, \"ior\": 1.4}],\n"
    " \"profile\": \"iso-15008\", \"forward\": [1, 0, 0],"
    " \"place\": {\"where\": [35.5, -120, 20], \"year\": 2027, \"headings_deg\": [90]}}";

/* ---- files ------------------------------------------------------------------------------- */

static void put_u32(unsigned char *at, size_t value) {
    for (int i = 0; i < 4; i++) at[i] = (unsigned char)(value >> 8 * i);
}

static const char *write_glb(const char *name) {
    static unsigned char bytes[4096];
    static char json[3072], path[FOLDER_BYTES + 32];
    snprintf(path, sizeof path, "%s/%s", test_folder(), name);
    size_t size = (size_t)snprintf(json, sizeof json, model_json, "");
    while (size % 4) json[size++] = ' ';
    memcpy(bytes, "glTF\2\0\0\0", 8);
    put_u32(bytes + 8, 12 + 8 + size + 8 + sizeof corners);
    put_u32(bytes + 12, size);
    memcpy(bytes + 16, "JSON", 4);
    memcpy(bytes + 20, json, size);
    put_u32(bytes + 20 + size, sizeof corners);
    memcpy(bytes + 24 + size, "BIN\0", 4);
    memcpy(bytes + 28 + size, corners, sizeof corners);
    write_bytes(path, bytes, 28 + size + sizeof corners);
    return path;
}

/* In a folder of its own, too far off for what it names to be named from the folder of others:
 * its bytes lie beside it. */
static const char *write_far(void) {
    static char json[3072], path[FOLDER_BYTES + 32];
    snprintf(path, sizeof path, "%s/a/b/far.gltf", test_folder());
    mkdir(in_folder("a"), 0777);
    mkdir(in_folder("a/b"), 0777);
    mkdir(in_folder("new"), 0777);
    mkdir(in_folder("new/deep"), 0777);
    snprintf(json, sizeof json, model_json, ", \"uri\": \"some%20bytes.bin\"");
    write_text(path, json);
    write_bytes(in_folder("a/b/some bytes.bin"), corners, sizeof corners);
    return path;
}

/* The good file with one text in another's place. */
static const char *write_changed(const char *from, const char *to, Arena *arena) {
    const char *at = strstr(good, from), *path = in_folder("e.json");
    if (!at) fail_msg("the good file has no %s", from);
    write_text(path,
               arena_format(arena, "%.*s%s%s", (int)(at - good), good, to, at + strlen(from)));
    return path;
}

static const char *reach; /* --root of the next order */

static bool apply(const char *model, const char *output, bool overwrites, Arena *arena,
                  EquipResult *result, Error *err) {
    Problems problems = problems_start(arena);
    const EquipOrder order = {model, in_folder("e.json"), output, reach, overwrites};
    return equip_apply(&order, arena, &problems, result, err);
}

static Scene *load(const char *path, Arena *arena) {
    Scene *scene = NULL;
    Problems problems = problems_start(arena);
    SceneOptions options = {.paths = &path, .path_count = 1};
    assert_done(scene_load(&options, arena, &problems, &scene, &err));
    return scene;
}

/* ---- where things are -------------------------------------------------------------------- */

static void assert_vec(Vec3 found, double x, double y, double z) {
    assert_near(found.x, x, OFF);
    assert_near(found.y, y, OFF);
    assert_near(found.z, z, OFF);
}

static const Part *part_named(const Scene *scene, const char *name) {
    for (int i = 0; i < scene->part_count; i++)
        if (!strcmp(scene->parts[i].name, name)) return &scene->parts[i];
    fail_msg("no part %s", name);
    return NULL;
}

/* Each corner of the rectangle, which its texture coordinates give. */
static void check_rectangle(const Scene *scene, const Part *part) {
    const double normal[3] = {0.48, -0.6, 0.64}; /* right x up */
    assert_int_equal(part->triangle_count, 2);
    for (uint32_t t = 0; t < 2; t++)
        for (int k = 0; k < 3; k++) {
            Vec2 uv = scene_corner_uv(scene, part->first_triangle + t, k, 0);
            double s = 0.3 * ((double)uv.x - 0.5), h = 0.12 * (0.5 - (double)uv.y);
            assert_vec(scene_corner(scene, part->first_triangle + t, k),
                       0.3 + 0.8 * s + 0.36 * h + 0.002 * normal[0],
                       0.25 + 0.8 * h + 0.002 * normal[1],
                       -0.5 - 0.6 * s + 0.48 * h + 0.002 * normal[2]);
        }
}

static void check_eye(const SceneCamera *camera) {
    const double way[3] = {0.3 + 0.37, 0.25 - 1.21, -0.5 - 0.11};
    const double length = sqrt(way[0] * way[0] + way[1] * way[1] + way[2] * way[2]);
    assert_string_equal(camera->node_name, "driver");
    assert_vec(camera->world_from_camera.origin, -0.37, 1.21, 0.11);
    assert_vec(vec3_neg(camera->world_from_camera.z), way[0] / length, way[1] / length,
               way[2] / length);
    assert_near(camera->world_from_camera.x.y, 0, OFF); /* level */
    assert_true(camera->world_from_camera.y.y > 0);
}

static void check_materials(const Scene *scene) {
    const Material *glass = &scene->materials[part_named(scene, "wall")->material_id];
    const Material *own = &scene->materials[part_named(scene, "door")->material_id];
    assert_string_equal(glass->name, "paint");
    assert_true(glass->transmission == 1 && glass->double_sided);
    assert_near(glass->ior, 1.52, 1e-6);
    assert_near(own->base_color[2], 0.3, 1e-6);
    assert_near(own->roughness, 0.25, 1e-6);
    assert_near(own->ior, 1.4, 1e-6);
}

ARENA_TEST(what_is_applied_is_found_again) {
    Error err = {0};
    EquipResult result;
    const char *model = write_glb("m.glb");
    write_text(in_folder("e.json"), good);
    if (!apply(model, in_folder("new.gltf"), false, &arena, &result, &err))
        fail_msg("%s: %s", err.path, err.text);
    Scene *scene = load(in_folder("new.gltf"), &arena);
    assert_int_equal(scene->display_count, 1);
    assert_string_equal(scene->displays[0].name, "speed");
    assert_near(scene->displays[0].level, 0.5, 1e-6);
    assert_true(scene->displays[0].content.texture_id != NO_ID);
    check_rectangle(scene, part_named(scene, "speed"));
    assert_int_equal(scene->camera_count, 2);
    check_eye(&scene->cameras[0]);
    assert_vec(vec3_neg(scene->cameras[1].world_from_camera.z), 0, -1, 0);
    assert_vec(scene->cameras[1].world_from_camera.y, 1, 0, 0); /* ahead is up */
    check_materials(scene);
    scene_close(scene);
    assert_true(file_exists(result.bin) && result.copy_count == 2);
    const char *review = read_text(result.review, &arena);
    assert_text_has(review, "2027-06-21T12:00-08:00");
    assert_text_has(review, "\"forward\": [1.0, 0.0, 0.0]");
    assert_text_has(review, "\"any sun\"");
    assert_text_has(review, "\"headings_deg\": [90]");
    assert_false(apply(model, in_folder("new.gltf"), false, &arena, &result, &err));
    assert_error_has(&err, "is there already, required: the name of a new file, or "
                           "--overwrite");
    assert_true(apply(model, in_folder("new.gltf"), true, &arena, &result, &err));
    assert_false(apply(model, model, true, &arena, &result, &err));
    assert_error_has(&err, "is read, required: the name of a new file");
}

ARENA_TEST(files_of_the_model_come_along) {
    Error err = {0};
    EquipResult result;
    const char *model = write_far();
    write_text(in_folder("e.json"), good);
    if (!apply(model, in_folder("new/deep/n.gltf"), false, &arena, &result, &err))
        fail_msg("%s: %s", err.path, err.text);
    assert_null(result.bin);
    assert_int_equal(result.copy_count, 3);
    assert_true(file_exists(in_folder("new/deep/some bytes.bin")));
    assert_text_has(read_text(in_folder("new/deep/n.gltf"), &arena), "\"some%20bytes.bin\"");
    scene_close(load(in_folder("new/deep/n.gltf"), &arena));
    /* another file of that name is not written over */
    write_text(in_folder("new/deep/some bytes.bin"), "other bytes");
    assert_true(apply(model, in_folder("new/deep/n.gltf"), true, &arena, &result, &err));
    assert_true(file_exists(in_folder("new/deep/n_some bytes.bin")));
    assert_string_equal(read_text(in_folder("new/deep/some bytes.bin"), &arena), "other bytes");
    /* and beside the model nothing is copied but what ships */
    assert_true(apply(model, in_folder("a/n.gltf"), true, &arena, &result, &err));
    assert_text_has(read_text(in_folder("a/n.gltf"), &arena), "\"b/some%20bytes.bin\"");
}

ARENA_TEST(without_content_there_is_no_review) {
    EquipResult result;
    const char *model = write_glb("m.glb");
    write_changed("\"content\": \"cluster\", ", "", &arena);
    assert_done(apply(model, in_folder("bare.gltf"), false, &arena, &result, &err));
    assert_null(result.review);
    assert_false(file_exists(in_folder("bare.review.json")));
}

/* The figures of scenes/occupant.gltf: its head's top is 1.434 m up and its toes are 0.75 m
 * ahead of its node, above which its eyes are, at 1.3 m. */
ARENA_TEST(an_occupant_sits_where_the_eye_is) {
    static const struct {
        const char *forward;
        double x, z;
    } ways[] = {
        {"[1, 0, 0]", 1, 0}, {"[0, 0, -1]", 0, -1}, {"[-1, 0, 0]", -1, 0}, {"[0, 0, 1]", 0, 1}};
    EquipResult result;
    const char *model = write_glb("m.glb");
    for (int i = 0; i < 4; i++) {
        Arena scratch = arena;
        write_changed("\"forward\": [1, 0, 0]",
                      arena_format(&scratch,
                                   "\"forward\": %s, \"occupant\": {\"eye\": "
                                   "\"driver\", \"shirt\": \"black\"}",
                                   ways[i].forward),
                      &scratch);
        assert_done(apply(model, in_folder("o.gltf"), true, &scratch, &result, &err));
        assert_text_has(result.occupant, "o.occupant.gltf");
        Scene *scene = load(result.occupant, &scratch);
        Vec3 low = scene->bounds_min, high = scene->bounds_max;
        double ahead = ways[i].x > 0   ? high.x + 0.37
                       : ways[i].x < 0 ? -0.37 - low.x
                       : ways[i].z > 0 ? high.z - 0.11
                                       : 0.11 - low.z;
        assert_near(high.y, 1.21 - 1.3 + 1.4339, 1e-3);
        assert_near(ahead, 0.7495, 1e-3);
        scene_close(scene);
        const char *review = read_text(result.review, &scratch);
        assert_text_has(review, "\"driver in black\": [\"o.occupant.gltf\"]");
        assert_text_has(review, "\"with\": \"driver in black\"");
    }
    assert_true(file_exists(in_folder("occupant.bin")));
}

ARENA_TEST(a_folder_can_be_sent_to_somebody) {
    EquipResult result;
    FileBytes bytes;
    const char *panel;
    mkdir(in_folder("mine"), 0777);
    mkdir(in_folder("sent"), 0777);
    assert_done(equip_shipped_find(&shipped_panels, "ips_cluster", &arena, &panel, &err));
    assert_done(file_read(panel, 1 << 26, &arena, &bytes, &err));
    write_bytes(in_folder("mine/own.panel"), bytes.data, bytes.size);
    const char *model = write_glb("mine/m.glb");
    write_changed("\"ips_cluster\"", "\"own.panel\"", &arena);
    assert_done(apply(model, in_folder("sent/n.gltf"), false, &arena, &result, &err));
    assert_true(file_exists(in_folder("sent/own.panel")));
    assert_true(file_exists(in_folder("sent/cluster.png")));
    assert_null(strstr(read_text(in_folder("sent/n.gltf"), &arena), "../"));
}

/* What the model itself names in a folder beside its own goes along where --root says so. */
ARENA_TEST(what_the_model_names_outside_its_folder_is_copied_if_that_is_allowed) {
    EquipResult result;
    Error why = {0};
    const char *model = arena_format(&arena, "%s", in_folder("car/m.gltf"));
    mkdir(in_folder("car"), 0777);
    mkdir(in_folder("parts"), 0777);
    write_text(model, arena_format(&arena, model_json, ", \"uri\": \"../parts/corners.bin\""));
    write_bytes(in_folder("parts/corners.bin"), corners, sizeof corners);
    write_changed("", "", &arena);
    assert_false(apply(model, in_folder("car/n.gltf"), false, &arena, &result, &why));
    assert_error_has(&why, "\"../parts/corners.bin\" leaves the folder of the file that names");
    reach = arena_format(&arena, "%s", in_folder("parts"));
    bool is_applied = apply(model, in_folder("car/n.gltf"), false, &arena, &result, &why);
    reach = NULL;
    if (!is_applied) fail_msg("%s", why.text);
    assert_true(file_exists(in_folder("car/corners.bin")));
    assert_null(strstr(read_text(in_folder("car/n.gltf"), &arena), "../"));
    scene_close(load(in_folder("car/n.gltf"), &arena));
}

/* Texts that name a file, a picture that nothing shows and that is none, a buffer that nothing
 * reads: the files of somebody who equips a model stay where they are. */
ARENA_TEST(only_what_was_decoded_is_copied) {
    EquipResult result;
    const char *model = arena_format(&arena, "%s", in_folder("theirs/m.gltf"));
    mkdir(in_folder("theirs"), 0777);
    mkdir(in_folder("ours"), 0777);
    write_text(model,
               arena_format(
                   &arena, model_json,
                   ", \"uri\": \"c.bin\"}, {\"byteLength\": 4, \"uri\": \"unread\"}], "
                   "\"images\": [{\"uri\": \"key\"}], \"extensions\": {\"PARHELION_x\": {\"note\": "
                   "\"key\"}}, \"extras\": {\"PARHELION_y\": \"{\\\"n\\\": \\\"key\\\"}\"}, "
                   "\"x\": [{\"y\": 1"));
    write_bytes(in_folder("theirs/c.bin"), corners, sizeof corners);
    write_text(in_folder("theirs/key"), "-----BEGIN KEY-----");
    write_text(in_folder("theirs/unread"), "also kept");
    write_changed("", "", &arena);
    assert_done(apply(model, in_folder("ours/n.gltf"), false, &arena, &result, &err));
    assert_true(file_exists(in_folder("ours/c.bin")));
    assert_false(file_exists(in_folder("ours/key")));
    assert_false(file_exists(in_folder("ours/unread")));
    assert_null(strstr(read_text(in_folder("ours/n.gltf"), &arena), "unread"));
}

/* An eighth of a cylinder of radius 0.4 m about the Y axis, seen from its axis: corners by sine
 * and cosine, normals towards the axis. */
static const char *cylinder(Arena *arena) {
    enum { STRIPS = 12 };
    Text text = {.arena = arena};
    text_add(&text, "\"mesh\": {\"positions_m\": [");
    for (int i = 0; i <= STRIPS; i++)
        for (int y = 0; y < 2; y++) {
            double angle = M_PI / 4 * ((double)i / STRIPS - 0.5);
            text_format(&text, "%s%.9g, %.9g, %.9g", i || y ? ", " : "", 0.4 * sin(angle), 0.2 * y,
                        -0.4 * cos(angle));
        }
    text_add(&text, "], \"uv\": [");
    for (int i = 0; i <= STRIPS; i++)
        text_format(&text, "%s%.9g, 1, %.9g, 0", i ? ", " : "", (double)i / STRIPS,
                    (double)i / STRIPS);
    text_add(&text, "], \"triangles\": [");
    for (int i = 0; i < STRIPS; i++)
        text_format(&text, "%s%d, %d, %d, %d, %d, %d", i ? ", " : "", 2 * i, 2 * i + 2, 2 * i + 3,
                    2 * i, 2 * i + 3, 2 * i + 1);
    text_add(&text, "]}, \"panel\"");
    return text.data;
}

ARENA_TEST(a_curved_face_is_a_display) {
    EquipResult result;
    DisplayFrame frame;
    const char *model = write_glb("m.glb");
    write_changed("\"panel\"", cylinder(&arena), &arena);
    assert_done(apply(model, in_folder("c.gltf"), true, &arena, &result, &err));
    Scene *scene = load(in_folder("c.gltf"), &arena);
    const Part *part = part_named(scene, "speed");
    assert_int_equal(part->triangle_count, 24);
    assert_true(display_frame_of(scene, part, &frame));
    assert_near(frame.width_m, 0.4 * 24 * sin(M_PI / 96), 1e-5); /* 12 chords */
    assert_near(frame.height_m, 0.2, 1e-5);
    assert_vec(frame.normal, 0, 0, 1);
    for (uint32_t v = 2; v < 24; v++) { /* all but the rims see both strips */
        Vec3 n = part->normals[v], p = scene->positions[part->first_vertex + v];
        assert_near(n.x, -p.x / 0.4, 1e-5);
        assert_near(n.z, -p.z / 0.4, 1e-5);
    }
    scene_close(scene);
}

ARENA_TEST(what_is_read_stands_in_the_review) {
    EquipResult result;
    const char *model = write_glb("m.glb");
    write_changed("\"level\": 0.5",
                  "\"symbols\": [{\"name\": \"48\", \"uv\": [0.1, 0.2, 0.3, "
                  "0.4], \"polarity\": \"light-on-dark\"}, {\"name\": \"km/h\", \"uv\": [0, 0, "
                  "1, 0.5]}]",
                  &arena);
    assert_done(apply(model, in_folder("s.gltf"), true, &arena, &result, &err));
    const char *review = read_text(result.review, &arena);
    assert_text_has(review, "\"48\": {");
    assert_text_has(review, "[0.1, 0.2, 0.3, 0.4]");
    assert_text_has(review, "\"light-on-dark\"");
    assert_text_has(review, "\"km/h\": {");
    assert_null(strstr(review, "\"find\""));
    assert_text_has(review, "\"an ordinary day\"");
    assert_text_has(review, "\"an ordinary night\"");
    write_changed("\"level\": 0.5", "\"symbols\": []", &arena);
    assert_done(apply(model, in_folder("s.gltf"), true, &arena, &result, &err));
    assert_null(result.review);
}

ARENA_TEST(forward_is_proposed_from_the_first_eye) {
    EquipResult result;
    const char *model = write_glb("m.glb");
    write_changed("\"forward\": [1, 0, 0],", "", &arena); /* it looks along (0.67, , -0.61) */
    assert_done(apply(model, in_folder("f.gltf"), true, &arena, &result, &err));
    assert_true(result.forward_is_proposed && result.forward[0] == 1 && result.forward[2] == 0);
    assert_null(result.occupant);
}

/* ---- what is refused --------------------------------------------------------------------- */

static const struct {
    const char *from, *to, *path, *text;
} wrong[] = {
    {"\"equip\": 1", "\"equip\": 2", "/equip", "is 2, required: 1"},
    {"\"model\"", "\"modle\"", "/modle", "the nearest known one is 'model'"},
    {"\"width_m\": 0.3", "\"width_mm\": 300", "/displays/0/width_mm", "'width_m'"},
    {"\"width_m\": 0.3", "\"width_m\": 0", "/displays/0/width_m", "from 0.001 to 100"},
    {"\"width_m\": 0.3", "\"width_m\": 1.75", "/displays/0/width_m", "required: 0.005 to 1.5 m"},
    {"\"level\": 0.5", "\"level\": 50", "/displays/0/level", "required: a level from 0 to 1"},
    {"\"level\": 0.5", "\"symbols\": [{\"name\": \"a\", \"uv\": [0.3, 0, 0.2, 1]}]",
     "/displays/0/symbols/0/uv", "required: left < right"},
    {"\"level\": 0.5",
     "\"symbols\": [{\"name\": \"a\", \"uv\": [0, 0, 1, 1]}, {\"name\": "
     "\"a\", \"uv\": [0, 0, 1, 1]}]",
     "/displays/0/symbols/1/name", "is 'a' once more"},
    {"\"level\": 0.5",
     "\"mesh\": {\"positions_m\": [0, 0, 0, 1], \"uv\": [0, 0], "
     "\"triangles\": [0, 0, 0]}",
     "/displays/0/mesh/positions_m", "required: a multiple of 3"},
    {"\"level\": 0.5",
     "\"mesh\": {\"positions_m\": [0, 0, 0, 1, 0, 0, 0, 1, 0], "
     "\"uv\": [0, 0], \"triangles\": [0, 1, 2]}",
     "/displays/0/mesh/uv", "required: one of each of 3"},
    {"\"level\": 0.5",
     "\"mesh\": {\"positions_m\": [0, 0, 0, 1, 0, 0, 0, 1, 0], "
     "\"uv\": [0, 0, 1, 0, 0, 1], \"triangles\": [0, 1, 3]}",
     "/displays/0/mesh/triangles", "below 3"},
    {"\"profile\"", "\"occupant\": {\"eye\": \"drver\"}, \"profile\"", "/occupant/eye",
     "did you mean driver?"},
    {"\"profile\"", "\"occupant\": {\"eye\": \"down\", \"shirt\": \"red\"}, \"profile\"",
     "/occupant/shirt", "white"},
    {"[0.36, 0.8, 0.48]", "[1, 1, 0]", "/displays/0/up", "degrees to \"right\", required: 90"},
    {"[0.36, 0.8, 0.48]", "[0, 0, 0]", "/displays/0/up", "is the zero vector"},
    {"ips_cluster", "ips_clustr", "/displays/0/panel", "did you mean ips_cluster?"},
    {"ips_cluster", "../../../x.panel", "/displays/0/panel", "leaves the folder"},
    {"ips_cluster", "mine.panel", "/displays/0/panel", "cannot be found"},
    {"\"content\": \"cluster\"", "\"content\": \"clusters\"", "/displays/0/content",
     "'clusters' is no shipped content"},
    {"\"name\": \"down\"", "\"name\": \"wall\"", "/eyes/1/name",
     "is 'wall', which the model has already"},
    {"\"name\": \"down\"", "\"name\": \"paint\"", "/eyes/1/name",
     "is 'paint', which the model has already"},
    {"\"looks_at\": \"speed\"", "\"looks_at\": \"sped\"", "/eyes/0/looks_at",
     "did you mean speed?"},
    {"\"looks_at\": \"speed\"", "\"target_m\": [-0.37, 1.21, 0.11]", "/eyes/0/position_m",
     "is where it looks at"},
    {"\"name\": \"down\"", "\"name\": \"driver\"", "/eyes/1/name", "is 'driver' once more"},
    {"\"glass, clear\"", "\"glas, clear\"", "/materials/0/as", "did you mean"},
    {"\"name\": \"paint\"", "\"name\": \"print\"", "/materials/0", "made for another model?"},
    {"\"index\": 1", "\"index\": 2", "/materials/1", "is for material 2, the model has 1"},
    {"\"index\": 1", "\"index\": 0", "/materials/1/index", "is 0 once more"},
    {"iso-15008", "iso-15009", "/profile", "did you mean iso-15008?"},
    {"\"forward\": [1, 0, 0]", "\"forward\": [0, 1, 0]", "/forward", "is vertical"},
    {"[35.5, -120, 20]", "[95, 0, 20]", "/place/where", "required: a latitude of -90 to 90"},
    {"\"year\": 2027", "\"year\": 1900", "/place/year", "from 1950 to 2100"},
};

TEST(a_wrong_file_is_refused_and_leaves_nothing) {
    Error err;
    EquipResult result;
    const char *model = write_glb("m.glb");
    write_text(in_folder("e.json"), good);
    int before = files_in_folder();
    for (size_t i = 0; i < sizeof wrong / sizeof *wrong; i++) {
        Arena arena = test_arena(state);
        err = (Error){0};
        write_changed(wrong[i].from, wrong[i].to, &arena);
        if (apply(model, in_folder("wrong.gltf"), false, &arena, &result, &err))
            fail_msg("%s is taken", wrong[i].to);
        if (strcmp(err.path, wrong[i].path))
            fail_msg("%s at %s: %s", wrong[i].to, err.path, err.text);
        assert_error_has(&err, wrong[i].text);
        assert_int_equal(files_in_folder(), before);
    }
}

/* ---- the page ---------------------------------------------------------------------------- */

ARENA_TEST(a_page_holds_the_model_and_asks_for_nothing) {
    const char *model = write_glb("<script>.glb"), *page = in_folder("page.html");
    Scene *scene = load(model, &arena);
    assert_done(equip_page_write(scene, model, "parhelion equip m", page, &arena, &err));
    scene_close(scene);
    const char *text = read_text(page, &arena);
    assert_text_has(text, "\"model\":\"\\u003cscript>.glb\"");
    assert_text_has(text, "id=\"equip-z\"");
    assert_text_has(text, "\"ips_cluster\"");
    assert_null(strstr(text, "<script src"));
    assert_null(strstr(text, "<link"));
    scene = ARENA_NEW(&arena, Scene, 1);
    assert_fails(equip_page_write(scene, model, "parhelion equip m", page, &arena, &err),
                 "has no triangles, so no face to click");
    scene->triangle_count = EQUIP_TRIANGLES_MAX + 1;
    assert_fails(equip_page_write(scene, model, "parhelion equip m", page, &arena, &err),
                 "a page takes at most 4000000");
}

TEST(usual_materials_can_be_told_apart_and_are_physical) {
    for (int i = 0; usual_materials[i].name; i++) {
        const UsualMaterial *m = &usual_materials[i];
        for (int c = 0; c < 3; c++) assert_true(m->base_color[c] > 0 && m->base_color[c] <= 1);
        assert_true(m->roughness >= 0 && m->roughness <= 1 && m->ior > 1);
        assert_true(m->metallic == 0 || m->metallic == 1);
        assert_true(m->source[0] != 0);
        for (int k = 0; k < i; k++) assert_true(strcmp(m->name, usual_materials[k].name) != 0);
    }
}

TEST_PROGRAM(make_folder, clear_folder)
