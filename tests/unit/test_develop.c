/* Developing: exposure, views, layers, false colours and figures of a frame. */
#include "check.h"

#include <dirent.h>
#include <signal.h>
#include <stdlib.h>
#include <string.h>
#include <sys/resource.h>
#include <unistd.h>

#include "base/file.h"
#include "image/colour.h"
#include "image/develop.h"
#include "image/exposure.h"
#include "image/false_colour.h"
#include "image/image.h"
#include "image/layer_view.h"
#include "image/lettering.h"
#include "image/measure.h"
#include "opencolorio/view_transform.h"

enum { ARENA_BYTES = 1 << 28 };

extern const char OWN_OCIO_CONFIG[];

static char folder[64] = "pictures-XXXXXX";

static int make_folder(void **state)
{
    (void)state;
    unsetenv("OCIO");
    return mkdtemp(folder) ? 0 : -1;
}

static int files_in_folder(void)
{
    DIR *dir = opendir(folder);
    int  count = 0;
    while (readdir(dir)) count++;
    closedir(dir);
    return count - 2;
}

static int remove_folder(void **state)
{
    (void)state;
    DIR *dir = opendir(folder);
    for (struct dirent *e; (e = readdir(dir));) {
        char path[400];
        snprintf(path, sizeof path, "%s/%s", folder, e->d_name);
        if (e->d_name[0] != '.') unlink(path);
    }
    closedir(dir);
    return rmdir(folder);
}

static const char *in_folder(const char *name)
{
    static char path[200];
    snprintf(path, sizeof path, "%s/%s", folder, name);
    return path;
}

static void assert_text_has(const Error *err, const char *part)
{
    if (!strstr(err->text, part)) fail_msg("\"%s\" lacks \"%s\"", err->text, part);
}

/* Every pixel of R, G, B holds cd_m2 of D65. */
static FrameImage uniform_frame(int width, int height, float cd_m2, Arena *arena)
{
    FrameImage frame = frame_create(width, height, (ExrWindow){0, 0, width, height}, 3, 0, arena);
    for (int c = 0; c < 3; c++) {
        char   name[2] = {"RGB"[c], 0};
        float *plane = frame_add_channel(&frame, name, false, arena);
        for (int i = 0; i < width * height; i++) plane[i] = cd_m2;
    }
    return frame;
}

static Picture develop(const FrameImage *frame, DevelopOptions options, Arena *arena,
                       DevelopReport *report)
{
    Picture picture;
    Error   err = {0};
    if (!develop_picture(frame, &options, arena, &picture, report, &err)) fail_msg("%s", err.text);
    return picture;
}

/* ---- views ------------------------------------------------------------------------------- */

static double srgb_encoded(double v)
{
    return v <= 0.0031308 ? 12.92 * v : 1.055 * pow(v, 1 / 2.4) - 0.055;
}

static float grey_through(const char *display, const char *view, float grey)
{
    ViewTransform *transform;
    ViewRequest    request = {NULL, OWN_OCIO_CONFIG, display, view};
    Error          err = {0};
    float          rgb[3] = {grey, grey, grey};
    if (!view_transform_create(&request, &transform, &err)) fail_msg("%s", err.text);
    assert_true(view_transform_apply(transform, rgb, 1, &err));
    assert_near(rgb[1], rgb[0], 2e-6); /* grey stays grey */
    assert_near(rgb[2], rgb[0], 2e-6);
    view_transform_destroy(transform);
    return rgb[1];
}

static void middle_grey_has_the_known_codes(void **state)
{
    (void)state;
    assert_near(grey_through("sRGB", "untonemapped", 0.18f), 0.461356, 2e-6);
    assert_near(grey_through("sRGB", "ACES SDR", 0.18f), 0.355954, 2e-6);
    assert_near(grey_through("sRGB", "photographic", 0.18f), 0.461356, 2e-5);
    assert_near(grey_through("Display P3", "untonemapped", 0.18f), 0.461356, 2e-5);
    assert_near(grey_through("Rec.1886", "untonemapped", 0.18f), pow(0.18, 1 / 2.4), 2e-5);
    assert_near(grey_through("sRGB", "raw", 0.18f), 0.18, 1e-7);
    assert_near(grey_through(NULL, NULL, 0.18f), grey_through("sRGB", "photographic", 0.18f), 0);
}

