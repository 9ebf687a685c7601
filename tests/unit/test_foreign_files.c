/* SPDX-License-Identifier: Apache-2.0 */
/* Files of others are looked over before a library opens them: none waits, grows or prints. */
#include "fixture.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <zlib.h>

#include "base/count.h"
#include "image/image.h"
#include "opencolorio/ocio_file.h"
#include "opencolorio/view_transform.h"

extern const char OWN_OCIO_CONFIG[];

/* ---- configurations of OpenColorIO ------------------------------------------------------- */

/* A table is named by a colour space, a look or a view: %1$s is its file, %2$s where the
 * transform stands. */
static const char config[] =
    "ocio_profile_version: 2\nsearch_path: .:/dev\nroles:\n  scene_linear: lin\n"
    "  aces_interchange: lin\n  default: lin\nfile_rules:\n"
    "  - !<Rule> {name: Default, colorspace: lin}\ndisplays:\n  d:\n"
    "    - !<View> {name: v, colorspace: lin}\nactive_displays: []\nactive_views: []\n"
    "looks:\n  - !<Look>\n    name: k\n    process_space: lin\n    transform: %s\n"
    "colorspaces:\n  - !<ColorSpace>\n    name: lin\n  - !<ColorSpace>\n    name: out\n"
    "    from_scene_reference: %s\n    to_scene_reference: %s\n";

static bool open_config(const char *path, Error *err) {
    ViewTransform *transform = NULL;
    const ViewRequest request = {path, OWN_OCIO_CONFIG, NULL, NULL, ocio_file_check};
    bool ok = view_transform_create(&request, &transform, err);
    view_transform_destroy(transform);
    return ok;
}

/* In each of the places, by itself and within a group. */
static void check_table(const char *name, const char *words, Arena arena) {
    const char *plain = "!<MatrixTransform> {}";
    const char *file = arena_format(&arena, "!<FileTransform> {src: %s}", name);
    const char *group = arena_format(&arena, "!<GroupTransform> {children: [%s]}", file);
    const char *path = arena_format(&arena, "%s", in_folder("a.ocio"));
    for (int place = 0; place < 6; place++) {
        const char *at[3] = {plain, plain, plain};
        Error why = {0};
        at[place / 2] = place % 2 ? group : file;
        write_text(path, arena_format(&arena, config, at[0], at[1], at[2]));
        bool opened = open_config(path, &why);
        if (opened != !words) fail_msg("%s at %d: %s: %s", name, place, why.file, why.text);
        if (words && (!strstr(why.text, words) || !strstr(why.file, name)))
            fail_msg("%s at %d: %s: %s", name, place, why.file, why.text);
    }
}

ARENA_TEST(a_configuration_and_its_tables_are_regular_files) {
    static const struct {
        const char *name, *text, *words;
    } tables[] = {
        {"fifo.cube", NULL, "not a regular file"},
        {"zero", NULL, "not a regular file"},
        {"folder", NULL, "is a folder"},
        {"none.cube", NULL, NULL},
        {"good.cube", "LUT_1D_SIZE 2\n0 0 0\n1 1 1\n", NULL},
        {"good.spi1d", "Version 1\nFrom 0 1\nLength 2\nComponents 1\n{\n0\n1\n}\n", NULL},
        {"long.spi1d", "Version 1\nFrom 0 1\nLength 2000000000\nComponents 1\n{\n0\n1\n}\n",
         "has Length 2e+09 in"},
        {"good.clf", "<?xml version=\"1.0\"?><ProcessList id=\"Reference\"/>", NULL},
        {"further.ctf",
         "\xEF\xBB\xBF<?xml version=\"1.0\"?>\n<ProcessList id=\"a\">"
         "<reference path=\"/dev/zero\"/></ProcessList>",
         "refers to another file"},
        {"grows.clf", "\n <!DOCTYPE p [<!ENTITY a \"aaaa\">]><ProcessList id=\"&a;\"/>",
         "has a document type"},
    };
    mkfifo(in_folder("fifo.cube"), 0600);
    mkdir(in_folder("folder"), 0700);
    for (int i = 0; i < COUNT_OF(tables); i++) {
        if (tables[i].text) write_text(in_folder(tables[i].name), tables[i].text);
        check_table(tables[i].name, tables[i].words, arena);
    }
    Error why = {0};
    write_bytes(in_folder("wide.ctf"), "<\0P\0", 4);
    assert_false(ocio_file_check(in_folder("wide.ctf"), &why));
    assert_error_has(&why, "has zero bytes");
    mkfifo(in_folder("fifo.ocio"), 0600);
    assert_false(open_config(in_folder("fifo.ocio"), &why));
    assert_false(open_config("/dev/zero", &why));
}

