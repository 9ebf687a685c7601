/* SPDX-License-Identifier: Apache-2.0 */
/* The laws of packed bytes: what is unpacked is what was packed, to the bits or to the filter's
 * rounding, and packed bytes that are cut or changed are refused or read, never more. */
#include <meshoptimizer.h>

#include "fixture.h"
#include "gltf_maker.h"

enum { SIDE = 20, VERTICES = SIDE * SIDE, CORNERS = 6 * (SIDE - 1) * (SIDE - 1) };

/* A curved sheet. */
typedef struct Sheet {
    float positions[3 * VERTICES];
    float normals[4 * VERTICES]; /* the fourth is 0: octahedral filters take four */
    uint32_t corners[CORNERS];
} Sheet;

static void add_cell(Sheet *sheet, uint32_t first, int *count) {
    const uint32_t around[6] = {first,     first + 1,        first + SIDE,
                                first + 1, first + SIDE + 1, first + SIDE};
    memcpy(sheet->corners + *count, around, sizeof around);
    *count += 6;
}

static Sheet make_sheet(void) {
    Sheet sheet;
    int count = 0;
    for (int i = 0; i < VERTICES; i++) {
        float x = (float)(i % SIDE) / SIDE, y = (float)(i / SIDE) / SIDE;
        Vec3 n = vec3_normalize(vec3(-0.5f * x, 0.3f * y, 1));
        float *p = sheet.positions + 3 * i, *normal = sheet.normals + 4 * i;
        p[0] = x, p[1] = y, p[2] = 0.25f * x * x - 0.15f * y * y;
        normal[0] = n.x, normal[1] = n.y, normal[2] = n.z, normal[3] = 0;
    }
    for (uint32_t y = 0; y + 1 < SIDE; y++)
        for (uint32_t x = 0; x + 1 < SIDE; x++) add_cell(&sheet, y * SIDE + x, &count);
    return sheet;
}

/* ---- files ------------------------------------------------------------------------------- */

/* Bytes one after the other, each part at a multiple of 16. */
typedef struct Bytes {
    unsigned char data[1 << 17];
    size_t size;
} Bytes;

static size_t append(Bytes *bytes, const void *data, size_t size) {
    size_t at = (bytes->size + 15) & ~(size_t)15;
    memset(bytes->data + bytes->size, 0, at - bytes->size);
    memcpy(bytes->data + at, data, size);
    bytes->size = at + size;
    return at;
}

/* A buffer view: plain bytes, or packed ones of `count` elements of `stride` bytes. */
typedef struct View {
    size_t offset, size;
    const char *mode, *filter; /* NULL: plain; NULL: none */
    int count, stride;
} View;

#define SHAPE \
    "'accessors':[{'bufferView':0,'componentType':5126,'count':400,'type':'VEC3'}," \
    "{'bufferView':1,'componentType':5125,'count':2166,'type':'SCALAR'}%s]," \
    "'meshes':[{'primitives':[{'attributes':{'POSITION':0%s},'indices':1}]}]," \
    "'scene':0,'scenes':[{'nodes':[0]}],'nodes':[{'mesh':0}]," \
    "'extensionsUsed':['EXT_meshopt_compression','KHR_mesh_quantization']," \
    "'extensionsRequired':['EXT_meshopt_compression','KHR_mesh_quantization']"

static const char *view_text(const View *view) {
    if (!view->mode)
        return arena_format(&maker.arena, "{'buffer':0,'byteOffset':%zu,'byteLength':%zu}",
                            view->offset, view->size);
    const char *filter =
        view->filter ? arena_format(&maker.arena, ",'filter':'%s'", view->filter) : "";
    const char *stride = strcmp(view->mode, "ATTRIBUTES")
                             ? ""
                             : arena_format(&maker.arena, ",'byteStride':%d", view->stride);
    return arena_format(&maker.arena,
                        "{'buffer':0,'byteLength':%d%s,'extensions':{'EXT_meshopt_compression':"
                        "{'buffer':0,'byteOffset':%zu,'byteLength':%zu,'byteStride':%d,"
                        "'count':%d,'mode':'%s'%s}}}",
                        view->count * view->stride, stride, view->offset, view->size, view->stride,
                        view->count, view->mode, filter);
}

