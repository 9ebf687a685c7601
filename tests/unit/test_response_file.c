/* SPDX-License-Identifier: Apache-2.0 */
/* A response that was read is the one that was written, bit for bit; whatever is not whole, or
 * of another question, is refused in one line that names the file. */
#include "fixture.h"

#include <sys/stat.h>
#define XXH_INLINE_ALL
#include <xxhash.h>

#include "review/light/response_file.h"

enum { LEVEL = 0 };

static const char identity[] = "version\t1\neye\t0 1 2\nseed\t9\n";
static char path[2 * FOLDER_BYTES];

static int start(void **state) {
    if (make_folder(state)) return -1;
    snprintf(path, sizeof path, "%s", in_folder("a.response"));
    return 0;
}

/* Half the triangles are empty, and one holds nothing but a negative zero. */
static Response make_response(Arena *arena) {
    Response response;
    float *shares = response_empty(LEVEL, arena, &response);
    int cells = response.cells.count;
    for (int i = 0; i < PROBE_ORDERS * cells * RESPONSE_BANDS; i++)
        if (i / RESPONSE_BANDS % 2) shares[i] = 1.0f / (float)(i + 3);
    for (int i = 0; i < 2 * cells * RESPONSE_GROUPS; i++)
        if (i / (2 * RESPONSE_GROUPS) % 2)
            shares[PROBE_ORDERS * cells * RESPONSE_BANDS + i] = 1.0f / (float)(i + 5);
    shares[0] = -0.0f;
    response.paths = 640;
    response.relative_error = 0.0123;
    return response;
}

static void assert_same_responses(const Response *a, const Response *b) {
    size_t bytes = (size_t)a->cells.count * RESPONSE_BANDS * sizeof(float);
    assert_int_equal(a->cells.count, b->cells.count);
    assert_int_equal(a->cells.level, b->cells.level);
    assert_int_equal(a->paths, b->paths);
    assert_memory_equal(&a->relative_error, &b->relative_error, sizeof(double));
    assert_memory_equal(a->first, b->first, bytes);
    assert_memory_equal(a->rest, b->rest, bytes);
    assert_memory_equal(a->groups, b->groups,
                        2 * (size_t)a->cells.count * RESPONSE_GROUPS * sizeof(float));
    assert_memory_equal(a->centers, b->centers, (size_t)a->cells.count * sizeof *a->centers);
}

static const OwnLight light = {0.25, 1.5};

static FileBytes write_one(Arena *arena) {
    Response response = make_response(arena);
    ResponseFile file = {.path = path, .identity = identity};
    FileBytes bytes;
    assert_done(response_write(&file, &response, &light, *arena, &err));
    assert_done(file_read(path, 1 << 24, arena, &bytes, &err));
    assert_int_equal(bytes.size, file.bytes);
    return bytes;
}

static void assert_refused(const char *as, Arena arena, Error *err) {
    ResponseFile file = {.path = path, .identity = as};
    Response response = {.paths = 7};
    OwnLight own = {1, 2};
    assert_false(response_read(&file, &arena, &response, &own, err));
    assert_int_equal(err->code, ERROR_INPUT);
    assert_string_equal(err->file, path);
    assert_true(response.paths == 7 && own.lamps == 1);
}

ARENA_TEST(what_was_written_is_read) {
    ResponseFile file = {.path = path, .identity = identity};
    Response found, wanted = make_response(&arena);
    OwnLight own;
    FileBytes bytes = write_one(&arena);
    assert_done(response_read(&file, &arena, &found, &own, &err));
    assert_same_responses(&found, &wanted);
    assert_memory_equal(&own, &light, sizeof own);
    assert_int_equal(file.bytes, bytes.size);
    size_t whole = (PROBE_ORDERS * RESPONSE_BANDS + 2 * RESPONSE_GROUPS) *
                   (size_t)wanted.cells.count * sizeof(float);
    assert_true(bytes.size < whole); /* empty triangles take no room */
}

ARENA_TEST(every_beginning_is_refused) {
    FileBytes bytes = write_one(&arena);
    for (size_t size = 0; size < bytes.size; size++) {
        write_bytes(path, bytes.data, size);
        assert_refused(identity, arena, why());
        assert_true(strstr(why()->text, size < 8 ? "is not a response" : "is cut off"));
    }
}

ARENA_TEST(every_damaged_byte_is_refused) {
    FileBytes bytes = write_one(&arena);
    unsigned char *damaged = ARENA_NEW(&arena, unsigned char, bytes.size + 1);
    for (size_t at = 0; at < bytes.size; at++) {
        memcpy(damaged, bytes.data, bytes.size);
        damaged[at] ^= 1;
        write_bytes(path, damaged, bytes.size);
        assert_refused(identity, arena, why());
    }
    memcpy(damaged, bytes.data, bytes.size);
    write_bytes(path, damaged, bytes.size + 1);
    assert_refused(identity, arena, why());
    assert_true(strstr(why()->text, "is damaged: has "));
}

ARENA_TEST(another_question_is_told_by_what_differs) {
    write_one(&arena);
    assert_refused("version\t1\neye\t0 1 3\nseed\t9\n", arena, why());
    assert_string_equal(why()->text,
                        "is the response of something else: eye: 0 1 2 there, 0 1 3 here");
}

static void assert_patch_refused(FileBytes bytes, size_t at, const void *value, size_t size,
                                 Arena arena) {
    unsigned char *wrong = ARENA_NEW(&arena, unsigned char, bytes.size);
    memcpy(wrong, bytes.data, bytes.size);
    memcpy(wrong + at, value, size);
    uint64_t sum = XXH3_64bits(wrong, bytes.size - sizeof sum);
    memcpy(wrong + bytes.size - sizeof sum, &sum, sizeof sum);
    write_bytes(path, wrong, bytes.size);
    assert_refused(identity, arena, why());
    assert_error_has(why(), "is damaged: ");
}

/* With the right checksum: light that is not finite, a level that would take the memory. */
ARENA_TEST(what_cannot_be_is_refused) {
    enum { AT_LEVEL = 32, AT_KEPT = 44, AT_ERROR = 48, AT_LAMPS = 56, AT_DISPLAYS = 64, HEAD = 72 };
    FileBytes bytes = write_one(&arena);
    const int32_t level = RESPONSE_LEVEL + 1;
    const double bad[] = {NAN, INFINITY, -INFINITY};
    int32_t kept;
    memcpy(&kept, bytes.data + AT_KEPT, sizeof kept);
    assert_patch_refused(bytes, AT_LEVEL, &level, sizeof level, arena);
    for (int i = 0; i < 3; i++) {
        const float value = (float)bad[i];
        size_t at = HEAD + sizeof identity - 1 + (size_t)kept * sizeof kept;
        assert_patch_refused(bytes, AT_ERROR, &bad[i], sizeof bad[i], arena);
        assert_patch_refused(bytes, AT_LAMPS, &bad[i], sizeof bad[i], arena);
        assert_patch_refused(bytes, AT_DISPLAYS, &bad[i], sizeof bad[i], arena);
        for (; at + 8 < bytes.size; at += 11 * sizeof value)
            assert_patch_refused(bytes, at, &value, sizeof value, arena);
    }
}

TEST_PROGRAM(start, clear_folder)
