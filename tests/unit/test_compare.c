/* SPDX-License-Identifier: Apache-2.0 */
/* Two sides of a comparison: what is read, what always differs, limits, which pixels count. */
#include "compare_fixture.h"
#include "base/count.h"
#include "compare/metrics.h"

/* ---- reading ----------------------------------------------------------------------------- */

ARENA_TEST(a_written_frame_is_read_as_light) {
    CompareInput made = frame_input("x", &arena), read, again;
    const char *path = in_folder("a.exr");
    assert_done(frame_write(path, &made.frame, &err));
    assert_done(input_read(path, 0, &arena, &read, &err));
    assert_int_equal(read.kind, INPUT_FRAME);
    assert_int_equal(read.file, LIGHT_FILE_OPENEXR);
    for (int i = 0; i < COUNT; i++) assert_near(read.light.rgb[0][i], i, 0);
    assert_done(input_read(path, 0, &arena, &again, &err));
    Comparison c = compared(&read, &again, (CompareOptions){0}, &arena);
    assert_true(c.same);
    assert_string_equal(c.verdict, "A: equal in every pixel");
    unlink(path);
    assert_fails_as(input_read(path, 0, &arena, &read, &err), ERROR_INPUT, "");
}

/* 8-bit codes and the same ones in 16 bits are the same fractions, bit for bit. */
ARENA_TEST(codes_of_8_and_16_bits_agree) {
    Picture picture = picture_create(16, 16, &arena);
    CompareInput read[2];
    for (int i = 0; i < 16 * 16 * 3; i++) picture.rgb[i] = (float)(i % 256) / 255;
    for (int k = 0; k < 2; k++) {
        const char *path = in_folder(k ? "16.png" : "8.png");
        PictureFile file = {.bits = k ? 16 : 8, .is_srgb = true};
        assert_done(picture_write(path, &picture, file, arena, &err));
        assert_done(input_read(path, 0, &arena, &read[k], &err));
        assert_int_equal(read[k].bits, k ? 16 : 8);
        unlink(path);
    }
    for (int i = 0; i < 16 * 16; i++) {
        for (int c = 0; c < 3; c++) {
            assert_true(read[0].codes.rgb[c][i] == read[1].codes.rgb[c][i]);
            assert_near(read[0].codes.rgb[c][i], picture.rgb[3 * i + c], 1e-6);
        }
        assert_near(srgb_from_linear(read[0].light.rgb[1][i]), read[0].codes.rgb[1][i], 1e-6);
    }
    Comparison c = compared(&read[0], &read[1], (CompareOptions){.groups = GROUP_MSE}, &arena);
    assert_true(c.same && has_note(&c, "8 bits, the test 16"));
}

ARENA_TEST(a_frame_against_a_picture_is_refused) {
    Error err = {0};
    CompareInput frame = frame_input("f.exr", &arena);
    CompareInput picture = picture_input("p.png", 8, &arena);
    Comparison c;
    CompareOptions options = {.threads = 1};
    for (int k = 0; k < 2; k++) {
        assert_false(compare_inputs(k ? &picture : &frame, k ? &frame : &picture, &options, &arena,
                                    &c, &err));
        assert_int_equal(err.code, ERROR_INPUT);
        assert_string_equal(err.file, "p.png");
        assert_non_null(strstr(err.text, "parhelion develop f.exr"));
    }
}

/* ---- structure --------------------------------------------------------------------------- */

ARENA_TEST(metadata_that_decides_fails_and_the_rest_explains) {
    CompareInput a = frame_input("a", &arena), b = frame_input("b", &arena);
    frame_set_string(&b.frame, "parhelion:seed", "2", &arena);
    frame_set_string(&b.frame, "parhelion:inputs", "00ac  a.gltf\n00cc  c.png\n", &arena);
    Comparison c = compared(&a, &b, LOOSE, &arena);
    assert_true(c.same);
    assert_int_equal(c.notes.count, 1);
    assert_true(has_note(&c, "other metadata: seed (1, now 2), inputs (a.gltf, b.png (gone) and 1 "
                             "more)"));
    frame_set_string(&b.frame, "parhelion:seed", "1", &arena);
    c = compared(&a, &b, LOOSE, &arena);
    assert_text_has(c.verdict, ". Inputs changed: a.gltf, b.png (gone), c.png (new)");
    frame_set_string(&b.frame, "parhelion:seed", "2", &arena);
    frame_set_string(&a.frame, "parhelion:inputs", "00aa  here/a.gltf\n00bb  b.png\n", &arena);
    frame_set_string(&b.frame, "parhelion:inputs", "00aa  /there/a.gltf\n00bd  b.png\n", &arena);
    c = compared(&a, &b, LOOSE, &arena);
    assert_false(has_note(&c, "a.gltf"));
    assert_true(has_note(&c, "seed (1, now 2), inputs (b.png)"));
    CompareOptions strict = LOOSE;
    strict.rules.strict = true;
    c = compared(&a, &b, strict, &arena);
    assert_reason(&c, "seed (1, now 2), inputs (b.png) (--strict)");
    const char *const ignored[] = {"seed", "parhelion:inputs"};
    strict.rules.ignored = ignored;
    strict.rules.ignored_count = 2;
    assert_true(compared(&a, &b, strict, &arena).same);
    frame_set_whole(&b.frame, "parhelion:maxBounces", 3, &arena);
    c = compared(&a, &b, LOOSE, &arena);
    assert_reason(&c, "maxBounces (only in the test)");
    frame_set_whole(&a.frame, "parhelion:maxBounces", 2, &arena);
    c = compared(&a, &b, LOOSE, &arena);
    assert_reason(&c, "maxBounces (2, now 3)");
}

