/* SPDX-License-Identifier: Apache-2.0 */
/* What large scenes rely on: no array is kept twice, numbers are the same however they are
 * stored, long reading is reported, and threads do not change what is found. */
#include "fixture.h"
#include "gltf_maker.h"
#include "scene_builder.h"

#include "bvh/bvh.h"
#include "path/light_selection.h"

/* ---- memory ------------------------------------------------------------------------------ */

typedef struct Ribbon {
    float position[3], normal[3];
} Ribbon;

/* A band of `squares`, with normals; its file. */
static const char *ribbon_file(uint32_t squares) {
    uint32_t vertices = 2 * (squares + 1), corners = 6 * squares;
    size_t head = sizeof(Ribbon) * vertices, size = head + 4 * (size_t)corners;
    char *bytes = ARENA_NEW(&maker.arena, char, size);
    Ribbon *vertex = (Ribbon *)(void *)bytes;
    uint32_t *index = (uint32_t *)(void *)(bytes + head);
    for (uint32_t i = 0; i < vertices; i++)
        vertex[i] = (Ribbon){{(float)(i / 2), (float)(i % 2), 0}, {0, 0, 1}};
    for (uint32_t i = 0; i < squares; i++) {
        const uint32_t corner[6] = {0, 2, 3, 0, 3, 1};
        for (int c = 0; c < 6; c++) *index++ = 2 * i + corner[c];
    }
    const char *members = arena_format(
        &maker.arena,
        "'bufferViews':[{'buffer':0,'byteLength':%zu,'byteStride':24},"
        "{'buffer':0,'byteOffset':%zu,'byteLength':%zu}],"
        "'accessors':[{'bufferView':0,'componentType':5126,'type':'VEC3','count':%u,"
        "'min':[0,0,0],'max':[%u,1,0]},"
        "{'bufferView':0,'byteOffset':12,'componentType':5126,'type':'VEC3','count':%u},"
        "{'bufferView':1,'componentType':5125,'type':'SCALAR','count':%u}],"
        "'meshes':[{'primitives':[{'attributes':{'POSITION':0,'NORMAL':1},'indices':2}]}],"
        "'nodes':[{'mesh':0}],'scenes':[{'nodes':[0]}]",
        head, head, size - head, vertices, squares, vertices, corners);
    return maker_gltf(bytes, size, members);
}

/* Bytes that the scene of such a band keeps. */
static double kept_bytes(uint32_t squares) {
    const char *path = ribbon_file(squares);
    const char *before = maker.arena.next;
    Found found = maker_survey_file(path);
    assert_int_equal(found.problems.error_count, 0);
    assert_int_equal(found.scene->triangle_count, 2 * squares);
    assert_int_equal(found.scene->vertex_count, 2 * (squares + 1));
    return (double)(maker.arena.next - before);
}

/* A triangle has three indices and its part, a vertex its place and its normal: nothing else
 * that grows with them stays, so one array that is kept twice would show. */
TEST_WITH(a_scene_keeps_no_array_twice, maker_reset, NULL) {
    double few = kept_bytes(1000), many = kept_bytes(21000);
    double triangles = 40000, vertices = 40000;
    assert_true(fabs(many - few - 16 * triangles - 24 * vertices) < 512);
}

/* ---- numbers ----------------------------------------------------------------------------- */

/* A square whose indices have this type, beside or among its normals. */
static Scene *square(int index_type, bool is_interleaved) {
    static const float PLACE[4][3] = {{0, 0, 0}, {1, 0, 0}, {1, 1, -0.0f}, {0, 1, 0.3f}};
    static const uint8_t CORNER[6] = {0, 1, 2, 0, 2, 3};
    unsigned char bytes[4 * 24 + 6 * 4] = {0};
    int width = index_type == 5121 ? 1 : index_type == 5123 ? 2 : 4;
    size_t step = is_interleaved ? 24 : 12, normals = is_interleaved ? 12 : 48;
    const float up[3] = {0, 0, 1};
    for (size_t i = 0; i < 4; i++) {
        memcpy(bytes + i * step, PLACE[i], 12);
        memcpy(bytes + normals + i * step, up, 12);
    }
    for (size_t i = 0; i < 6; i++) bytes[96 + i * (size_t)width] = CORNER[i];
    const char *stride = is_interleaved ? ",'byteStride':24" : "";
    const char *members = arena_format(
        &maker.arena,
        "'bufferViews':[{'buffer':0,'byteLength':%d%s},{'buffer':0,'byteOffset':%zu,"
        "'byteLength':%d%s},{'buffer':0,'byteOffset':96,'byteLength':%d}],'accessors':[" FLOATS(
            0, 4,
            "VEC3") "," FLOATS(1, 4,
                               "VEC3") ",{'bufferView':2,'componentType':%d,"
                                       "'type':'SCALAR','count':6}],'meshes':[{'primitives':[{'attributes':{'POSITION':0,"
                                       "'NORMAL':1},'indices':2}]}],'nodes':[{'mesh':0}],'scenes':[{'nodes':[0]}]",
        is_interleaved ? 96 : 48, stride, normals, is_interleaved ? 84 : 48, stride, 6 * width,
        index_type);
    return maker_load(bytes, sizeof bytes, members);
}

