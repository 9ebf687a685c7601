/* SPDX-License-Identifier: Apache-2.0 */
/* The laws of src/scene: shapes, transforms and materials come out as glTF says. */
#include "check.h"
#include "gltf_maker.h"

/* One triangle (0,0,0) (1,0,0) (0,1,0) facing +z, and its nodes. */
static const float TRIANGLE[9] = {0, 0, 0, 1, 0, 0, 0, 1, 0};

#define MESH MESH_OF("'POSITION':0")
#define NODE "'scene':0," ONE_NODE

static Scene *load_triangle(const char *more) {
    return maker_load(
        TRIANGLE, sizeof TRIANGLE,
        maker_format("'bufferViews':[" VIEW0(36) "],'accessors':[" FLOATS(0, 3, "VEC3") "],%s",
                     more));
}

static Tangent tangent(const Scene *scene, uint32_t triangle, int c) {
    return scene_part(scene, triangle)->tangents[scene_corner_place(scene, triangle, c)];
}

/* Of the side from which the corners run counter-clockwise. */
static Vec3 front(const Scene *scene, uint32_t triangle) {
    Vec3 a = scene_corner(scene, triangle, 0);
    return vec3_normalize(vec3_cross(vec3_sub(scene_corner(scene, triangle, 1), a),
                                     vec3_sub(scene_corner(scene, triangle, 2), a)));
}

/* A flat part has no normals of its own. */
static Vec3 normal(const Scene *scene, uint32_t triangle, int c) {
    const Part *part = scene_part(scene, triangle);
    return part->normals ? part->normals[scene_corner_place(scene, triangle, c)]
                         : front(scene, triangle);
}

static void assert_vec3(Vec3 found, float x, float y, float z) {
    assert_near(found.x, x, 1e-5);
    assert_near(found.y, y, 1e-5);
    assert_near(found.z, z, 1e-5);
}

/* ---- accessors ------------------------------------------------------------------------- */

/* Puts value (an integer code, or the float itself) at bytes; returns its size. */
static size_t put(unsigned char *bytes, int type, double value) {
    float f = (float)value;
    uint32_t bits = (uint32_t)(int32_t)value;
    size_t size = type < 5122 ? 1 : type < 5124 ? 2 : 4;
    if (type == 5126) memcpy(&bits, &f, 4);
    for (size_t i = 0; i < size; i++) bytes[i] = (unsigned char)(bits >> 8 * i);
    return size;
}

static double normalised(int type, double code) {
    static const double GREATEST[] = {127, 255, 32767, 65535};
    double value = code / GREATEST[type - 5120];
    return value < -1 ? -1 : value;
}

/* A triangle of integer codes in a view with stride 8 or 12, as POSITION. */
static void check_component(int type, bool is_normalized) {
    static const double CODES[3][3] = {{0, 3, 1}, {120, 2, 7}, {5, 127, 90}};
    unsigned char bytes[36] = {0};
    int stride = type == 5126 ? 12 : 8;
    double sign = type == 5120 || type == 5122 ? -1 : 1; /* signed types show it */
    for (int v = 0; v < 3; v++)
        for (int c = 0; c < 3; c++) {
            size_t size = type < 5122 ? 1 : type < 5124 ? 2 : 4;
            put(bytes + v * stride + (int)size * c, type, sign * CODES[v][c]);
        }
    Scene *scene = maker_load(
        bytes, (size_t)(3 * stride),
        maker_format(
            "'extensionsUsed':['KHR_mesh_quantization'],"
            "'extensionsRequired':['KHR_mesh_quantization'],"
            "'bufferViews':[{'buffer':0,'byteLength':%d,'byteStride':%d}],"
            "'accessors':[{'bufferView':0,'componentType':%d,'count':3,'type':'VEC3'%s}]," MESH
                NODE,
            3 * stride, stride, type, is_normalized ? ",'normalized':true" : ""));
    assert_int_equal(scene->triangle_count, 1);
    for (int v = 0; v < 3; v++) {
        Vec3 at = scene_corner(scene, 0, v);
        const float p[3] = {at.x, at.y, at.z};
        for (int c = 0; c < 3; c++) {
            double code = sign * CODES[v][c];
            assert_near(p[c], is_normalized ? normalised(type, code) : code, 1e-6);
        }
    }
}