static void untonemapped_is_the_srgb_curve(void **state)
{
    (void)state;
    for (int i = 0; i <= 1000; i++)
        assert_near(grey_through("sRGB", "untonemapped", (float)i / 1000),
                    srgb_encoded(i / 1000.0), 1e-5);
}

/* L = m x^c / (x^c + b), as the configuration's comment says. */
static void photographic_is_its_formula(void **state)
{
    (void)state;
    const double c = 1.12, g = pow(0.18, c), w = pow(0.18 * 256, c);
    const double b = (g - 0.18 * g) / (0.18 - g / w), m = 1 + b / w;
    for (int stop = -8; stop <= 8; stop++) {
        double x = 0.18 * exp2(stop), p = pow(x, c);
        assert_near(grey_through("sRGB", "photographic", (float)x),
                    srgb_encoded(m * p / (p + b)), 3e-5);
    }
    assert_near(grey_through("sRGB", "photographic", 0), 0, 1e-5);
    assert_near(grey_through("sRGB", "photographic", -3), 0, 1e-5);
    assert_near(grey_through("sRGB", "photographic", 1e6f), 1, 1e-5);
}

static void wrong_names_are_told_with_the_right_ones(void **state)
{
    (void)state;
    ViewTransform *transform = NULL;
    Error          err = {0};
    ViewRequest    request = {NULL, OWN_OCIO_CONFIG, "CRT", NULL};
    assert_false(view_transform_create(&request, &transform, &err));
    assert_text_has(&err, "sRGB, Display P3, Rec.1886");
    request.display = "sRGB";
    request.view = "beautiful";
    assert_false(view_transform_create(&request, &transform, &err));
    assert_text_has(&err, "photographic, ACES SDR, untonemapped, raw");
    assert_int_equal(err.code, ERROR_USAGE);
    request = (ViewRequest){"no/such.ocio", OWN_OCIO_CONFIG, NULL, NULL};
    assert_false(view_transform_create(&request, &transform, &err));
    assert_string_equal(err.file, "no/such.ocio");
    assert_null(transform);
    view_transform_destroy(NULL);
}

/* A configuration that does not say what its colours mean. */
static void a_configuration_without_interchange_is_refused(void **state)
{
    (void)state;
    static const char TEXT[] =
        "ocio_profile_version: 1\nroles:\n  default: raw\n  scene_linear: raw\n"
        "displays:\n  screen:\n    - !<View> {name: plain, colorspace: raw}\n"
        "active_displays: []\nactive_views: []\n"
        "colorspaces:\n  - !<ColorSpace>\n    name: raw\n    isdata: false\n";
    Error          err = {0};
    ViewTransform *transform;
    char           path[200];
    snprintf(path, sizeof path, "%s", in_folder("raw.ocio"));
    assert_true(file_write(path, TEXT, sizeof TEXT - 1, &err));
    ViewRequest request = {path, OWN_OCIO_CONFIG, NULL, NULL};
    assert_false(view_transform_create(&request, &transform, &err));
    assert_text_has(&err, "aces_interchange");
    assert_string_equal(err.file, path);
}

