/* SPDX-License-Identifier: Apache-2.0 */
/* The second part of a picture's file: words come back bit for bit, and the picture does not
 * know of them. */
#include "fixture.h"

#include "image/frame.h"

enum { WIDTH = 11, HEIGHT = 37, WORDS = 5 };

static const char *const NAMES[WORDS] = {"sum.Y.0", "sum.Y.1", "count", "a.0", "sum.X.0"};
static const ExrWindow CROP = {3, 5, 3 + WIDTH, 5 + HEIGHT};

/* Noise over all bits, which ZIP cannot make shorter, and some zeros, which it can. */
static uint32_t *make_values(Arena *arena) {
    uint32_t *values = ARENA_NEW(arena, uint32_t, WIDTH *HEIGHT *WORDS), seed = 1;
    for (int i = 0; i < WIDTH * HEIGHT * WORDS; i++) {
        seed = seed * 1664525u + 1013904223u;
        values[i] = i % 7 == 3 ? 0 : seed ^ seed >> 13;
    }
    return values;
}

/* A small picture, with words unless they are NULL. */
static FileBytes encode(const ExrWords *words, Arena *arena) {
    FrameImage frame = frame_create(40, 60, CROP, 2, 1, arena);
    float *red = frame_add_channel(&frame, "R", false, arena);
    for (int i = 0; i < WIDTH * HEIGHT; i++) red[i] = (float)i * 0.37f;
    frame_set_string(&frame, "comments", "a picture", arena);
    frame.words = words;
    ExrBytes *encoded;
    FileBytes file;
    assert_done(exr_encode(&frame, &encoded, &err));
    const void *bytes = exr_bytes(encoded, &file.size);
    file.data = memcpy(ARENA_NEW(arena, unsigned char, file.size), bytes, file.size);
    exr_bytes_destroy(encoded);
    return file;
}

static const ExrWords *make_words(Arena *arena) {
    static const ExrAttribute attributes[] = {{"unit", EXR_STRING, "steps", {0}},
                                              {"range", EXR_INT, "", {42}}};
    ExrWords *words = ARENA_NEW(arena, ExrWords, 1);
    *words = (ExrWords){"film", WORDS, NAMES, make_values(arena), 2, attributes, NULL};
    return words;
}

static ExrReader *open_bytes(FileBytes file) {
    ExrReader *reader;
    assert_done(exr_reader_create("a.exr", file.data, file.size, &reader, &err));
    return reader;
}

/* ---- what is written is read ------------------------------------------------------------- */

ARENA_TEST(every_word_comes_back_in_the_order_asked_for) {
    const ExrWords *words = make_words(&arena), *found;
    const uint32_t *written = words->values;
    ExrReader *reader = open_bytes(encode(words, &arena));
    static const char *const two[] = {"sum.X.0", "sum.Y.1"};
    const ExrWords wanted = {"film", 2, two, NULL, 0, NULL, NULL};
    assert_done(exr_reader_words(reader, "film", &found, &err));
    assert_int_equal(found->count, WORDS);
    assert_string_equal(found->name, "film");
    assert_string_equal(found->names[0], "a.0"); /* files sort them */
    for (int y0 = 0; y0 < HEIGHT; y0 += 10) {
        int y1 = y0 + 10 < HEIGHT ? y0 + 10 : HEIGHT;
        uint32_t *rows = ARENA_NEW(&arena, uint32_t, WIDTH * 10 * WORDS);
        uint32_t *pair = ARENA_NEW(&arena, uint32_t, WIDTH * 10 * 2);
        assert_done(exr_reader_read_words(reader, words, CROP.y0 + y0, CROP.y0 + y1, rows, &err));
        assert_memory_equal(rows, written + y0 * WIDTH * WORDS,
                            (size_t)((y1 - y0) * WIDTH * WORDS) * sizeof *rows);
        assert_done(exr_reader_read_words(reader, &wanted, CROP.y0 + y0, CROP.y0 + y1, pair, &err));
        for (int i = 0; i < (y1 - y0) * WIDTH; i++) {
            assert_int_equal(pair[2 * i], written[(y0 * WIDTH + i) * WORDS + 4]);
            assert_int_equal(pair[2 * i + 1], written[(y0 * WIDTH + i) * WORDS + 1]);
        }
    }
    exr_reader_destroy(reader);
}

