/* The program as its users start it: exit statuses, outputs, interruption. */
#include "check.h"

#include <dirent.h>
#include <fcntl.h>
#include <jansson.h>
#include <signal.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include "base/units.h"
#include "cli/render_command.h"

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
    int  status; /* exit status */
    char out[16384], err[16384];
} Outcome;

static char folder[256];

/* ---- running ----------------------------------------------------------------------------- */

static pid_t start(const char *const *words, int out, int err)
{
    char *argv[32] = {(char *)(uintptr_t)PROGRAM};
    for (int i = 0; words[i]; i++) argv[i + 1] = (char *)(uintptr_t)words[i];
    pid_t child = fork();
    if (child != 0) return child;
    if (chdir(folder)) _exit(99);
    dup2(out, STDOUT_FILENO);
    dup2(err, STDERR_FILENO);
    execv(PROGRAM, argv);
    _exit(98);
}

static void read_back(FILE *file, char *text, size_t size)
{
    ssize_t length = pread(fileno(file), text, size - 1, 0);
    text[length < 0 ? 0 : length] = '\0';
    fclose(file);
}

static int exit_status(pid_t child)
{
    int status;
    assert_int_equal(waitpid(child, &status, 0), child);
    assert_true(WIFEXITED(status));
    return WEXITSTATUS(status);
}

static void run(const char *const *words, Outcome *outcome)
{
    FILE *out = tmpfile(), *err = tmpfile();
    pid_t child = start(words, fileno(out), fileno(err));
    outcome->status = exit_status(child);
    read_back(out, outcome->out, sizeof outcome->out);
    read_back(err, outcome->err, sizeof outcome->err);
}

#define RUN(outcome, ...) run((const char *const[]){__VA_ARGS__, NULL}, (outcome))

static char *in_folder(char path[512], const char *name)
{
    snprintf(path, 512, "%s/%s", folder, name);
    return path;
}

static FrameImage read_frame(const char *name, Arena *arena)
{
    char       path[512];
    FrameImage frame = {0};
    Error      err = {0};
    if (!frame_read(in_folder(path, name), arena, &frame, &err)) fail_msg("%s", err.text);
    return frame;
}

static bool exists(const char *name)
{
    char path[512];
    return access(in_folder(path, name), F_OK) == 0;
}

static double whole_attribute(const FrameImage *frame, const char *name)
{
    const ExrAttribute *attribute = frame_attribute(frame, name);
    assert_non_null(attribute);
    return attribute->values[0];
}

static void assert_same_pixels(const FrameImage *a, const FrameImage *b)
{
    static const char *const names[] = {"R", "G", "B"};
    assert_int_equal(frame_pixel_count(a), frame_pixel_count(b));
    for (int i = 0; i < 3; i++)
        assert_memory_equal(frame_channel(a, names[i]), frame_channel(b, names[i]),
                            frame_pixel_count(a) * sizeof(float));
}

/* ---- exit statuses ----------------------------------------------------------------------- */

static void a_wrong_line_is_status_2(void **state)
{
    (void)state;
    Outcome o;
    RUN(&o, "rendr");
    assert_int_equal(o.status, 2);
    assert_string_equal(o.err, "parhelion: unknown command rendr — did you mean render? "
                               "`parhelion --help` lists them\n");
    RUN(&o, "render", "scene.gltf");
    assert_int_equal(o.status, 2);
    assert_string_equal(o.err, "parhelion: no output — add -o FRAME.exr\n");
    RUN(&o, "render", "scene.gltf", "-o", "a.exr", "--sppp", "3");
    assert_int_equal(o.status, 2);
    assert_non_null(strstr(o.err, "did you mean --spp?"));
    RUN(&o, "render", "scene.gltf", "-o", "a.png");
    assert_string_equal(o.err, "parhelion: -o a.png: wanted a name that ends in .exr\n");
    RUN(&o, "render", "scene.gltf", "-o", "a.exr", "--spp", "4", "--samples", "0:4");
    assert_string_equal(o.err, "parhelion: --spp and --samples exclude each other — --samples "
                               "0:N is --spp N\n");
    assert_false(exists("a.exr"));
}

