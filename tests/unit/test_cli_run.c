/* SPDX-License-Identifier: Apache-2.0 */
/* The program as its users start it: exit statuses, outputs, interruption. */
#include "fixture.h"

#include <fcntl.h>
#include <jansson.h>
#include <signal.h>
#include <sys/stat.h>

#include "image/frame.h"

/* A room that lights itself: one quad that emits 100 cd/m2 in front of a grey one. */
static const char scene_text[] =
    "{\"asset\":{\"version\":\"2.0\"},\"scene\":0,\"scenes\":[{\"nodes\":[0,1,2]}],"
    "\"nodes\":[{\"name\":\"lamp\",\"mesh\":0,\"translation\":[0,1,-2]},"
    "{\"name\":\"wall\",\"mesh\":1,\"translation\":[0,0,-3],\"scale\":[4,4,4]},"
    "{\"name\":\"eye\",\"camera\":0}],"
    "\"cameras\":[{\"name\":\"lens\",\"type\":\"perspective\",\"perspective\":"
    "{\"yfov\":0.9,\"znear\":0.01}}],"
    "\"materials\":[{\"name\":\"glow\",\"emissiveFactor\":[1,1,1],\"extensions\":"
    "{\"KHR_materials_emissive_strength\":{\"emissiveStrength\":100}},\"doubleSided\":true},"
    "{\"name\":\"grey\",\"pbrMetallicRoughness\":{\"baseColorFactor\":[0.5,0.5,0.5,1],"
    "\"metallicFactor\":0}}],"
    "\"extensionsUsed\":[\"KHR_materials_emissive_strength\"],"
    "\"meshes\":[{\"primitives\":[{\"attributes\":{\"POSITION\":0},\"indices\":1,"
    "\"material\":0}]},{\"primitives\":[{\"attributes\":{\"POSITION\":0},\"indices\":1,"
    "\"material\":1}]}],"
    "\"buffers\":[{\"byteLength\":60,\"uri\":\"data:application/octet-stream;base64,"
    "AAAAvwAAAL8AAAAAAAAAPwAAAL8AAAAAAAAAPwAAAD8AAAAAAAAAvwAAAD8AAAAAAAABAAIAAAACAAMA\"}],"
    "\"bufferViews\":[{\"buffer\":0,\"byteLength\":48},"
    "{\"buffer\":0,\"byteOffset\":48,\"byteLength\":12}],"
    "\"accessors\":[{\"bufferView\":0,\"componentType\":5126,\"count\":4,\"type\":\"VEC3\","
    "\"min\":[-0.5,-0.5,0],\"max\":[0.5,0.5,0]},"
    "{\"bufferView\":1,\"componentType\":5123,\"count\":6,\"type\":\"SCALAR\"}]}";

typedef struct Outcome {
    int status; /* exit status */
    char out[16384], err[16384];
} Outcome;

/* ---- running ----------------------------------------------------------------------------- */

static pid_t start(const char *const *words, int out, int err) {
    char *argv[32] = {(char *)(uintptr_t)PROGRAM};
    for (int i = 0; words[i]; i++) argv[i + 1] = (char *)(uintptr_t)words[i];
    pid_t child = fork();
    if (child != 0) return child;
    if (chdir(test_folder())) _exit(99);
    dup2(out, STDOUT_FILENO);
    dup2(err, STDERR_FILENO);
    execv(PROGRAM, argv);
    _exit(98);
}

static void read_back(FILE *file, char *text, size_t size) {
    ssize_t length = pread(fileno(file), text, size - 1, 0);
    text[length < 0 ? 0 : length] = '\0';
    fclose(file);
}

static int exit_status(pid_t child) {
    int status;
    assert_int_equal(waitpid(child, &status, 0), child);
    assert_true(WIFEXITED(status));
    return WEXITSTATUS(status);
}

static void run(const char *const *words, Outcome *outcome) {
    FILE *out = tmpfile(), *err = tmpfile();
    pid_t child = start(words, fileno(out), fileno(err));
    outcome->status = exit_status(child);
    read_back(out, outcome->out, sizeof outcome->out);
    read_back(err, outcome->err, sizeof outcome->err);
}

#define RUN(outcome, ...) run((const char *const[]){__VA_ARGS__, NULL}, (outcome))

/* With this status. */
#define RUN_AS(wanted, outcome, ...) \
    do { \
        RUN(outcome, __VA_ARGS__); \
        if ((outcome)->status != (wanted)) \
            fail_msg("status %d, required: %d: %s", (outcome)->status, wanted, (outcome)->err); \
    } while (0)

