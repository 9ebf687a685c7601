/* SPDX-License-Identifier: Apache-2.0 */
/* Developing: exposure, views, layers and the picture files. */
#include "frame_fixture.h"

#include <signal.h>
#include <sys/resource.h>

#include "image/develop.h"
#include "image/exposure.h"
#include "image/false_colour.h"
#include "image/image.h"
#include "opencolorio/ocio_file.h"
#include "opencolorio/view_transform.h"

enum { ARENA_BYTES = 1 << 28 };

extern const char OWN_OCIO_CONFIG[];

static Picture develop(const FrameImage *frame, DevelopOptions options, Arena *arena,
                       DevelopReport *report) {
    Picture picture;
    assert_done(develop_picture(frame, &options, arena, &picture, report, &err));
    return picture;
}

/* ---- views ------------------------------------------------------------------------------- */

static double srgb_encoded(double v) {
    return v <= 0.0031308 ? 12.92 * v : 1.055 * pow(v, 1 / 2.4) - 0.055;
}

/* Replaces every grey by its code. */
static void greys_through(const char *display, const char *view, float *grey, int count) {
    ViewTransform *transform;
    ViewRequest request = {NULL, OWN_OCIO_CONFIG, display, view, NULL};
    assert_done(view_transform_create(&request, &transform, &err));
    for (int i = 0; i < count; i++) {
        float rgb[3] = {grey[i], grey[i], grey[i]};
        assert_done(view_transform_apply(transform, rgb, 1, &err));
        assert_near(rgb[1], rgb[0], 2e-6); /* grey stays grey */
        assert_near(rgb[2], rgb[0], 2e-6);
        grey[i] = rgb[1];
    }
    view_transform_destroy(transform);
}

static float grey_through(const char *display, const char *view, float grey) {
    greys_through(display, view, &grey, 1);
    return grey;
}

TEST(middle_grey_has_the_known_codes) {
    assert_near(grey_through("sRGB", "untonemapped", 0.18f), 0.461356, 2e-6);
    assert_near(grey_through("sRGB", "ACES SDR", 0.18f), 0.355954, 2e-6);
    assert_near(grey_through("sRGB", "photographic", 0.18f), 0.461356, 2e-5);
    assert_near(grey_through("Display P3", "untonemapped", 0.18f), 0.461356, 2e-5);
    assert_near(grey_through("Rec.1886", "untonemapped", 0.18f), pow(0.18, 1 / 2.4), 2e-5);
    assert_near(grey_through("sRGB", "raw", 0.18f), 0.18, 1e-7);
    assert_near(grey_through(NULL, NULL, 0.4f), grey_through("sRGB", "photographic", 0.4f), 0);
}

TEST(untonemapped_is_the_srgb_curve) {
    float grey[1001];
    for (int i = 0; i <= 1000; i++) grey[i] = (float)i / 1000;
    greys_through("sRGB", "untonemapped", grey, 1001);
    for (int i = 0; i <= 1000; i++) assert_near(grey[i], srgb_encoded(i / 1000.0), 1e-5);
}

/* L = m x^c / (x^c + b), as the configuration's comment says. */
TEST(photographic_is_its_formula) {
    const double c = 1.2, g = pow(0.18, c), w = pow(0.18 * 256, c);
    const double b = (g - 0.18 * g) / (0.18 - g / w), m = 1 + b / w;
    for (int stop = -8; stop <= 8; stop++) {
        double x = 0.18 * exp2(stop), p = pow(x, c);
        assert_near(grey_through("sRGB", "photographic", (float)x), srgb_encoded(m * p / (p + b)),
                    3e-5);
    }
    assert_near(grey_through("sRGB", "photographic", 0), 0, 1e-5);
    assert_near(grey_through("sRGB", "photographic", -3), 0, 1e-5);
    assert_near(grey_through("sRGB", "photographic", 1e6f), 1, 1e-5);
}