/* The studios' own ACES configuration agrees with ours. */
static void a_users_configuration_is_entered_by_its_interchange_role(void **state)
{
    (void)state;
    char path[512];
    snprintf(path, sizeof path, "%s/ocio/cg-config-v1.0.0_aces-v1.3_ocio-v2.1.ocio",
             SHARED_DATA_DIR);
    if (!file_exists(path)) skip();
    Arena         arena = arena_reserve(ARENA_BYTES);
    FrameImage    frame = uniform_frame(2, 2, 18, &arena);
    DevelopReport report;
    Picture p = develop(&frame, (DevelopOptions){.config = path, .exposure = "white:100"},
                        &arena, &report);
    assert_near(p.rgb[0], 0.355954, 1e-4);
    assert_non_null(strstr(report.config, "cg-config"));
    setenv("OCIO", path, 1);
    p = develop(&frame, (DevelopOptions){.exposure = "white:100"}, &arena, &report);
    unsetenv("OCIO");
    assert_near(p.rgb[0], 0.355954, 1e-4);
    assert_non_null(strstr(report.config, "cg-config"));
    arena_release(&arena);
}

/* ---- exposure ---------------------------------------------------------------------------- */

static double grey_of(const char *text, const float *luminance, size_t count)
{
    Arena           arena = arena_reserve(ARENA_BYTES);
    ExposureRequest request;
    Error           err = {0};
    if (!exposure_parse(text, &request, &err)) fail_msg("%s", err.text);
    double grey = exposure_grey(request, luminance, count, arena);
    arena_release(&arena);
    return grey;
}

static void exposure_follows_its_closed_forms(void **state)
{
    (void)state;
    enum { N = 10000 };
    static float luminance[N];
    for (int i = 0; i < N; i++) luminance[i] = 37;
    assert_close(grey_of("auto", luminance, N), 37 * 0.18 / 0.15, 1e-5);
    assert_close(grey_of("0", luminance, N), 0.125, 1e-12);
    assert_close(grey_of("15", luminance, N), 4096, 1e-12);
    assert_close(grey_of("white:250", luminance, N), 45, 1e-12);
    assert_close(exposure_ev_of_grey(exposure_grey_of_ev(7.3)), 7.3, 1e-12);
    for (int i = 0; i < N; i++) luminance[i] = i < 6500 ? 400 : 9000; /* a cabin by day */
    assert_close(grey_of("auto", luminance, N), 400 * 0.18 / 0.15, 1e-4);
    for (int i = 0; i < N; i++) luminance[i] = i < 9700 ? 0.02f : 200; /* displays at night */
    assert_close(grey_of("auto", luminance, N), 200 / 16.0, 1e-4);
    for (int i = 0; i < N; i++) luminance[i] = i < 6500 ? 1 : 30000;
    assert_close(grey_of("auto", luminance, N), 30000 / (16 * 10.0), 1e-4);
}

static void what_is_not_light_has_no_say_in_exposure(void **state)
{
    (void)state;
    const float odd[] = {37, NAN, -5, INFINITY, 0, 37}, nothing[] = {NAN, 0, -1};
    assert_close(grey_of("auto", odd, 6), 37 * 0.18 / 0.15, 1e-5);
    assert_true(grey_of("auto", nothing, 3) == 1);
    assert_true(grey_of("auto", nothing, 0) == 1);
}

static void bad_exposures_are_told(void **state)
{
    (void)state;
    static const char *const BAD[] = {"", "bright", "white:", "white:0", "white:-3", "white:nan",
                                      "1e9", "3 ", "inf", "auto1"};
    for (size_t i = 0; i < sizeof BAD / sizeof *BAD; i++) {
        ExposureRequest request;
        Error           err = {0};
        assert_false(exposure_parse(BAD[i], &request, &err));
        assert_int_equal(err.code, ERROR_USAGE);
        assert_text_has(&err, "wanted auto, an exposure value");
    }
}

/* ---- pictures ---------------------------------------------------------------------------- */

