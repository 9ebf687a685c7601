/* SPDX-License-Identifier: Apache-2.0 */
/* The laws of packed meshes (KHR_draco_mesh_compression): they equal what was packed within
 * their quantisation, and whatever is wrong with them is reported. */
#include "check.h"
#include "draco_fixture.h"
#include "gltf_maker.h"
#include "scene/gltf/document.h"

enum { SIDE = 5, VERTICES = SIDE * SIDE, TRIANGLES = 2 * (SIDE - 1) * (SIDE - 1) };

#define IDS "'POSITION':0,'NORMAL':1,'TEXCOORD_0':2,'COLOR_0':3"

/* What may be changed in a file. */
typedef struct Sheet {
    const unsigned char *bytes;
    size_t size;
    int vertices, corners;
    const char *ids, *mode, *indices;
    const char *more, *nodes; /* accessors; of the document */
} Sheet;

static Sheet sheet_of(const unsigned char *bytes, size_t size) {
    return (Sheet){bytes, size, VERTICES, 3 * TRIANGLES, IDS, "", ",'indices':4", "", ""};
}

static const Sheet WHOLE = {
    SEQUENTIAL, sizeof SEQUENTIAL, VERTICES, 3 * TRIANGLES, IDS, "", ",'indices':4", "", ""};

static const char *nodes_of(const Sheet *sheet) {
    bool has_own = strstr(sheet->nodes, "'nodes'") != NULL;
    return maker_format("%s%s", has_own ? "" : ",'nodes':[{'mesh':0}]", sheet->nodes);
}

static const char *write_sheet(const Sheet *sheet) {
    return maker_gltf(
        sheet->bytes, sheet->size,
        arena_format(
            &maker.arena,
            "'bufferViews':[{'buffer':0,'byteLength':%zu}],"
            "'accessors':[{'componentType':5126,'count':%d,'type':'VEC3'},"
            "{'componentType':5126,'count':%d,'type':'VEC3'},{'componentType':5126,"
            "'count':%d,'type':'VEC2'},{'componentType':5121,'count':%d,'type':'VEC4',"
            "'normalized':true},{'componentType':5123,'count':%d,'type':'SCALAR'}%s],"
            "'materials':[{'pbrMetallicRoughness':{'baseColorTexture':{'index':0}}}],"
            "'textures':[{}],'meshes':[{'primitives':[{'attributes':{'POSITION':0,'NORMAL':1,"
            "'TEXCOORD_0':2,'COLOR_0':3}%s%s,"
            "'extensions':{'KHR_draco_mesh_compression':{'bufferView':0,"
            "'attributes':{%s}}}}]}],'scene':0,'scenes':[{'nodes':[0]}]%s,"
            "'extensionsUsed':['KHR_draco_mesh_compression'],"
            "'extensionsRequired':['KHR_draco_mesh_compression']",
            sheet->size, sheet->vertices, sheet->vertices, sheet->vertices, sheet->vertices,
            sheet->corners, sheet->more, sheet->indices, sheet->mode, sheet->ids, nodes_of(sheet)));
}

/* ---- what is packed is unpacked ---------------------------------------------------------- */

/* Which vertex of the sheet this is; all it has is held against what was packed. */
static int place_of(const Scene *scene, uint32_t vertex) {
    const Part *part = &scene->parts[0];
    Vec3 p = scene->positions[vertex];
    int column = (int)lroundf(4 * p.x), row = (int)lroundf(4 * p.y);
    float x = 0.25f * (float)column, y = 0.25f * (float)row;
    Vec3 n = vec3_normalize(vec3(-x, 0.25f, 1));
    const float step = ldexpf(1, -14);
    assert_near(p.x, x, step);
    assert_near(p.y, y, step);
    assert_near(p.z, 0.5f * x * x - 0.25f * y, step);
    assert_true(vec3_length(vec3_sub(part->normals[vertex], n)) < ldexpf(1, -8));
    assert_near(part->uv[0][vertex].x, x, ldexpf(1, -12));
    assert_near(part->uv[0][vertex].y, 1 - y, ldexpf(1, -12));
    const int color[4] = {10 * column, 20 * row, 200, 255 - (SIDE * row + column)};
    for (int c = 0; c < 4; c++) assert_int_equal(part->colors[vertex].linear[c], 257 * color[c]);
    return SIDE * row + column;
}

