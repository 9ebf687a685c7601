/* SPDX-License-Identifier: Apache-2.0 */
/* The laws of what is tried out on a scene: nodes that turn, patches of materials, hoods. */
#include "base/count.h"
#include "check.h"
#include "gltf_maker.h"

/* ---- the scene: triangles that face the eye at +Z ---------------------------------------- */

static const struct {
    float facing[9], lying[9], uv[6];
} BYTES = {{0, 0, 0, 1, 0, 0, 0, 1, 0}, {0, 0, 0, 0, 0, 1, 1, 0, 0}, {0, 1, 1, 1, 0, 0}};

/* Triangle 0: "face", 1: "glass" below it, 2: "rim", 3: "desk", which faces up. */
#define MEMBERS \
    "'bufferViews':[{'buffer':0,'byteLength':36},{'buffer':0,'byteOffset':36," \
    "'byteLength':36},{'buffer':0,'byteOffset':72,'byteLength':24}]," \
    "'accessors':[{'bufferView':0,'componentType':5126,'count':3," \
    "'type':'VEC3','min':[0,0,0],'max':[1,1,0]},{'bufferView':1,'componentType':5126," \
    "'count':3,'type':'VEC3','min':[0,0,0],'max':[1,0,1]}," \
    "{'bufferView':2,'componentType':5126,'count':3,'type':'VEC2'}]," \
    "'materials':[{'name':'screen','pbrMetallicRoughness':{'roughnessFactor':0.3," \
    "'metallicFactor':0},'extensions':{'PARHELION_coating':{'stack':'mgf2'}}}," \
    "{'name':'lying'},{'name':'both'}],'extensionsUsed':['PARHELION_coating']," \
    "'meshes':[{'primitives':[{'attributes':{'POSITION':0,'TEXCOORD_0':2},'material':0}]}," \
    "{'primitives':[{'attributes':{'POSITION':1,'TEXCOORD_0':2},'material':1}]}," \
    "{'primitives':[{'attributes':{'POSITION':0,'TEXCOORD_0':2},'material':2}]}]," \
    "'scene':0,'scenes':[{'nodes':[0,2,3,4,5,6,7,8]}],'nodes':[" \
    "{'name':'face','mesh':0,'children':[1]},{'name':'glass','mesh':0}," \
    "{'name':'rim','mesh':0},{'name':'desk','mesh':1},{'name':'twin'},{'name':'twin'}," \
    "{'name':'empty'},{'name':'front','mesh':2}," \
    "{'name':'rear','mesh':2,'scale':[1,1,-1]}]"

/* Only then are there displays. */
static bool has_hood(const SceneChange *changes, int count) {
    return count > 0 && changes[0].kind == CHANGE_HOOD;
}

static Found survey(const SceneChange *changes, int count) {
    const char *path = maker_gltf(&BYTES, sizeof BYTES, MEMBERS);
    const char *panel = PROJECT_DIR "/assets/panels/ips_cluster.panel";
    SceneOverride panels[3] = {
        {"screen", panel, NULL}, {"lying", panel, NULL}, {"both", panel, NULL}};
    return maker_survey(&(SceneOptions){
        .paths = &path,
        .path_count = 1,
        .panels = panels,
        .panel_count = has_hood(changes, count) ? 2 + !strcmp(changes->name, "both") : 0,
        .changes = changes,
        .change_count = count});
}

static const Scene *load(SceneChange change) {
    SceneChange *kept = ARENA_NEW(&maker.arena, SceneChange, 1);
    *kept = change;
    kept->file = "r.json", kept->place = "/variants/v";
    kept->ahead[2] = -1;
    Found found = survey(kept, 1);
    maker_expect_whole(&found);
    return found.scene;
}

static void assert_refused(SceneChange change, const char *text) {
    change.file = "r.json", change.place = "/variants/v", change.ahead[2] = -1;
    Found found = survey(&change, 1);
    const Problem *problem = maker_find(&found, "/variants/v", text);
    if (!problem) fail_msg("nothing says \"%s\"", text);
    assert_string_equal(problem->file, "r.json");
    assert_int_equal(problem->severity, SEVERITY_ERROR);
    scene_close(found.scene);
}

static Vec3 corner_of(const Scene *scene, const char *node, int corner) {
    for (int i = 0; i < scene->part_count; i++)
        if (!strcmp(scene->parts[i].node_name, node))
            return scene_corner(scene, scene->parts[i].first_triangle, corner);
    fail_msg("no part is named %s", node);
    return vec3(0, 0, 0);
}

