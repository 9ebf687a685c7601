/* SPDX-License-Identifier: Apache-2.0 */
/* develop and measure as scripts use them: exit statuses, answers, what is left behind. */
#include "fixture.h"

#include <jansson.h>

#include "image/frame.h"
#include "image/image.h"

typedef struct Outcome {
    int status;
    char out[8192];
} Outcome;

/* Runs `parhelion WORDS` in the folder; stderr is thrown away, or with "2>&1" joins stdout. */
static Outcome run(const char *words) {
    Outcome outcome;
    char line[1024];
    snprintf(line, sizeof line, "cd %s && unset OCIO && %s %s %s", test_folder(), PROGRAM, words,
             strstr(words, "2>&1") ? "" : "2>/dev/null");
    FILE *pipe = popen(line, "r");
    size_t size = fread(outcome.out, 1, sizeof outcome.out - 1, pipe);
    outcome.out[size] = '\0';
    outcome.status = WEXITSTATUS(pclose(pipe));
    return outcome;
}

/* With this status. */
static Outcome run_as(int wanted, const char *words) {
    Outcome outcome = run(words);
    if (outcome.status != wanted)
        fail_msg("%s: status %d, required: %d", words, outcome.status, wanted);
    return outcome;
}

static void add(FrameImage *frame, const char *name, float left, float right, Arena *arena) {
    float *plane = frame_add_channel(frame, name, !strncmp(name, "id", 2), arena);
    for (int i = 0; i < 12 * 8; i++) plane[i] = i % 12 < 6 ? left : right;
}

static int remove_pictures(void **state) {
    static const char *const NAMES[] = {"f.exr", "a.png", "b.png", "c.tif",
                                        "d.jpg", "e.png", "n.exr", "n.png"};
    for (size_t i = 0; i < sizeof NAMES / sizeof *NAMES; i++) unlink(in_folder(NAMES[i]));
    return remove_folder(state);
}

/* A display of 100 cd/m2 at the left, a wall of 300 cd/m2 at the right. */
static int write_frame(void **state) {
    static const char *const DISPLAY[] = {"white", "black", "reflected"};
    static const float LEVELS[] = {400, 1, 4};
    if (make_folder(state)) return -1;
    Arena arena = test_arena(state);
    FrameImage frame = frame_create(12, 8, (ExrWindow){0, 0, 12, 8}, 20, 5, &arena);
    Error err = {0};
    for (int c = 0; c < 3; c++) {
        char name[64];
        add(&frame, (char[]){"RGB"[c], 0}, 100, 300, &arena);
        snprintf(name, sizeof name, "variance.%c", "RGB"[c]);
        add(&frame, name, 1, 1, &arena);
        for (int k = 0; k < 3; k++) {
            snprintf(name, sizeof name, "display.%s.%c", DISPLAY[k], "RGB"[c]);
            add(&frame, name, LEVELS[k], NAN, &arena);
        }
    }
    add(&frame, "id.display", 0, -1, &arena);
    frame_set_string(&frame, "parhelion:display.0", "cluster", &arena);
    return frame_write(in_folder("f.exr"), &frame, &err) ? 0 : -1;
}

static json_t *answer(const Outcome *outcome) {
    json_error_t error;
    json_t *document = json_loads(outcome->out, 0, &error);
    if (!document) fail_msg("%s: %s", error.text, outcome->out);
    return document;
}

static double number(const json_t *document, const char *key) {
    const json_t *value = json_object_get(document, key);
    if (!json_is_number(value)) fail_msg("no number %s", key);
    return json_number_value(value);
}

ARENA_TEST(develop_writes_what_it_says) {
    Outcome o = run("develop f.exr -o a.png --exposure white:500 --view untonemapped");
    Image image;
    assert_int_equal(o.status, 0);
    assert_non_null(strstr(o.out, " 90.00 cd/m2\n"));
    assert_non_null(strstr(o.out, "parhelion-1"));
    assert_done(image_read(in_folder("a.png"), &arena, &image, &err));
    assert_int_equal(image.width, 12);
    /* 100/500 and 300/500 through the sRGB curve */
    assert_int_equal(((const uint8_t *)image.pixels)[0], 124);
    assert_int_equal(((const uint8_t *)image.pixels)[4 * 11], 203);
}