static FrameImage read_frame(const char *name, Arena *arena) {
    FrameImage frame = {0};
    assert_done(frame_read(in_folder(name), arena, &frame, &err));
    return frame;
}

static bool exists(const char *name) {
    return access(in_folder(name), F_OK) == 0;
}

static double whole_attribute(const FrameImage *frame, const char *name) {
    const ExrAttribute *attribute = frame_attribute(frame, name);
    assert_non_null(attribute);
    return attribute->values[0];
}

static void assert_same_pixels(const FrameImage *a, const FrameImage *b) {
    static const char *const names[] = {"R", "G", "B"};
    assert_int_equal(frame_pixel_count(a), frame_pixel_count(b));
    for (int i = 0; i < 3; i++)
        assert_memory_equal(frame_channel(a, names[i]), frame_channel(b, names[i]),
                            frame_pixel_count(a) * sizeof(float));
}

/* ---- exit statuses ----------------------------------------------------------------------- */

TEST(a_wrong_line_is_status_2) {
    Outcome o;
    RUN_AS(2, &o, "rendr");
    assert_non_null(strstr(o.err, "parhelion: unknown command rendr — did you mean render? "
                                  "There are render, develop, panel, "));
    RUN_AS(2, &o, "render", "scene.gltf");
    assert_string_equal(o.err, "parhelion: no output — add -o FRAME.exr\n");
    RUN_AS(2, &o, "render", "scene.gltf", "-o", "a.exr", "--sppp", "3");
    assert_non_null(strstr(o.err, "did you mean --spp?"));
    RUN(&o, "render", "scene.gltf", "-o", "a.png");
    assert_string_equal(o.err, "parhelion: -o a.png: required: a name that ends in .exr, or in "
                               ".hdr for a Radiance picture\n");
    RUN(&o, "render", "scene.gltf", "-o", "a.exr", "--spp", "4", "--samples", "0:4");
    assert_string_equal(o.err, "parhelion: --spp and --samples exclude each other — --samples "
                               "0:N is --spp N\n");
    assert_false(exists("a.exr"));
}

TEST(an_option_of_the_other_basis_is_refused) {
    Outcome o;
    RUN_AS(2, &o, "panel", "fit", "set.json", "-o", "a.panel", "--keep", "0.1");
    assert_string_equal(o.err, "parhelion: --keep is for --basis haar, --basis vertex has "
                               "--max-error\n");
    RUN_AS(2, &o, "panel", "fit", "set.json", "-o", "a.panel", "--basis", "haar", "--max-error",
           "0.1");
    assert_string_equal(o.err, "parhelion: --max-error is for --basis vertex, --basis haar has "
                               "--keep\n");
}

TEST(an_hdri_that_is_missing_or_not_linear_is_named) {
    Outcome o;
    RUN_AS(3, &o, "render", "scene.gltf", "-o", "a.exr", "--environment", "hdri:nowhere.exr");
    assert_non_null(strstr(o.err, "parhelion: nowhere.exr: "));
    RUN_AS(2, &o, "render", "scene.gltf", "-o", "a.exr", "--png", "x.gif");
    assert_non_null(strstr(o.err, "parhelion: x.gif: "));
    assert_false(exists("a.exr"));
}

TEST(a_frame_too_large_is_refused_before_it_fills_the_memory) {
    Outcome o;
    RUN_AS(2, &o, "render", "scene.gltf", "-o", "a.exr", "--size", "65536x65536", "--crop",
           "0,0,4,4");
    assert_string_equal(o.err, "parhelion: --size 65536x65536: 4294967296 pixels, at most "
                               "268435456 are supported\n");
    if ((double)sysconf(_SC_PHYS_PAGES) * (double)sysconf(_SC_PAGESIZE) > 160e9) return;
    RUN_AS(3, &o, "render", "scene.gltf", "-o", "a.exr", "--size", "16384x16384", "--layers",
           "all");
    assert_non_null(strstr(o.err, "parhelion: the film of 16384x16384 pixels needs 343.6 GB "
                                  "with its frame, there are "));
}

