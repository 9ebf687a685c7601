/* SPDX-License-Identifier: Apache-2.0 */
/* Frames: what is written is read, whole or not at all. */
#include "fixture.h"

#include <sched.h>
#include <signal.h>
#include <sys/resource.h>
#include <sys/stat.h>

#include "image/frame.h"

/* Noise, which ZIP cannot make shorter, besides values that are no ordinary numbers. */
static void fill(float *values, size_t count, unsigned seed) {
    static const float ODD[] = {-1.5f, INFINITY, -INFINITY, 1e-40f, 3e38f, -0.0f};
    for (size_t i = 0; i < count; i++) {
        seed = seed * 1664525u + 1013904223u;
        values[i] = i < 6 ? ODD[i] : (float)seed * 1e-3f;
    }
    if (count > 6) values[6] = NAN;
}

static FrameImage make_frame(int width, int height, ExrWindow data, Arena *arena) {
    static const char *const NAMES[] = {
        "R", "G", "B", "depth.Z", "variance.R", "display.emitted.R", "display.theta"};
    static const double MATRIX[16] = {1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15, 16};
    static const double SECONDS = 0.5;
    FrameImage frame = frame_create(width, height, data, 1, 1, arena); /* and grows */
    size_t count = frame_pixel_count(&frame);
    for (unsigned i = 0; i < 7; i++)
        fill(frame_add_channel(&frame, NAMES[i], false, arena), count, i);
    float *id = frame_add_channel(&frame, "id.display", true, arena);
    for (size_t i = 0; i < count; i++) id[i] = i % 3 ? (float)i : -1;
    if (count > 1) id[1] = 16777216;
    frame_set_string(&frame, "parhelion:display.3", "cluster", arena);
    frame_set_string(&frame, "parhelion:version", "old", arena);
    frame_set_string(&frame, "parhelion:version", "new", arena);
    frame_set_number(&frame, "parhelion:a name longer than thirty-one letters", 0.1, arena);
    frame_set_whole(&frame, "parhelion:seed", -12345, arena);
    frame_set_values(&frame, "worldToCamera", EXR_MATRIX44, MATRIX, arena);
    frame_set_values(&frame, "expTime", EXR_FLOAT, &SECONDS, arena);
    return frame;
}

static FrameImage write_and_read(const FrameImage *frame, Arena *arena) {
    FrameImage back;
    assert_done(frame_write(in_folder("a.exr"), frame, &err));
    assert_done(frame_read(in_folder("a.exr"), arena, &back, &err));
    return back;
}

static void assert_same_channels(const FrameImage *a, const FrameImage *b) {
    assert_int_equal(a->channel_count, b->channel_count);
    for (int i = 0; i < a->channel_count; i++) {
        const float *values = frame_channel(b, a->channels[i].name);
        size_t bytes = frame_pixel_count(a) * sizeof(float);
        assert_non_null(values);
        assert_memory_equal(values, a->channels[i].values, bytes);
    }
}

ARENA_TEST(every_bit_comes_back) {
    static const int SIZES[][2] = {{1, 1}, {7, 3}, {64, 33}, {200, 70}};
    for (int i = 0; i < 4; i++) {
        int w = SIZES[i][0], h = SIZES[i][1];
        FrameImage frame = make_frame(w, h, (ExrWindow){0, 0, w, h}, &arena);
        FrameImage back = write_and_read(&frame, &arena);
        assert_memory_equal(&back.display, &frame.display, sizeof frame.display);
        assert_same_channels(&frame, &back);
    }
}

ARENA_TEST(a_crop_keeps_its_place) {
    ExrWindow crop = {13, 5, 40, 30};
    FrameImage frame = make_frame(64, 48, crop, &arena), back = write_and_read(&frame, &arena);
    assert_memory_equal(&back.data, &crop, sizeof crop);
    assert_int_equal(back.display.x1, 64);
    assert_int_equal(back.display.y1, 48);
    assert_same_channels(&frame, &back);
}