static void values_of_render_are_checked_before_anything_is_read(void **state)
{
    static const struct {
        const char *option, *value, *text;
    } cases[] = {
        {"--samples", "5:5",
         "--samples 5:5: wanted A:B, whole numbers with 0 <= A < B <= "
         "2147483647"},
        {"--samples", "-1:5", "--samples -1:5: wanted A:B"},
        {"--samples", "5", "--samples 5: wanted A:B"},
        {"--noise", "0", "--noise 0: wanted a relative error above 0 and below 1"},
        {"--noise", "displays:0.1", "--noise displays:0.1: wanted a relative error"},
        {"--layers", "depth,norml",
         "--layers: no layer is named 'norml' — did you mean normal?"},
        {"--layers", "", "--layers '': wanted a text that is not empty"},
        {"--crop", "0,0,65,4",
         "--crop 0,0,65,4: wanted X0,Y0,X1,Y1 with X0 < X1 and Y0 < Y1 "
         "inside the frame of 64x36 pixels"},
        {"--crop", "4,0,4,4", "--crop 4,0,4,4: wanted X0,Y0,X1,Y1"},
        {"--crop", "0.5,0,4,4", "--crop: 0.5 is no whole number of pixels"},
        {"--replay", "64,0,1", "--replay 64,0,1: wanted X,Y,SAMPLE"},
        {"--content", "cluster", "--content cluster: wanted NAME=VALUE, both not empty"},
        {"--view", "raw", "a look is asked for, but no picture — add --png FILE"},
    };
    Arena *arena = *state;
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        RenderRequest request;
        Error         err = {0};
        const char   *words[] = {"render", "nowhere.gltf", "-o", "a.exr", "--size", "64x36",
                                 cases[i].option, cases[i].value};
        assert_false(render_request_parse(8, (char **)(uintptr_t)words, arena, &request, &err));
        if (err.code != ERROR_USAGE || strstr(err.text, cases[i].text) != err.text)
            fail_msg("%s %s: %s", cases[i].option, cases[i].value, err.text);
    }
}

static void values_of_the_surroundings_are_checked(void **state)
{
    static const struct {
        EnvironmentChange change;
        const char       *text;
    } cases[] = {
        {{.environment = "sky:clear"},
         "--environment sky:clear: sky models are not available in "
         "this version — use constant:CD_M2 or hdri:FILE"},
        {{.environment = "constant:-1"},
         "--environment constant:-1: wanted a luminance in cd/m2, "
         "at least 0"},
        {{.environment = "black"}, "--environment black: wanted constant:CD_M2 or hdri:FILE"},
        {{.has_hdri_lux = true, .hdri_lux = 9},
         "--hdri-lux: there is no HDRI — add --environment "
         "hdri:FILE"},
        {{.sun = "100,20"},
         "--sun 100,20: the scene's sun has no illuminance to keep — write "
         "AZ,EL,LUX"},
        {{.sun = "1,95,1000"},
         "--sun 1,95,1000: wanted off, or AZ,EL,LUX with AZ -360 to 360 and "
         "EL -90 to 90 degrees and LUX at least 0"},
        {{.has_forward = true, .forward = {0, 1, 0}},
         "--forward 0,1,0: wanted a vector that is "
         "not vertical"},
    };
    Arena *arena = *state;
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        Scene scene = {0};
        Error err = {0};
        assert_false(render_change_environment(&cases[i].change, &scene, arena, &err));
        assert_int_equal(err.code, ERROR_USAGE);
        assert_string_equal(err.text, cases[i].text);
    }
}

static void the_line_overrides_single_members_of_the_surroundings(void **state)
{
    Arena            *arena = *state;
    Scene             scene = {.environment = {.has_sun = true, .sun_illuminance_lx = 5000,
                                               .sun_angular_radius = 0.01f}};
    EnvironmentChange change = {.environment = "constant:250", .sun = "90,30",
                                .has_heading = true, .heading_deg = 180};
    Error             err;
    assert_true(render_change_environment(&change, &scene, arena, &err));
    const Environment *e = &scene.environment;
    assert_int_equal(e->kind, ENVIRONMENT_CONSTANT);
    assert_true(e->luminance_cd_m2 == 250 && e->color[2] == 1);
    assert_close(e->sun_azimuth, PI / 2, 1e-6);
    assert_close(e->sun_elevation, PI / 6, 1e-6);
    assert_true(e->sun_illuminance_lx == 5000 && e->sun_angular_radius == 0.01f);
    assert_close(e->heading, PI, 1e-6);
    assert_true(e->forward.z == -1);
    EnvironmentChange off = {.sun = "off"};
    assert_true(render_change_environment(&off, &scene, arena, &err));
    assert_false(e->has_sun);
    assert_true(e->luminance_cd_m2 == 250);
}