TEST_WITH(every_component_type_keeps_its_values, maker_reset, NULL) {
    for (int type = 5120; type <= 5123; type++) {
        check_component(type, false);
        check_component(type, true);
    }
    check_component(5126, false);
}

TEST_WITH(the_smallest_signed_code_is_minus_one, maker_reset, NULL) {
    static const signed char BYTES[12] = {-128, 0, 0, 0, 127, 0, 0, 0, 0, 127, 0, 0};
    Scene *scene =
        maker_load(BYTES, sizeof BYTES,
                   "'extensionsUsed':['KHR_mesh_quantization'],"
                   "'extensionsRequired':['KHR_mesh_quantization'],"
                   "'bufferViews':[{'buffer':0,'byteLength':12,'byteStride':4}],"
                   "'accessors':[{'bufferView':0,'componentType':5120,'count':3,'type':'VEC3',"
                   "'normalized':true}]," MESH NODE);
    assert_vec3(scene_corner(scene, 0, 0), -1, 0, 0);
    assert_vec3(scene_corner(scene, 0, 1), 1, 0, 0);
}

/* Vertex 1 of the triangle is replaced, once over bytes and once over zeros. */
TEST_WITH(sparse_values_replace_the_base, maker_reset, NULL) {
    struct {
        float base[9];
        uint16_t index[2];
        float value[3];
    } data = {{0, 0, 0, 9, 9, 9, 0, 1, 0}, {1, 0}, {1, 0, 0}};
    Scene *scene = maker_load(
        &data, sizeof data,
        "'bufferViews':[" VIEW0(36) "," VIEW(36, 2) "," VIEW(
            40, 12) "],"
                    "'accessors':[{'bufferView':0,'componentType':5126,'count':3,'type':'VEC3',"
                    "'sparse':{'count':1,'indices':{'bufferView':1,'componentType':5123},"
                    "'values':{'bufferView':2}}}]," MESH NODE);
    assert_vec3(scene_corner(scene, 0, 1), 1, 0, 0);
    struct {
        uint8_t index[4];
        float value[6];
    } over_zeros = {{1, 2}, {2, 0, 0, 0, 3, 0}};
    scene = maker_load(
        &over_zeros, sizeof over_zeros,
        "'bufferViews':[" VIEW0(2) "," VIEW(
            4, 24) "],'accessors':[{'componentType':5126,"
                   "'count':3,'type':'VEC3','sparse':{'count':2,'indices':{'bufferView':0,"
                   "'componentType':5121},'values':{'bufferView':1}}}]," MESH NODE);
    assert_vec3(scene_corner(scene, 0, 0), 0, 0, 0);
    assert_vec3(scene_corner(scene, 0, 1), 2, 0, 0);
    assert_vec3(scene_corner(scene, 0, 2), 0, 3, 0);
}

/* ---- strips and fans ------------------------------------------------------------------- */

/* Loads five points of a zigzag or fan with these indices and mode. */
static Scene *load_mode(const uint8_t *indices, int count, int mode, const float *points) {
    struct {
        float points[15];
        uint8_t indices[12];
    } data = {0};
    memcpy(data.points, points, sizeof data.points);
    memcpy(data.indices, indices, (size_t)count);
    return maker_load(
        &data, sizeof data,
        maker_format(
            "'bufferViews':[" VIEW0(60) "," VIEW(60, 12) "],'accessors':[" FLOATS(
                0, 5,
                "VEC3") ",{'bufferView':1,'componentType':5121,'count':%d,'type':'SCALAR'}],"
                        "'meshes':[{'primitives':[{'attributes':{'POSITION':0},'indices':1,'mode':%d}]}]," NODE,
            count, mode));
}