ARENA_TEST(attributes_of_the_words_are_their_own) {
    ExrReader *reader = open_bytes(encode(make_words(&arena), &arena));
    const ExrWords *found;
    Error err = {0};
    assert_true(exr_reader_words(reader, "film", &found, &err));
    const FrameImage words = {.attribute_count = found->attribute_count,
                              .attributes = (ExrAttribute *)found->attributes};
    assert_string_equal(frame_string(&words, "unit"), "steps");
    assert_true(frame_attribute(&words, "range")->values[0] == 42);
    assert_null(frame_attribute(&words, "comments"));
    assert_null(frame_attribute(&words, "name"));
    assert_null(frame_attribute(exr_reader_picture(reader), "unit"));
    assert_true(exr_reader_words(reader, "other", &found, &err));
    assert_null(found);
    assert_true(exr_reader_words(reader, "picture", &found, &err)); /* the first is no words */
    assert_null(found);
    exr_reader_destroy(reader);
}

ARENA_TEST(the_picture_is_the_same_with_and_without) {
    FileBytes with = encode(make_words(&arena), &arena), without = encode(NULL, &arena);
    FileBytes again = encode(make_words(&arena), &arena);
    FrameImage a, b;
    assert_done(frame_read_memory(with.data, with.size, "with.exr", &arena, &a, &err));
    assert_done(frame_read_memory(without.data, without.size, "without", &arena, &b, &err));
    assert_memory_equal(a.channels[0].values, b.channels[0].values, WIDTH * HEIGHT * sizeof(float));
    assert_int_equal(a.channel_count, 1);
    assert_int_equal(a.attribute_count, b.attribute_count);
    for (int i = 0; i < a.attribute_count; i++)
        assert_string_equal(a.attributes[i].name, b.attributes[i].name);
    assert_memory_equal(&a.data, &CROP, sizeof CROP);
    assert_null(a.words);
    assert_int_equal(with.size, again.size);
    assert_memory_equal(with.data, again.data, with.size);
}

ARENA_TEST(a_file_on_disk_is_read_too) {
    const ExrWords *words = make_words(&arena), *found;
    FileBytes file = encode(words, &arena);
    ExrReader *reader;
    uint32_t *rows = ARENA_NEW(&arena, uint32_t, WIDTH *HEIGHT *WORDS);
    assert_done(file_write(in_folder("a.exr"), file.data, file.size, &err));
    assert_done(exr_reader_open(in_folder("a.exr"), &reader, &err));
    assert_done(exr_reader_words(reader, "film", &found, &err));
    assert_done(exr_reader_read_words(reader, words, CROP.y0, CROP.y1, rows, &err));
    assert_memory_equal(rows, words->values, WIDTH * HEIGHT * WORDS * sizeof *rows);
    exr_reader_destroy(reader);
    assert_done(exr_reader_open(in_folder("a.exr"), &reader, &err));
    assert_done(exr_reader_words(reader, "film", &found, &err));
    assert_int_equal(truncate(in_folder("a.exr"), (off_t)file.size - 100), 0);
    assert_fails(exr_reader_read_words(reader, words, CROP.y0, CROP.y1, rows, &err),
                 "damaged OpenEXR file");
    exr_reader_destroy(reader);
    unlink(in_folder("a.exr"));
}

/* ---- what is broken is refused ----------------------------------------------------------- */

/* All of the words, or an error of one line. */
static bool read_all(const void *bytes, size_t size, const ExrWords *words, uint32_t *rows,
                     Error *err) {
    ExrReader *reader;
    const ExrWords *found;
    if (!exr_reader_create("cut.exr", bytes, size, &reader, err)) return false;
    const ExrWindow *data = &exr_reader_picture(reader)->data;
    bool ok = exr_reader_words(reader, "film", &found, err) && found &&
              data->x1 - data->x0 == WIDTH && data->y0 == CROP.y0 && data->y1 == CROP.y1 &&
              exr_reader_read_words(reader, words, CROP.y0, CROP.y1, rows, err);
    exr_reader_destroy(reader);
    return ok;
}