TEST(develop_answers_in_json) {
    Outcome o = run_as(0, "develop f.exr -o b.png --exposure 10 --json");
    json_t *j = answer(&o);
    assert_string_equal(json_string_value(json_object_get(j, "output")), "b.png");
    assert_string_equal(json_string_value(json_object_get(j, "view")), "photographic");
    assert_close(number(j, "exposure_ev"), 10, 1e-9);
    assert_close(number(j, "middle_grey_cd_m2"), 128, 1e-9);
    assert_true(number(j, "nonfinite_pixels") == 0);
    json_decref(j);
    o = run("develop f.exr -o e.png --false-colour luminance --range 1,1000 --json");
    j = answer(&o);
    assert_string_equal(json_string_value(json_object_get(j, "scale")),
                        "1 to 1000 cd/m^2, logarithmic");
    json_decref(j);
}

static int code_at(const char *picture, int x, int y, Arena *arena) {
    Image image;
    assert_done(image_read(in_folder(picture), arena, &image, &err));
    return ((const uint8_t *)image.pixels)[4 * (y * image.width + x)];
}

/* The frame does not say how high it is; once it does, --fov must agree. */
ARENA_TEST(develop_sees_as_an_eye) {
    Outcome o = run_as(2, "develop f.exr -o b.png --eye 70 2>&1");
    assert_non_null(strstr(o.out, "f.exr: does not say its field of view"));
    assert_non_null(strstr(o.out, "--fov DEG"));
    o = run_as(0, "develop f.exr -o b.png --eye 70 --fov 2 --exposure white:500 "
                  "--view untonemapped");
    assert_non_null(strstr(o.out, "light as in an eye of 70 years, pigment 0.5; of what lies"));
    /* 124 and 203 without an eye; it mixes them at the edge between, at the border less. */
    int dark = code_at("b.png", 5, 4, &arena), bright = code_at("b.png", 6, 4, &arena);
    assert_true(dark > 126 && bright < 202 && dark < bright);
    assert_true(code_at("b.png", 0, 4, &arena) < dark);
    assert_true(code_at("b.png", 11, 4, &arena) > bright);
    o = run("develop f.exr -o b.png --eye 70,0 --fov 2 --json");
    json_t *j = answer(&o), *eye = json_object_get(j, "eye");
    assert_close(number(eye, "age_years"), 70, 0);
    assert_near(number(eye, "pigment"), 0, 0);
    json_decref(j);
    o = run("develop f.exr -o b.png --eye 50 --fov 2 --false-colour luminance --json");
    j = answer(&o);
    assert_non_null(json_object_get(j, "scale"));
    assert_close(number(json_object_get(j, "eye"), "age_years"), 50, 0);
    json_decref(j);
    o = run("develop f.exr -o b.png --json");
    j = answer(&o);
    assert_true(json_is_null(json_object_get(j, "eye")));
    json_decref(j);
}