static bool has_triangle(const Scene *scene, Vec3 a, Vec3 b, Vec3 c) {
    const Vec3 wanted[3] = {a, b, c};
    for (uint32_t t = 0; t < scene->triangle_count; t++)
        for (int turn = 0; turn < 3; turn++) {
            bool is_same = true;
            for (int i = 0; i < 3; i++)
                is_same &=
                    vec3_length(vec3_sub(scene_corner(scene, t, (i + turn) % 3), wanted[i])) == 0;
            if (is_same) return true;
        }
    return false;
}

/* The same triangles, each turning the same way. */
static void assert_same_triangles(const Scene *a, const Scene *b) {
    assert_int_equal(a->triangle_count, b->triangle_count);
    for (uint32_t t = 0; t < a->triangle_count; t++)
        assert_true(
            has_triangle(b, scene_corner(a, t, 0), scene_corner(a, t, 1), scene_corner(a, t, 2)));
}

TEST_WITH(strips_and_fans_are_their_triangles, maker_reset, NULL) {
    static const float ZIGZAG[15] = {0, 0, 0, 1, 0, 0, 0, 1, 0, 1, 1, 0, 0, 2, 0};
    static const uint8_t ORDER[5] = {0, 1, 2, 3, 4};
    static const uint8_t STRIP[9] = {0, 1, 2, 2, 1, 3, 2, 3, 4};
    assert_same_triangles(load_mode(STRIP, 9, 4, ZIGZAG), load_mode(ORDER, 5, 5, ZIGZAG));
    static const float PIE[15] = {0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0, -1, 1, 0};
    static const uint8_t FAN[9] = {0, 1, 2, 0, 2, 3, 0, 3, 4};
    assert_same_triangles(load_mode(FAN, 9, 4, PIE), load_mode(ORDER, 5, 6, PIE));
}

/* ---- nodes ----------------------------------------------------------------------------- */

TEST_WITH(nodes_move_their_meshes, maker_reset, NULL) {
    Scene *scene = load_triangle(
        MESH "'scenes':[{'nodes':[0]}],'nodes':[{'children':[1],"
             "'translation':[10,0,0]},{'mesh':0,'rotation':[0,0,0.70710678,0.70710678],"
             "'scale':[2,3,1],'translation':[0,5,0]}]");
    assert_vec3(scene_corner(scene, 0, 0), 10, 5, 0);
    assert_vec3(scene_corner(scene, 0, 1), 10, 7, 0); /* x turned to y, doubled */
    assert_vec3(scene_corner(scene, 0, 2), 7, 5, 0);  /* y turned to -x, tripled */
    assert_vec3(normal(scene, 0, 0), 0, 0, 1);
}

TEST_WITH(a_matrix_says_the_same_as_its_parts, maker_reset, NULL) {
    Scene *parts = load_triangle(
        MESH "'scenes':[{'nodes':[0]}],'nodes':[{'mesh':0,"
             "'rotation':[0,0,0.70710678,0.70710678],'scale':[2,3,1],'translation':[1,2,3]}]");
    Scene *matrix = load_triangle(MESH "'scenes':[{'nodes':[0]}],'nodes':[{'mesh':0,"
                                       "'matrix':[0,2,0,0,-3,0,0,0,0,0,1,0,1,2,3,1]}]");
    for (int c = 0; c < 3; c++) {
        Vec3 p = scene_corner(matrix, 0, c);
        assert_vec3(scene_corner(parts, 0, c), p.x, p.y, p.z);
    }
}

/* Mirrored by one axis or by three, the front stays where the shape has it. */
TEST_WITH(mirroring_keeps_the_front_outside, maker_reset, NULL) {
    struct {
        float points[9], normals[9];
    } data = {{0, 0, 0, 1, 0, 0, 0, 1, 0}, {0, 0, 1, 0, 0, 1, 0, 0, 1}};
    static const char *const SCALES[] = {"[-1,1,1]", "[1,1,-1]", "[-2,-2,-2]", "[-1,-1,1]"};
    static const float FACING[] = {1, -1, -1, 1};
    for (int with_normals = 0; with_normals < 2; with_normals++)
        for (int i = 0; i < 4; i++) {
            Scene *scene = maker_load(
                &data, sizeof data,
                maker_format(
                    "'bufferViews':[" VIEW0(36) "," VIEW(36, 36) "],'accessors':[" FLOATS(
                        0, 3,
                        "VEC3") "," FLOATS(1, 3,
                                           "VEC3") "],"
                                                   "'meshes':[{'primitives':[{'attributes':{'POSITION':0%s}}]}],"
                                                   "'scenes':[{'nodes':[0]}],'nodes':[{'mesh':0,'scale':%s}]",
                    with_normals ? ",'NORMAL':1" : "", SCALES[i]));
            assert_vec3(front(scene, 0), 0, 0, FACING[i]);
            assert_vec3(normal(scene, 0, 0), 0, 0, FACING[i]);
        }
}