/* Positions, corners and, if any, normals: `more` their accessor. */
static const char *write_views(Bytes *bytes, const View *views, int count, const char *more) {
    const char *text = view_text(&views[0]);
    for (int i = 1; i < count; i++)
        text = arena_format(&maker.arena, "%s,%s", text, view_text(&views[i]));
    /* The bytes in a packed view's own place need be no others: the buffer is long enough. */
    while (bytes->size < 32000) bytes->data[bytes->size++] = 0;
    return maker_gltf(bytes->data, bytes->size,
                      arena_format(&maker.arena, "'bufferViews':[%s]," SHAPE, text, more,
                                   more[0] ? ",'NORMAL':2" : ""));
}

static View pack_vertices(Bytes *bytes, const void *data, int stride) {
    unsigned char packed[1 << 16];
    size_t size = meshopt_encodeVertexBuffer(packed, sizeof packed, data, VERTICES, (size_t)stride);
    assert_true(size > 0);
    return (View){append(bytes, packed, size), size, "ATTRIBUTES", NULL, VERTICES, stride};
}

static View pack_corners(Bytes *bytes, const uint32_t *corners, bool is_sequence) {
    unsigned char packed[1 << 15];
    size_t size = is_sequence ? meshopt_encodeIndexSequence(packed, sizeof packed, corners, CORNERS)
                              : meshopt_encodeIndexBuffer(packed, sizeof packed, corners, CORNERS);
    assert_true(size > 0);
    return (View){
        append(bytes, packed, size), size, is_sequence ? "INDICES" : "TRIANGLES", NULL, CORNERS, 4};
}

static const Scene *load(const char *path) {
    Found found = maker_survey_file(path);
    maker_expect_whole(&found);
    return found.scene;
}

/* Triangles may begin with another of their corners. */
static void assert_same_shape(const Scene *found, const Sheet *sheet, float allowed) {
    assert_int_equal(found->triangle_count, CORNERS / 3);
    for (uint32_t t = 0; t < found->triangle_count; t++) {
        const uint32_t *at = found->triangles[t].vertex;
        const uint32_t *wanted = sheet->corners + 3 * t;
        int first = at[0] == wanted[0] ? 0 : at[0] == wanted[1] ? 1 : 2;
        for (int c = 0; c < 3; c++) assert_int_equal(at[c], wanted[(c + first) % 3]);
    }
    for (int i = 0; i < VERTICES; i++) {
        const float *p = sheet->positions + 3 * i;
        assert_near(found->positions[i].x, p[0], allowed);
        assert_near(found->positions[i].y, p[1], allowed);
        assert_near(found->positions[i].z, p[2], allowed);
    }
}

/* ---- what is packed is unpacked ---------------------------------------------------------- */

TEST_WITH(packed_vertices_and_triangles_keep_their_bits, maker_reset, NULL) {
    Sheet sheet = make_sheet();
    for (int is_sequence = 0; is_sequence < 2; is_sequence++) {
        Bytes bytes = {.size = 0};
        View views[2] = {pack_vertices(&bytes, sheet.positions, 12),
                         pack_corners(&bytes, sheet.corners, is_sequence)};
        assert_same_shape(load(write_views(&bytes, views, 2, "")), &sheet, 0);
    }
}

/* One exponent a vector, as the extension has it: newer versions require that said. */
#if MESHOPTIMIZER_VERSION >= 190
#define encode_exponents(...) meshopt_encodeFilterExp(__VA_ARGS__, meshopt_EncodeExpSharedVector)
#else
#define encode_exponents meshopt_encodeFilterExp
#endif

TEST_WITH(exponential_filters_round_to_their_bits, maker_reset, NULL) {
    Sheet sheet = make_sheet();
    uint32_t filtered[3 * VERTICES];
    for (int bits = 8; bits <= 24; bits += 8) {
        Bytes bytes = {.size = 0};
        encode_exponents(filtered, VERTICES, 12, bits, sheet.positions);
        View views[2] = {pack_vertices(&bytes, filtered, 12),
                         pack_corners(&bytes, sheet.corners, false)};
        views[0].filter = "EXPONENTIAL";
        assert_same_shape(load(write_views(&bytes, views, 2, "")), &sheet, ldexpf(1, 1 - bits));
    }
}

#define NORMAL_BYTES \
    ",{'bufferView':2,'componentType':5120,'count':400,'type':'VEC3'," \
    "'normalized':true}"