ARENA_TEST(an_eye_needs_a_view) {
    FrameImage frame = frame_create(4, 4, (ExrWindow){0, 0, 4, 4}, 3, 5, &arena);
    for (int c = 0; c < 3; c++) frame_add_channel(&frame, (char[]){"RGB"[c], 0}, false, &arena);
    frame_set_number(&frame, "parhelion:yfov_deg", 40, &arena);
    assert_done(frame_write(in_folder("n.exr"), &frame, &err));
    run_as(0, "develop n.exr -o n.png --eye 30");
    run_as(0, "develop n.exr -o n.png --eye 30 --fov 40");
    Outcome o = run_as(2, "develop n.exr -o n.png --eye 30 --fov 41 2>&1");
    assert_non_null(strstr(o.out, "n.exr: says itself that it is 40 degrees high"));
    run_as(2, "develop n.exr -o n.png --eye 30 --layer R");
    frame_set_number(&frame, "parhelion:yfov_deg", 190, &arena);
    assert_done(frame_write(in_folder("n.exr"), &frame, &err));
    o = run_as(3, "develop n.exr -o n.png --eye 30 2>&1");
    assert_non_null(strstr(o.out, "yfov_deg is 190, required: degrees between 0 and 180"));
    frame_set_number(&frame, "parhelion:ymag_m", 1, &arena);
    assert_done(frame_write(in_folder("n.exr"), &frame, &err));
    o = run_as(3, "develop n.exr -o n.png --eye 30 2>&1");
    assert_non_null(strstr(o.out, "orthographic"));
}

TEST(other_endings_work) {
    run_as(0, "develop f.exr -o c.tif --bits 16");
    run_as(0, "develop f.exr -o d.jpg --view 'ACES SDR'");
    assert_true(file_exists(in_folder("c.tif")) && file_exists(in_folder("d.jpg")));
}

TEST(wrong_uses_have_their_status) {
    run_as(2, "develop f.exr");
    run_as(2, "develop f.exr -o x.gif");
    run_as(2, "develop f.exr -o x.jpg --bits 16");
    run_as(2, "develop f.exr -o x.png --exposure bright");
    run_as(2, "develop f.exr -o x.png --layer nothing");
    run_as(2, "develop f.exr -o x.png --view nothing");
    run_as(2, "develop f.exr -o x.png --false-colour hue");
    run_as(3, "develop none.exr -o x.png");
    run_as(3, "develop f.exr -o x.png --config none.ocio");
    run_as(4, "develop f.exr -o none/x.png");
    run_as(3, "measure none.exr");
    run_as(2, "measure f.exr --region 0,0,13,8");
    run_as(2, "measure f.exr --region 0,0,1.5,8");
    run_as(2, "measure f.exr --display other");
    run_as(2, "measure");
    Outcome o = run("develop none.exr -o x.png 2>&1");
    assert_string_equal(o.out, "parhelion: none.exr: cannot be opened: No such file or "
                               "directory\n");
}

/* The frame of write_frame with all that the filter goes by. */
static void write_layers(void **state) {
    static const char *const GIVEN[] = {"normal.X", "normal.Y", "normal.Z",
                                        "albedo.R", "albedo.G", "albedo.B"};
    Arena arena = test_arena(state);
    FrameImage frame;
    assert_done(frame_read(in_folder("f.exr"), &arena, &frame, &err));
    for (size_t i = 0; i < sizeof GIVEN / sizeof *GIVEN; i++)
        add(&frame, GIVEN[i], 0.5f, 0.5f, &arena);
    for (const char *c = "RGB"; *c; c++)
        add(&frame, arena_format(&arena, "display.emitted.%c", *c), 96, NAN, &arena);
    add(&frame, "display.coverage", 1, 0, &arena);
    assert_done(frame_write(in_folder("n.exr"), &frame, &err));
}

static bool picture_says(const char *name, const char *words) {
    Arena arena = arena_reserve(1 << 20);
    FileBytes bytes;
    bool found = false;
    assert_done(file_read(in_folder(name), 1 << 19, &arena, &bytes, &err));
    for (size_t i = 0; i + strlen(words) <= bytes.size; i++)
        found = found || !memcmp((const char *)bytes.data + i, words, strlen(words));
    arena_release(&arena);
    return found;
}

