/* SPDX-License-Identifier: Apache-2.0 */
/* Figures of displays: worked examples, closed forms, what stands where there are none. */
#include "fixture.h"

#include "image/layer_view.h"
#include "image/legibility.h"

#define WIDE 4

/* Luminances of one grey light. */
static DisplayLight grey(double white, double black, double shown, double reflected)
{
    DisplayLight light = {white, black, {0}, {0}};
    static const double D65[3] = {0.95047, 1, 1.08883};
    for (int c = 0; c < 3; c++) {
        light.shown[c] = shown * D65[c];
        light.reflected[c] = reflected * D65[c];
    }
    return light;
}

TEST(the_ambient_contrast_of_a_worked_example)
{
    /* 1 % of 5 klx of sky, luminance factor 1.5 % of 45 klx of sun, over pi */
    double       reflected = (0.01 * 5000 + 0.015 * 45000) / acos(-1);
    DisplayLight light = grey(1000, 1, 500, reflected);
    assert_near(reflected, 230.775, 5e-4);
    assert_near(legibility_contrast(&light), 5.310, 5e-4);
    assert_near(legibility_weber(&light), 4.310, 5e-4);
    assert_near(legibility_michelson(&light), 4.310 / 6.310, 5e-4);
    assert_near(legibility_luminance_error(&light), 230.775 / 500, 1e-5);
    assert_near(legibility_colour_error(&light), 0, 1e-12);
}

TEST(contrasts_follow_from_each_other)
{
    for (double reflected = 0; reflected < 5000; reflected = 3 * reflected + 0.7) {
        DisplayLight light = grey(400, 0.5, 30, reflected);
        double       ratio = legibility_contrast(&light);
        assert_close(legibility_weber(&light), ratio - 1, 1e-9);
        assert_close(legibility_michelson(&light), (ratio - 1) / (ratio + 1), 1e-9);
    }
}

TEST(what_is_seen_as_it_is_shown_has_no_error)
{
    DisplayLight dark = grey(400, 0, 0, 0), bright = grey(400, 0.5, 30, 0);
    assert_true(legibility_luminance_error(&dark) == 0);
    assert_true(legibility_luminance_error(&bright) == 0);
    assert_true(legibility_colour_error(&bright) == 0);
    dark.reflected[1] = 1;
    assert_true(isinf(legibility_luminance_error(&dark)));
}

/* Half of one light and half of another lies between the two: in u', v' weighed by the sums
 * X + 15 Y + 3 Z, so that equal sums meet in the middle. */
TEST(the_error_of_colour_is_the_way_in_u_and_v)
{
    DisplayLight light = {1, 0, {1, 0, 0}, {0, 1 / 15.0, 0}};
    /* X alone has u' 4, v' 0, Y alone 0 and 0.6 */
    assert_near(legibility_colour_error(&light), hypot(4, 0.6) / 2, 1e-12);
}

/* ---- as layers --------------------------------------------------------------------------- */

/* One row of pixels; the last shows no display. */
static FrameImage a_frame(const char *const *layers, int count, Arena *arena)
{
    FrameImage frame = frame_create(WIDE, 1, (ExrWindow){0, 0, WIDE, 1}, 20, 0, arena);
    for (int k = 0; k < count; k++)
        for (int c = 0; c < 3; c++) {
            float *plane = frame_add_channel(
                &frame, arena_format(arena, "%s.%c", layers[k], "RGB"[c]), false, arena);
            for (int i = 0; i < WIDE; i++)
                plane[i] = i == WIDE - 1 ? NAN : (float)((k + 1) * (i + 1));
        }
    return frame;
}

ARENA_TEST(a_frame_has_them_as_layers)
{
    static const char *const LAYERS[] = {"display.black", "display.reflected",
                                         "display.emitted", "display.white"};
    FrameImage frame = a_frame(LAYERS, 4, &arena);
    LayerView  view;
    assert_done(layer_view_find(&frame, "display.weber", &arena, &view, &err));
    assert_true(view.show == SHOW_NUMBER && view.has_gaps && view.is_log);
    for (int i = 0; i < WIDE - 1; i++) assert_near(view.planes[0][i], (4.0 - 1) / 3, 1e-6);
    assert_true(isnan(view.planes[0][WIDE - 1]));
    assert_done(layer_view_find(&frame, "display.luminance_error", &arena, &view, &err));
    assert_near(view.planes[0][1], 2 / 3.0, 1e-6);
    assert_done(layer_view_find(&frame, "display.colour_error", &arena, &view, &err));
    assert_near(view.planes[0][1], 0, 1e-6);
    assert_fails_as(layer_view_find(&frame, "display.webber", &arena, &view, &err), ERROR_USAGE,
                    "display.white, display.contrast, display.weber");
}

ARENA_TEST(what_a_figure_lacks_is_told)
{
    static const char *const LAYERS[] = {"display.black", "display.reflected"};
    FrameImage frame = a_frame(LAYERS, 2, &arena);
    LayerView  view;
    assert_true(!layer_view_find(&frame, "display.weber", &arena, &view, why()));
    assert_string_equal(why()->text, "has no layer \"display.white\", from which "
                                  "\"display.weber\" follows; render it with --layers display");
}

TEST_PROGRAM(make_arena, drop_arena)