static void a_frame_becomes_the_codes_it_should(void **state)
{
    (void)state;
    Arena          arena = arena_reserve(ARENA_BYTES);
    FrameImage     frame = uniform_frame(8, 5, 90, &arena);
    DevelopOptions options = {.exposure = "white:500", .view = "untonemapped"};
    Error          err = {0};
    Image          image;
    if (!develop_frame(&frame, &options, in_folder("a.png"), arena, NULL, &err))
        fail_msg("%s", err.text);
    assert_true(image_read(in_folder("a.png"), &arena, &image, &err));
    assert_int_equal(image.width, 8);
    assert_int_equal(((const uint8_t *)image.pixels)[0], (int)(255 * 0.461356 + 0.5));
    options.bits = 16;
    assert_true(develop_frame(&frame, &options, in_folder("a.png"), arena, NULL, &err));
    assert_true(image_read(in_folder("a.png"), &arena, &image, &err));
    assert_near(((const uint16_t *)image.pixels)[0], 65535 * 0.461356, 1);
    assert_true(develop_frame(&frame, &options, in_folder("a.tif"), arena, NULL, &err));
    if (!image_read(in_folder("a.tif"), &arena, &image, &err)) fail_msg("%s", err.text);
    assert_near(((const uint16_t *)image.pixels)[0], 65535 * 0.461356, 1);
    options.bits = 8;
    assert_true(develop_frame(&frame, &options, in_folder("a.jpg"), arena, NULL, &err));
    assert_true(image_read(in_folder("a.jpg"), &arena, &image, &err));
    assert_near(((const uint8_t *)image.pixels)[0], 255 * 0.461356, 2);
    arena_release(&arena);
}

static void the_same_frame_makes_the_same_picture_file(void **state)
{
    (void)state;
    Arena          arena = arena_reserve(ARENA_BYTES);
    FrameImage     frame = uniform_frame(8, 5, 90, &arena);
    DevelopOptions options = {.false_colour = true};
    FileBytes      bytes[2];
    Error          err = {0};
    for (int i = 0; i < 2; i++) {
        assert_true(develop_frame(&frame, &options, in_folder("same.png"), arena, NULL, &err));
        assert_true(file_read(in_folder("same.png"), ARENA_BYTES, &arena, &bytes[i], &err));
    }
    assert_int_equal(bytes[0].size, bytes[1].size);
    assert_memory_equal(bytes[0].data, bytes[1].data, bytes[0].size);
    arena_release(&arena);
}

static void what_is_not_finite_is_cleaned_and_counted(void **state)
{
    (void)state;
    Arena      arena = arena_reserve(ARENA_BYTES);
    FrameImage frame = uniform_frame(4, 1, 90, &arena);
    frame.channels[0].values[0] = NAN;
    frame.channels[1].values[1] = INFINITY;
    frame.channels[2].values[2] = -INFINITY;
    DevelopReport report;
    Picture p = develop(&frame, (DevelopOptions){.view = "ACES SDR"}, &arena, &report);
    assert_int_equal(report.nonfinite_pixels, 3);
    for (int i = 0; i < 12; i++) assert_true(isfinite(p.rgb[i]));
    arena_release(&arena);
}

static void a_crop_stands_in_its_frame(void **state)
{
    (void)state;
    Arena      arena = arena_reserve(ARENA_BYTES);
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
    arena_release(&arena);
}

static void a_picture_that_fails_leaves_nothing(void **state)
{
    (void)state;
    Arena          arena = arena_reserve(ARENA_BYTES);
    FrameImage     frame = uniform_frame(64, 64, 90, &arena);
    DevelopOptions options = {.bits = 16};
    Error          err = {0};
    struct rlimit  before, small;
    int            files = files_in_folder();
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
    assert_text_has(&err, "a JPEG holds 8");
    assert_false(develop_frame(&frame, &options, in_folder("a.exr"), arena, NULL, &err));
    assert_text_has(&err, "ends in .png, .jpg");
    arena_release(&arena);
}

/* ---- layers ------------------------------------------------------------------------------ */