TEST(wrong_names_are_told_with_the_right_ones) {
    ViewTransform *transform = NULL;
    Error err = {0};
    ViewRequest request = {NULL, OWN_OCIO_CONFIG, "CRT", NULL, NULL};
    assert_false(view_transform_create(&request, &transform, &err));
    assert_error_has(&err, "sRGB, Display P3, Rec.1886");
    request.display = "sRGB";
    request.view = "beautiful";
    assert_false(view_transform_create(&request, &transform, &err));
    assert_error_has(&err, "photographic, ACES SDR, untonemapped, raw");
    assert_int_equal(err.code, ERROR_USAGE);
    request = (ViewRequest){"no/such.ocio", OWN_OCIO_CONFIG, NULL, NULL, ocio_file_check};
    assert_false(view_transform_create(&request, &transform, &err));
    assert_string_equal(err.file, "no/such.ocio");
    assert_null(transform);
    view_transform_destroy(NULL);
}

/* A configuration that does not say what its colours mean. */
TEST(a_configuration_without_interchange_is_refused) {
    static const char TEXT[] =
        "ocio_profile_version: 1\nroles:\n  default: raw\n  scene_linear: raw\n"
        "displays:\n  screen:\n    - !<View> {name: plain, colorspace: raw}\n"
        "active_displays: []\nactive_views: []\n"
        "colorspaces:\n  - !<ColorSpace>\n    name: raw\n    isdata: false\n";
    Error err = {0};
    ViewTransform *transform;
    char path[200];
    snprintf(path, sizeof path, "%s", in_folder("raw.ocio"));
    assert_true(file_write(path, TEXT, sizeof TEXT - 1, &err));
    ViewRequest request = {path, OWN_OCIO_CONFIG, NULL, NULL, ocio_file_check};
    assert_false(view_transform_create(&request, &transform, &err));
    assert_error_has(&err, "aces_interchange");
    assert_string_equal(err.file, path);
}

/* A newer version than the library knows is refused in one line. */
TEST(a_configuration_that_is_too_new_is_refused) {
    char *text = strdup(OWN_OCIO_CONFIG), *version = strstr(text, "version: 2\n");
    char path[200], newer[20000];
    Error err = {0};
    ViewTransform *transform;
    snprintf(newer, sizeof newer, "ocio_profile_version: 2.9%s", version + 10);
    snprintf(path, sizeof path, "%s", in_folder("newer.ocio"));
    assert_true(file_write(path, newer, strlen(newer), &err));
    ViewRequest request = {path, OWN_OCIO_CONFIG, NULL, NULL, ocio_file_check};
    assert_false(view_transform_create(&request, &transform, &err));
    assert_error_has(&err, "2.9");
    assert_null(strchr(err.text, '\n'));
    free(text);
}

/* The studios' own ACES configuration agrees with ours. */
ARENA_TEST(a_users_configuration_is_entered_by_its_interchange_role) {
    char path[512];
    snprintf(path, sizeof path, "%s/ocio/cg-config-v1.0.0_aces-v1.3_ocio-v2.1.ocio",
             SHARED_DATA_DIR);
    if (!file_exists(path)) skip();
    FrameImage frame = uniform_frame(2, 2, 18, &arena);
    DevelopReport report;
    Picture p =
        develop(&frame, (DevelopOptions){.config = path, .exposure = "white:100"}, &arena, &report);
    assert_near(p.rgb[0], 0.355954, 1e-4);
    assert_non_null(strstr(report.config, "cg-config"));
    setenv("OCIO", path, 1);
    p = develop(&frame, (DevelopOptions){.exposure = "white:100"}, &arena, &report);
    unsetenv("OCIO");
    assert_near(p.rgb[0], 0.355954, 1e-4);
    assert_non_null(strstr(report.config, "cg-config"));
}

/* ---- exposure ---------------------------------------------------------------------------- */

static double grey_of(const char *text, const float *luminance, size_t count) {
    Arena arena = arena_reserve(ARENA_BYTES);
    ExposureRequest request;
    assert_done(exposure_parse(text, &request, &err));
    double grey = exposure_grey(request, luminance, count, arena);
    arena_release(&arena);
    return grey;
}