static void a_camera_is_found_by_node_then_by_camera_then_by_place(void **state)
{
    SceneCamera cameras[] = {{.node_name = "left", .camera_name = "1"},
                             {.node_name = "right", .camera_name = "left"},
                             {.node_name = "", .camera_name = "lens"}};
    Scene       scene = {.cameras = cameras, .camera_count = 3};
    Problems    problems = problems_start(*state);
    SceneCamera found;
    Error       err;
    static const struct {
        const char *wanted;
        int         index;
    } cases[] = {{NULL, 0}, {"left", 0}, {"1", 0}, {"right", 1}, {"lens", 2}, {"2", 2}};
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        assert_true(render_choose_camera(&scene, cases[i].wanted, &problems, &found, &err));
        assert_ptr_equal(found.camera_name, cameras[cases[i].index].camera_name);
    }
    assert_false(render_choose_camera(&scene, "3", &problems, &found, &err));
    assert_string_equal(err.text,
                        "--camera 3: no camera has this name or index — the scene has 0 "
                        "'left', 1 'right', 2 'lens'");
    assert_int_equal(problems.count, 0);
    Scene empty = {0};
    assert_false(render_choose_camera(&empty, NULL, &problems, &found, &err));
    assert_string_equal(err.text, "the scene has neither a camera nor triangles to look at");
}

static void an_hdri_that_is_missing_or_not_linear_is_named(void **state)
{
    (void)state;
    Outcome o;
    RUN(&o, "render", "scene.gltf", "-o", "a.exr", "--environment", "hdri:nowhere.exr");
    assert_int_equal(o.status, 3);
    assert_non_null(strstr(o.err, "parhelion: nowhere.exr: "));
    RUN(&o, "render", "scene.gltf", "-o", "a.exr", "--png", "x.gif");
    assert_int_equal(o.status, 2);
    assert_non_null(strstr(o.err, "parhelion: x.gif: "));
    assert_false(exists("a.exr"));
}

static void a_missing_input_is_status_3_and_named(void **state)
{
    (void)state;
    Outcome o;
    RUN(&o, "render", "nowhere.gltf", "-o", "a.exr", "--json");
    assert_int_equal(o.status, 3);
    assert_non_null(strstr(o.err, "parhelion: nowhere.gltf: "));
    json_t *answer = json_loads(o.out, 0, NULL), *error = json_object_get(answer, "error");
    assert_int_equal(json_integer_value(json_object_get(error, "status")), 3);
    assert_string_equal(json_string_value(json_object_get(error, "file")), "nowhere.gltf");
    assert_non_null(json_object_get(error, "path"));
    assert_non_null(json_object_get(error, "message"));
    json_decref(answer);
}

static void an_output_that_cannot_be_written_is_status_4_at_once(void **state)
{
    (void)state;
    Outcome o;
    RUN(&o, "render", "scene.gltf", "-o", "nowhere/a.exr", "--spp", "1000000");
    assert_int_equal(o.status, 4);
    assert_string_equal(o.err, "parhelion: nowhere/a.exr: cannot be written: No such file or "
                               "directory\n");
    RUN(&o, "render", "scene.gltf", "-o", "a.exr", "--png", "nowhere/a.png", "--spp",
        "1000000");
    assert_int_equal(o.status, 4);
}

static void version_and_help_need_nothing(void **state)
{
    (void)state;
    Outcome o;
    RUN(&o, "--version");
    assert_int_equal(o.status, 0);
    assert_non_null(strstr(o.out, "parhelion " PARHELION_VERSION "\ninstruction set: "));
    assert_non_null(strstr(o.out, "Embree "));
    assert_non_null(strstr(o.out, "OpenColorIO "));
    RUN(&o, "--help");
    assert_int_equal(o.status, 0);
    assert_non_null(strstr(o.out, "  render "));
    RUN(&o, "render", "--help");
    assert_int_equal(o.status, 0);
    assert_non_null(strstr(o.out, "example:\n  parhelion render scenes/"));
    assert_string_equal(o.err, "");
}

/* ---- frames ------------------------------------------------------------------------------ */