static void every_layer_can_be_looked_at(void **state)
{
    (void)state;
    static const char *const CHANNELS[] = {
        "xyz.X", "xyz.Y", "xyz.Z", "depth.Z", "position.X", "position.Y", "position.Z",
        "normal.X", "normal.Y", "normal.Z", "albedo.R", "albedo.G", "albedo.B", "id.part",
        "id.display", "uv.U", "uv.V", "variance.R", "variance.G", "variance.B", "samples.N",
        "light.sun.R", "light.sun.G", "light.sun.B", "display.emitted.R", "display.emitted.G",
        "display.emitted.B", "display.theta", "display.phi", "display.contrast"};
    static const char *const LAYERS[] = {
        "xyz", "depth", "depth.Z", "position", "normal", "albedo", "id", "id.display", "uv",
        "variance", "variance.G", "samples", "light.sun", "display.emitted", "display.theta",
        "display.contrast", "R", "light.sun.B", NULL};
    Arena      arena = arena_reserve(ARENA_BYTES);
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
    arena_release(&arena);
}

static void directions_and_albedo_have_their_closed_forms(void **state)
{
    (void)state;
    Arena      arena = arena_reserve(ARENA_BYTES);
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
    arena_release(&arena);
}

static void an_unknown_layer_is_told_with_those_there_are(void **state)
{
    (void)state;
    Arena          arena = arena_reserve(ARENA_BYTES);
    FrameImage     frame = uniform_frame(2, 1, 90, &arena);
    DevelopOptions options = {.layer = "norml", .frame_name = "f.exr"};
    Picture        picture;
    Error          err = {0};
    frame_add_channel(&frame, "normal.X", false, &arena);
    frame_add_channel(&frame, "display.theta", false, &arena);
    assert_false(develop_picture(&frame, &options, &arena, &picture, NULL, &err));
    assert_text_has(&err, "has no layer \"norml\"; it has: R, G, B, normal, display.theta");
    assert_string_equal(err.file, "f.exr");
    options = (DevelopOptions){.layer = "display.theta", .false_colour = true};
    assert_false(develop_picture(&frame, &options, &arena, &picture, NULL, &err));
    assert_text_has(&err, "is not light");
    arena_release(&arena);
}

/* ---- false colours ----------------------------------------------------------------------- */

static double luminance_of_code(const float srgb[3])
{
    double y = 0;
    for (int c = 0; c < 3; c++) {
        double v = (double)srgb[c];
        double linear = v <= 0.04045 ? v / 12.92 : pow((v + 0.055) / 1.055, 2.4);
        y += linear * (c == 0 ? 0.2126 : c == 1 ? 0.7152 : 0.0722);
    }
    return y;
}

static void false_colours_grow_lighter_all_the_way(void **state)
{
    (void)state;
    double last = -1;
    for (int i = 0; i <= 200; i++) {
        float rgb[3];
        false_colour_of((float)i / 200, rgb);
        for (int c = 0; c < 3; c++) assert_true(rgb[c] >= 0 && rgb[c] <= 1);
        double y = luminance_of_code(rgb);
        assert_true(y > last);
        last = y;
    }
    assert_true(last > 0.8);
}

static void false_colours_show_the_value_by_the_scale(void **state)
{
    (void)state;
    Arena       arena = arena_reserve(ARENA_BYTES);
    const float values[6] = {0.1f, 1, 10, 100, 1000, NAN};
    ScaleRange  range = {0.1f, 1000, true};
    Picture     p = false_colour_picture(values, 6, 1, range, "cd/m^2", &arena);
    assert_true(p.width > 6 && p.height == 1);
    for (int i = 0; i < 5; i++) {
        float want[3];
        assert_near(scale_position(range, values[i]), i / 4.0, 1e-6);
        false_colour_of((float)i / 4, want);
        for (int c = 0; c < 3; c++) assert_near(picture_pixel(&p, i, 0)[c], want[c], 1e-3);
    }
    assert_true(scale_position(range, -1) == 0 && scale_position(range, 0) == 0);
    assert_true(scale_position(range, INFINITY) == 1);
    arena_release(&arena);
}