TEST_WITH(hidden_nodes_are_left_out, maker_reset, NULL) {
    Scene *scene = load_triangle(
        MESH "'extensionsUsed':['KHR_node_visibility'],"
             "'scenes':[{'nodes':[0]}],'nodes':[{'children':[1],'mesh':0},{'mesh':0,'extensions':"
             "{'KHR_node_visibility':{'visible':false}},'children':[2]},{'mesh':0}]");
    assert_int_equal(scene->part_count, 1);
}

TEST_WITH(cameras_come_in_the_order_of_their_nodes, maker_reset, NULL) {
    Scene *scene = maker_load(
        NULL, 0,
        "'cameras':[{'type':'orthographic','orthographic':{'xmag':2,'ymag':1,'znear':0,'zfar':"
        "9}},"
        "{'type':'perspective','name':'lens','perspective':{'yfov':0.5,'znear':0.1,"
        "'aspectRatio':1.5}}],'scenes':[{'nodes':[1,0]}],'nodes':[{'camera':0},{'camera':1,"
        "'name':'eye','translation':[1,2,3],'scale':[4,4,4]}]");
    assert_int_equal(scene->camera_count, 2);
    const SceneCamera *eye = &scene->cameras[0], *flat = &scene->cameras[1];
    assert_true(eye->is_perspective);
    assert_string_equal(eye->node_name, "eye");
    assert_string_equal(eye->camera_name, "lens");
    assert_close(eye->yfov, 0.5, 1e-6);
    assert_close(eye->aspect, 1.5, 1e-6);
    assert_true(isinf(eye->zfar));
    assert_vec3(eye->world_from_camera.origin, 1, 2, 3);
    assert_vec3(eye->world_from_camera.z, 0, 0, 1);
    assert_false(flat->is_perspective);
    assert_close(flat->ymag, 1, 1e-6);
    assert_close(flat->aspect, 2, 1e-6);
}

/* ---- skins and morph targets ----------------------------------------------------------- */

TEST_WITH(morph_weights_of_the_node_win, maker_reset, NULL) {
    struct {
        float points[9], change[9];
    } data = {{0, 0, 0, 1, 0, 0, 0, 1, 0}, {0, 0, 1, 0, 0, 2, 0, 0, 4}};
    static const char HEAD[] =
        "'bufferViews':[" VIEW0(36) "," VIEW(36, 36) "],'accessors':[" FLOATS(0, 3, "VEC3") "," FLOATS(
            1, 3,
            "VEC3") "],'meshes':[{'weights':[0.5],"
                    "'primitives':[{'attributes':{'POSITION':0},'targets':[{'POSITION':1}]}]}],"
                    "'scenes':[{'nodes':[0]}],'nodes':[{'mesh':0%s}]";
    static const struct {
        const char *weights;
        float factor;
    } CASES[] = {{"", 0.5f}, {",'weights':[2]", 2}, {",'weights':[0]", 0}};
    for (int i = 0; i < 3; i++) {
        Scene *scene = maker_load(&data, sizeof data, maker_format(HEAD, CASES[i].weights));
        assert_vec3(scene_corner(scene, 0, 2), 0, 1, 4 * CASES[i].factor);
    }
}