static void a_frame_says_how_to_make_it_again(void **state)
{
    Arena  *arena = *state;
    Outcome o;
    RUN(&o, "render", "scene.gltf", "-o", "a.exr", "--size", "16x12", "--spp", "3", "--seed",
        "9", "--quiet", "--layers", "id,samples");
    assert_int_equal(o.status, 0);
    assert_string_equal(o.err, "");
    assert_non_null(strstr(o.out, "a.exr: 16x12, 3 samples a pixel, "));
    FrameImage frame = read_frame("a.exr", arena);
    assert_string_equal(frame_string(&frame, "parhelion:commandLine"),
                        "parhelion render scene.gltf -o a.exr --size 16x12 --spp 3 --seed 9 "
                        "--quiet --layers id,samples");
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

static void the_time_is_told_when_the_build_system_fixes_it(void **state)
{
    Arena  *arena = *state;
    Outcome o;
    setenv("SOURCE_DATE_EPOCH", "86400", 1);
    RUN(&o, "render", "scene.gltf", "-o", "t.exr", "--size", "4x4", "--spp", "1", "--quiet");
    unsetenv("SOURCE_DATE_EPOCH");
    FrameImage frame = read_frame("t.exr", arena);
    assert_string_equal(frame_string(&frame, "capDate"), "1970:01:02 00:00:00");
}

static void threads_do_not_change_a_bit_and_a_crop_is_a_part(void **state)
{
    Arena  *arena = *state;
    Outcome o;
    RUN(&o, "render", "scene.gltf", "-o", "one.exr", "--size", "50x40", "--spp", "5",
        "--threads", "1", "--quiet");
    RUN(&o, "render", "scene.gltf", "-o", "five.exr", "--size", "50x40", "--spp", "5",
        "--threads", "5", "--quiet");
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

static void a_replayed_sample_is_the_one_that_was_rendered(void **state)
{
    Arena  *arena = *state;
    Outcome o;
    RUN(&o, "render", "scene.gltf", "-o", "s.exr", "--size", "16x12", "--samples", "6:7",
        "--quiet");
    FrameImage frame = read_frame("s.exr", arena);
    RUN(&o, "render", "scene.gltf", "--size", "16x12", "--replay", "8,6,6", "--json");
    assert_int_equal(o.status, 0);
    json_t *answer = json_loads(o.out, 0, NULL);
    json_t *green = json_array_get(json_object_get(answer, "RGB"), 1);
    assert_close(json_number_value(green), (double)frame_channel(&frame, "G")[6 * 16 + 8],
                 1e-8);
    assert_true(json_number_value(green) > 0);
    assert_string_equal(json_string_value(json_object_get(answer, "part")), "wall");
    json_decref(answer);
}

static void noise_stops_before_spp(void **state)
{
    Arena  *arena = *state;
    Outcome o;
    RUN(&o, "render", "scene.gltf", "-o", "n.exr", "--size", "16x12", "--spp", "100000",
        "--noise", "0.2", "--json", "--quiet");
    assert_int_equal(o.status, 0);
    json_t *answer = json_loads(o.out, 0, NULL);
    double  error = json_number_value(json_object_get(answer, "relative_error"));
    int     samples = (int)json_integer_value(json_object_get(answer, "samples"));
    assert_true(error > 0 && error <= 0.2);
    assert_in_range(samples, 16, 20000);
    assert_true(json_is_true(json_object_get(answer, "complete")));
    assert_true(json_integer_value(json_object_get(answer, "rays")) > 16 * 12 * samples / 2);
    assert_true(json_number_value(json_object_get(answer, "peak_memory_bytes")) > 1e6);
    assert_int_equal(json_array_size(json_object_get(answer, "warnings")), 0);
    json_decref(answer);
    FrameImage frame = read_frame("n.exr", arena);
    assert_close(whole_attribute(&frame, "parhelion:relativeError"), error, 1e-6);
}

static void a_picture_is_developed_as_well(void **state)
{
    (void)state;
    Outcome o;
    RUN(&o, "render", "scene.gltf", "-o", "p.exr", "--size", "16x12", "--spp", "1", "--png",
        "p.png", "--quiet");
    assert_int_equal(o.status, 0);
    assert_true(exists("p.exr") && exists("p.png"));
    assert_non_null(strstr(o.out, "p.png: "));
}

static void a_scene_without_a_camera_is_framed_whole_with_a_warning(void **state)
{
    (void)state;
    Outcome o;
    RUN(&o, "render", "blind.gltf", "-o", "b.exr", "--size", "16x12", "--spp", "1", "--quiet");
    assert_int_equal(o.status, 0);
    assert_string_equal(o.err, "parhelion: warning: blind.gltf: the scene has no camera: it is "
                               "framed whole\n");
}

/* ---- interruption ------------------------------------------------------------------------ */

/* Waits until a file has something in it. */
static void wait_for_bytes(FILE *file)
{
    struct stat info;
    for (int i = 0; i < 1000; i++) {
        if (!fstat(fileno(file), &info) && info.st_size > 0) return;
        usleep(10000);
    }
    fail_msg("nothing came for ten seconds");
}

/* Starts an endless render and returns when its first progress line is out. */
static pid_t start_long_render(const char *output, FILE *out, FILE *err)
{
    const char *const words[] = {"render", "scene.gltf", "-o", output, "--size", "32x32",
                                 "--spp", "2000000000", "--progress", "json", NULL};
    pid_t child = start(words, fileno(out), fileno(err));
    wait_for_bytes(err);
    return child;
}

static void an_interrupted_render_leaves_a_frame_marked_incomplete(void **state)
{
    static const struct {
        int         number, status;
        const char *name;
    } cases[] = {{SIGINT, 130, "INT"}, {SIGTERM, 143, "TERM"}};
    Arena *arena = *state;
    for (int i = 0; i < 2; i++) {
        Outcome o;
        char    text[64];
        FILE   *out = tmpfile(), *err = tmpfile();
        pid_t   child = start_long_render("i.exr", out, err);
        kill(child, cases[i].number);
        assert_int_equal(exit_status(child), cases[i].status);
        read_back(out, o.out, sizeof o.out);
        read_back(err, o.err, sizeof o.err);
        snprintf(text, sizeof text, "parhelion: i.exr: stopped by %s after ", cases[i].name);
        assert_non_null(strstr(o.err, text));
        assert_non_null(strstr(o.out, "(incomplete)"));
        FrameImage frame = read_frame("i.exr", arena);
        assert_true(whole_attribute(&frame, "parhelion:complete") == 0);
        assert_true(frame_channel(&frame, "G")[16 * 32 + 16] > 0);
    }
}

static void a_second_signal_ends_at_once_and_leaves_nothing(void **state)
{
    (void)state;
    FILE *out = tmpfile(), *err = tmpfile();
    pid_t child = start_long_render("k.exr", out, err);
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

static void usr1_writes_a_snapshot_and_goes_on(void **state)
{
    Arena *arena = *state;
    FILE  *out = tmpfile(), *err = tmpfile();
    pid_t  child = start_long_render("u.exr", out, err);
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

static void write_text(const char *name, const char *text)
{
    char  path[512];
    FILE *file = fopen(in_folder(path, name), "w");
    assert_non_null(file);
    fputs(text, file);
    fclose(file);
}

/* The scene with its camera node taken off the list. */
static void write_blind_scene(void)
{
    char  text[sizeof scene_text];
    char *nodes;
    memcpy(text, scene_text, sizeof text);
    nodes = strstr(text, "[0,1,2]");
    memcpy(nodes, "[0,1]  ", 7);
    write_text("blind.gltf", text);
}

static int set_up(void **state)
{
    static Arena arena;
    const char  *base = getenv("TMPDIR");
    snprintf(folder, sizeof folder, "%s/parhelion_cli_XXXXXX", base ? base : P_tmpdir);
    if (!mkdtemp(folder)) return -1;
    write_text("scene.gltf", scene_text);
    write_blind_scene();
    arena = arena_reserve((size_t)1 << 28);
    *state = &arena;
    return 0;
}

static int tear_down(void **state)
{
    DIR *listing = opendir(folder);
    for (struct dirent *entry; listing && (entry = readdir(listing));) {
        char path[512];
        if (entry->d_name[0] != '.') unlink(in_folder(path, entry->d_name));
    }
    if (listing) closedir(listing);
    arena_release(*state);
    return rmdir(folder);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_wrong_line_is_status_2),
        cmocka_unit_test(values_of_render_are_checked_before_anything_is_read),
        cmocka_unit_test(values_of_the_surroundings_are_checked),
        cmocka_unit_test(the_line_overrides_single_members_of_the_surroundings),
        cmocka_unit_test(a_camera_is_found_by_node_then_by_camera_then_by_place),
        cmocka_unit_test(an_hdri_that_is_missing_or_not_linear_is_named),
        cmocka_unit_test(a_missing_input_is_status_3_and_named),
        cmocka_unit_test(an_output_that_cannot_be_written_is_status_4_at_once),
        cmocka_unit_test(version_and_help_need_nothing),
        cmocka_unit_test(a_frame_says_how_to_make_it_again),
        cmocka_unit_test(the_time_is_told_when_the_build_system_fixes_it),
        cmocka_unit_test(threads_do_not_change_a_bit_and_a_crop_is_a_part),
        cmocka_unit_test(a_replayed_sample_is_the_one_that_was_rendered),
        cmocka_unit_test(noise_stops_before_spp),
        cmocka_unit_test(a_picture_is_developed_as_well),
        cmocka_unit_test(a_scene_without_a_camera_is_framed_whole_with_a_warning),
        cmocka_unit_test(an_interrupted_render_leaves_a_frame_marked_incomplete),
        cmocka_unit_test(a_second_signal_ends_at_once_and_leaves_nothing),
        cmocka_unit_test(usr1_writes_a_snapshot_and_goes_on),
    };
    return cmocka_run_group_tests_name("cli_run", tests, set_up, tear_down);
}