/* Triangles of the sheet by their first place in its order: each must be there once. */
static void mark_triangle(const int at[3], int seen[TRIANGLES]) {
    int least = at[0] < at[1] ? (at[0] < at[2] ? 0 : 2) : at[1] < at[2] ? 1 : 2;
    int a = at[least], b = at[(least + 1) % 3], c = at[(least + 2) % 3];
    int is_upper = b == a + SIDE; /* a + 1, a + 1 + SIDE, a + SIDE begins with a + 1 */
    int cell = is_upper ? a - 1 : a;
    assert_int_equal(b, a + (is_upper ? SIDE : 1));
    assert_int_equal(c, a + (is_upper ? SIDE - 1 : SIDE));
    seen[2 * (cell / SIDE * (SIDE - 1) + cell % SIDE) + is_upper]++;
}

static void assert_whole(const char *path) {
    Found found = maker_survey_file(path);
    maker_expect_whole(&found);
    const Scene *scene = found.scene;
    int seen[TRIANGLES] = {0};
    assert_int_equal(scene->triangle_count, TRIANGLES);
    for (uint32_t t = 0; t < TRIANGLES; t++) {
        int at[3];
        for (int c = 0; c < 3; c++) at[c] = place_of(scene, scene->triangles[t].vertex[c]);
        mark_triangle(at, seen);
    }
    for (int t = 0; t < TRIANGLES; t++) assert_int_equal(seen[t], 1);
}

TEST_WITH(packed_meshes_are_what_was_packed, maker_reset, NULL) {
    Sheet other = sheet_of(EDGEBREAKER, sizeof EDGEBREAKER);
    assert_whole(write_sheet(&WHOLE));
    assert_whole(write_sheet(&other));
}

/* A strip's corners are triangles when they are unpacked. */
TEST_WITH(packed_strips_are_triangles, maker_reset, NULL) {
    Sheet strip = sheet_of(EDGEBREAKER, sizeof EDGEBREAKER);
    strip.mode = ",'mode':5";
    strip.corners = 46;
    assert_whole(write_sheet(&strip));
}

static bool tells(const char *path, const char *text) {
    Found found = maker_survey_file(path);
    for (int i = 0; i < found.problems.count; i++)
        if (found.problems.list[i].severity == SEVERITY_ERROR &&
            strstr(found.problems.list[i].message, text))
            return true;
    for (int i = 0; i < found.problems.count; i++)
        print_message("%s: %s\n", found.problems.list[i].path, found.problems.list[i].message);
    return false;
}

static void assert_told(const Sheet *sheet, const char *text) {
    if (!tells(write_sheet(sheet), text)) fail_msg("not told: %s", text);
}

/* Exporters write the counts from before the packing: the packed mesh is whole. */
TEST_WITH(other_counts_are_told_and_the_packed_mesh_is_shown, maker_reset, NULL) {
    static const int POINTS[] = {1, 22, 24, 26, 100, 1 << 22};
    static const int CORNERS[] = {3, 93, 99, 300};
    for (int i = 0; i < 10; i++) {
        maker_reset(NULL);
        Sheet s = i % 2 ? WHOLE : sheet_of(EDGEBREAKER, sizeof EDGEBREAKER);
        *(i < 6 ? &s.vertices : &s.corners) = i < 6 ? POINTS[i] : CORNERS[i - 6];
        const char *path = write_sheet(&s);
        assert_whole(path);
        Found found = maker_survey_file(path);
        const char *place = "/meshes/0/primitives/0/extensions/" DRACO_EXTENSION;
        const char *text = maker_format("the accessors have %d vertices and %d indices, the "
                                        "packed mesh has 25 and 96: the packed mesh is shown",
                                        s.vertices, s.corners);
        assert_non_null(maker_find(&found, place, text));
    }
}

/* What is not packed keeps the accessors' counts, and must fit. */
TEST_WITH(what_is_read_beside_a_packed_mesh_has_its_count, maker_reset, NULL) {
    Sheet s = WHOLE;
    s.vertices = 24, s.ids = "'POSITION':0,'NORMAL':1,'TEXCOORD_0':2";
    assert_told(&s, "COLOR_0 has 24 elements, the packed mesh has 25 vertices");
    s.vertices = 26;
    assert_told(&s, "COLOR_0 has 26 elements, the packed mesh has 25 vertices");
    s = WHOLE, s.vertices = 24;
    s.mode = ",'targets':[{'POSITION':5}]";
    s.more = ",{'componentType':5126,'count':24,'type':'VEC3'}";
    assert_told(&s, "POSITION has 24 elements, the packed mesh has 25 vertices");
    s.mode = "";
    s.nodes = ",'animations':[{'channels':[{'sampler':0,'target':{'node':0,'path':"
              "'translation'}}],'samplers':[{'input':6,'output':0}]}]";
    s.more = ",{'componentType':5126,'count':24,'type':'VEC3'},"
             "{'componentType':5126,'count':24,'type':'SCALAR'}";
    assert_told(&s, "is read as part of a packed mesh too");
    s.nodes = ",'nodes':[{'mesh':0,'extensions':{'EXT_mesh_gpu_instancing':{'attributes':{"
              "'TRANSLATION':0}}}}]";
    assert_told(&s, "is read as part of a packed mesh too");
}

