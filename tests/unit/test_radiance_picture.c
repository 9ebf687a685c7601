/* SPDX-License-Identifier: Apache-2.0 */
#include "frame_fixture.h"

#include "image/frame_view.h"
#include "image/light/light_file.h"
#include "image/light/radiance_picture.h"

/* What Radiance's tools make of a pixel's bytes: the middles of the codes' steps, weighed for
 * its default primaries, times 179 lm/W. */
static double luminance_of(const uint8_t code[4]) {
    if (!code[3]) return 0;
    double step = ldexp(1, code[3] - 136);
    return 179 * step *
           (0.265074126 * (code[0] + 0.5) + 0.670114631 * (code[1] + 0.5) +
            0.064811243 * (code[2] + 0.5));
}

static FrameImage fisheye_frame(int width, int height, Arena *arena) {
    FrameImage frame = uniform_frame(width, height, 0, arena);
    frame_set_fisheye(&frame, FISHEYE_EQUIDISTANT, arena);
    return frame;
}

static FileBytes written(const FrameImage *frame, const char *path, Arena *arena) {
    FileBytes bytes;
    Error err;
    assert_true(radiance_picture_write(path, frame, "parhelion render x", *arena, &err));
    assert_true(file_read(path, 1 << 24, arena, &bytes, &err));
    return bytes;
}

static float *plane(FrameImage *frame, int c) {
    const float *rgb[3];
    assert_true(frame_rgb(frame, "", rgb));
    return (float *)rgb[c];
}

/* Any colour, in the gamut or out of it, from far below a candela to the sun. */
MEMORY_TEST(radiance_sees_the_frames_luminance) {
    FrameImage frame = fisheye_frame(64, 64, arena);
    float *r = plane(&frame, 0), *g = plane(&frame, 1), *b = plane(&frame, 2);
    double sum = 0, count = 0;
    for (int i = 0; i < 4096; i++) {
        float scale = powf(10, (float)(i % 128) / 10 - 3);
        r[i] = scale * (float)fabs(sin(i * 1.7));
        g[i] = scale * (float)fabs(sin(i * 2.3 + 1));
        b[i] = scale * (float)(i % 5 ? fabs(sin(i * 3.1)) : -0.1);
    }
    const char *path = in_folder("a.hdr");
    FileBytes bytes = written(&frame, path, arena);
    const uint8_t *pixels = (const uint8_t *)bytes.data + bytes.size - 4096 * 4;
    for (int i = 0; i < 4096; i++) {
        double y = 0.2126 * (double)r[i] + 0.7152 * (double)g[i] + 0.0722 * (double)b[i];
        double ratio = luminance_of(pixels + 4 * i) / y;
        /* half a step of the components, whose weights are 1 together */
        assert_near(ratio, 1, 179 * ldexp(0.5001, pixels[4 * i + 3] - 136) / y);
        sum += ratio;
        count++;
    }
    assert_near(sum / count, 1, 3e-4);
}

MEMORY_TEST(dark_and_broken_pixels_are_black) {
    static const float CASES[][3] = {{0, 0, 0},   {-1, -2, -3},     {1, -1, 0},
                                     {NAN, 1, 1}, {INFINITY, 1, 1}, {1e-38f, 1e-38f, 1e-38f}};
    FrameImage frame = fisheye_frame(6, 6, arena);
    for (int i = 0; i < 6; i++)
        for (int c = 0; c < 3; c++) plane(&frame, c)[i] = CASES[i][c];
    const char *path = in_folder("b.hdr");
    FileBytes bytes = written(&frame, path, arena);
    const uint8_t *pixels = (const uint8_t *)bytes.data + bytes.size - 36 * 4;
    for (int i = 0; i < 24; i++) assert_int_equal(pixels[i], 0);
}

MEMORY_TEST(what_is_written_is_read_with_its_view) {
    FrameImage frame = fisheye_frame(40, 40, arena), back;
    LightFile file;
    Problems problems = problems_start(arena);
    Error err;
    for (int i = 0; i < 1600; i++)
        for (int c = 0; c < 3; c++) plane(&frame, c)[i] = (float)(1 + i % 37) * (float)(c + 3);
    const char *path = in_folder("c.hdr");
    written(&frame, path, arena);
    assert_true(light_file_read(path, arena, &problems, &file, &err));
    back = file.frame;
    assert_int_equal(frame_pixel_count(&back), 1600);
    for (int i = 0; i < 1600; i++) {
        double y = 0, wanted = 0;
        static const double weight[3] = {0.2126, 0.7152, 0.0722};
        for (int c = 0; c < 3; c++) {
            y += weight[c] * (double)plane(&back, c)[i];
            wanted += weight[c] * (double)plane(&frame, c)[i];
        }
        assert_close(y, wanted, 0.007);
    }
    FrameView view;
    assert_true(frame_view_find(&back, &view, &err));
    assert_int_equal(view.fisheye, FISHEYE_EQUIDISTANT);
    assert_close(view.half_width, 1, 1e-9);
}

/* Lines of the pictures that this one was made from are indented. */
MEMORY_TEST(the_last_view_of_the_header_counts) {
    static const unsigned char HEAD[] = "#?RADIANCE\n\tVIEW= -vta -vh 90 -vv 90\n"
                                        "VIEW= -vtv -vh 40 -vv 40\n"
                                        "VIEW= -vta -vh 180 -vv 180\n\tVIEW= -vtl\n"
                                        "FORMAT=32-bit_rle_rgbe\n\n-Y 1 +X 1\n\x80\x80\x80\x80";
    LightFile file;
    FrameView view;
    Problems problems = problems_start(arena);
    Error err;
    assert_true(light_file_read_memory((FileBytes){HEAD, sizeof HEAD - 1}, "x.hdr", arena,
                                       &problems, &file, &err));
    assert_true(frame_view_find(&file.frame, &view, &err));
    assert_int_equal(view.fisheye, FISHEYE_EQUIDISTANT);
    assert_close(plane(&file.frame, 1)[0], 179 * 128.5 / 256, 1e-6);
}

MEMORY_TEST(a_write_that_fails_leaves_nothing) {
    FrameImage frame = fisheye_frame(4, 4, arena);
    Error err;
    const char *path = in_folder("no/d.hdr");
    assert_false(radiance_picture_write(path, &frame, "x", *arena, &err));
    assert_int_equal(err.code, ERROR_OUTPUT);
    assert_int_equal(access(path, F_OK), -1);
    frame_set_fisheye(&frame, FISHEYE_EQUISOLID, arena);
    path = in_folder("e.hdr");
    assert_false(radiance_picture_write(path, &frame, "x", *arena, &err));
    assert_int_equal(access(path, F_OK), -1);
}

TEST_PROGRAM(make_folder, clear_folder)