static void assert_at(const Scene *scene, const char *node, int corner, double x, double y,
                      double z) {
    Vec3 p = corner_of(scene, node, corner);
    assert_near(p.x, x, 2e-6);
    assert_near(p.y, y, 2e-6);
    assert_near(p.z, z, 2e-6);
}

/* ---- nodes ------------------------------------------------------------------------------- */

static SceneChange turn(float tilt, float about_up, float roll) {
    return (SceneChange){
        .kind = CHANGE_NODES, .name = "face", .tilt = tilt, .turn = about_up, .roll = roll};
}

#define ANGLE 0.3f

TEST(a_tilt_turns_the_face_up_about_its_middle) {
    const Scene *scene = load(turn(ANGLE, 0, 0));
    double c = cos((double)ANGLE), s = sin((double)ANGLE);
    assert_at(scene, "face", 0, 0, 0.5 - 0.5 * c, 0.5 * s);
    assert_at(scene, "face", 2, 0, 0.5 + 0.5 * c, -0.5 * s); /* the top leans back */
    assert_at(scene, "rim", 2, 0, 1, 0);
    scene_close((Scene *)scene);
}

TEST(a_turn_goes_to_the_right_of_who_faces_it_and_a_roll_clockwise) {
    double c = cos((double)ANGLE), s = sin((double)ANGLE);
    const Scene *turned = load(turn(0, ANGLE, 0)), *rolled = load(turn(0, 0, ANGLE));
    assert_at(turned, "face", 1, 0.5 + 0.5 * c, 0, -0.5 * s); /* its right edge goes back */
    assert_at(rolled, "face", 1, 0.5 + 0.5 * c - 0.5 * s, 0.5 - 0.5 * s - 0.5 * c, 0);
    assert_at(rolled, "face", 2, 0.5 - 0.5 * c + 0.5 * s, 0.5 + 0.5 * s + 0.5 * c, 0);
    scene_close((Scene *)turned);
    scene_close((Scene *)rolled);
}

/* Lengths stay, and the middle goes where it is moved. */
TEST(turns_are_rigid) {
    for (int i = 0; i < 20; i++) {
        Arena begun = maker.arena;
        SceneChange change = turn(0.1f * (float)i, 0.7f - 0.13f * (float)i, 0.05f * (float)i);
        change.move_m[0] = 0.4f, change.move_m[1] = -0.2f, change.move_m[2] = 0.1f * (float)i;
        const Scene *scene = load(change);
        Vec3 a = corner_of(scene, "face", 0), b = corner_of(scene, "face", 1);
        Vec3 c = corner_of(scene, "face", 2);
        assert_near(vec3_length(vec3_sub(b, a)), 1, 1e-5);
        assert_near(vec3_length(vec3_sub(c, a)), 1, 1e-5);
        assert_near(vec3_dot(vec3_sub(b, a), vec3_sub(c, a)), 0, 1e-5);
        Vec3 middle = vec3_scale(vec3_add(b, c), 0.5f); /* of the box about it at rest */
        assert_near(middle.x, 0.9, 1e-5);
        assert_near(middle.y, 0.3, 1e-5);
        assert_near(middle.z, 0.1 * i, 1e-5);
        scene_close((Scene *)scene);
        maker.arena = begun;
    }
}

TEST(what_hangs_below_and_what_is_named_moves_along) {
    static const char *const WITH[] = {"rim"};
    SceneChange change = turn(ANGLE, 0.1f, 0);
    change.with = WITH, change.with_count = 1;
    const Scene *scene = load(change);
    for (int corner = 0; corner < 3; corner++) {
        Vec3 p = corner_of(scene, "face", corner);
        assert_at(scene, "glass", corner, (double)p.x, (double)p.y, (double)p.z);
        assert_at(scene, "rim", corner, (double)p.x, (double)p.y, (double)p.z);
    }
    assert_at(scene, "desk", 1, 0, 0, 1);
    scene_close((Scene *)scene);
}

/* Of a surface that faces up the axes are the vehicle's. */
TEST(a_desk_is_tilted_as_the_vehicle_stands) {
    SceneChange change = turn(ANGLE, 0, 0);
    change.name = "desk";
    const Scene *scene = load(change);
    double c = cos((double)ANGLE), s = sin((double)ANGLE);
    assert_at(scene, "desk", 0, 0, 0.5 * -s, 0.5 - 0.5 * c); /* behind: as a face to +Z does */
    assert_at(scene, "desk", 1, 0, 0.5 * s, 0.5 + 0.5 * c);
    scene_close((Scene *)scene);
}