TEST_WITH(numbers_are_the_same_however_they_are_stored, maker_reset, NULL) {
    const Scene *first = square(5125, false);
    assert_int_equal(first->triangle_count, 2);
    assert_true(first->positions[3].z == 0.3f);
    for (int type = 5121; type <= 5125; type += 2)
        for (int way = 0; way < 2; way++) {
            const Scene *scene = square(type, way == 1);
            assert_int_equal(scene->vertex_count, 4);
            assert_memory_equal(scene->positions, first->positions, 4 * sizeof(Vec3));
            assert_memory_equal(scene->parts[0].normals, first->parts[0].normals, 4 * sizeof(Vec3));
            assert_memory_equal(scene->triangles, first->triangles, 2 * sizeof(Triangle));
        }
}

/* ---- progress ---------------------------------------------------------------------------- */

typedef struct BytesTold {
    size_t last, size;
    int count;
} BytesTold;

static void note(void *user, size_t done, size_t size) {
    BytesTold *told = user;
    assert_true(done > told->last && done <= size);
    *told = (BytesTold){done, size, told->count + 1};
}

TEST_WITH(reading_a_long_file_is_told_of, maker_reset, NULL) {
    FileBytes bytes;
    BytesTold told = {0};
    size_t size = ((size_t)20 << 20) + 5;
    char *content = ARENA_NEW(&maker.arena, char, size);
    content[size - 1] = 'x';
    FilePieces how = {.max_bytes = size, .on_bytes = note, .user = &told};
    const char *path = maker_file(content, size, ".glb");
    assert_done(file_read_pieces(path, &how, &maker.arena, &bytes, &err));
    assert_int_equal(bytes.size, size);
    assert_memory_equal(bytes.data, content, size);
    assert_true(told.count >= 3);
    assert_int_equal(told.last, size);
    assert_int_equal(told.size, size);
}

/* ---- threads ----------------------------------------------------------------------------- */

enum { PARTS = 40 };

static LightSelection selection_of(const Scene *scene, int threads, Arena *arena) {
    Bvh *bvh;
    Lights *lights;
    assert_done(bvh_create(scene, threads, NULL, &bvh, &err));
    assert_done(lights_build(scene, arena, &lights, &err));
    assert_int_equal(bvh_threads(bvh), threads);
    const SunlitTools tools = {scene, bvh, lights};
    const SunlitMap none = {.nodes = NULL};
    const PlateBoxes no_boxes = {0};
    const PlateView plates = {.scene = scene, .bvh = bvh, .boxes = &no_boxes};
    LightSelection selection = light_selection_build(&tools, &none, &plates, arena);
    bvh_destroy(bvh);
    return selection;
}

/* Shelves above one another, in the light of a sky and of the lamp among them: each part has
 * other shares of the two. */
TEST(light_selection_is_the_same_for_any_number_of_threads) {
    ENDS_BY(arena_release) Arena arena = arena_reserve((size_t)1 << 28);
    Scene *scene = builder_scene(&arena);
    scene->environment.kind = ENVIRONMENT_CONSTANT;
    scene->environment.luminance_cd_m2 = 100;
    for (int i = 0; i < 3; i++) scene->environment.color[i] = 1;
    for (int i = 0; i < PARTS; i++) {
        Material material = builder_material(0.5f);
        for (int c = 0; c < 3 && i == PARTS / 2; c++) material.emissive_cd_m2[c] = 1000;
        material.is_emitter = i == PARTS / 2;
        builder_part(scene, material);
        builder_quad(scene, vec3(0.1f * (float)(i % 3), 0.2f * (float)i, 0), vec3(1, 0, 0),
                     vec3(0, 0, -1));
    }
    LightSelection one = selection_of(scene, 1, &arena), four = selection_of(scene, 4, &arena);
    assert_memory_equal(one.prob, four.prob, sizeof one.prob[0] * 2 * PARTS);
    assert_memory_equal(one.lx, four.lx, sizeof one.lx[0] * 2 * PARTS);
    assert_true(one.lx[0] > 0 && one.lx[2 * PARTS - 1] > 0 && one.lx[0] != one.lx[2]);
}

TEST_PROGRAM(maker_start, maker_end)