#define NORMAL_SHORTS \
    ",{'bufferView':2,'componentType':5122,'count':400,'type':'VEC3'," \
    "'normalized':true}"

TEST_WITH(octahedral_filters_round_directions_to_their_bits, maker_reset, NULL) {
    Sheet sheet = make_sheet();
    unsigned char filtered[8 * VERTICES];
    for (int stride = 4; stride <= 8; stride += 4) {
        Bytes bytes = {.size = 0};
        int bits = 2 * stride;
        meshopt_encodeFilterOct(filtered, VERTICES, (size_t)stride, bits, sheet.normals);
        View views[3] = {pack_vertices(&bytes, sheet.positions, 12),
                         pack_corners(&bytes, sheet.corners, false),
                         pack_vertices(&bytes, filtered, stride)};
        views[2].filter = "OCTAHEDRAL";
        const Scene *scene =
            load(write_views(&bytes, views, 3, stride == 4 ? NORMAL_BYTES : NORMAL_SHORTS));
        for (int i = 0; i < VERTICES; i++) {
            const float *n = sheet.normals + 4 * i;
            Vec3 found = scene->parts[0].normals[i];
            float apart = vec3_length(vec3_sub(found, vec3(n[0], n[1], n[2])));
            assert_true(apart < ldexpf(3, -bits + 1));
        }
    }
}

/* A turn of an animation: four shorts. */
TEST_WITH(quaternion_filters_round_turns_to_their_bits, maker_reset, NULL) {
    static const float TRIANGLE[9] = {0, 0, 0, 1, 0, 0, 0, 1, 0}, TIMES[2] = {0, 1};
    const float turns[8] = {0, 0, 0, 1, 0.5f, -0.1f, 0.7f, 0.5f}; /* of length 1 */
    unsigned char filtered[16], packed[256];
    Bytes bytes = {.size = 0};
    append(&bytes, TRIANGLE, 36);
    append(&bytes, TIMES, 8);
    meshopt_encodeFilterQuat(filtered, 2, 8, 16, turns);
    size_t size = meshopt_encodeVertexBuffer(packed, sizeof packed, filtered, 2, 8);
    View view = {append(&bytes, packed, size), size, "ATTRIBUTES", "QUATERNION", 2, 8};
    const char *path = maker_gltf(
        bytes.data, bytes.size,
        arena_format(
            &maker.arena,
            "'extensionsUsed':['EXT_meshopt_compression'],'bufferViews':[" VIEW0(36) "," VIEW(48, 8) ",%s],'accessors':[" FLOATS(
                0, 3,
                "VEC3") "," FLOATS(1, 2,
                                   "SCALAR") ",{'bufferView':2,'componentType':5122,'count':2,'type':'VEC4',"
                                             "'normalized':true}]," MESH_OF(
                                                 "'POSITION':0") "'scene':0," ONE_NODE ","
                                                                 "'animations':[{'samplers':[{'input':1,'output':2}],'channels':[{'sampler':0,"
                                                                 "'target':{'node':0,'path':'rotation'}}]}]",
            view_text(&view)));
    Found found = maker_survey(
        &(SceneOptions){.paths = &path, .path_count = 1, .state = {.has_time = true, .time_s = 1}});
    assert_int_equal(found.problems.error_count, 0);
    Vec3 x = scene_corner(found.scene, 0, 1);
    const float *q = turns + 4;
    assert_near(x.x, 1 - 2 * (q[1] * q[1] + q[2] * q[2]), 2e-4);
    assert_near(x.y, 2 * (q[0] * q[1] + q[3] * q[2]), 2e-4);
    assert_near(x.z, 2 * (q[0] * q[2] - q[3] * q[1]), 2e-4);
}

/* ---- what is wrong ----------------------------------------------------------------------- */

typedef struct Wrong {
    View change; /* what is not 0 or NULL replaces the packed positions' */
    int view;
    const char *text;
} Wrong;