ARENA_TEST(attributes_come_back) {
    FrameImage frame = make_frame(4, 4, (ExrWindow){0, 0, 4, 4}, &arena);
    FrameImage back = write_and_read(&frame, &arena);
    assert_string_equal(frame_string(&back, "parhelion:version"), "new");
    const ExrAttribute *a =
        frame_attribute(&back, "parhelion:a name longer than thirty-one letters");
    assert_true(a->kind == EXR_DOUBLE && a->values[0] == 0.1);
    assert_true(frame_attribute(&back, "parhelion:seed")->values[0] == -12345);
    assert_true(frame_attribute(&back, "expTime")->values[0] == 0.5);
    assert_true(frame_attribute(&back, "whiteLuminance")->values[0] == 1);
    const ExrAttribute *c = frame_attribute(&back, "chromaticities");
    assert_int_equal(c->kind, EXR_CHROMATICITIES);
    assert_near(c->values[0], 0.64, 1e-6);
    assert_near(c->values[7], 0.3290, 1e-6);
    const ExrAttribute *m = frame_attribute(&back, "worldToCamera");
    for (int i = 0; i < 16; i++) assert_true(m->values[i] == i + 1);
    assert_null(frame_attribute(&back, "nothing"));
    assert_null(frame_string(&back, "expTime"));
    assert_int_equal(frame_id_of(&back, "display", "cluster"), 3);
    assert_int_equal(frame_id_of(&back, "display", "clust"), -1);
    assert_int_equal(frame_id_of(&back, "part", "cluster"), -1);
}

ARENA_TEST(layers_are_found_by_name) {
    FrameImage frame = make_frame(4, 4, (ExrWindow){0, 0, 4, 4}, &arena);
    const float *rgb[3];
    assert_true(frame_rgb(&frame, "", rgb));
    assert_ptr_equal(rgb[1], frame_channel(&frame, "G"));
    assert_false(frame_rgb(&frame, "variance", rgb));
    assert_null(frame_channel(&frame, "depth"));
}

ARENA_TEST(the_same_frame_makes_the_same_bytes) {
    FrameImage frame = make_frame(90, 400, (ExrWindow){0, 0, 90, 400}, &arena);
    FileBytes bytes[2];
    cpu_set_t all, one;
    assert_int_equal(sched_getaffinity(0, sizeof all, &all), 0);
    CPU_ZERO(&one);
    for (int c = 0; c < CPU_SETSIZE && !CPU_COUNT(&one); c++)
        if (CPU_ISSET(c, &all)) CPU_SET(c, &one);
    for (int i = 0; i < 2; i++) {
        sched_setaffinity(0, sizeof one, i ? &one : &all); /* then with one thread */
        assert_done(frame_write(in_folder("same.exr"), &frame, &err));
        bytes[i] = read_bytes(in_folder("same.exr"), &arena);
    }
    sched_setaffinity(0, sizeof all, &all);
    assert_int_equal(bytes[0].size, bytes[1].size);
    assert_memory_equal(bytes[0].data, bytes[1].data, bytes[0].size);
}

/* ---- writing that fails ------------------------------------------------------------------ */

ARENA_TEST(a_full_disk_leaves_nothing) {
    FrameImage frame = make_frame(90, 40, (ExrWindow){0, 0, 90, 40}, &arena);
    struct rlimit before, small;
    Error err = {0};
    int files = files_in_folder();
    signal(SIGXFSZ, SIG_IGN);
    getrlimit(RLIMIT_FSIZE, &before);
    small = before;
    small.rlim_cur = 5000; /* bytes that fit before the "disk" is full */
    setrlimit(RLIMIT_FSIZE, &small);
    bool done = frame_write(in_folder("full.exr"), &frame, &err);
    setrlimit(RLIMIT_FSIZE, &before);
    assert_false(done);
    assert_int_equal(err.code, ERROR_OUTPUT);
    assert_error_has(&err, "cannot be written");
    assert_non_null(strstr(err.file, "full.exr"));
    assert_int_equal(files_in_folder(), files);
}