/* Vertex 0 follows joint A, 1 joint B, 2 half each; the mesh's own node does not matter. */
TEST_WITH(skinned_vertices_follow_their_joints, maker_reset, NULL) {
    struct {
        float points[9];
        uint8_t joints[12];
        float weights[12];
    } data = {{0, 0, 0, 1, 0, 0, 0, 1, 0},
              {0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0},
              {1, 0, 0, 0, 1, 0, 0, 0, 0.5f, 0.5f, 0, 0}};
    Scene *scene = maker_load(
        &data, sizeof data,
        "'bufferViews':[" VIEW0(36) "," VIEW(36, 12) "," VIEW(48, 48) "],'accessors':[" FLOATS(0, 3, "VEC3") ",{'bufferView':1,'componentType':5121,'count':3,'type':'VEC4'}," FLOATS(
            2, 3,
            "VEC4") "]," MESH_OF("'POSITION':0,'JOINTS_0':1,'WEIGHTS_0':2") "'skins':[{'joints':[1,2]}],'scenes':[{'nodes':[0,1]}],'nodes':[{'mesh':0,'skin':0,"
                                                                            "'translation':[100,0,0]},{'translation':[0,0,1],'children':[2]},{'translation':[0,0,"
                                                                            "4]}]");
    assert_vec3(scene_corner(scene, 0, 0), 0, 0, 1);
    assert_vec3(scene_corner(scene, 0, 1), 1, 0, 5);
    assert_vec3(scene_corner(scene, 0, 2), 0, 1, 3);
}

/* ---- colours, coordinates, tangents
 * ---------------------------------------------------------- */

TEST_WITH(vertex_colours_of_every_format_agree, maker_reset, NULL) {
    static const int TYPES[] = {5121, 5123, 5126};
    for (int t = 0; t < 3; t++)
        for (int components = 3; components <= 4; components++) {
            unsigned char bytes[36 + 48] = {0};
            memcpy(bytes, TRIANGLE, 36);
            int stride = TYPES[t] == 5121 ? 4 : TYPES[t] == 5123 ? 8 : 16;
            double whole = TYPES[t] == 5121 ? 255 : TYPES[t] == 5123 ? 65535 : 1;
            for (int v = 0; v < 3; v++)
                for (int c = 0; c < components; c++)
                    put(bytes + 36 + v * stride + c * stride / 4, TYPES[t],
                        c == 3   ? whole / 5
                        : c == v ? whole
                                 : 0);
            Scene *scene = maker_load(
                bytes, sizeof bytes,
                maker_format(
                    "'bufferViews':[" VIEW0(
                        36) ",{'buffer':0,'byteOffset':36,"
                            "'byteLength':48,'byteStride':%d}],'accessors':[" FLOATS(
                                0, 3,
                                "VEC3") ",{'bufferView':1,'componentType':%d,'count':3,'type':'VEC%d'%s}]," MESH_OF("'POSITION':0,'COLOR_0':1")
                                NODE,
                    stride, TYPES[t], components, TYPES[t] == 5126 ? "" : ",'normalized':true"));
            for (int v = 0; v < 3; v++) {
                const Part *part = scene_part(scene, 0);
                const uint16_t *color = part->colors[scene_corner_place(scene, 0, v)].linear;
                for (int c = 0; c < 3; c++) assert_int_equal(color[c], c == v ? 65535 : 0);
                assert_int_equal(color[3], components == 4 ? 13107 : 65535);
            }
        }
}

/* u runs right and v down on a triangle that faces +z, or u runs left when mirrored. */
static Scene *load_with_normal_map(bool is_mirrored) {
    struct {
        float points[9], uv[6];
    } data = {{0, 0, 0, 1, 0, 0, 0, 1, 0}, {0, 1, 1, 1, 0, 0}};
    for (int i = 0; i < 6; i += 2)
        if (is_mirrored) data.uv[i] = 1 - data.uv[i];
    return maker_load(
        &data, sizeof data,
        PICTURE
        "'bufferViews':[" VIEW0(36) "," VIEW(36, 24) "],'accessors':[" FLOATS(0, 3, "VEC3") "," FLOATS(
            1, 3,
            "VEC2") "],"
                    "'materials':[{'normalTexture':{'index':0}}],'meshes':[{'primitives':[{'material':0,"
                    "'attributes':{'POSITION':0,'TEXCOORD_0':1}}]}]," NODE);
}

