/* SPDX-License-Identifier: Apache-2.0 */
/* The wrapper of tinygltf from C: values know their place, nothing foreign comes out. */
#include "fixture.h"

#include "scene/gltf/tree.h"

static const GltfValue *parse(const char *text) {
    const GltfValue *root = NULL;
    assert_done(gltf_json_parse(text, strlen(text), test_memory(), &root, &err));
    return root;
}

TEST(values_keep_their_kind_and_order) {
    const GltfValue *root =
        parse("{\"z\":[null,true,-2,2.5,1e3,\"\\u00e9\\n\"],\"a\":{},\"big\":9007199254740993}");
    assert_int_equal(root->kind, GLTF_OBJECT);
    assert_int_equal(root->count, 3);
    assert_string_equal(root->items[0].key, "z");
    const GltfValue *z = tree_member(root, "z");
    static const GltfKind KINDS[] = {GLTF_NULL,   GLTF_BOOLEAN, GLTF_NUMBER,
                                     GLTF_NUMBER, GLTF_NUMBER,  GLTF_STRING};
    for (int i = 0; i < 6; i++) assert_int_equal(z->items[i].kind, KINDS[i]);
    assert_true(z->items[1].number == 1 && z->items[2].number == -2);
    assert_true(z->items[3].number == 2.5 && z->items[4].number == 1000);
    assert_true(tree_is_integer(&z->items[4]));
    assert_false(tree_is_integer(&z->items[3]));
    assert_false(tree_is_integer(tree_member(root, "big"))); /* more than a double counts */
    assert_string_equal(z->items[5].text, "\xc3\xa9\n");
    assert_null(z->items[0].key);
}

TEST(values_know_their_place) {
    char pointer[64];
    const GltfValue *root = parse("{\"a/b\":[{},{\"m~n\":[0,1,2]}]}");
    const GltfValue *inner = tree_member(tree_item(tree_member(root, "a/b"), 1), "m~n");
    tree_pointer(&inner->items[2], pointer, sizeof pointer);
    assert_string_equal(pointer, "/a~1b/1/m~0n/2"); /* RFC 6901 */
    tree_pointer(root, pointer, sizeof pointer);
    assert_string_equal(pointer, "");
    tree_pointer(inner, pointer, 5); /* too little room: cut, and terminated */
    assert_string_equal(pointer, "/a~1");
}

TEST(readers_take_the_default_for_what_is_not_there) {
    float numbers[2] = {7, 8};
    const GltfValue *root =
        parse("{\"n\":1,\"t\":\"x\",\"l\":[1,2],\"mixed\":[1,\"2\"],\"f\":1.5}");
    assert_true(tree_number(root, "t", 5) == 5);
    assert_int_equal(tree_int(root, "f", 5), 5);
    assert_int_equal(tree_int(root, "n", 5), 1);
    assert_string_equal(tree_text(root, "n", "none"), "none");
    assert_true(tree_boolean(root, "n", true));
    assert_false(tree_floats(root, "mixed", 2, numbers));
    assert_false(tree_floats(root, "l", 3, numbers));
    assert_true(numbers[0] == 7);
    assert_true(tree_floats(root, "l", 2, numbers));
    assert_true(numbers[1] == 2);
    assert_null(tree_member(NULL, "n"));
    assert_null(tree_item(root, 0));
    assert_null(tree_element(root, "l", 2));
    assert_null(tree_element(root, "l", -1));
}

static bool parses_depth(int depth) {
    Error err;
    const GltfValue *root;
    char text[1024];
    memset(text, '[', (size_t)depth);
    memset(text + depth, ']', (size_t)depth);
    bool done = gltf_json_parse(text, 2 * (size_t)depth, test_memory(), &root, &err);
    if (!done) assert_string_equal(err.text, "JSON nested deeper than 256 levels");
    return done;
}