ARENA_TEST(a_device_that_is_full_says_so) {
    FrameImage frame = make_frame(90, 40, (ExrWindow){0, 0, 90, 40}, &arena);
    struct stat info;
    if (stat("/dev/full", &info) != 0 || !S_ISCHR(info.st_mode)) skip();
    assert_fails(frame_write("/dev/full", &frame, &err), "No space left");
    assert_int_equal(stat("/dev/full", &info), 0);
    assert_true(S_ISCHR(info.st_mode));
}

ARENA_TEST(a_missing_folder_and_a_bad_window_are_told) {
    FrameImage frame = make_frame(9, 4, (ExrWindow){0, 0, 9, 4}, &arena);
    Error err = {0};
    assert_false(frame_write("no/such/folder/a.exr", &frame, &err));
    assert_int_equal(err.code, ERROR_OUTPUT);
    assert_string_equal(err.file, "no/such/folder/a.exr");
    frame.data.x1 = 10;
    assert_false(frame_write(in_folder("window.exr"), &frame, &err));
    assert_error_has(&err, "not inside the display window");
    assert_false(file_exists(in_folder("window.exr")));
}

/* ---- reading what is broken -------------------------------------------------------------- */

ARENA_TEST(refuses_every_prefix) {
    FrameImage frame = make_frame(5, 20, (ExrWindow){0, 0, 5, 20}, &arena), back;
    FileBytes whole;
    Error err = {0};
    assert_true(frame_write(in_folder("whole.exr"), &frame, &err));
    whole = read_bytes(in_folder("whole.exr"), &arena);
    for (size_t size = 0; size < whole.size; size++) {
        Arena before = arena;
        unsigned char *exact = malloc(size + (size == 0)); /* so that ASan sees a step beyond */
        memcpy(exact, whole.data, size);
        err.text[0] = '\0';
        if (frame_read_memory(exact, size, "cut.exr", &arena, &back, &err))
            fail_msg("%zu of %zu bytes were accepted", size, whole.size);
        assert_true(err.text[0] && !strchr(err.text, '\n'));
        assert_string_equal(err.file, "cut.exr");
        assert_ptr_equal(arena.next, before.next);
        free(exact);
    }
}

/* The library would take memory for what a file says, before it finds that it is not there. */
ARENA_TEST(an_attribute_larger_than_the_file_is_refused) {
    FrameImage frame = make_frame(5, 20, (ExrWindow){0, 0, 5, 20}, &arena), back;
    FileBytes whole;
    Error err = {0};
    static const char HEAD[] = "parhelion:version\0string";
    assert_true(frame_write(in_folder("whole.exr"), &frame, &err));
    whole = read_bytes(in_folder("whole.exr"), &arena);
    unsigned char *bytes = ARENA_NEW(&arena, unsigned char, whole.size);
    memcpy(bytes, whole.data, whole.size);
    unsigned char *size =
        (unsigned char *)memmem(bytes, whole.size, HEAD, sizeof HEAD) + sizeof HEAD;
    size[3] = 0x70;
    assert_false(frame_read_memory(bytes, whole.size, "large.exr", &arena, &back, &err));
    assert_error_has(&err, "attribute \"parhelion:version\" has 1879048195 bytes, the file");
    assert_string_equal(err.file, "large.exr");
}