TEST(a_missing_input_is_status_3_and_named) {
    Outcome o;
    RUN_AS(3, &o, "render", "nowhere.gltf", "-o", "a.exr", "--json");
    assert_non_null(strstr(o.err, "parhelion: nowhere.gltf: "));
    json_t *answer = json_loads(o.out, 0, NULL), *error = json_object_get(answer, "error");
    assert_int_equal(json_integer_value(json_object_get(error, "status")), 3);
    assert_string_equal(json_string_value(json_object_get(error, "file")), "nowhere.gltf");
    assert_non_null(json_object_get(error, "path"));
    assert_non_null(json_object_get(error, "message"));
    json_decref(answer);
}

ARENA_TEST(a_picture_with_negative_light_is_told_of) {
    Outcome o;
    Error err = {0};
    FrameImage picture = frame_create(8, 4, (ExrWindow){0, 0, 8, 4}, 3, 8, &arena);
    for (int c = 0; c < 3; c++) {
        float *values = frame_add_channel(&picture,
                                          c == 0   ? "R"
                                          : c == 1 ? "G"
                                                   : "B",
                                          false, &arena);
        for (int i = 0; i < 32; i++) values[i] = c == 1 && i % 16 == 3 ? -1.0f : 10.0f;
    }
    assert_true(frame_write(in_folder("negative.exr"), &picture, &err));
    RUN(&o, "render", "scene.gltf", "-o", "a.exr", "--size", "4x4", "--spp", "1", "--environment",
        "hdri:negative.exr");
    if (o.status) fail_msg("%s", o.err);
    assert_non_null(strstr(o.err, "negative.exr: 2 negative values count as 0"));
}

/* One command renders with the layers that the filter goes by, and filters the picture only. */
TEST(render_makes_a_denoised_picture_at_once) {
    Outcome o;
    RUN(&o, "render", "scene.gltf", "-o", "a.exr", "--size", "8x6", "--spp", "2", "--png", "a.png",
        "--denoise", "--adapt", "local");
    if (o.status) fail_msg("%s", o.err);
    assert_non_null(strstr(o.out, "  denoised, of the light, %  adapted  "));
    assert_non_null(strstr(o.out, "  local  "));
    RUN_AS(0, &o, "develop", "a.exr", "-o", "a.png", "--denoise");
    RUN_AS(2, &o, "render", "scene.gltf", "-o", "a.exr", "--size", "8x6", "--spp", "2",
           "--denoise");
    assert_non_null(strstr(o.err, "a look is asked for, but no picture"));
}

/* Half of the first sample is taken before the other half: the frame is the same. */
TEST(a_preview_shows_a_first_look_and_then_the_same_frame) {
    Outcome o;
    RUN_AS(0, &o, "render", "scene.gltf", "-o", "a.exr", "--size", "513x257", "--png", "a.png",
           "--preview", "--spp", "1", "--no-guiding");
    assert_non_null(strstr(o.err, "a.png: a first look, of a quarter of the pixels; "));
    RUN_AS(0, &o, "render", "scene.gltf", "-o", "b.exr", "--size", "513x257", "--png", "b.png",
           "--denoise", "--spp", "1", "--no-guiding");
    assert_null(strstr(o.err, "a first look"));
    RUN_AS(0, &o, "compare", "a.exr", "b.exr");
    assert_non_null(strstr(o.out, "same: B: equal in every pixel"));
}

TEST(a_preview_is_four_samples_denoised) {
    Outcome o;
    RUN_AS(0, &o, "render", "scene.gltf", "-o", "a.exr", "--size", "8x6", "--png", "a.png",
           "--preview");
    assert_non_null(strstr(o.out, "  denoised, of the light, %  "));
    assert_non_null(strstr(o.out, "samples a pixel   4\n"));
    RUN_AS(0, &o, "render", "scene.gltf", "-o", "a.exr", "--size", "8x6", "--png", "a.png",
           "--preview", "--spp", "2");
    assert_non_null(strstr(o.out, "samples a pixel   2\n"));
    assert_null(strstr(o.err, "a first look"));
    RUN_AS(2, &o, "render", "scene.gltf", "-o", "a.exr", "--png", "a.png", "--preview", "--noise",
           "0.1");
    assert_non_null(strstr(o.err, "--preview and --noise exclude each other"));
    RUN_AS(2, &o, "render", "scene.gltf", "-o", "a.exr", "--png", "a.png", "--preview", "--samples",
           "0:4");
    RUN_AS(2, &o, "render", "scene.gltf", "-o", "a.exr", "--preview");
    assert_non_null(strstr(o.err, "add --png FILE"));
}