static const Wrong WRONGS[] = {
    {{.stride = 8}, 0, "unpacks to 3200 bytes, the buffer view has 4800"},
    {{.count = 399}, 0, "unpacks to 4788 bytes, the buffer view has 4800"},
    {{.offset = 40000}, 0, "of a buffer of"},
    {{.size = 1}, 0, "1 packed bytes are too few for 400 elements of 12 bytes"},
    {{.size = 90}, 0, "the packed bytes are no 400 elements of the mode ATTRIBUTES"},
    {{.mode = "TRIANGLES"}, 0, "is 12, with TRIANGLES 2 or 4 is required"},
    {{.mode = "LINES"}, 0, "one of ATTRIBUTES|TRIANGLES|INDICES"},
    {{.filter = "OCTAHEDRAL"}, 0, "is 12, with OCTAHEDRAL 4 or 8 is required"},
    {{.filter = "QUATERNION"}, 0, "is 12, with QUATERNION 8 is required"},
    {{.filter = "COLOR"}, 0, "one of NONE|OCTAHEDRAL|QUATERNION|EXPONENTIAL"},
    {{.filter = "EXPONENTIAL"}, 1, "with TRIANGLES only NONE is required"},
    {{.count = 2165}, 1, "is 2165, with TRIANGLES a multiple of 3 is required"},
};

/* The packed view as it was, but for what is changed. */
static const char *change_text(const char *text, const View *was, const Wrong *wrong) {
    View changed = *was;
    const View *change = &wrong->change;
    if (change->stride) changed.stride = change->stride;
    if (change->count) changed.count = change->count;
    if (change->offset) changed.offset = change->offset;
    if (change->size) changed.size = change->size;
    if (change->mode) changed.mode = change->mode;
    if (change->filter) changed.filter = change->filter;
    const char *before = strstr(view_text(was), "'extensions'");
    const char *after = strstr(view_text(&changed), "'extensions'");
    const char *at = strstr(text, before);
    return arena_format(&maker.arena, "%.*s%s%s", (int)(at - text), text, after,
                        at + strlen(before));
}

TEST_WITH(numbers_that_do_not_fit_are_told, maker_reset, NULL) {
    Sheet sheet = make_sheet();
    Bytes bytes = {.size = 0};
    View views[2] = {pack_vertices(&bytes, sheet.positions, 12),
                     pack_corners(&bytes, sheet.corners, false)};
    while (bytes.size < 32000) bytes.data[bytes.size++] = 0;
    const char *text = arena_format(&maker.arena, "'bufferViews':[%s,%s]," SHAPE,
                                    view_text(&views[0]), view_text(&views[1]), "", "");
    for (size_t i = 0; i < sizeof WRONGS / sizeof *WRONGS; i++) {
        const Wrong *wrong = &WRONGS[i];
        const char *members = change_text(text, &views[wrong->view], wrong);
        Found found = maker_survey_file(maker_gltf(bytes.data, bytes.size, members));
        bool is_told = false;
        for (int k = 0; k < found.problems.count; k++)
            is_told |= found.problems.list[k].severity == SEVERITY_ERROR &&
                       strstr(found.problems.list[k].message, wrong->text);
        if (!is_told) fail_msg("not told: %s", wrong->text);
    }
}

/* The coder's last bytes are read from the end of what there is, so that bytes cut off at the
 * end are no fewer elements but others: they may be read, or refused. */
TEST_WITH(cut_and_changed_bytes_are_read_or_refused, maker_reset, NULL) {
    Sheet sheet = make_sheet();
    uint32_t chance = 12345;
    int refused = 0;
    for (int i = 0; i < 60; i++) {
        Arena begun = maker.arena;
        Bytes bytes = {.size = 0};
        View views[2] = {pack_vertices(&bytes, sheet.positions, 12),
                         pack_corners(&bytes, sheet.corners, i % 3 == 0)};
        View *hurt = &views[i % 2];
        chance = chance * 1664525 + 1013904223;
        if (i % 4 < 2) hurt->size -= 1 + chance % (hurt->size - 100);
        else bytes.data[hurt->offset + chance % hurt->size] ^= (unsigned char)(chance >> 24);
        Found found = maker_survey_file(write_views(&bytes, views, 2, ""));
        refused += found.problems.error_count > 0;
        maker.arena = begun;
    }
    assert_true(refused > 20);
}

/* ---- pictures ---------------------------------------------------------------------------- */