TEST(exposure_follows_its_closed_forms) {
    enum { N = 10000 };
    static float luminance[N];
    for (int i = 0; i < N; i++) luminance[i] = 37;
    assert_close(grey_of("auto", luminance, N), 37 * 0.18 / 0.12, 1e-5);
    assert_close(grey_of("0", luminance, N), 0.125, 1e-12);
    assert_close(grey_of("15", luminance, N), 4096, 1e-12);
    assert_close(grey_of("white:250", luminance, N), 45, 1e-12);
    assert_close(exposure_ev_of_grey(exposure_grey_of_ev(7.3)), 7.3, 1e-12);
    for (int i = 0; i < N; i++) luminance[i] = i < 6500 ? 400 : 9000; /* a cabin by day */
    assert_close(grey_of("auto", luminance, N), 400 * 0.18 / 0.12, 1e-4);
    for (int i = 0; i < N; i++) luminance[i] = i < 9700 ? 0.02f : 200; /* displays at night */
    assert_close(grey_of("auto", luminance, N), 200 / 16.0, 1e-4);
    for (int i = 0; i < N; i++) luminance[i] = i < 6500 ? 0.05f : 1.2f; /* a lit street */
    assert_close(grey_of("auto", luminance, N), 1.2 / 1.5, 1e-4);
    for (int i = 0; i < N; i++) luminance[i] = i < 6500 ? 0.05f : 12; /* brighter than night */
    assert_close(grey_of("auto", luminance, N), 2 / 1.5, 1e-4);
    for (int i = 0; i < N; i++) luminance[i] = i < 6500 ? 1 : 30000;
    assert_close(grey_of("auto", luminance, N), 30000 / (16 * 10.0), 1e-4);
}

/* The 90th percentile lies among the brighter tenths. */
ARENA_TEST(the_bright_part_is_counted_in_stops) {
    float luminance[100];
    for (int i = 0; i < 100; i++) luminance[i] = i < 80 ? 3 : 64;
    assert_near(exposure_bright_stops(luminance, 100, 8, arena), 3, 1e-5);
    for (int i = 0; i < 100; i++) luminance[i] = i < 95 ? 3 : 64;
    assert_near(exposure_bright_stops(luminance, 100, 3, arena), 0, 1e-5);
    assert_true(exposure_bright_stops((const float[]){0, NAN}, 2, 3, arena) == 0);
}

TEST(what_is_not_light_has_no_say_in_exposure) {
    const float odd[] = {37, NAN, -5, INFINITY, 0, 37}, nothing[] = {NAN, 0, -1};
    assert_close(grey_of("auto", odd, 6), 37 * 0.18 / 0.12, 1e-5);
    assert_true(grey_of("auto", nothing, 3) == 1);
    assert_true(grey_of("auto", nothing, 0) == 1);
}

TEST(bad_exposures_are_told) {
    static const char *const BAD[] = {"",          "bright", "white:", "white:0", "white:-3",
                                      "white:nan", "1e9",    "3 ",     "inf",     "auto1"};
    for (size_t i = 0; i < sizeof BAD / sizeof *BAD; i++) {
        ExposureRequest request;
        assert_fails_as(exposure_parse(BAD[i], &request, &err), ERROR_USAGE,
                        "required: auto, an exposure value");
    }
}

/* ---- pictures ---------------------------------------------------------------------------- */

ARENA_TEST(a_frame_becomes_the_codes_it_should) {
    FrameImage frame = uniform_frame(8, 5, 90, &arena);
    DevelopOptions options = {.exposure = "white:500", .view = "untonemapped"};
    Image image;
    assert_done(develop_frame(&frame, &options, in_folder("a.png"), arena, NULL, &err));
    assert_done(image_read(in_folder("a.png"), &arena, &image, &err));
    assert_int_equal(image.width, 8);
    assert_int_equal(((const uint8_t *)image.pixels)[0], (int)(255 * 0.461356 + 0.5));
    options.bits = 16;
    assert_done(develop_frame(&frame, &options, in_folder("a.png"), arena, NULL, &err));
    assert_done(image_read(in_folder("a.png"), &arena, &image, &err));
    assert_near(((const uint16_t *)image.pixels)[0], 65535 * 0.461356, 1);
    assert_done(develop_frame(&frame, &options, in_folder("a.tif"), arena, NULL, &err));
    assert_done(image_read(in_folder("a.tif"), &arena, &image, &err));
    assert_near(((const uint16_t *)image.pixels)[0], 65535 * 0.461356, 1);
    options.bits = 8;
    assert_done(develop_frame(&frame, &options, in_folder("a.jpg"), arena, NULL, &err));
    assert_done(image_read(in_folder("a.jpg"), &arena, &image, &err));
    assert_near(((const uint8_t *)image.pixels)[0], 255 * 0.461356, 2);
}