/* However many keys differ, they are one line of what decides and one of what explains. */
ARENA_TEST(many_differences_of_metadata_are_two_lines) {
    CompareInput a = frame_input("a", &arena), b = frame_input("b", &arena);
    for (int i = 0; i < 300; i++) {
        const char *part = arena_format(&arena, "parhelion:part.%d", i);
        frame_set_string(&a.frame, part, "one", &arena);
        frame_set_string(&b.frame, part, "other", &arena);
        frame_set_string(&b.frame, arena_format(&arena, "note%d", i), "x", &arena);
    }
    frame_set_string(&b.frame, "parhelion:camera", "side", &arena);
    Comparison c = compared(&a, &b, LOOSE, &arena);
    assert_int_equal(c.reasons.count, 1);
    assert_int_equal(c.notes.count, 1);
    assert_reason(&c, "other metadata that decides what the picture shows: camera (eye, now side), "
                      "part.* (300 of them)");
    assert_true(has_note(&c, "other metadata: note0 (only in the test), "));
    assert_true(has_note(&c, " and 292 more"));
    assert_int_equal(c.structure.metadata_count - 7, 600);
}

/* Frames are of Rec.709, whether they say so or not. */
ARENA_TEST(what_is_implied_need_not_be_said) {
    CompareInput a = frame_input("a", &arena), b = frame_input("b", &arena);
    for (int i = 0; i < a.frame.attribute_count; i++)
        if (!strcmp(a.frame.attributes[i].name, "chromaticities"))
            a.frame.attributes[i].name = "elsewhere";
    Comparison c = compared(&a, &b, LOOSE, &arena);
    assert_true(c.same && has_note(&c, "chromaticities (only in the test)"));
}

/* Layers of one side are one line and no failure; a picture without one of its colours is. */
ARENA_TEST(layers_of_one_side_are_left_out) {
    CompareInput a = frame_input("a", &arena), b = frame_input("b", &arena);
    for (const char *x = "BGR"; *x; x++) {
        frame_add_channel(&a.frame, arena_format(&arena, "light.sun.%c", *x), 0, &arena);
        frame_add_channel(&b.frame, arena_format(&arena, "light.lamp.%c", *x), 0, &arena);
    }
    for (const char *x = "XYZ"; *x; x++)
        frame_add_channel(&a.frame, arena_format(&arena, "normal.%c", *x), 0, &arena);
    frame_add_channel(&a.frame, "id.part", true, &arena);
    frame_set_string(&a.frame, "parhelion:part.0", "wheel", &arena); /* goes with its layer */
    Comparison c = compared(&a, &b, LOOSE, &arena);
    assert_true(c.same);
    assert_true(has_note(&c, "only the reference has light.sun, normal, id; only the test has "
                             "light.lamp"));
    CompareOptions options = LOOSE;
    options.rules.strict = true;
    c = compared(&a, &b, options, &arena);
    assert_reason(&c, "only the test has light.lamp (--strict)");
    const char *const ignored[] = {"light", "normal", "id", "part"};
    options.rules = (CompareRules){ignored, 4, true};
    assert_true(compared(&a, &b, options, &arena).same);
    frame_add_channel(&b.frame, "A", false, &arena);
    c = compared(&a, &b, LOOSE, &arena);
    assert_reason(&c, "channels are missing in the reference: A");
}