static void a_scale_has_round_ends_around_the_values(void **state)
{
    (void)state;
    enum { N = 10000 };
    static float values[N];
    Arena        arena = arena_reserve(ARENA_BYTES);
    for (int i = 0; i < N; i++) values[i] = (float)exp(log(0.03) + i * log(7000 / 0.03) / N);
    ScaleRange r = scale_range_of(values, N, true, arena);
    assert_close(r.low, 0.05, 1e-5); /* the 5th percentile is 0.056 */
    assert_close(r.high, 10000, 1e-5);
    for (int i = 0; i < N; i++) values[i] = 5;
    r = scale_range_of(values, N, true, arena);
    assert_close(r.high, 5, 1e-5);
    assert_close(r.low, 0.05, 1e-5);
    for (int i = 0; i < N; i++) values[i] = i == 0 ? NAN : (float)i * 0.0088f;
    r = scale_range_of(values, N, false, arena);
    assert_true(r.low == 0 && r.high == 100);
    values[0] = NAN;
    r = scale_range_of(values, 1, true, arena);
    assert_true(r.low > 0 && r.high > r.low);
    arena_release(&arena);
}

static void letters_are_drawn_as_wide_as_they_are_said_to_be(void **state)
{
    (void)state;
    static const char TEXT[] = "0123456789.-+/:%()abcdefghijklmnopqrstuvwxyz";
    Arena     arena = arena_reserve(ARENA_BYTES);
    Lettering lettering = {24, {1, 1, 1}};
    for (size_t i = 0; i + 1 < sizeof TEXT; i++) {
        char    text[2] = {TEXT[i], 0};
        Picture p = picture_create(60, 60, &arena);
        float   width = lettering_width(lettering, text);
        int     ink = 0;
        lettering_draw(&p, lettering, 12, 30, text);
        for (int k = 0; k < 3600; k++) {
            if (!(p.rgb[3 * k] > 0.5f)) continue;
            ink++;
            assert_true((float)(k % 60) > 12 - 8 && (float)(k % 60) < 12 + width + 1);
        }
        assert_true(ink > 8);
    }
    assert_near(lettering_width(lettering, "00"), 2 * lettering_width(lettering, "0"), 1e-3);
    assert_near(lettering_width(lettering, "1"), lettering_width(lettering, "8"), 1e-3);
    assert_true(lettering_width(lettering, "^2") < lettering_width(lettering, "2"));
    arena_release(&arena);
}

/* ---- colour spaces ----------------------------------------------------------------------- */

static void primaries_give_the_published_matrix(void **state)
{
    (void)state;
    /* ITU-R BT.709 with D65, as in IEC 61966-2-1 to four digits. */
    static const double WANT[3][3] = {
        {0.4124, 0.3576, 0.1805}, {0.2126, 0.7152, 0.0722}, {0.0193, 0.1192, 0.9505}};
    ColourMatrix m = xyz_from_primaries(REC709_CHROMATICITIES);
    for (int i = 0; i < 3; i++)
        for (int j = 0; j < 3; j++) assert_near(m.m[i][j], WANT[i][j], 1e-4);
    ColourMatrix one = rec709_from_primaries(REC709_CHROMATICITIES);
    for (int i = 0; i < 3; i++)
        for (int j = 0; j < 3; j++) assert_near(one.m[i][j], i == j, 1e-12);
    assert_false(chromaticities_are_usable((double[8]){.1, .1, .2, .2, .3, .3, .33, .33}));
    assert_false(chromaticities_are_usable((double[8]){NAN}));
}

/* ---- figures of a region ----------------------------------------------------------------- */

static Measurement measure(const FrameImage *frame, MeasureRequest request, Arena arena)
{
    Measurement m;
    Error       err = {0};
    request.frame_name = "f.exr";
    if (!measure_frame(frame, &request, arena, &m, &err)) fail_msg("%s", err.text);
    return m;
}

static void add_layer(FrameImage *frame, const char *layer, float value, Arena *arena)
{
    for (int c = 0; c < 3; c++) {
        char name[64];
        snprintf(name, sizeof name, "%s.%c", layer, "RGB"[c]);
        float *plane = frame_add_channel(frame, name, false, arena);
        for (size_t i = 0; i < frame_pixel_count(frame); i++) plane[i] = value;
    }
}