/* Flat triangles share their corners and store no normals, unless a normal map needs a frame
 * of each one's own. What the file lacks or nobody requests is not there. */
TEST_WITH(what_a_hit_does_not_need_is_not_kept, maker_reset, NULL) {
    struct {
        float points[12], normals[12], tangents[16], uv[8];
        uint8_t indices[8];
    } data = {.points = {0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 1},
              .normals = {0, 0, 1, 0, 0, 1, 0, 0, 1, 0, 0, 1},
              .tangents = {1, 0, 0, 1, 1, 0, 0, 1, 1, 0, 0, 1, 1, 0, 0, 1},
              .uv = {0, 1, 1, 1, 1, 0, 0, 0},
              .indices = {0, 1, 2, 0, 2, 3}};
    static const char *const ATTRIBUTES[] = {
        "", ",'NORMAL':2,'TANGENT':3,'TEXCOORD_0':4,'TEXCOORD_1':4"};
    for (int k = 0; k < 4; k++) {
        bool has_all = k % 2, is_mapped = k / 2;
        Scene *scene = maker_load(
            &data, sizeof data,
            maker_format(
                PICTURE
                "'bufferViews':[" VIEW0(48) "," VIEW(48, 48) "," VIEW(96, 64) "," VIEW(160, 32) "," VIEW(192, 8) "],'accessors':[" FLOATS(
                    0, 4,
                    "VEC3") ","
                            "{'bufferView':4,'componentType':5121,'count':6,'type':'SCALAR'}," FLOATS(
                                1, 4,
                                "VEC3") "," FLOATS(2, 4,
                                                   "VEC4") "," FLOATS(3, 4,
                                                                      "VEC2") "],"
                                                                              "'materials':[{%s}],'meshes':[{'primitives':[{'material':0,'indices':1,"
                                                                              "'attributes':{'POSITION':0%s}}]}]," NODE,
                is_mapped ? "'normalTexture':{'index':0}" : "", ATTRIBUTES[has_all]));
        const Part *part = &scene->parts[0];
        assert_int_equal(scene->vertex_count, is_mapped && !has_all ? 6 : 4);
        assert_int_equal(part->normals != NULL, is_mapped || has_all);
        assert_int_equal(part->tangents != NULL, is_mapped);
        assert_int_equal(part->uv[0] != NULL, has_all);
        assert_null(part->uv[1]);
        assert_null(part->colors);
    }
}

/* right x up = normal, where up is the picture's. */
TEST_WITH(tangents_point_to_the_pictures_right, maker_reset, NULL) {
    for (int is_mirrored = 0; is_mirrored < 2; is_mirrored++) {
        Scene *scene = load_with_normal_map(is_mirrored);
        for (int c = 0; c < 3; c++) {
            Tangent t = tangent(scene, 0, c);
            assert_vec3(t.along, is_mirrored ? -1.0f : 1.0f, 0, 0);
            Vec3 up = vec3_scale(vec3_cross(normal(scene, 0, c), t.along), t.side);
            assert_vec3(up, 0, 1, 0);
        }
    }
}

/* Along an edge where the picture folds back, either side keeps its own tangent. */
TEST_WITH(a_mirrored_seam_splits_its_vertices, maker_reset, NULL) {
    struct {
        float points[12], normals[12], uv[8];
        uint8_t indices[8];
    } data = {{0, 0, 0, 1, 0, 0, 1, 1, 0, 2, 0, 0},
              {0, 0, 1, 0, 0, 1, 0, 0, 1, 0, 0, 1},
              {0, 1, 1, 1, 1, 0, 0, 1}, /* the last corner mirrors the first */
              {0, 1, 2, 1, 3, 2}};
    Scene *scene = maker_load(
        &data, sizeof data,
        PICTURE
        "'bufferViews':[" VIEW0(48) "," VIEW(48, 48) "," VIEW(96, 32) "," VIEW(128, 8) "],'accessors':[" FLOATS(
            0, 4,
            "VEC3") "," FLOATS(1, 4,
                               "VEC3") "," FLOATS(2, 4,
                                                  "VEC2") ",{'bufferView':3,'componentType':5121,'count':6,"
                                                          "'type':'SCALAR'}],'materials':[{'normalTexture':{'index':0}}],"
                                                          "'meshes':[{'primitives':[{'material':0,'indices':3,'attributes':{'POSITION':0,"
                                                          "'NORMAL':1,'TEXCOORD_0':2}}]}]," NODE);
    assert_int_equal(scene->vertex_count, 6);
    for (int c = 0; c < 3; c++) {
        Tangent left = tangent(scene, 0, c), right = tangent(scene, 1, c);
        assert_near(left.along.x, 1, 1e-6);
        assert_near(left.side, 1, 0);
        assert_near(right.along.x, -1, 1e-6);
        assert_near(right.side, -1, 0);
    }
}