ARENA_TEST(windows_and_sizes_must_agree) {
    CompareInput a = frame_input("a", &arena), b = frame_input("b", &arena);
    b.frame.display = (ExrWindow){1, 0, WIDTH + 1, HEIGHT};
    Comparison c = compared(&a, &b, LOOSE, &arena);
    assert_reason(&c, "other display window: 0,0,12,8, now 1,0,13,8");
    assert_false(c.has_pixels);
    b = frame_input("b", &arena);
    b.light.width--;
    c = compared(&a, &b, LOOSE, &arena);
    assert_reason(&c, "other size: 12 x 8 pixels, now 11 x 8");
}

/* ---- NaN and infinity -------------------------------------------------------------------- */

ARENA_TEST(what_is_no_number_in_light_always_fails) {
    const float wrong[] = {NAN, INFINITY, -INFINITY};
    for (int k = 0; k < 9; k++) {
        CompareInput a = frame_input("a", &arena), b = frame_input("b", &arena);
        if (k / 3 != 0) channel(&a, "G")[17] = wrong[k % 3];
        if (k / 3 != 1) channel(&b, "G")[17] = wrong[k % 3];
        Comparison c = compared(&a, &b, LOOSE, &arena);
        assert_reason(&c, "channel G has 1 values in the ");
        assert_reason(&c, "the first at pixel 5,1");
        assert_true(isfinite(c.value[METRIC_MSE]));
        CompareOptions part = LOOSE;
        part.selection.region_count = 1;
        part.selection.regions = &(const ExrWindow){0, 2, WIDTH, HEIGHT};
        c = compared(&a, &b, part, &arena);
        assert_true(c.same && has_note(&c, "in pixels that do not count"));
    }
}

/* Off displays NaN is legal. Frames of other noise may disagree at a rim (one pixel beside the
 * display), and where a sliver shows; not about an area, here of 3 x 3 pixels. */
ARENA_TEST(gaps_of_surface_layers_must_coincide) {
    CompareInput a = frame_input("a", &arena);
    assert_true(compared(&a, &a, LOOSE, &arena).same);
    for (int area = 0; area < 2; area++) {
        for (int seed = 1; seed <= 2; seed++) {
            CompareInput b = frame_input("b", &arena);
            float *shown = channel(&b, "display.emitted.R");
            if (!area) shown[3] = shown[4 * WIDTH + 1] = 5;
            for (int i = 0; i < 9 && area; i++) shown[(i / 3 + 2) * WIDTH + i % 3] = 5;
            frame_set_string(&b.frame, "parhelion:seed", seed == 1 ? "1" : "2", &arena);
            Comparison c = compared(&a, &b, LOOSE, &arena);
            assert_int_equal(c.same, !area && seed == 2);
            if (!c.same) assert_reason(&c, "1 channel is NaN or infinite on one side only");
            assert_int_equal(compared(&b, &a, LOOSE, &arena).same, !area && seed == 2);
        }
    }
}

/* Too few samples to show the noise are no fault of the light. */
ARENA_TEST(noise_may_be_unknown) {
    static const char *const LAYERS[] = {"halves.R", "display.halves.R"};
    for (int i = 0; i < 2; i++) {
        CompareInput a = frame_input("a", &arena), b = frame_input("b", &arena);
        frame_add_channel(&a.frame, LAYERS[i], false, &arena)[7] = NAN;
        frame_add_channel(&b.frame, LAYERS[i], false, &arena);
        frame_set_string(&b.frame, "parhelion:samples", "0:17", &arena);
        assert_true(compared(&a, &a, LOOSE, &arena).same);
        assert_true(compared(&a, &b, LOOSE, &arena).same);
        frame_set_string(&b.frame, "parhelion:samples", "0:16", &arena);
        Comparison c = compared(&a, &b, LOOSE, &arena);
        assert_reason(&c, arena_format(&arena, "in up to 1 pixels: %s", LAYERS[i]));
    }
}

/* ---- figures and limits ------------------------------------------------------------------ */

TEST(limits_hold_in_their_direction) {
    assert_true(threshold_holds((Threshold){METRIC_FLIP, 0.1}, 0.1));
    assert_false(threshold_holds((Threshold){METRIC_FLIP, 0.1}, 0.11));
    assert_true(threshold_holds((Threshold){METRIC_PSNR, 30}, INFINITY));
    assert_false(threshold_holds((Threshold){METRIC_PSNR, 30}, 29.9));
    assert_false(threshold_holds((Threshold){METRIC_MEAN_SHIFT, 0.1}, -0.2));
    for (int i = 0; i < METRIC_COUNT; i++) {
        assert_false(threshold_holds((Threshold){(Metric)i, 1e9}, NAN));
        assert_int_equal(metric_find(metric_info((Metric)i)->name), i);
    }
    assert_int_equal(metric_find("flops"), METRIC_COUNT);
    assert_int_equal(metric_group_find("stat"), GROUP_STAT);
    assert_int_equal(metric_group_find("mae"), GROUP_MSE);
    assert_int_equal(metric_group_find("flops"), 0);
}