TEST(an_output_that_cannot_be_written_is_status_4_at_once) {
    Outcome o;
    RUN_AS(4, &o, "render", "scene.gltf", "-o", "nowhere/a.exr", "--spp", "1000000");
    assert_string_equal(o.err, "parhelion: nowhere/a.exr: cannot be written: No such file or "
                               "directory\n");
    RUN_AS(4, &o, "render", "scene.gltf", "-o", "a.exr", "--png", "nowhere/a.png", "--spp",
           "1000000");
}

TEST(version_and_help_need_nothing) {
    Outcome o;
    RUN_AS(0, &o, "--version");
    assert_non_null(strstr(o.out, "parhelion " PARHELION_VERSION "\nsources: "));
    assert_non_null(strstr(o.out, "Embree "));
    assert_non_null(strstr(o.out, "OpenColorIO "));
    RUN_AS(0, &o, "--help");
    assert_non_null(strstr(o.out, "  render "));
    RUN_AS(0, &o, "render", "--help");
    assert_non_null(strstr(o.out, "example:\n  parhelion render scenes/"));
    assert_string_equal(o.err, "");
}

/* ---- frames ------------------------------------------------------------------------------ */

MEMORY_TEST(a_frame_says_how_to_make_it_again) {
    Outcome o;
    RUN_AS(0, &o, "render", "scene.gltf", "-o", "a.exr", "--size", "16x12", "--spp", "3", "--seed",
           "9", "--quiet", "--layers", "id,samples");
    assert_string_equal(o.err, "");
    assert_non_null(strstr(o.out, "pixels            16, 12\nsamples a pixel   3\n"));
    FrameImage frame = read_frame("a.exr", arena);
    assert_string_equal(frame_string(&frame, "parhelion:commandLine"),
                        "parhelion render scene.gltf --size 16x12 --spp 3 --seed 9 "
                        "--layers id,samples");
    assert_string_equal(frame_string(&frame, "parhelion:samples"), "0:3");
    assert_string_equal(frame_string(&frame, "parhelion:seed"), "9");
    assert_string_equal(frame_string(&frame, "parhelion:camera"), "eye");
    assert_string_equal(frame_string(&frame, "parhelion:part.0"), "lamp");
    assert_non_null(strstr(frame_string(&frame, "parhelion:inputs"), "  scene.gltf\n"));
    assert_true(whole_attribute(&frame, "parhelion:complete") == 1);
    assert_true(whole_attribute(&frame, "parhelion:maxBounces") == 64);
    assert_true(whole_attribute(&frame, "whiteLuminance") == 1);
    assert_non_null(frame_attribute(&frame, "worldToCamera"));
    assert_null(frame_attribute(&frame, "capDate"));
    assert_true(frame_channel(&frame, "samples.N")[5] == 3);
}

MEMORY_TEST(the_time_is_told_when_the_build_system_fixes_it) {
    Outcome o;
    setenv("SOURCE_DATE_EPOCH", "86400", 1);
    RUN(&o, "render", "scene.gltf", "-o", "t.exr", "--size", "4x4", "--spp", "1", "--quiet");
    unsetenv("SOURCE_DATE_EPOCH");
    FrameImage frame = read_frame("t.exr", arena);
    assert_string_equal(frame_string(&frame, "capDate"), "1970:01:02 00:00:00");
}

MEMORY_TEST(threads_do_not_change_a_bit_and_a_crop_is_a_part) {
    Outcome o;
    RUN(&o, "render", "scene.gltf", "-o", "one.exr", "--size", "50x40", "--spp", "5", "--threads",
        "1", "--quiet");
    RUN(&o, "render", "scene.gltf", "-o", "five.exr", "--size", "50x40", "--spp", "5", "--threads",
        "5", "--quiet");
    RUN(&o, "render", "scene.gltf", "-o", "crop.exr", "--size", "50x40", "--spp", "5", "--crop",
        "7,9,31,30", "--quiet");
    FrameImage one = read_frame("one.exr", arena), five = read_frame("five.exr", arena);
    FrameImage crop = read_frame("crop.exr", arena);
    assert_same_pixels(&one, &five);
    assert_int_equal(crop.data.x0, 7);
    assert_int_equal(crop.display.x1, 50);
    for (int y = 9; y < 30; y++)
        assert_memory_equal(frame_channel(&one, "G") + y * 50 + 7,
                            frame_channel(&crop, "G") + (y - 9) * 24, 24 * sizeof(float));
}