/* White is code 1 in every display, half of it half the light, and what is brighter is white;
 * a view that is named holds, and so does the default one of other exposures. */
ARENA_TEST(what_is_to_become_white_is_white) {
    static const char *const DISPLAYS[] = {NULL, "sRGB", "Display P3"};
    DevelopReport report;
    for (int i = 0; i < 3; i++) {
        DevelopOptions options = {.exposure = "white:320", .display = DISPLAYS[i]};
        FrameImage white = uniform_frame(2, 1, 320, &arena);
        FrameImage half = uniform_frame(2, 1, 160, &arena);
        FrameImage bright = uniform_frame(2, 1, 900, &arena);
        assert_near(develop(&white, options, &arena, &report).rgb[0], 1, 1e-4);
        assert_string_equal(report.view, "untonemapped");
        assert_near(develop(&half, options, &arena, &report).rgb[0], srgb_encoded(0.5), 1e-4);
        assert_true(develop(&bright, options, &arena, &report).rgb[0] >= 1);
        options.view = "photographic";
        assert_true(develop(&white, options, &arena, &report).rgb[0] < 0.9);
        assert_string_equal(report.view, "photographic");
    }
    FrameImage frame = uniform_frame(2, 1, 320, &arena);
    develop(&frame, (DevelopOptions){.exposure = "10"}, &arena, &report);
    assert_string_equal(report.view, "photographic");
}

ARENA_TEST(the_same_frame_makes_the_same_picture_file) {
    FrameImage frame = uniform_frame(8, 5, 90, &arena);
    DevelopOptions options = {.false_colour = true};
    FileBytes bytes[2];
    for (int i = 0; i < 2; i++) {
        assert_done(develop_frame(&frame, &options, in_folder("same.png"), arena, NULL, &err));
        bytes[i] = read_bytes(in_folder("same.png"), &arena);
    }
    assert_int_equal(bytes[0].size, bytes[1].size);
    assert_memory_equal(bytes[0].data, bytes[1].data, bytes[0].size);
}

ARENA_TEST(a_range_makes_frames_comparable) {
    FrameImage frame = uniform_frame(8, 5, 90, &arena);
    DevelopOptions options = {.false_colour = true, .range = {0.9, 900}};
    DevelopReport report;
    Picture p = develop(&frame, options, &arena, &report);
    float want[3];
    false_colour_of(2 / 3.0f, want);
    for (int c = 0; c < 3; c++) assert_near(p.rgb[c], want[c], 5e-3);
    assert_string_equal(report.scale, "0.9 to 900 cd/m^2, logarithmic");
    options.range[0] = 0;
    assert_fails(develop_picture(&frame, &options, &arena, &p, NULL, &err),
                 "--range 0,900: required: LOW,HIGH with LOW < HIGH and LOW above 0");
    options.false_colour = false;
    assert_fails(develop_picture(&frame, &options, &arena, &p, NULL, &err),
                 "only false colours have a range");
}

ARENA_TEST(what_is_not_finite_is_cleaned_and_counted) {
    FrameImage frame = uniform_frame(4, 1, 90, &arena);
    frame.channels[0].values[0] = NAN;
    frame.channels[1].values[1] = INFINITY;
    frame.channels[2].values[2] = -INFINITY;
    DevelopReport report;
    Picture p = develop(&frame, (DevelopOptions){.view = "ACES SDR"}, &arena, &report);
    assert_int_equal(report.nonfinite_pixels, 3);
    for (int i = 0; i < 12; i++) assert_true(isfinite(p.rgb[i]));
}

ARENA_TEST(a_crop_stands_in_its_frame) {
    FrameImage frame = uniform_frame(4, 2, 90, &arena);
    frame.display = (ExrWindow){0, 0, 10, 6};
    frame.data = (ExrWindow){3, 1, 7, 3};
    DevelopReport report;
    Picture p = develop(&frame, (DevelopOptions){0}, &arena, &report);
    assert_int_equal(p.width, 10);
    assert_int_equal(p.height, 6);
    assert_int_equal(report.nonfinite_pixels, 0);
    for (int y = 0; y < 6; y++)
        for (int x = 0; x < 10; x++) {
            bool inside = x >= 3 && x < 7 && y >= 1 && y < 3;
            assert_true((picture_pixel(&p, x, y)[1] > 0.3f) == inside);
        }
}