/* One code of one channel is off by d: mse = d^2 / (3 n). */
ARENA_TEST(figures_of_pictures_are_those_of_codes) {
    CompareInput a = picture_input("a", 8, &arena), b = picture_input("b", 8, &arena);
    ((float *)b.codes.rgb[2])[30] += 0.25f;
    ((float *)b.light.rgb[2])[30] = linear_from_srgb(b.codes.rgb[2][30]);
    Comparison c = compared(&a, &b, (CompareOptions){0}, &arena);
    assert_reason(&c, "1 of 96 pixels differ");
    assert_close(c.value[METRIC_MSE], 0.0625 / (3 * COUNT), 1e-5);
    assert_close(c.value[METRIC_PSNR], 10 * log10(3 * COUNT / 0.0625), 1e-5);
    assert_close(c.value[METRIC_DIFFERING], 1.0 / COUNT, 1e-9);
    assert_true(c.value[METRIC_FLIP] > 0 && c.value[METRIC_SSIM] < 1);
    assert_true(c.value[METRIC_DELTAE_MAX] > 1 && c.value[METRIC_MEAN_SHIFT] > 0);
    assert_true(isnan(c.value[METRIC_P_VALUE]));
    assert_true(has_note(&c, "--max flip=0.05"));
    c = compared(&a, &a, (CompareOptions){0}, &arena);
    assert_true(c.same && isinf(c.value[METRIC_PSNR]) && c.value[METRIC_FLIP] == 0);
}

ARENA_TEST(only_what_is_asked_for_is_computed) {
    CompareInput a = picture_input("a", 8, &arena);
    Comparison c = compared(&a, &a, (CompareOptions){.groups = GROUP_MSE}, &arena);
    assert_true(isnan(c.value[METRIC_FLIP]) && isnan(c.value[METRIC_PSNR]));
    assert_near(c.value[METRIC_MSE], 0, 0);
    const Threshold limit = {METRIC_FLIP, 0.5};
    c = compared(&a, &a,
                 (CompareOptions){.groups = GROUP_MSE, .thresholds = &limit, .threshold_count = 1},
                 &arena);
    assert_near(c.value[METRIC_FLIP], 0, 0);
    const Threshold unknown = {METRIC_CONTRAST_CHANGE, 0.5};
    c = compared(&a, &a, (CompareOptions){.thresholds = &unknown, .threshold_count = 1}, &arena);
    assert_reason(&c, "contrast_change not known, required: at most 50 %");
}

TEST(exposures_are_the_ones_of_develop) {
    for (double ev = -4; ev < 20; ev += 3) {
        assert_near(ev_of_stops(stops_of_ev(ev)), ev, 1e-9);
        /* What EV e makes middle grey is 0.125 * 2^e cd/m2 (ISO 2720, K = 12.5). */
        assert_close(0.125 * exp2(ev) * exp2(stops_of_ev(ev)), 0.18, 1e-9);
    }
}

/* A picture of sRGB codes with edges, ramps and something of chance, and gaps of alpha. */
static const char *write_picture(const char *name, int change, Arena *arena) {
    enum { ROWS = 61, COLUMNS = 150 };
    const char *path = in_folder(name);
    Picture picture = picture_create(COLUMNS, ROWS, arena);
    uint32_t chance = 1;
    for (int i = 0; i < ROWS * COLUMNS * 3; i++) {
        int x = i / 3 % COLUMNS, y = i / 3 / COLUMNS;
        chance = chance * 1664525u + 1013904223u;
        picture.rgb[i] =
            (float)((x * 3 + y * 5 + (x > 60 ? 90 : 0) + (int)(chance >> 28)) % 250) / 255;
        if (change && (x + y) % 7 == 0) picture.rgb[i] += (float)change / 255;
    }
    const PictureFile file = {.bits = 8, .is_srgb = true};
    assert_done(picture_write(path, &picture, file, *arena, &err));
    return path;
}