MEMORY_TEST(a_replayed_sample_is_the_one_that_was_rendered) {
    Outcome o;
    RUN(&o, "render", "scene.gltf", "-o", "s.exr", "--size", "16x12", "--samples", "6:7",
        "--quiet");
    FrameImage frame = read_frame("s.exr", arena);
    RUN_AS(0, &o, "render", "scene.gltf", "--size", "16x12", "--replay", "8,6,6", "--json");
    json_auto_t *answer = json_loads(o.out, 0, NULL);
    json_t *green = json_array_get(json_object_get(answer, "RGB"), 1);
    assert_close(json_number_value(green), (double)frame_channel(&frame, "G")[6 * 16 + 8], 1e-8);
    assert_true(json_number_value(green) > 0);
    assert_string_equal(json_string_value(json_object_get(answer, "part")), "wall");
}

MEMORY_TEST(noise_stops_before_spp) {
    Outcome o;
    RUN_AS(0, &o, "render", "scene.gltf", "-o", "n.exr", "--size", "16x12", "--spp", "100000",
           "--noise", "0.2", "--json", "--quiet");
    json_auto_t *answer = json_loads(o.out, 0, NULL);
    double error = json_number_value(json_object_get(answer, "relative_error"));
    int samples = (int)json_integer_value(json_object_get(answer, "samples"));
    assert_true(error > 0 && error <= 0.2);
    assert_in_range(samples, 16, 20000);
    assert_true(json_is_true(json_object_get(answer, "complete")));
    assert_true(json_integer_value(json_object_get(answer, "rays")) > 16 * 12 * samples / 2);
    assert_true(json_number_value(json_object_get(answer, "peak_memory_bytes")) > 1e6);
    assert_int_equal(json_array_size(json_object_get(answer, "warnings")), 0);
    FrameImage frame = read_frame("n.exr", arena);
    assert_close(whole_attribute(&frame, "parhelion:relativeError"), error, 1e-6);
}

TEST(noise_that_is_not_reached_is_said) {
    Outcome o;
    RUN_AS(0, &o, "render", "scene.gltf", "-o", "n.exr", "--size", "16x12", "--spp", "2", "--noise",
           "0.0001", "--quiet");
    assert_non_null(strstr(o.err, "parhelion: warning: the relative error of the frame is 0."));
    assert_non_null(strstr(o.err, ", not the 0.0001 of --noise, after all 2 samples a pixel\n"));
    RUN(&o, "render", "scene.gltf", "-o", "n.exr", "--size", "16x12", "--spp", "2", "--noise",
        "display:0.5", "--quiet", "--json");
    assert_string_equal(o.err,
                        "parhelion: warning: nothing of the displays is in view: --noise had "
                        "nothing to go by\n");
    json_auto_t *answer = json_loads(o.out, 0, NULL);
    assert_int_equal(json_array_size(json_object_get(answer, "warnings")), 1);
}

/* The corner of the room that has no noise decides, not the rest; a name that is no display's
 * is reported. */
TEST(noise_of_an_area_decides_alone) {
    Outcome o;
    RUN_AS(0, &o, "render", "scene.gltf", "-o", "n.exr", "--size", "16x12", "--spp", "64",
           "--noise", "2,2,9,8:0.9", "--quiet", "--json");
    json_auto_t *answer = json_loads(o.out, 0, NULL);
    assert_int_equal(json_integer_value(json_object_get(answer, "samples")), 16);
    RUN_AS(2, &o, "render", "scene.gltf", "-o", "n.exr", "--size", "16x12", "--noise",
           "display:cluster:0.1", "--quiet");
    assert_non_null(strstr(o.err, "--noise display:cluster: no display has this name"));
}

TEST(a_picture_is_developed_as_well) {
    Outcome o;
    RUN_AS(0, &o, "render", "scene.gltf", "-o", "p.exr", "--size", "16x12", "--spp", "1", "--png",
           "p.png", "--quiet");
    assert_true(exists("p.exr") && exists("p.png"));
    assert_non_null(strstr(o.out, "\np.png  "));
}

TEST(a_scene_without_a_camera_is_framed_whole_with_a_warning) {
    Outcome o;
    RUN_AS(0, &o, "render", "blind.gltf", "-o", "b.exr", "--size", "16x12", "--spp", "1",
           "--quiet");
    assert_true(strstr(o.err, "parhelion: warning: blind.gltf: the scene has no camera: it is "
                              "framed whole, seen from the front, from ") == o.err);
    assert_non_null(strstr(o.err, " — another place with --eye and --look-at"));
    assert_ptr_equal(strchr(o.err, '\n'), o.err + strlen(o.err) - 1);
}