/* The packed bytes are few: what they claim to hold is not believed. */
TEST_WITH(few_bytes_do_not_take_gigabytes, maker_reset, NULL) {
    unsigned char changed[sizeof EDGEBREAKER + 8];
    /* vertices 12,000, triangles 40 million, as variable lengths of seven bits */
    static const unsigned char CLAIM[] = {0xe0, 0x5d, 0x80, 0xb4, 0x89, 0x13};
    memcpy(changed, EDGEBREAKER, 30);
    memcpy(changed + 30, CLAIM, sizeof CLAIM);
    memcpy(changed + 30 + sizeof CLAIM, EDGEBREAKER + 32, sizeof EDGEBREAKER - 32);
    Sheet s = sheet_of(changed, sizeof EDGEBREAKER + sizeof CLAIM - 2);
    s.vertices = 12000;
    s.corners = 120000000;
    assert_told(&s, "40000000 triangles and 12000 vertices are packed, at most 4194304 and");
}

/* ---- what is wrong ----------------------------------------------------------------------- */

TEST_WITH(members_that_do_not_fit_are_told, maker_reset, NULL) {
    Sheet s = WHOLE;
    s.ids = "'POSITION':7";
    assert_told(&s, "the packed mesh has no attribute 7");
    s = WHOLE, s.ids = "'POSITION':2";
    assert_told(&s, "attribute 2 of the packed mesh has 2 components, 3 are required");
    s = WHOLE, s.ids = "'POSITION':0,'COLOR_0':-1";
    assert_told(&s, "the id of an attribute is required");
    s = WHOLE, s.ids = "'POSITION':0,'TANGENT':1";
    assert_told(&s, "the primitive has no TANGENT");
    s = WHOLE, s.ids = "'NORMAL':1";
    assert_told(&s, "\"POSITION\" is missing");
    s = WHOLE, s.mode = ",'mode':6";
    assert_told(&s, "is 6, packed meshes are of mode 4 or 5");
    s = WHOLE, s.indices = "";
    assert_told(&s, "\"indices\" is missing, which packed meshes have");
}

/* One byte of the packed ones is another; how much they hold is stated before it is
 * unpacked. */
TEST_WITH(headers_are_refused_before_anything_is_unpacked, maker_reset, NULL) {
    static const struct {
        int at, value;
        const char *text;
    } CHANGES[] = {{0, 'd', "are no Draco mesh"},
                   {6, 1, "bitstream is 2.1, 2.2 is required"},
                   {7, 0, "are no mesh, but points"}};
    for (size_t i = 0; i < sizeof CHANGES / sizeof *CHANGES; i++) {
        unsigned char changed[sizeof SEQUENTIAL];
        memcpy(changed, SEQUENTIAL, sizeof changed);
        changed[CHANGES[i].at] = (unsigned char)CHANGES[i].value;
        Sheet sheet = sheet_of(changed, sizeof changed);
        assert_told(&sheet, CHANGES[i].text);
    }
}

static bool is_refused(const unsigned char *bytes, size_t size) {
    Arena begun = maker.arena;
    maker.file_count = 0;
    Sheet sheet = sheet_of(bytes, size);
    Found found = maker_survey_file(write_sheet(&sheet));
    maker.arena = begun;
    return found.problems.error_count > 0;
}

TEST_WITH(cut_meshes_are_refused_and_changed_ones_too_or_read, maker_reset, NULL) {
    uint32_t chance = 99;
    for (size_t size = 1; size < sizeof EDGEBREAKER; size += 3)
        if (!is_refused(EDGEBREAKER, size)) fail_msg("%zu bytes are enough", size);
    for (size_t size = 1; size < sizeof SEQUENTIAL; size += 3)
        if (!is_refused(SEQUENTIAL, size)) fail_msg("%zu bytes are enough", size);
    int refused = 0;
    for (int i = 0; i < 300; i++) {
        unsigned char changed[sizeof EDGEBREAKER];
        memcpy(changed, EDGEBREAKER, sizeof changed);
        chance = chance * 1664525 + 1013904223;
        changed[(chance >> 8) % sizeof changed] ^= (unsigned char)(1 + (chance >> 24) % 255);
        refused += is_refused(changed, sizeof changed);
    }
    assert_in_range(refused, 30, 297);
}

TEST_PROGRAM(maker_start, maker_end)