static void a_region_has_the_mean_of_its_pixels(void **state)
{
    (void)state;
    Arena      arena = arena_reserve(ARENA_BYTES);
    FrameImage frame = uniform_frame(10, 10, 100, &arena);
    for (int c = 0; c < 3; c++) frame.channels[c].values[0] = 500;
    Measurement m = measure(&frame, (MeasureRequest){.has_region = true, .region = {0, 0, 2, 2}},
                            arena);
    assert_int_equal(m.pixels, 4);
    assert_close(m.luminance.value, 200, 1e-5);
    assert_close(m.least, 100, 1e-5);
    assert_close(m.greatest, 500, 1e-5);
    assert_near(m.x.value, 0.3127, 2e-4);
    assert_near(m.y.value, 0.3290, 2e-4);
    assert_near(m.u.value, 0.1978, 3e-4);
    assert_near(m.v.value, 0.4683, 3e-4);
    assert_true(isnan(m.luminance.half_width) && !m.has_variance && !m.has_contrast);
    frame.channels[1].values[1] = NAN;
    m = measure(&frame, (MeasureRequest){.has_region = true, .region = {0, 0, 2, 2}}, arena);
    assert_int_equal(m.pixels, 3);
    assert_int_equal(m.nonfinite, 1);
    arena_release(&arena);
}

/* 100 pixels whose means have a variance of 4 each: 1.96 * 2 / sqrt(100). */
static void intervals_follow_from_the_variance_layer(void **state)
{
    (void)state;
    Arena      arena = arena_reserve(ARENA_BYTES);
    FrameImage frame = uniform_frame(10, 10, 100, &arena);
    add_layer(&frame, "variance", 4, &arena);
    Measurement m = measure(&frame, (MeasureRequest){0}, arena);
    assert_close(m.luminance.half_width, 1.959964 * 0.2, 1e-4);
    assert_true(m.x.half_width > 0 && m.x.half_width < 0.01);
    arena_release(&arena);
}

/* With channels that are independent and normal the interval of x holds 95 of 100 times. */
static void the_interval_of_chromaticity_covers(void **state)
{
    (void)state;
    enum { TRIALS = 2000 };
    Arena    arena = arena_reserve(ARENA_BYTES);
    unsigned seed = 7;
    int      inside = 0;
    double   truth = 0;
    for (int trial = -1; trial < TRIALS; trial++) {
        Arena      scratch = arena;
        FrameImage frame = uniform_frame(1, 1, 100, &scratch);
        add_layer(&frame, "variance", 4, &scratch);
        for (int c = 0; c < 3; c++) {
            double sum = -6; /* twelve uniform numbers make a normal one */
            for (int k = 0; k < 12; k++) {
                seed = seed * 1664525u + 1013904223u;
                sum += (double)(seed >> 8) / (1 << 24);
            }
            if (trial >= 0) frame.channels[c].values[0] += (float)(2 * sum);
        }
        Measurement m = measure(&frame, (MeasureRequest){0}, scratch);
        if (trial < 0) truth = m.x.value;
        else inside += fabs(m.x.value - truth) <= m.x.half_width;
    }
    assert_near(inside / (double)TRIALS, 0.95, 0.02);
    arena_release(&arena);
}

static void a_display_has_its_contrast(void **state)
{
    (void)state;
    Arena      arena = arena_reserve(ARENA_BYTES);
    FrameImage frame = uniform_frame(10, 10, 100, &arena);
    add_layer(&frame, "variance", 4, &arena);
    add_layer(&frame, "display.white", 400, &arena);
    add_layer(&frame, "display.black", 0.4f, &arena);
    add_layer(&frame, "display.reflected", 20, &arena);
    float *id = frame_add_channel(&frame, "id.display", true, &arena);
    for (int i = 0; i < 100; i++) id[i] = i < 50 ? 1 : i < 60 ? 0 : -1;
    frame_set_string(&frame, "parhelion:display.0", "centre", &arena);
    frame_set_string(&frame, "parhelion:display.1", "cluster", &arena);
    Measurement m = measure(&frame, (MeasureRequest){.display = "cluster"}, arena);
    assert_int_equal(m.pixels, 50);
    assert_true(m.has_contrast);
    assert_close(m.contrast.value, 420 / 20.4, 1e-5);
    assert_close(m.contrast.half_width, 1.959964 * 399.6 / (20.4 * 20.4) * 2 / sqrt(50), 1e-3);
    m = measure(&frame, (MeasureRequest){.display = "centre"}, arena);
    assert_int_equal(m.pixels, 10);
    arena_release(&arena);
}