TEST(nesting_has_a_limit) {
    assert_true(parses_depth(GLTF_MAX_DEPTH));
    assert_false(parses_depth(GLTF_MAX_DEPTH + 1));
}

TEST(faults_name_line_and_column) {
    const GltfValue *root;
    static const char TEXT[] = "{\n  \"a\" \"b\"}";
    assert_fails(gltf_json_parse(TEXT, sizeof TEXT - 1, test_memory(), &root, &err),
                 "not valid JSON: parse error at line 2, column 9");
    assert_fails_with(gltf_json_parse("{\"a\":1,\"a\":2}", 13, test_memory(), &root, &err),
                      "the name \"a\" stands twice in one object");
    assert_fails(gltf_json_parse("\"\xff\"", 3, test_memory(), &root, &err), ""); /* no UTF-8 */
}

static GltfData data_of(const char *text) {
    Error err;
    GltfData data = {0};
    const GltfValue *root;
    if (!gltf_json_parse(text, strlen(text), test_memory(), &root, &err) ||
        !gltf_json_data(root, test_memory(), &data, &err))
        fail_msg("%s", err.text);
    return data;
}

TEST(accessors_come_as_plain_arrays) {
    GltfData data =
        data_of("{\"bufferViews\":[{\"buffer\":0,\"byteLength\":64,\"byteOffset\":4,"
                "\"byteStride\":16}],"
                "\"accessors\":[{\"bufferView\":0,\"byteOffset\":8.0,\"componentType\":5123,"
                "\"count\":3.0,"
                "\"type\":\"MAT3\",\"normalized\":true},{\"componentType\":5126,\"count\":9,"
                "\"type\":\"VEC2\",\"sparse\":{\"count\":2,\"indices\":{\"bufferView\":0,"
                "\"byteOffset\":6,\"componentType\":5121},\"values\":{\"bufferView\":0}}}]}");
    assert_int_equal(data.view_count, 1);
    assert_int_equal(data.views[0].offset, 4);
    assert_int_equal(data.views[0].stride, 16);
    const GltfAccessor *matrix = &data.accessors[0], *sparse = &data.accessors[1];
    assert_int_equal(matrix->offset, 8); /* 8.0 is an integer */
    assert_int_equal(matrix->count, 3);
    assert_int_equal(matrix->component_count, 9);
    assert_int_equal(matrix->matrix_rows, 3);
    assert_true(matrix->is_normalized);
    assert_int_equal(matrix->sparse_count, 0);
    assert_int_equal(sparse->buffer_view, -1);
    assert_int_equal(sparse->component_count, 2);
    assert_int_equal(sparse->sparse_count, 2);
    assert_int_equal(sparse->sparse_index_offset, 6);
    assert_int_equal(sparse->sparse_index_type, 5121);
    data = data_of("{}");
    assert_int_equal(data.accessor_count, 0);
}

TEST(what_tinygltf_refuses_comes_back_as_an_error) {
    Error err;
    GltfData data = {.view_count = 77};
    const GltfValue *root;
    static const char TEXT[] = "{\"bufferViews\":[{\"buffer\":0}]}",
                      THROWS[] = "{\"accessors\":[{\"type\":\"SCALAR\",\"componentType\":5126,"
                                 "\"count\":1,\"sparse\":{}}]}";
    assert_true(gltf_json_parse(TEXT, sizeof TEXT - 1, test_memory(), &root, &err));
    assert_false(gltf_json_data(root, test_memory(), &data, &err));
    assert_int_equal(err.code, ERROR_LIBRARY);
    assert_non_null(strstr(err.text, "tinygltf: "));
    assert_int_equal(data.view_count, 77); /* outputs stay as they were */
    assert_true(gltf_json_parse(THROWS, sizeof THROWS - 1, test_memory(), &root, &err));
    assert_false(gltf_json_data(root, test_memory(), &data, &err)); /* an exception inside */
    assert_non_null(strstr(err.text, "'indices' not found"));
}

TEST_PROGRAM(make_arena, drop_arena)