/* Three pixels, lossless: (255, 0, 0, 255), (0, 128, 255, 51), (10, 20, 30, 255). */
static const unsigned char WEBP[62] = {
    0x52, 0x49, 0x46, 0x46, 0x36, 0x00, 0x00, 0x00, 0x57, 0x45, 0x42, 0x50, 0x56, 0x50, 0x38, 0x4c,
    0x2a, 0x00, 0x00, 0x00, 0x2f, 0x02, 0x00, 0x00, 0x10, 0x17, 0x20, 0x10, 0x48, 0x71, 0x10, 0x63,
    0x2e, 0x16, 0x4c, 0x00, 0xe6, 0xaf, 0xda, 0x9b, 0x40, 0x20, 0x89, 0x64, 0x7f, 0xad, 0x4d, 0x04,
    0x02, 0x49, 0x50, 0xfb, 0xab, 0x1d, 0x76, 0x72, 0x87, 0x62, 0x44, 0xf4, 0x3f, 0x00};

static Found survey_texture(const char *texture, const char *required) {
    static const float TRIANGLE[9] = {0, 0, 0, 1, 0, 0, 0, 1, 0};
    Bytes bytes = {.size = 0};
    append(&bytes, TRIANGLE, 36);
    append(&bytes, WEBP, sizeof WEBP);
    return maker_survey_file(maker_gltf(
        bytes.data, bytes.size,
        arena_format(
            &maker.arena,
            "'bufferViews':[" VIEW0(36) "," VIEW(48, 62) "],'accessors':[" FLOATS(
                0, 3,
                "VEC3") "],'images':[{'bufferView':0,"
                        "'mimeType':'image/png'},{'bufferView':1,'mimeType':'image/webp'}],"
                        "'textures':[{%s}],"
                        "'materials':[{'pbrMetallicRoughness':{'baseColorTexture':{'index':0}}}],"
                        "'meshes':[{'primitives':[{'attributes':{'POSITION':0},'material':0}]}],"
                        "'scene':0," ONE_NODE ",'extensionsUsed':['EXT_texture_webp',"
                        "'KHR_texture_basisu']%s",
            texture, required)));
}

/* Image 0, which is for other readers, is no picture at all. */
TEST_WITH(a_webp_picture_is_shown_before_the_one_for_other_readers, maker_reset, NULL) {
    Found found = survey_texture("'source':0,'extensions':{'EXT_texture_webp':{'source':1}}",
                                 ",'extensionsRequired':['EXT_texture_webp']");
    assert_int_equal(found.problems.error_count, 0);
    const Image *image = &found.scene->textures[0].image;
    const uint8_t wanted[12] = {255, 0, 0, 255, 0, 128, 255, 51, 10, 20, 30, 255};
    assert_int_equal(image->width, 3);
    assert_int_equal(image->height, 1);
    assert_memory_equal(image->pixels, wanted, sizeof wanted);
}

TEST_WITH(webp_pictures_that_are_cut_are_refused, maker_reset, NULL) {
    Image image;
    assert_done(image_read_memory(WEBP, sizeof WEBP, "a.webp", &maker.arena, &image, &err));
    for (size_t size = 0; size < sizeof WEBP - 1; size++) {
        unsigned char *cut = malloc(size + 1); /* of this size, for the address sanitizer */
        memcpy(cut, WEBP, size);
        cut = realloc(cut, size ? size : 1);
        if (image_read_memory(cut, size, "a.webp", &maker.arena, &image, why()))
            fail_msg("%zu bytes are taken for a picture", size);
        free(cut);
    }
}

TEST_WITH(a_ktx2_picture_is_told_by_name, maker_reset, NULL) {
    Found alone = survey_texture("'extensions':{'KHR_texture_basisu':{'source':0}}", "");
    assert_non_null(maker_find(&alone, "/materials/0/pbrMetallicRoughness/baseColorTexture",
                               "texture 0 has a KTX2 picture alone (KHR_texture_basisu)"));
    Found needed = survey_texture("'extensions':{'KHR_texture_basisu':{'source':0}}",
                                  ",'extensionsRequired':['KHR_texture_basisu']");
    const Problem *told = maker_find(&needed, "/extensionsRequired/0", "KHR_texture_basisu");
    assert_non_null(told);
    assert_int_equal(told->severity, SEVERITY_ERROR);
    Found beside =
        survey_texture("'source':1,'extensions':{'KHR_texture_basisu':{'source':0}}", "");
    assert_non_null(maker_find(&beside, "/extensionsUsed/1", "is not supported"));
    assert_int_equal(beside.scene->textures[0].image.width, 3);
}

TEST_PROGRAM(maker_start, maker_end)
