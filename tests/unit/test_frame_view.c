/* SPDX-License-Identifier: Apache-2.0 */
#include "frame_fixture.h"

#include "image/frame_view.h"

#define PI 3.14159265358979323846

static FrameImage fisheye_frame(int size, Fisheye kind, Arena *arena) {
    FrameImage frame = uniform_frame(size, size, 1, arena);
    frame_set_fisheye(&frame, kind, arena);
    return frame;
}

static FrameView view_of(const FrameImage *frame) {
    FrameView view;
    Error err;
    assert_true(frame_view_find(frame, &view, &err));
    return view;
}

static void sum_of(const FrameView *view, double out[2]) {
    out[0] = out[1] = 0;
    for (int y = 0; y < view->height; y++)
        for (int x = 0; x < view->width; x++) {
            ViewPixel p = frame_view_pixel(view, x, y);
            out[0] += p.sr;
            out[1] += p.projected_sr;
            if (!frame_view_sees(view, x, y)) assert_near(p.sr, 0, 1e-12);
        }
}

MEMORY_TEST(a_fisheye_has_half_the_space) {
    static const int SIZES[] = {1, 2, 3, 16, 101};
    for (Fisheye kind = FISHEYE_EQUIDISTANT; kind <= FISHEYE_EQUISOLID; kind++)
        for (int i = 0; i < 5; i++) {
            FrameImage frame = fisheye_frame(SIZES[i], kind, arena);
            FrameView view = view_of(&frame);
            double sums[2];
            sum_of(&view, sums);
            assert_close(sums[0], 2 * PI, i ? 1e-6 : 1e-3);
            assert_close(sums[1], PI, i ? 1e-6 : 1e-3);
        }
}

MEMORY_TEST(equal_areas_of_an_equisolid_one_are_equal_solid_angles) {
    FrameImage frame = fisheye_frame(40, FISHEYE_EQUISOLID, arena);
    FrameView view = view_of(&frame);
    for (int x = 3; x < 37; x++)
        assert_close(frame_view_pixel(&view, x, 20).sr, 2 * (2 / 40.0) * (2 / 40.0), 1e-9);
}

/* Its density: the sine of the angle over the radius, 90 degrees to a radius. */
MEMORY_TEST(small_pixels_have_the_density_of_their_middle) {
    FrameImage frame = fisheye_frame(2001, FISHEYE_EQUIDISTANT, arena);
    FrameView view = view_of(&frame);
    for (int x = 130; x < 1000; x += 97) {
        ViewPixel p = frame_view_pixel(&view, x, 700);
        double u = 2 * (x + 0.5) / 2001 - 1, v = 1 - 2 * 700.5 / 2001, r = hypot(u, v);
        double a = r * PI / 2, area = (2 / 2001.0) * (2 / 2001.0);
        assert_close(p.sr, sin(a) / r * PI / 2 * area, 1e-6);
        assert_close(p.projected_sr, p.sr * cos(a), 1e-5);
        assert_close(p.direction[0], sin(a) * u / r, 1e-9);
        assert_close(p.direction[1], sin(a) * v / r, 1e-9);
        assert_close(p.direction[2], cos(a), 1e-9);
    }
}

/* A rectangle a x b at distance d: 4 atan(a b / (2 d sqrt(4 d^2 + a^2 + b^2))). */
MEMORY_TEST(a_perspective_view_has_the_solid_angle_of_its_rectangle) {
    for (double fov = 20; fov < 150; fov += 30) {
        FrameImage frame = uniform_frame(60, 40, 1, arena);
        frame_set_number(&frame, "parhelion:yfov_deg", fov, arena);
        FrameView view = view_of(&frame);
        double b = 2 * tan(fov * PI / 360), a = b * 1.5, sums[2];
        sum_of(&view, sums);
        assert_close(sums[0], 4 * atan(a * b / (2 * sqrt(4 + a * a + b * b))), 1e-6);
        /* the view factor of the rectangle from a point that faces its middle */
        double x = a / 2, y = b / 2, f = sqrt(1 + x * x), g = sqrt(1 + y * y);
        assert_close(sums[1], 2 * (x / f * atan(y / f) + y / g * atan(x / g)), 1e-6);
    }
}

/* ---- Radiance's words ------------------------------------------------------------------- */

static FrameView parsed(const char *words, int width, int height, Arena *arena) {
    FrameImage frame = uniform_frame(width, height, 1, arena);
    frame_set_string(&frame, "VIEW", words, arena);
    return view_of(&frame);
}