/* ---- pictures ---------------------------------------------------------------------------- */

static size_t put_part(unsigned char *to, const char *type, const void *data, size_t size) {
    const unsigned char length[4] = {0, 0, (unsigned char)(size >> 8), (unsigned char)size};
    memcpy(to, length, 4);
    memcpy(to + 4, type, 4);
    if (size) memcpy(to + 8, data, size);
    uLong sum = crc32(0, to + 4, (uInt)(4 + size));
    for (int i = 0; i < 4; i++) to[8 + size + (size_t)i] = (unsigned char)(sum >> (24 - 8 * i));
    return 12 + size;
}

/* 2 x 2 pixels of a depth and kind of colour, with a part before the pixels' `data`. */
static size_t make_png(unsigned char *to, unsigned depth, unsigned colour, const char *type,
                       const char *data) {
    unsigned char head[13] = {0, 0, 0, 2, 0, 0, 0, 2, (unsigned char)depth, (unsigned char)colour};
    size_t at = 8;
    memcpy(to, "\x89PNG\r\n\x1a\n", 8);
    at += put_part(to + at, "IHDR", head, sizeof head);
    if (type) at += put_part(to + at, type, "\0\5\0\0\0\0", 6);
    at += put_part(to + at, "IDAT", data, strlen(data));
    return at + put_part(to + at, "IEND", NULL, 0);
}

/* What the call prints to stderr goes to a file: its size. */
static off_t printed(const unsigned char *bytes, size_t size, Arena arena, Error *err) {
    struct stat info;
    Image image;
    int to = open(in_folder("stderr"), O_RDWR | O_CREAT | O_TRUNC, 0600), before = dup(2);
    dup2(to, 2);
    bool reads = image_read_memory(bytes, size, "a.png", &arena, &image, err);
    dup2(before, 2);
    assert_false(reads);
    assert_int_equal(fstat(to, &info), 0);
    close(to);
    close(before);
    return info.st_size;
}

ARENA_TEST(a_damaged_png_is_told_in_one_line) {
    static const struct {
        unsigned depth, colour;
        const char *type, *data;
    } rows[] = {{8, 2, NULL, "x"},        {8, 0, NULL, "\x78\x9c\x03"},
                {16, 2, NULL, "garbage"}, {8, 3, NULL, "x"},
                {1, 0, NULL, "x"},        {8, 3, "PLTE", "x"},
                {8, 2, "ABCD", "x"},      {8, 6, "tRNS", "x"},
                {16, 4, "PLTE", "x"},     {8, 2, "tRNS", "\x78\x9c\x03"}};
    for (int i = 0; i < COUNT_OF(rows); i++) {
        unsigned char bytes[256];
        Error why = {0};
        size_t size = make_png(bytes, rows[i].depth, rows[i].colour, rows[i].type, rows[i].data);
        if (printed(bytes, size, arena, &why)) fail_msg("row %d prints a line of its own", i);
        assert_error_has(&why, "damaged png picture: ");
    }
}

TEST_PROGRAM(make_folder, clear_folder)