ARENA_TEST(a_picture_that_fails_leaves_nothing) {
    FrameImage frame = uniform_frame(64, 64, 90, &arena);
    DevelopOptions options = {.bits = 16};
    Error err = {0};
    struct rlimit before, small;
    int files = files_in_folder();
    for (int i = 0; i < 64 * 64; i++) frame.channels[1].values[i] = (float)(i * 7919 % 1000);
    signal(SIGXFSZ, SIG_IGN);
    getrlimit(RLIMIT_FSIZE, &before);
    small = before;
    small.rlim_cur = 1000; /* bytes that fit before the "disk" is full */
    setrlimit(RLIMIT_FSIZE, &small);
    bool done = develop_frame(&frame, &options, in_folder("full.png"), arena, NULL, &err);
    setrlimit(RLIMIT_FSIZE, &before);
    assert_false(done);
    assert_int_equal(err.code, ERROR_OUTPUT);
    assert_int_equal(files_in_folder(), files);
    assert_false(develop_frame(&frame, &options, "no/such/a.png", arena, NULL, &err));
    assert_int_equal(err.code, ERROR_OUTPUT);
    assert_false(develop_frame(&frame, &options, in_folder("a.jpg"), arena, NULL, &err));
    assert_error_has(&err, "a JPEG holds 8");
    assert_false(develop_frame(&frame, &options, in_folder("a.exr"), arena, NULL, &err));
    assert_error_has(&err, "ends in .png, .jpg");
}

/* ---- layers ------------------------------------------------------------------------------ */

ARENA_TEST(every_layer_can_be_looked_at) {
    static const char *const CHANNELS[] = {"xyz.X",
                                           "xyz.Y",
                                           "xyz.Z",
                                           "depth.Z",
                                           "position.X",
                                           "position.Y",
                                           "position.Z",
                                           "normal.X",
                                           "normal.Y",
                                           "normal.Z",
                                           "albedo.R",
                                           "albedo.G",
                                           "albedo.B",
                                           "id.part",
                                           "id.display",
                                           "uv.U",
                                           "uv.V",
                                           "variance.R",
                                           "variance.G",
                                           "variance.B",
                                           "halves.R",
                                           "halves.G",
                                           "halves.B",
                                           "samples.N",
                                           "light.sun.R",
                                           "light.sun.G",
                                           "light.sun.B",
                                           "display.emitted.R",
                                           "display.emitted.G",
                                           "display.emitted.B",
                                           "display.theta",
                                           "display.phi",
                                           "display.contrast"};
    static const char *const LAYERS[] = {"xyz",
                                         "depth",
                                         "depth.Z",
                                         "position",
                                         "normal",
                                         "albedo",
                                         "id",
                                         "id.display",
                                         "uv",
                                         "variance",
                                         "variance.G",
                                         "halves",
                                         "halves.G",
                                         "samples",
                                         "light.sun",
                                         "display.emitted",
                                         "display.theta",
                                         "display.contrast",
                                         "R",
                                         "light.sun.B",
                                         NULL};
    FrameImage frame = uniform_frame(40, 30, 90, &arena);
    for (size_t k = 0; k < sizeof CHANNELS / sizeof *CHANNELS; k++) {
        float *plane = frame_add_channel(&frame, CHANNELS[k], false, &arena);
        for (int i = 0; i < 1200; i++) plane[i] = i % 7 ? (float)(i % 40) / 20 : NAN;
    }
    for (size_t k = 0; k < sizeof LAYERS / sizeof *LAYERS; k++) {
        DevelopReport report;
        Picture p = develop(&frame, (DevelopOptions){.layer = LAYERS[k]}, &arena, &report);
        float least = 2, greatest = -1;
        for (int i = 0; i < p.width * p.height * 3; i++) {
            assert_true(isfinite(p.rgb[i]));
            least = fminf(least, p.rgb[i]);
            greatest = fmaxf(greatest, p.rgb[i]);
        }
        if (LAYERS[k]) assert_true(greatest - least > 0.3f); /* one sees something */
    }
}