TEST(nodes_that_are_not_there_or_not_alone_are_refused) {
    static const char *const WITH[] = {"rimm"};
    SceneChange change = turn(ANGLE, 0, 0);
    change.name = "fase";
    assert_refused(change, "no node is named \"fase\" — did you mean face?");
    change.name = "twin";
    assert_refused(change, "2 nodes of");
    change.name = "empty";
    assert_refused(change, "has no surface to turn about");
    change.name = "face", change.with = WITH, change.with_count = 1;
    assert_refused(change, "is named \"rimm\" — did you mean rim?");
}

/* ---- hinges, and a mirrored scene -------------------------------------------------------- */

static SceneChange swing(float x, float y, float z, float angle) {
    return (SceneChange){
        .kind = CHANGE_NODES, .name = "face", .hinge = {.axis = {x, y, z}, .angle = angle}};
}

TEST(a_door_swings_about_its_hinge) {
    double c = cos((double)ANGLE), s = sin((double)ANGLE);
    SceneChange change = swing(0, 1, 0, ANGLE);
    change.hinge.through_m[0] = 2, change.hinge.through_m[1] = 7;
    const Scene *scene = load(change);
    assert_at(scene, "face", 0, 2 - 2 * c, 0, 2 * s); /* anticlockwise as seen from above */
    assert_at(scene, "face", 1, 2 - c, 0, s);
    assert_at(scene, "face", 2, 2 - 2 * c, 1, 2 * s);
    assert_at(scene, "rim", 1, 1, 0, 0);
    scene_close((Scene *)scene);
    change = swing(0, 0, -1, ANGLE); /* about the node's own origin */
    change.hinge.is_own = true;
    change.move_m[2] = 3;
    const Scene *own = load(change);
    assert_at(own, "face", 1, c, -s, 3);
    assert_at(own, "face", 2, s, c, 3);
    assert_at(own, "glass", 2, s, c, 3); /* what hangs below it */
    scene_close((Scene *)own);
}

TEST(what_has_no_surface_may_swing) {
    SceneChange change = swing(1, 0, 0, ANGLE);
    change.name = "empty";
    scene_close((Scene *)load(change));
}

/* The vehicle points along -Z, so that its plane is one of x. */
TEST(a_mirrored_scene_is_mirrored_at_its_middle) {
    SceneChange mirror = {.kind = CHANGE_MIRROR, .name = "", .middle_m = 0.25f};
    const Scene *scene = load(mirror);
    double x = -scene->origin[0]; /* of the world's, in the scene */
    assert_at(scene, "face", 0, x + 0.5, 0, 0);
    assert_at(scene, "face", 2, x - 0.5, 0, 0); /* its corners change places: the front stays */
    assert_at(scene, "face", 1, x + 0.5, 1, 0);
    assert_at(scene, "desk", 0, x + 0.5, 0, 0);
    Vec3 n = vec3_cross(vec3_sub(corner_of(scene, "face", 1), corner_of(scene, "face", 0)),
                        vec3_sub(corner_of(scene, "face", 2), corner_of(scene, "face", 0)));
    assert_near(n.z, 1, 1e-6);
    scene_close((Scene *)scene);
}

/* ---- materials --------------------------------------------------------------------------- */

static SceneChange patch(const char *text) {
    char *json = arena_format(&maker.arena, "%s", text);
    for (char *c = json; *c; c++)
        if (*c == '\'') *c = '"';
    return (SceneChange){.kind = CHANGE_MATERIAL, .name = "screen", .patch = json};
}

TEST(a_patch_merges_and_leaves_what_it_does_not_say) {
    const Scene *scene = load(patch("{'pbrMetallicRoughness':{'roughnessFactor':0.5}}"));
    assert_near(scene->materials[0].roughness, 0.5, 1e-7);
    assert_near(scene->materials[0].metallic, 0, 1e-7);
    assert_non_null(scene->materials[0].coating);
    scene_close((Scene *)scene);
}

TEST(null_takes_away_and_new_extensions_are_used) {
    const Scene *bare = load(patch("{'extensions':{'PARHELION_coating':null}}"));
    assert_null(bare->materials[0].coating);
    scene_close((Scene *)bare);
    SceneChange change = patch("{'extensions':{'KHR_materials_ior':{'ior':1.7}}}");
    change.file = "r.json", change.place = "/variants/v";
    Found found = survey(&change, 1);
    assert_near(found.scene->materials[0].ior, 1.7, 1e-6);
    for (int i = 0; i < found.problems.count; i++)
        assert_null(strstr(found.problems.list[i].message, "not listed"));
    scene_close(found.scene);
}