static const float *slot_matrix(const char *transform) {
    Scene *scene =
        maker_load(NULL, 0,
                   maker_format("'extensionsUsed':['KHR_texture_transform']," PICTURE
                                "'materials':[{'emissiveTexture':{'index':0,'texCoord':1%s}}]",
                                transform));
    return scene->materials[0].emissive_texture.uv_from_uv;
}

static void assert_maps(const float *m, float u, float v, float to_u, float to_v) {
    assert_near(m[0] * u + m[1] * v + m[2], to_u, 1e-6);
    assert_near(m[3] * u + m[4] * v + m[5], to_v, 1e-6);
}

TEST_WITH(texture_transforms_scale_turn_and_shift, maker_reset, NULL) {
    const float *m = slot_matrix("");
    assert_maps(m, 0.25f, 0.75f, 0.25f, 0.75f);
    m = slot_matrix(",'extensions':{'KHR_texture_transform':{'offset':[0.5,0.25],'scale':[2,3]}}");
    assert_maps(m, 1, 1, 2.5f, 3.25f);
    /* Counter-clockwise as one sees it, with v running down: right turns to up. */
    m = slot_matrix(",'extensions':{'KHR_texture_transform':{'rotation':1.5707963267948966}}");
    assert_maps(m, 1, 0, 0, -1);
    assert_maps(m, 0, 1, 1, 0);
    m = slot_matrix(",'extensions':{'KHR_texture_transform':{'rotation':1.5707963267948966,"
                    "'scale':[2,1],'offset':[0.1,0.2]}}");
    assert_maps(m, 1, 0, 0.1f, -1.8f);
}

TEST_WITH(two_uv_sets_of_any_number_are_carried, maker_reset, NULL) {
    struct {
        float points[9], uv[3][6];
    } data = {{0, 0, 0, 1, 0, 0, 0, 1, 0}, {{0}, {1, 1, 1, 1, 1, 1}, {2, 2, 2, 2, 2, 2}}};
    Scene *scene = maker_load(
        &data, sizeof data,
        PICTURE
        "'bufferViews':[" VIEW0(36) "," VIEW(36, 24) "," VIEW(60, 24) "," VIEW(84, 24) "],'accessors':[" FLOATS(
            0, 3,
            "VEC3") "," FLOATS(1, 3,
                               "VEC2") "," FLOATS(2, 3,
                                                  "VEC2") "," FLOATS(3, 3,
                                                                     "VEC2") "],"
                                                                             "'materials':[{'emissiveTexture':{'index':0,'texCoord':2},"
                                                                             "'pbrMetallicRoughness':{'baseColorTexture':{'index':0,'texCoord':1}}}],"
                                                                             "'meshes':[{'primitives':[{'material':0,'attributes':{'POSITION':0,'TEXCOORD_0':1,"
                                                                             "'TEXCOORD_1':2,'TEXCOORD_2':3}}]}]," NODE);
    const Material *m = &scene->materials[0];
    assert_near(scene_corner_uv(scene, 0, 0, m->base_color_texture.uv_set).x, 1, 0);
    assert_near(scene_corner_uv(scene, 0, 0, m->emissive_texture.uv_set).x, 2, 0);
}

TEST_PROGRAM(maker_start, maker_end)