ARENA_TEST(directions_and_albedo_have_their_closed_forms) {
    FrameImage frame = uniform_frame(2, 1, 90, &arena);
    for (int c = 0; c < 3; c++) {
        char normal[] = "normal.X", albedo[] = "albedo.R";
        normal[7] = "XYZ"[c];
        albedo[7] = "RGB"[c];
        frame_add_channel(&frame, normal, false, &arena)[0] = (float)(c - 1);
        frame_add_channel(&frame, albedo, false, &arena)[0] = 0.18f;
    }
    Picture p = develop(&frame, (DevelopOptions){.layer = "normal"}, &arena, NULL);
    assert_true(p.rgb[0] == 0 && p.rgb[1] == 0.5f && p.rgb[2] == 1);
    p = develop(&frame, (DevelopOptions){.layer = "albedo"}, &arena, NULL);
    assert_near(p.rgb[0], 0.461356, 1e-5);
}

ARENA_TEST(a_grey_frame_is_light_as_well) {
    FrameImage frame = frame_create(1, 1, (ExrWindow){0, 0, 1, 1}, 1, 0, &arena);
    DevelopReport report;
    Picture picture;
    float *depth = frame_add_channel(&frame, "depth.Z", false, &arena);
    depth[0] = 1;
    DevelopOptions plain = {0};
    assert_fails(develop_picture(&frame, &plain, &arena, &picture, &report, &err),
                 "has no channels R, G, B or Y; it has: depth");
    frame_add_channel(&frame, "Y", false, &arena)[0] = 18;
    picture = develop(&frame, (DevelopOptions){.exposure = "white:100", .view = "untonemapped"},
                      &arena, &report);
    assert_near(picture.rgb[0], 0.461356, 1e-5);
    assert_near(picture.rgb[2], 0.461356, 1e-5);
}

ARENA_TEST(an_unknown_layer_is_told_with_those_there_are) {
    FrameImage frame = uniform_frame(2, 1, 90, &arena);
    DevelopOptions options = {.layer = "norml", .frame_name = "f.exr"};
    Picture picture;
    Error err = {0};
    frame_add_channel(&frame, "normal.X", false, &arena);
    frame_add_channel(&frame, "display.theta", false, &arena);
    assert_false(develop_picture(&frame, &options, &arena, &picture, NULL, &err));
    assert_error_has(&err, "has no layer \"norml\"; it has: R, G, B, normal, display.theta");
    assert_string_equal(err.file, "f.exr");
    options = (DevelopOptions){.layer = "display.theta", .false_colour = true};
    assert_false(develop_picture(&frame, &options, &arena, &picture, NULL, &err));
    assert_error_has(&err, "is not light");
}

/* Where a display's layer has nothing the frame shows, grey and dim. */
ARENA_TEST(figures_of_displays_stand_over_the_frame) {
    FrameImage frame = frame_create(8, 8, (ExrWindow){0, 0, 8, 8}, 8, 0, &arena);
    DevelopOptions options = {.layer = "display.contrast", .range = {1, 100}};
    Picture picture;
    float *contrast, *light[3];
    for (int c = 0; c < 3; c++)
        light[c] = frame_add_channel(&frame, (char[]){"RGB"[c], 0}, false, &arena);
    contrast = frame_add_channel(&frame, "display.contrast", false, &arena);
    for (int i = 0; i < 64; i++) {
        contrast[i] = i % 8 < 4 ? 10 : NAN;
        for (int c = 0; c < 3; c++) light[c][i] = i < 32 ? 40 * (float)(c + 1) : 4000;
    }
    assert_done(develop_picture(&frame, &options, &arena, &picture, NULL, &err));
    float want[3], *dim = picture_pixel(&picture, 6, 1);
    float *bright = picture_pixel(&picture, 6, 6);
    false_colour_of(0.5f, want);
    for (int c = 0; c < 3; c++) {
        assert_near(picture_pixel(&picture, 1, 1)[c], want[c], 2e-3);
        assert_true(dim[c] == dim[0] && bright[c] == bright[0]);
    }
    assert_true(dim[0] > 0 && dim[0] < bright[0] && bright[0] < 0.46f);
}

int main(void) {
    unsetenv("OCIO");
    return run_cases(make_folder, clear_folder);
}