TEST(looks_that_are_no_figures_say_so) {
    write_layers(state);
    Outcome o = run_as(0, "develop n.exr -o n.png --denoise --adapt local --json");
    json_t *j = answer(&o), *denoised = json_object_get(j, "denoised");
    assert_close(number(denoised, "energy_ratio"), 1, 1e-4);
    assert_true(number(denoised, "block_error") < 0.0081);
    assert_true(number(denoised, "left_share") == 0);
    assert_string_equal(json_string_value(json_object_get(j, "adapt")), "local");
    json_decref(j);
    assert_true(picture_says("n.png", "denoised preview, not for figures; locally adapted, not "
                                      "for figures; middle grey"));
    o = run("develop n.exr -o n.png --json");
    j = answer(&o);
    assert_true(json_is_null(json_object_get(j, "denoised")));
    assert_true(json_is_null(json_object_get(j, "adapt")));
    json_decref(j);
    assert_false(picture_says("n.png", "not for figures"));
    o = run("develop n.exr -o n.png --denoise");
    assert_non_null(strstr(o.out, "denoised, of the light  "));
}

/* Nothing that gives figures takes a filtered or adapted frame. */
TEST(figures_are_of_the_frame_alone) {
    static const char *const WORDS[] = {
        "measure n.exr --display cluster --denoise",
        "measure n.exr --adapt local",
        "compare n.exr n.exr --denoise",
        "compare n.exr n.exr --adapt local",
        "develop n.exr -o m.exr --denoise",
        "develop n.exr -o n.png --denoise --layer normal",
        "develop n.exr -o n.png --denoise --false-colour luminance",
        "develop n.exr -o n.png --adapt local --false-colour luminance",
        "develop n.exr -o n.png --adapt local --layer normal",
        "develop n.exr -o n.png --adapt global",
        "merge n.exr -o m.exr --denoise"};
    for (size_t i = 0; i < sizeof WORDS / sizeof *WORDS; i++) run_as(2, WORDS[i]);
    Outcome o = run_as(3, "develop f.exr -o n.png --denoise 2>&1");
    assert_non_null(strstr(o.out, "parhelion: f.exr: lacks what --denoise requires (missing: "
                                  "normal, albedo, display.emitted, display.coverage) — "
                                  "render it with --layers normal,albedo,"));
}

TEST(help_tells_the_options) {
    Outcome o = run_as(0, "develop --help");
    assert_non_null(strstr(o.out, "--exposure auto|EV|white:CD_M2"));
    o = run_as(0, "measure --help");
    assert_non_null(strstr(o.out, "--region X0,Y0,X1,Y1"));
}

TEST(measure_gives_the_figures_of_a_display) {
    Outcome o = run_as(0, "measure f.exr --display cluster --json");
    json_t *j = answer(&o), *contrast = json_object_get(j, "contrast");
    assert_true(number(j, "pixels") == 48);
    assert_close(number(j, "luminance_cd_m2"), 100, 1e-5);
    assert_close(json_number_value(json_array_get(json_object_get(j, "luminance_interval"), 1)),
                 100 + 1.959964 / sqrt(48) + (1 + 14 / 48.0) / 48, 1e-5); /* bright_missing */
    assert_near(json_number_value(json_array_get(json_object_get(j, "xy"), 0)), 0.3127, 2e-4);
    assert_near(json_number_value(json_array_get(json_object_get(j, "uv"), 1)), 0.4683, 3e-4);
    assert_close(number(contrast, "value"), 404 / 5.0, 1e-5);
    assert_int_equal(json_array_size(json_object_get(j, "missing_layers")), 0);
    json_decref(j);
}

TEST(measure_gives_the_figures_of_a_region) {
    Outcome o = run("measure f.exr --region 6,0,12,8 --json");
    json_auto_t *j = answer(&o);
    assert_close(number(j, "luminance_cd_m2"), 300, 1e-5);
    assert_true(json_is_null(json_object_get(j, "contrast")));
    o = run("measure f.exr --region 3,0,9,8");
    assert_non_null(strstr(o.out, " 200.0 +- 0.3 cd/m2\n"));
    assert_non_null(strstr(o.out, " 100 cd/m2\n"));
}

TEST_PROGRAM(write_frame, remove_pictures)