MEMORY_TEST(a_view_written_is_the_view_read) {
    /* a camera at (3, -1, 2) that looks along +X: right is +Z, rows are for row vectors */
    static const double MATRIX[16] = {0, 0, -1, 0, 0, 1, 0, 0, 1, 0, 0, 0, -2, 1, 3, 1};
    const ExrWindow crop = {10, 4, 34, 22};
    for (int kind = 0; kind < 3; kind++) {
        FrameImage frame = uniform_frame(60, kind == 1 ? 60 : 40, 1, arena);
        frame_set_values(&frame, "worldToCamera", EXR_MATRIX44, MATRIX, arena);
        if (kind == 0) frame_set_number(&frame, "parhelion:yfov_deg", 50, arena);
        if (kind == 1) frame_set_fisheye(&frame, FISHEYE_EQUIDISTANT, arena);
        if (kind == 2) frame_set_number(&frame, "parhelion:ymag_m", 1.5, arena);
        FrameView whole = view_of(&frame);
        const char *words;
        Error err;
        assert_close(whole.eye[0], 3, 1e-12);
        assert_close(whole.eye[1], -1, 1e-12);
        assert_close(whole.ahead[0], 1, 1e-12);
        assert_true(frame_view_words(&whole, crop, arena, &words, &err));
        FrameView part = parsed(words, crop.x1 - crop.x0, crop.y1 - crop.y0, arena);
        assert_close(part.eye[2], 2, 1e-8);
        assert_close(part.right[2], 1, 1e-8);
        assert_close(part.up[1], 1, 1e-8);
        for (int x = 0; x < 24 && kind < 2; x += 7) {
            ViewPixel a = frame_view_pixel(&part, x, 5), b;
            b = frame_view_pixel(&whole, x + crop.x0, 5 + crop.y0);
            assert_close(a.sr, b.sr, 1e-6);
            for (int c = 0; c < 3; c++) assert_near(a.direction[c], b.direction[c], 1e-7);
        }
    }
}

MEMORY_TEST(a_fisheye_of_others_may_be_wider_than_its_circle) {
    FrameView view = parsed(" -vta -vv 200 -vh 200 -vd 0 1 0 -vu 0 0 1", 50, 50, arena);
    double sums[2];
    sum_of(&view, sums);
    assert_close(sums[0], 2 * PI, 1e-6);
    assert_close(view.half_width, 200 / 180.0, 1e-12);
    assert_false(frame_view_sees(&view, 1, 25));
}

MEMORY_TEST(a_wrong_view_is_told) {
    static const char *const CASES[][2] = {
        {"-vth -vh 180 -vv 180", "-vth, required: -vta"},
        {"-vtv -vh 200 -vv 20", "required: angles below 180"},
        {"-vta -vh nan", "'-vh nan'"},
        {"-vta -vd 0 0 1 -vu 0 0 2", "not along one line"},
        {"-vtv -vq 4", "'-vq 4', required: an option of a view"},
        {"-vta -vh 180,5 -vv 180", "'-vh 180,5 "},
        {"-vta -vh 180x", "'-vh 180x'"},
        {"-vta -vh 0x1p7", "'-vh 0x1p7'"},
        {"-vta -vh inf", "'-vh inf'"},
        {"-vta -vh 1e999", "'-vh 1e999'"},
        {"-vta -vh 180 5", "'-vh 180 5'"},
        {"-vta -vp 1,2,3", "'-vp 1,2,3'"},
        {"-vta -vp 1 2", "'-vp 1 2'"},
        {"-vta -vp 1 2 3 4", "'-vp 1 2 3 4'"},
        {"-vta -vh 1\1garbage", "'-vh 1"},
    };
    for (size_t i = 0; i < sizeof CASES / sizeof *CASES; i++) {
        FrameImage frame = uniform_frame(4, 4, 1, arena);
        FrameView view;
        Error err;
        frame_set_string(&frame, "VIEW", CASES[i][0], arena);
        assert_false(frame_view_find(&frame, &view, &err));
        if (!strstr(err.text, CASES[i][1])) fail_msg("%s: %s", CASES[i][0], err.text);
    }
}

MEMORY_TEST(radiance_has_no_equisolid_view) {
    FrameImage frame = fisheye_frame(8, FISHEYE_EQUISOLID, arena);
    FrameView view = view_of(&frame);
    const char *words;
    Error err;
    assert_false(frame_view_words(&view, frame.data, arena, &words, &err));
    assert_non_null(strstr(err.text, "no equisolid views"));
}

TEST_PROGRAM(make_arena, drop_arena)