ARENA_TEST(every_prefix_is_refused) {
    const ExrWords *words = make_words(&arena);
    FileBytes file = encode(words, &arena);
    uint32_t *rows = ARENA_NEW(&arena, uint32_t, WIDTH *HEIGHT *WORDS);
    for (size_t size = 0; size < file.size; size += size < 3000 ? 1 : 61) {
        unsigned char *exact = malloc(size + (size == 0)); /* so that ASan sees a step beyond */
        Error err = {0};
        memcpy(exact, file.data, size);
        if (read_all(exact, size, words, rows, &err))
            fail_msg("%zu of %zu bytes were accepted", size, file.size);
        assert_true(err.text[0] && !strchr(err.text, '\n'));
        free(exact);
    }
}

ARENA_TEST(flipped_bits_are_survived) {
    const ExrWords *words = make_words(&arena);
    FileBytes file = encode(words, &arena);
    uint32_t *rows = ARENA_NEW(&arena, uint32_t, WIDTH *HEIGHT *WORDS), seed = 1;
    unsigned char *bytes = ARENA_NEW(&arena, unsigned char, file.size);
    for (int i = 0; i < 2000; i++) {
        Error err = {0};
        seed = seed * 1664525u + 1013904223u;
        memcpy(bytes, file.data, file.size);
        bytes[(seed >> 8) % (i % 4 ? 2000 : file.size)] ^= (unsigned char)(1u << (seed & 7));
        if (!read_all(bytes, file.size, words, rows, &err)) assert_null(strchr(err.text, '\n'));
    }
}

ARENA_TEST(a_part_of_another_kind_is_refused) {
    FileBytes file = encode(make_words(&arena), &arena);
    unsigned char *bytes = (unsigned char *)file.data;
    unsigned char *entry = memmem(bytes, file.size, "count\0\0\0\0\0", 10); /* UINT is 0 */
    const ExrWords *found;
    assert_non_null(entry);
    entry[6] = 2; /* FLOAT */
    ExrReader *reader = open_bytes(file);
    assert_fails(exr_reader_words(reader, "film", &found, &err),
                 "its part \"film\" does not hold 32-bit words of the picture's pixels");
    exr_reader_destroy(reader);
}

ARENA_TEST(a_word_that_is_missing_is_named) {
    static const char *const names[] = {"count", "sum.Z.0"};
    const ExrWords wanted = {"film", 2, names, NULL, 0, NULL, NULL};
    uint32_t *rows = ARENA_NEW(&arena, uint32_t, WIDTH *HEIGHT * 2);
    ExrReader *reader = open_bytes(encode(make_words(&arena), &arena));
    const ExrWords *found;
    assert_done(exr_reader_words(reader, "film", &found, &err));
    assert_fails(exr_reader_read_words(reader, &wanted, CROP.y0, CROP.y1, rows, &err),
                 "its part \"film\" has no words sum.Z.0");
    exr_reader_destroy(reader);
}

ARENA_TEST(a_zero_byte_ends_no_attribute) {
    FileBytes file = encode(NULL, &arena);
    char *text = memmem(file.data, file.size, "a picture", 9);
    text[1] = 0;
    ExrReader *reader = open_bytes(file);
    const ExrPicture *picture = exr_reader_picture(reader);
    for (int i = 0; i < picture->attribute_count; i++)
        if (!strcmp(picture->attributes[i].name, "comments"))
            assert_string_equal(picture->attributes[i].text, "a\1picture");
    exr_reader_destroy(reader);
}

TEST(what_is_no_openexr_file_is_told) {
    ExrReader *reader;
    Error err = {0};
    assert_false(exr_reader_open("no/such.exr", &reader, &err));
    assert_error_has(&err, "No such file");
    assert_string_equal(err.file, "no/such.exr");
    assert_true(file_write(in_folder("a.txt"), "hello", 5, &err));
    assert_false(exr_reader_open(in_folder("a.txt"), &reader, &err));
    assert_error_has(&err, "not an OpenEXR file");
    assert_true(file_write(in_folder("a.txt"), "\x76\x2f\x31\x01", 4, &err));
    assert_false(exr_reader_open(in_folder("a.txt"), &reader, &err));
    assert_error_has(&err, "damaged OpenEXR file");
    unlink(in_folder("a.txt"));
}

TEST_PROGRAM(make_folder, remove_folder)