/* In bands, of however many rows, all figures have the bits of whole pictures. */
ARENA_TEST(bands_give_the_figures_of_whole_pictures) {
    static const int ROWS[] = {1, 7, 16, 61, 100};
    const char *a = write_picture("a.png", 0, &arena), *b = write_picture("b.png", 9, &arena);
    CompareOptions options = {.threads = 2};
    Comparison whole, bands;
    for (int region = 0; region < 2; region++) {
        options.selection.region_count = region;
        options.selection.regions = &(const ExrWindow){3, 5, 140, 50};
        options.whole_pixels = 0;
        assert_done(compare_files(a, b, &options, &arena, &whole, &err));
        for (int k = 0; k < COUNT_OF(ROWS); k++) {
            options.whole_pixels = 1;
            options.band_rows = ROWS[k];
            assert_done(compare_files(a, b, &options, &arena, &bands, &err));
            assert_true(input_is_packed(&bands.reference) && !input_is_packed(&whole.test));
            for (int m = 0; m < METRIC_COUNT; m++)
                if (!isnan(whole.value[m]) || !isnan(bands.value[m]))
                    assert_true(whole.value[m] == bands.value[m]);
            assert_true(whole.value[METRIC_FLIP] > 0 && whole.value[METRIC_SSIM] < 1);
            assert_int_equal(whole.channels.differing, bands.channels.differing);
            for (int c = 0; c < 3; c++) {
                assert_true(whole.channels.list[c].mean == bands.channels.list[c].mean);
                assert_true(whole.channels.list[c].max == bands.channels.list[c].max);
            }
            assert_string_equal(whole.verdict, bands.verdict);
            assert_true(has_note(&bands, "a report has neither the pictures nor maps of FLIP"));
        }
    }
    unlink(a);
    unlink(b);
}

/* ---- which pixels count ------------------------------------------------------------------ */

TEST(a_data_window_places_values) {
    FrameImage frame = {.display = {10, 20, 22, 28}, .data = {14, 18, 24, 26}};
    assert_int_equal(selection_place(&frame, 0), -1);      /* row 18 is above */
    assert_int_equal(selection_place(&frame, 20), 4);      /* 14,20 */
    assert_int_equal(selection_place(&frame, 20 + 7), 11); /* 21,20 */
    assert_int_equal(selection_place(&frame, 20 + 8), -1); /* 22 is outside */
    assert_int_equal(selection_place(&frame, 30), 12 + 4);
}

ARENA_TEST(regions_select_and_displays_are_known) {
    Selection selection;
    CompareInput a = frame_input("a.exr", &arena);
    ExrWindow regions[2] = {{2, 1, 5, 3}, {4, 2, 6, 4}}; /* one pixel is of both */
    SelectionRequest request = {.regions = regions, .region_count = 1};
    const CompareInput *const sides[2] = {&a, &a};
    assert_done(selection_make(sides, &request, &arena, &selection, &err));
    assert_int_equal(selection.pixels, 6);
    assert_true(selection.counts[WIDTH + 2] && !selection.counts[WIDTH + 5]);
    request.region_count = 2;
    assert_done(selection_make(sides, &request, &arena, &selection, &err));
    assert_int_equal(selection.pixels, 9);
    assert_true(selection.counts[3 * WIDTH + 5] && !selection.counts[3 * WIDTH + 3]);
    regions[1].x1 = WIDTH + 1;
    assert_fails(selection_make(sides, &request, &arena, &selection, &err),
                 "inside the pixels 0,0,12,8 of a.exr");
    request = (SelectionRequest){.display = "cluster"};
    assert_fails(selection_make(sides, &request, &arena, &selection, &err),
                 "has no display \"cluster\"; its displays: none");
    frame_set_string(&a.frame, "parhelion:display.3", "cluster", &arena);
    assert_fails(selection_make(sides, &request, &arena, &selection, &err), "--layers id,display");
    float *id = frame_add_channel(&a.frame, "id.display", true, &arena);
    for (int i = 0; i < COUNT; i++) id[i] = i < 7 ? 3 : -1;
    assert_done(selection_make(sides, &request, &arena, &selection, &err));
    assert_int_equal(selection.pixels, 7);
}

/* Sizes alone decide it: nothing of the pixels is read. */
TEST(frames_that_cannot_fit_are_refused_by_a_line) {
    Error err = {0};
    Comparison out;
    CompareOptions options = {.threads = 1};
    CompareInput frame = {
        .name = "huge.exr", .kind = INPUT_FRAME, .light = {.width = 1 << 20, .height = 1 << 20}};
    Arena arena = arena_reserve(1 << 20);
    assert_false(compare_inputs(&frame, &frame, &options, &arena, &out, &err));
    arena_release(&arena);
    assert_int_equal(err.code, ERROR_MEMORY);
    assert_string_equal(err.file, "huge.exr");
    assert_error_has(&err, "1048576 x 1048576 pixels: frames of light are compared whole");
    assert_error_has(&err, "GB; compare crops, or developed pictures");
}

TEST_PROGRAM(make_folder, remove_folder)