/* ---- interruption ------------------------------------------------------------------------ */

/* Waits until a file has something in it. */
static void wait_for_bytes(FILE *file) {
    struct stat info;
    for (int i = 0; i < 1000; i++) {
        if (!fstat(fileno(file), &info) && info.st_size > 0) return;
        usleep(10000);
    }
    fail_msg("nothing came for ten seconds");
}

/* Starts an endless render and returns when its first progress line is out: a time that one
 * thread fills as well as two, where the law is not about both. */
static pid_t start_long_render(const char *output, const char *threads, FILE *out, FILE *err) {
    const char *const words[] = {"render",    "scene.gltf", "-o",         output,       "--size",
                                 "32x32",     "--spp",      "2000000000", "--progress", "json",
                                 "--threads", threads,      NULL};
    pid_t child = start(words, fileno(out), fileno(err));
    wait_for_bytes(err);
    return child;
}

MEMORY_TEST(an_interrupted_render_leaves_a_frame_marked_incomplete) {
    static const struct {
        int number, status;
        const char *name;
    } cases[] = {{SIGINT, 130, "INT"}, {SIGTERM, 143, "TERM"}, {SIGHUP, 129, "HUP"}};
    for (int i = 0; i < 3; i++) {
        Outcome o;
        char text[64];
        FILE *out = tmpfile(), *err = tmpfile();
        pid_t child = start_long_render("i.exr", i ? "1" : "2", out, err);
        kill(child, cases[i].number);
        assert_int_equal(exit_status(child), cases[i].status);
        read_back(out, o.out, sizeof o.out);
        read_back(err, o.err, sizeof o.err);
        snprintf(text, sizeof text, "parhelion: i.exr: stopped by %s after ", cases[i].name);
        assert_non_null(strstr(o.err, text));
        assert_non_null(strstr(o.err, "; the frame is marked incomplete — go on with: "
                                      "parhelion render --resume scene.gltf -o i.exr"));
        assert_true(exists("i.exr.checkpoint"));
        unlink(in_folder("i.exr.checkpoint"));
        assert_non_null(strstr(o.out, "complete          no\n"));
        FrameImage frame = read_frame("i.exr", arena);
        assert_true(whole_attribute(&frame, "parhelion:complete") == 0);
        assert_true(frame_channel(&frame, "G")[16 * 32 + 16] > 0);
    }
}

TEST(a_second_signal_ends_at_once_and_leaves_nothing) {
    FILE *out = tmpfile(), *err = tmpfile();
    pid_t child = start_long_render("k.exr", "1", out, err);
    kill(child, SIGSTOP);
    kill(child, SIGINT);
    kill(child, SIGTERM);
    kill(child, SIGCONT);
    int status = exit_status(child);
    assert_true(status == 130 || status == 143);
    assert_false(exists("k.exr"));
    fclose(out);
    fclose(err);
}

MEMORY_TEST(usr1_writes_a_snapshot_and_goes_on) {
    FILE *out = tmpfile(), *err = tmpfile();
    pid_t child = start_long_render("u.exr", "1", out, err);
    kill(child, SIGUSR1);
    for (int i = 0; i < 1000 && !exists("u.exr"); i++) usleep(10000);
    FrameImage frame = read_frame("u.exr", arena);
    assert_true(whole_attribute(&frame, "parhelion:complete") == 0);
    assert_int_equal(waitpid(child, NULL, WNOHANG), 0);
    kill(child, SIGTERM);
    assert_int_equal(exit_status(child), 143);
    fclose(out);
    fclose(err);
}

/* ---- the folder -------------------------------------------------------------------------- */

/* The scene with its camera node taken off the list. */
static void write_blind_scene(void) {
    char text[sizeof scene_text];
    char *nodes;
    memcpy(text, scene_text, sizeof text);
    nodes = strstr(text, "[0,1,2]");
    memcpy(nodes, "[0,1]  ", 7);
    write_text(in_folder("blind.gltf"), text);
}

static int write_scenes(void **state) {
    if (make_folder(state)) return -1;
    write_text(in_folder("scene.gltf"), scene_text);
    write_blind_scene();
    return 0;
}

TEST_PROGRAM(write_scenes, clear_folder)