static void what_cannot_be_measured_is_told(void **state)
{
    (void)state;
    Arena          arena = arena_reserve(ARENA_BYTES);
    FrameImage     frame = uniform_frame(10, 10, 100, &arena);
    MeasureRequest request = {.frame_name = "f.exr", .has_region = true, .region = {5, 5, 11, 8}};
    Measurement    m;
    Error          err = {0};
    assert_false(measure_frame(&frame, &request, arena, &m, &err));
    assert_text_has(&err, "inside the frame's pixels 0,0,10,10");
    frame_set_string(&frame, "parhelion:display.1", "cluster", &arena);
    request = (MeasureRequest){.frame_name = "f.exr", .display = "claster"};
    assert_false(measure_frame(&frame, &request, arena, &m, &err));
    assert_text_has(&err, "its displays: cluster");
    request.display = "cluster";
    assert_false(measure_frame(&frame, &request, arena, &m, &err));
    assert_text_has(&err, "--layers id");
    float *id = frame_add_channel(&frame, "id.display", true, &arena);
    for (int i = 0; i < 100; i++) id[i] = -1;
    assert_false(measure_frame(&frame, &request, arena, &m, &err));
    assert_text_has(&err, "no pixel to measure on display cluster");
    arena_release(&arena);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(middle_grey_has_the_known_codes),
        cmocka_unit_test(untonemapped_is_the_srgb_curve),
        cmocka_unit_test(photographic_is_its_formula),
        cmocka_unit_test(wrong_names_are_told_with_the_right_ones),
        cmocka_unit_test(a_configuration_without_interchange_is_refused),
        cmocka_unit_test(a_users_configuration_is_entered_by_its_interchange_role),
        cmocka_unit_test(exposure_follows_its_closed_forms),
        cmocka_unit_test(what_is_not_light_has_no_say_in_exposure),
        cmocka_unit_test(bad_exposures_are_told),
        cmocka_unit_test(a_frame_becomes_the_codes_it_should),
        cmocka_unit_test(the_same_frame_makes_the_same_picture_file),
        cmocka_unit_test(what_is_not_finite_is_cleaned_and_counted),
        cmocka_unit_test(a_crop_stands_in_its_frame),
        cmocka_unit_test(a_picture_that_fails_leaves_nothing),
        cmocka_unit_test(every_layer_can_be_looked_at),
        cmocka_unit_test(directions_and_albedo_have_their_closed_forms),
        cmocka_unit_test(an_unknown_layer_is_told_with_those_there_are),
        cmocka_unit_test(false_colours_grow_lighter_all_the_way),
        cmocka_unit_test(false_colours_show_the_value_by_the_scale),
        cmocka_unit_test(a_scale_has_round_ends_around_the_values),
        cmocka_unit_test(letters_are_drawn_as_wide_as_they_are_said_to_be),
        cmocka_unit_test(primaries_give_the_published_matrix),
        cmocka_unit_test(a_region_has_the_mean_of_its_pixels),
        cmocka_unit_test(intervals_follow_from_the_variance_layer),
        cmocka_unit_test(the_interval_of_chromaticity_covers),
        cmocka_unit_test(a_display_has_its_contrast),
        cmocka_unit_test(what_cannot_be_measured_is_told),
    };
    return cmocka_run_group_tests(tests, make_folder, remove_folder);
}