ARENA_TEST(survives_flipped_bits) {
    FrameImage frame = make_frame(5, 20, (ExrWindow){0, 0, 5, 20}, &arena), back;
    FileBytes whole;
    Error err = {0};
    unsigned seed = 1;
    assert_true(frame_write(in_folder("whole.exr"), &frame, &err));
    whole = read_bytes(in_folder("whole.exr"), &arena);
    unsigned char *bytes = ARENA_NEW(&arena, unsigned char, whole.size);
    for (int i = 0; i < 3000; i++) {
        Arena scratch = arena;
        seed = seed * 1664525u + 1013904223u;
        memcpy(bytes, whole.data, whole.size);
        bytes[(seed >> 8) % (i % 2 ? whole.size : 1200)] ^= (unsigned char)(1u << (seed & 7));
        err.text[0] = '\0';
        if (!frame_read_memory(bytes, whole.size, "flipped.exr", &scratch, &back, &err))
            assert_true(err.text[0] && !strchr(err.text, '\n'));
    }
}

/* The corpus of the library's own makers: files found by fuzzing. */
TEST(damaged_files_are_read_or_refused) {
    char name[200], path[600];
    int refused = 0, total = 0;
    snprintf(name, sizeof name, "%s/exr/Damaged", SHARED_DATA_DIR);
    DIR *dir = opendir(name);
    if (!dir) skip();
    for (struct dirent *e; (e = readdir(dir));) {
        Arena arena = *test_memory();
        FrameImage frame;
        Error err = {0};
        if (e->d_name[0] == '.') continue;
        snprintf(path, sizeof path, "%s/%s", name, e->d_name);
        total++;
        if (!frame_read(path, &arena, &frame, &err)) {
            refused++;
            assert_string_equal(err.file, path);
            assert_true(err.text[0] && !strchr(err.text, '\n'));
        }
    }
    closedir(dir);
    print_message("%d of %d damaged files are refused\n", refused, total);
    assert_true(total > 50 && refused > total / 2);
}

ARENA_TEST(what_cannot_be_shown_flat_is_refused) {
    FrameImage frame;
    Error err = {0};
    char path[512];
    assert_false(frame_read_memory("hello, world", 12, "a.txt", &arena, &frame, &err));
    assert_error_has(&err, "not an OpenEXR file");
    assert_false(frame_read("no/such.exr", &arena, &frame, &err));
    assert_error_has(&err, "No such file");
    snprintf(path, sizeof path, "%s/exr/LuminanceChroma/Garden.exr", SHARED_DATA_DIR);
    if (!file_exists(path)) skip();
    assert_true(frame_read(path, &arena, &frame, &err)); /* luminance only: one plain channel */
}

/* The sampling of channel G in the header becomes 2 x 2, as in luminance-chroma coding. */
ARENA_TEST(coarse_channels_are_refused) {
    FrameImage frame = make_frame(8, 4, (ExrWindow){0, 0, 8, 4}, &arena), back;
    FileBytes file;
    assert_done(frame_write(in_folder("fine.exr"), &frame, &err));
    file = read_bytes(in_folder("fine.exr"), &arena);
    unsigned char *bytes = ARENA_NEW(&arena, unsigned char, file.size), *entry;
    memcpy(bytes, file.data, file.size);
    entry = memmem(bytes, file.size, "\0G\0\2\0\0\0", 7); /* name, then FLOAT */
    assert_non_null(entry);
    entry[11] = entry[15] = 2;
    assert_fails(frame_read_memory(bytes, file.size, "coarse.exr", &arena, &back, &err),
                 "channel G is sampled every 2 x 2 pixels");
}

ARENA_TEST(a_file_larger_than_the_arena_is_refused) {
    Arena small = arena_reserve(1 << 21);
    FrameImage frame = make_frame(300, 300, (ExrWindow){0, 0, 300, 300}, &arena), back;
    assert_done(frame_write(in_folder("large.exr"), &frame, &err));
    assert_fails_as(frame_read(in_folder("large.exr"), &small, &back, &err), ERROR_MEMORY,
                    "8 channels of 90000 pixels");
    arena_release(&small);
}

TEST_PROGRAM(make_folder, clear_folder)