/* What is merged is checked as the file's own. */
TEST(a_patch_that_is_wrong_is_refused_at_its_place) {
    static const struct {
        const char *patch, *place, *text;
    } WRONG[] = {
        {"{'pbrMetallicRoughness':{'roughnessFactor':2}}",
         "/materials/0/pbrMetallicRoughness/roughnessFactor", "is 2, a number from 0 to 1"},
        {"{'pbrMetallicRoughness':7}", "/materials/0/pbrMetallicRoughness", "is 7, an object"},
        {"{'extensions':{'PARHELION_coating':{'stack':'nothing'}}}",
         "/materials/0/extensions/PARHELION_coating/stack", "nothing"},
        {"{'extensions':{'PARHELION_coating':{'layers':[]}}}",
         "/materials/0/extensions/PARHELION_coating/stack", "stands beside \"layers\""},
        {"{'doubleSided':'yes'}", "/materials/0/doubleSided", "is \"yes\""}};
    for (int i = 0; i < COUNT_OF(WRONG); i++) {
        SceneChange change = patch(WRONG[i].patch);
        Found found = survey(&change, 1);
        if (!maker_find(&found, WRONG[i].place, WRONG[i].text))
            fail_msg("nothing at %s says \"%s\"", WRONG[i].place, WRONG[i].text);
        scene_close(found.scene);
    }
    assert_refused(patch("{'a':"), "not valid JSON");
    SceneChange other = patch("{}");
    other.name = "scren";
    assert_refused(other, "no material is named \"scren\" — did you mean screen?");
}

/* ---- hoods ------------------------------------------------------------------------------- */

#define THICK 0.002
#define GAP 0.002
#define DEPTH 0.05

static double volume_of(const Scene *scene, const Part *part) {
    double sum = 0;
    for (uint32_t t = 0; t < part->triangle_count; t++) {
        uint32_t at = part->first_triangle + t;
        Vec3 cross = vec3_cross(scene_corner(scene, at, 1), scene_corner(scene, at, 2));
        sum += (double)vec3_dot(scene_corner(scene, at, 0), cross) / 6;
    }
    return sum;
}

/* A closed body whose triangles face outside has its volume: of a plate, and of two cheeks that
 * narrow to the plate's thickness. */
TEST(a_hood_is_a_plate_and_two_cheeks) {
    SceneChange change = {.kind = CHANGE_HOOD, .name = "screen", .depth_m = DEPTH};
    const Scene *scene = load(change);
    double plate = (1 + 2 * (GAP + THICK)) * THICK * DEPTH;
    double cheek = (1 + GAP) * THICK * 0.5 * (DEPTH + THICK), wanted[3] = {plate, cheek, cheek};
    int count = 0;
    for (int i = 0; i < scene->part_count; i++) {
        const Part *part = &scene->parts[i];
        if (strcmp(part->node_name, "hood") != 0) continue;
        assert_int_equal(part->triangle_count, 12);
        assert_in_range(count, 0, 2);
        assert_close(volume_of(scene, part), wanted[count++], 1e-2);
        for (uint32_t t = 0; t < 12; t++)
            for (int c = 0; c < 3; c++) {
                Vec3 p = scene_corner(scene, part->first_triangle + t, c);
                assert_true((double)p.z > -1e-6 && (double)p.z < DEPTH + 1e-6);
                assert_true(p.y > 1 || p.x < 0 || p.x > 1); /* beside the display */
            }
        const Material *m = &scene->materials[part->material_id];
        assert_near(m->base_color[1], 0.04, 1e-6);
        assert_int_equal(m->display_id, NO_ID);
    }
    assert_int_equal(count, 3);
    scene_close((Scene *)scene);
}

TEST(a_hood_needs_an_upper_edge) {
    assert_refused((SceneChange){.kind = CHANGE_HOOD, .name = "lying", .depth_m = DEPTH},
                   "lies flat");
    assert_refused((SceneChange){.kind = CHANGE_HOOD, .name = "both", .depth_m = DEPTH},
                   "faces nowhere");
    assert_refused((SceneChange){.kind = CHANGE_HOOD, .name = "skreen", .depth_m = DEPTH},
                   "no display is named \"skreen\" — did you mean screen?");
}

TEST_PROGRAM(maker_start, maker_end)
