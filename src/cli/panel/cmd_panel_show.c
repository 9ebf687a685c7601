/* SPDX-License-Identifier: Apache-2.0 */
/* panel show: a bare display as an eye sees it, in given light: a render of a scene that the
 * command writes itself. */
#include <math.h>
#include <string.h>

#include "base/arena.h"
#include "base/count.h"
#include "base/error.h"
#include "base/file.h"
#include "base/units.h"
#include "cli/options/answer.h"
#include "cli/options/look_options.h"
#include "cli/panel/panel_commands.h"
#include "cli/render/cmd_render.h"
#include "cli/render/command_line.h"
#include "cli/render/render_columns.h"
#include "denoise/denoise.h"
#include "image/image.h"
#include "panel/query/panel_open.h"
#include "panel/query/panel_report.h"
#include "spectrum/twice.h"
#include "text/base64.h"
#include "text/json_text.h"
#include "text/text.h"

/* ---- the scene -------------------------------------------------------------------------- */

/* A bare display, the light on it and the eye that sees it, for `panel show`.
 *
 * Frame    the display's: metres from its centre, +X to its right as seen, +Y up, +Z towards
 *          who looks at it. Theta counts from +Z, phi from +X to +Y, as everywhere of a panel.
 */

#define SHOW_DISPLAY "display" /* the material's name */

typedef struct ShowScene {
    double size_m[2];                    /* of the active area */
    double eye_m[3];                     /* z > 0; looks at the centre */
    double ambient_lx;                   /* on the display, from an even dome; 0: none */
    double directed_lx;                  /* on the display, from a disc; 0: none */
    double directed_theta, directed_phi; /* degrees */
} ShowScene;

#define LONGER_SIDE 1280
#define LEAST_SIDE 16
#define WIDEST_FOV_DEG 170

/* ---- directions -------------------------------------------------------------------------- */

/* Where theta, phi (degrees) and a distance lead. */
static void show_place(double theta_deg, double phi_deg, double distance_m, double out_m[3]) {
    double theta = radians_from_degrees(theta_deg), phi = radians_from_degrees(phi_deg);
    out_m[0] = distance_m * sin(theta) * cos(phi);
    out_m[1] = distance_m * sin(theta) * sin(phi);
    out_m[2] = distance_m * cos(theta);
}

static double show_distance(const double at_m[3]) {
    return hypot(hypot(at_m[0], at_m[1]), at_m[2]);
}

/* Degrees; phi from 0 to 360. */
static void show_angles(const double at_m[3], double *theta_deg, double *phi_deg) {
    double across = hypot(at_m[0], at_m[1]);
    *theta_deg = degrees_from_radians(atan2(across, at_m[2]));
    *phi_deg = across > 0 ? degrees_from_radians(atan2(at_m[1], at_m[0])) : 0;
    if (*phi_deg < 0) *phi_deg += 360;
}

/* ---- the document ------------------------------------------------------------------------ */

/* A strip of two triangles whose content begins at the upper left corner. */
static void add_corners(Text *text) {
    static const float corners[4][5] = {{-0.5f, 0.5f, 0, 0, 0},
                                        {-0.5f, -0.5f, 0, 0, 1},
                                        {0.5f, 0.5f, 0, 1, 0},
                                        {0.5f, -0.5f, 0, 1, 1}};
    text_add(text, "\"buffers\": [{\"byteLength\": 80, \"uri\": "
                   "\"data:application/octet-stream;base64,");
    base64_encode(text, corners, sizeof corners);
    text_add(text,
             "\"}], \"bufferViews\": [{\"buffer\": 0, \"byteLength\": 80, \"byteStride\": 20, "
             "\"target\": 34962}], \"accessors\": [{\"bufferView\": 0, "
             "\"componentType\": 5126, \"count\": 4, \"type\": \"VEC3\", "
             "\"min\": [-0.5, -0.5, 0], \"max\": [0.5, 0.5, 0]}, "
             "{\"bufferView\": 0, \"byteOffset\": 12, \"componentType\": 5126, \"count\": 4, "
             "\"type\": \"VEC2\"}], ");
}

/* A dome of lux / pi all around, and a sun: its illuminance is normal to its beam, north -Z. */
static void add_light(Text *text, const ShowScene *scene) {
    double towards[3],
        illuminance = scene->directed_lx / cos(radians_from_degrees(scene->directed_theta));
    text_format(text,
                "\"extensions\": {\"PARHELION_environment\": {\"type\": \"constant\", "
                "\"luminance\": %.17g",
                scene->ambient_lx / PI);
    show_place(scene->directed_theta, scene->directed_phi, 1, towards);
    if (scene->directed_lx > 0)
        text_format(text,
                    ", \"sun\": {\"azimuth_deg\": %.17g, \"elevation_deg\": %.17g, "
                    "\"illuminance_lx\": %.17g}",
                    degrees_from_radians(atan2(towards[0], -towards[2])),
                    degrees_from_radians(asin(towards[1])), illuminance);
    text_add(text, "}}");
}

/* glTF: the display is a material without a panel or content. */
static const char *show_scene_text(const ShowScene *scene, Arena *arena) {
    Text text = {.arena = arena};
    text_add(&text, "{\"asset\": {\"version\": \"2.0\"}, \"extensionsUsed\": "
                    "[\"PARHELION_environment\", \"PARHELION_display\"], ");
    add_corners(&text);
    text_add(&text, "\"materials\": [{\"name\": \"" SHOW_DISPLAY "\", \"extensions\": "
                    "{\"PARHELION_display\": {\"any_size\": true}}}], "
                    "\"meshes\": [{\"primitives\": [{\"mode\": 5, \"material\": 0, "
                    "\"attributes\": {\"POSITION\": 0, \"TEXCOORD_0\": 1}}]}], ");
    text_format(&text,
                "\"nodes\": [{\"name\": \"" SHOW_DISPLAY "\", \"mesh\": 0, "
                "\"scale\": [%.17g, %.17g, 1]}], \"scene\": 0, "
                "\"scenes\": [{\"nodes\": [0], ",
                scene->size_m[0], scene->size_m[1]);
    add_light(&text, scene);
    text_add(&text, "}]}\n");
    return text.data;
}

/* ---- the frame --------------------------------------------------------------------------- */

/* Tangents of the half angles, to the side and upwards, that hold all corners. */
static bool find_reach(const ShowScene *scene, double reach[2]) {
    const double *eye = scene->eye_m;
    double far = show_distance(eye);
    double z[3] = {eye[0] / far, eye[1] / far, eye[2] / far}; /* towards the eye */
    double level = hypot(z[0], z[2]);
    double x[3] = {z[2] / level, 0, -z[0] / level}; /* +Y is up */
    double y[2] = {z[1] * x[2], level};             /* corners have no Z */
    reach[0] = reach[1] = 0;
    for (int i = 0; i < 4; i++) {
        double cx = (i & 1 ? 0.5 : -0.5) * scene->size_m[0];
        double cy = (i & 2 ? 0.5 : -0.5) * scene->size_m[1];
        double depth = far - cx * z[0] - cy * z[1];
        if (!(depth > 1e-3 * far)) return false;
        reach[0] = fmax(reach[0], fabs(cx * x[0]) / depth);
        reach[1] = fmax(reach[1], fabs(cx * y[0] + cy * y[1]) / depth);
    }
    return true;
}

/* Frames the display: all of it, as large as it fits. size: pixels; given: as typed, else set,
 * 1280 the longer side. Fails where a corner does not lie before the eye. */
static bool show_frame(const ShowScene *scene, bool given, int size[2], double *fov_deg,
                       Error *err) {
    double reach[2];
    bool is_before = find_reach(scene, reach);
    double longer = is_before ? fmax(reach[0], reach[1]) : 1;
    for (int i = 0; is_before && !given && i < 2; i++)
        size[i] = (int)fmax(round(LONGER_SIDE * reach[i] / longer), LEAST_SIDE);
    double half = is_before ? fmax(reach[1], reach[0] * size[1] / size[0]) : INFINITY;
    *fov_deg = 2 * degrees_from_radians(atan(half));
    return *fov_deg <= WIDEST_FOV_DEG ||
           error_set(err, ERROR_USAGE,
                     "the eye, %.4g m from the centre of a display of %g x "
                     "%g mm, is too close to see all of it in one picture: required a field of "
                     "view of at most %d degrees",
                     show_distance(scene->eye_m), 1e3 * scene->size_m[0], 1e3 * scene->size_m[1],
                     WIDEST_FOV_DEG);
}

#define USUAL_WIDTH_MM 300 /* where neither the panel nor the user says one */
#define USUAL_DISTANCE_M 0.8
#define MOST_THETA_DEG 89

typedef struct ShowWords {
    const char *content, *size_from;
    double theta, phi, distance_m, size_mm[2], directed[3];
    long spp, seed;
    const char *noise, *layers;
    bool has_angle[3], has_eye, has_size_mm, has_directed, has_size;
    int size[2], false_colour;
} ShowWords;

typedef struct ShowRun {
    RenderRequest request;
    ShowWords words;
    ShowScene scene;
    SceneOverride content, panel;
    const char *path; /* the scene's name in messages and in the frame */
    double theta_deg, phi_deg;
} ShowRun;

/* ---- the eye and the light --------------------------------------------------------------- */

static bool find_eye(ShowRun *work, Error *err) {
    const ShowWords *words = &work->words;
    double *eye = work->scene.eye_m;
    if (words->has_eye && (words->has_angle[0] || words->has_angle[1] || words->has_angle[2]))
        return error_set(err, ERROR_USAGE,
                         "--eye says the place: --theta, --phi and "
                         "--distance do not go with it");
    if (!words->has_eye) show_place(words->theta, words->phi, words->distance_m, eye);
    show_angles(eye, &work->theta_deg, &work->phi_deg);
    return work->theta_deg <= MOST_THETA_DEG + 1e-9 ||
           error_set(err, ERROR_USAGE,
                     "--eye %g,%g,%g is %.4g degrees from the normal (+Z), "
                     "required a place before the display, at most %d degrees from it",
                     eye[0], eye[1], eye[2], work->theta_deg, MOST_THETA_DEG);
}

static bool find_light(ShowRun *work, Error *err) {
    const double *said = work->words.directed;
    if (!work->words.has_directed) return true;
    if (said[0] < 0 || said[1] < 0 || said[1] > MOST_THETA_DEG)
        return error_set(err, ERROR_USAGE,
                         "--directed %g,%g,%g: required LUX,THETA,PHI with "
                         "LUX at least 0 and THETA 0 to %d degrees",
                         said[0], said[1], said[2], MOST_THETA_DEG);
    work->scene.directed_lx = said[0];
    work->scene.directed_theta = said[1];
    work->scene.directed_phi = said[2];
    return true;
}

/* ---- the display ------------------------------------------------------------------------- */

/* mm of the active area, as the panel's set says it; zeros: it does not. */
static bool read_size(const char *path, Arena scratch, double mm[2], Error *err) {
    Panel *panel = NULL;
    json_t *report = NULL;
    if (!panel_open(path, &scratch, &panel, err)) return false;
    bool ok = panel_report(panel, &report, err) || error_in_file(err, path);
    const json_t *size = json_object_get(report, "size_mm");
    for (size_t i = 0; i < 2; i++) mm[i] = json_number_value(json_array_get(size, i));
    json_decref(report);
    panel_close(panel);
    return ok;
}

/* A picture fills the display: of another shape it is stretched. */
static void warn_of_shape(const ShowWords *words, const double mm[2], const Image *picture,
                          Arena scratch) {
    double shape = (double)picture->width / picture->height;
    Twice twice = twice_shape("the display", shape, mm[0] / mm[1], &scratch);
    Problems problems = problems_start(&scratch);
    if (words->has_size_mm || !twice_differ(&twice)) return;
    problems_add(&problems, SEVERITY_WARNING, words->content, "",
                 "%s: %d x %d pixels on the panel's %g x %g mm — fit the picture, or name the "
                 "size that it fills by --size-mm W,H",
                 twice_text(&twice, &scratch), picture->width, picture->height, mm[0], mm[1]);
    cli_print_warnings(&problems);
}

static bool find_display(ShowRun *work, const char *panel, Arena scratch, Error *err) {
    ShowWords *words = &work->words;
    double mm[2];
    Image picture;
    if (!read_size(panel, scratch, mm, err) || !image_read(words->content, &scratch, &picture, err))
        return false;
    words->size_from = words->has_size_mm ? "--size-mm" : mm[0] > 0 ? "the panel" : "assumed";
    if (words->has_size_mm) memcpy(mm, words->size_mm, sizeof mm);
    if (!(mm[0] > 0 && mm[1] > 0)) {
        mm[0] = USUAL_WIDTH_MM;
        mm[1] = mm[0] * picture.height / picture.width;
    }
    for (int i = 0; i < 2; i++) work->scene.size_m[i] = mm[i] / 1e3;
    warn_of_shape(words, mm, &picture, scratch);
    return true;
}

/* ---- the render -------------------------------------------------------------------------- */

static bool check_outputs(const RenderRequest *request, Error *err) {
    const DevelopOptions *look = &request->look;
    if (!request->output && !request->png)
        return error_set(err, ERROR_USAGE, "panel show wants -o FRAME.exr or --png FILE");
    if (request->output && strcmp(path_ending(request->output), ".exr"))
        return error_set(err, ERROR_USAGE, "-o is '%s', required: a name that ends in .exr",
                         request->output);
    return request->png ||
           !(look->exposure || look->config || look->display || look->view || look->false_colour ||
             look->adapt || look->is_denoised) ||
           error_set(err, ERROR_USAGE, "a look is given, but no picture — add --png FILE");
}

static void set_scene(ShowRun *work, Arena *arena) {
    RenderRequest *request = &work->request;
    SceneOptions *scene = &request->scene;
    work->path = "panel_show.gltf";
    work->content = (SceneOverride){SHOW_DISPLAY, work->words.content, NULL};
    work->panel = (SceneOverride){SHOW_DISPLAY, request->cli.arguments[0], NULL};
    *scene = (SceneOptions){.paths = &work->path,
                            .path_count = 1,
                            .written = show_scene_text(&work->scene, arena),
                            .contents = &work->content,
                            .content_count = 1,
                            .panels = &work->panel,
                            .panel_count = 1};
    memcpy(request->camera.eye, work->scene.eye_m, sizeof request->camera.eye);
    request->camera.has_eye = request->camera.has_look_at = request->camera.has_fov = true;
}

/* One flat display reflects nothing twice, and no guide has to be trained. */
static bool set_render(ShowRun *work, Arena *arena, Error *err) {
    RenderRequest *request = &work->request;
    RenderOptions *options = &request->render;
    const ShowWords *words = &work->words;
    options->width = words->size[0];
    options->height = words->size[1];
    options->crop = (FilmRect){0, 0, options->width, options->height};
    options->end_sample = (uint32_t)words->spp;
    options->seed = (uint32_t)words->seed;
    options->max_bounces = 1;
    options->no_guiding = true;
    options->threads = request->cli.threads;
    options->progress = request->cli.progress;
    if (words->layers && !render_layers_parse(words->layers, &options->layers, err)) return false;
    if (request->look.is_denoised && !render_layers_parse(DENOISE_LAYERS, &options->layers, err))
        return false;
    return !words->noise ||
           noise_goal_parse(words->noise, options->crop, arena, &request->noise, err);
}

static void set_words(ShowRun *work, int argc, char **argv, Arena *arena) {
    RenderRequest *request = &work->request;
    char group[] = "panel";
    char **words = ARENA_NEW(arena, char *, argc + 1);
    words[0] = group;
    memcpy(words + 1, argv, (size_t)argc * sizeof *argv);
    request->command_line = command_line_join(argc + 1, words, false, arena);
    request->only_png = !request->output;
    if (request->only_png) request->output = request->png;
}

/* ---- the answer -------------------------------------------------------------------------- */

static json_t *directed_json(const ShowScene *scene) {
    if (!(scene->directed_lx > 0)) return json_null();
    return json_pack("{s:f, s:f, s:f, s:f}", "illuminance_lx", scene->directed_lx, "theta_deg",
                     scene->directed_theta, "phi_deg", scene->directed_phi, "diameter_deg",
                     2 * SUN_MEAN_RADIUS_DEG);
}

static json_t *about(const ShowRun *work) {
    const ShowScene *scene = &work->scene;
    const double *eye = scene->eye_m;
    return json_pack(
        "{s:o, s:o, s:[f,f], s:s, s:{s:[f,f,f], s:f, s:f, s:f}, s:f, s:f, s:o}", "panel",
        json_text(work->panel.value), "content", json_text(work->content.value), "size_mm",
        1e3 * scene->size_m[0], 1e3 * scene->size_m[1], "size_from", work->words.size_from, "eye",
        "position_m", eye[0], eye[1], eye[2], "theta_deg", work->theta_deg, "phi_deg",
        work->phi_deg, "distance_m", show_distance(eye), "fov_deg", work->request.camera.fov_deg,
        "ambient_lx", scene->ambient_lx, "directed", directed_json(scene));
}

/* Beside what `render` answers. */
static const Column ABOUT[] = {
    COLUMN_TEXT("panel", "panel"),
    COLUMN_TEXT("content", "content"),
    COLUMN_DIGITS("size_mm", "size", "mm", 4),
    {.key = "size_from", .words = "size from", .about = "`the panel`, `--size-mm`, `assumed`"},
    {.key = "eye.position_m",
     .words = "eye (right, up, before it)",
     .unit = "m",
     .about = "from the display's centre"},
    COLUMN_DIGITS("eye.theta_deg", "seen from theta", "degrees", 0),
    COLUMN_DIGITS("eye.phi_deg", "phi", "degrees", 0),
    COLUMN_DIGITS("eye.distance_m", "distance", "m", 0),
    COLUMN_DIGITS("ambient_lx", "from a dome", "lx", 0),
    {.key = "directed.illuminance_lx",
     .words = "from a disc",
     .unit = "lx",
     .about = "on the display; `directed` is null: none"},
    COLUMN_DIGITS("directed.theta_deg", "its theta", "degrees", 0),
    COLUMN_DIGITS("directed.phi_deg", "its phi", "degrees", 0),
    COLUMN_DIGITS("directed.diameter_deg", "its diameter", "degrees", 2),
    COLUMN_KEY("fov_deg", "the frame's height"),
    COLUMN_KEY("output", "without `-o` the picture")};
static const TableKind ABOUT_KIND = TABLE_KIND("show", NULL, ABOUT);

static Outcome show(ShowRun *work, Arena *arena, Error *err) {
    RenderRequest *request = &work->request;
    set_scene(work, arena);
    if (!set_render(work, arena, err)) return OUTCOME_FAILED;
    request->about = about(work);
    Outcome outcome = cmd_render_request(request, arena, err);
    bool is_told = request->cli.json || request->cli.quiet;
    if (outcome == OUTCOME_DONE && !is_told)
        return outcome_of(cli_print_answer(&ABOUT_KIND, request->about, false, err));
    json_decref(request->about);
    return outcome;
}

/* ---- the command line -------------------------------------------------------------------- */

#define EYE_ROWS(work, words) \
    {"--theta", \
     OPTION_NUMBER, \
     "DEG", \
     "of the eye, from the display's normal (default 0)", \
     &(words)->theta, \
     .low = 0, \
     .high = MOST_THETA_DEG, \
     .given = &(words)->has_angle[0]}, \
        {"--phi",       OPTION_NUMBER, \
         "DEG",         "of the eye: 0 to the display's right, 90 above it (default 0)", \
         &(words)->phi, .low = -360, \
         .high = 360,   .given = &(words)->has_angle[1]}, \
        {"--distance", \
         OPTION_NUMBER, \
         "M", \
         "of the eye from the display's centre (default 0.8)", \
         &(words)->distance_m, \
         .low = 0.01, \
         .high = 1000, \
         .given = &(words)->has_angle[2]}, \
        {"--eye", \
         OPTION_NUMBERS, \
         "X,Y,Z", \
         "instead: the eye, m from the display's centre, to its right, up and before it", \
         (work)->scene.eye_m, \
         .low = -1000, \
         .high = 1000, \
         .count = 3, \
         .given = &(words)->has_eye}, \
    { \
        "--size-mm", OPTION_NUMBERS, "W,H", \
            "of the active area, which the picture fills (default the panel's; else 300 wide, in " \
            "the picture's shape)", \
            (words)->size_mm, .low = 1, .high = 1e4, .count = 2, .given = &(words)->has_size_mm \
    }

#define LIGHT_ROWS(work, words) \
    {"--ambient", \
     OPTION_NUMBER, \
     "LUX", \
     "on the display from an even dome all around (default 0)", \
     &(work)->scene.ambient_lx, \
     .low = 0, \
     .high = SCENE_MOST_LX}, \
    { \
        "--directed", OPTION_NUMBERS, "LUX,THETA,PHI", \
            "on the display from a disc of 0.53 degrees that is there", (words)->directed, \
            .low = -360, .high = SCENE_MOST_LX, .count = 3, .given = &(words)->has_directed \
    }

static bool parse(int argc, char **argv, Arena *arena, ShowRun *work, Error *err) {
    RenderRequest *request = &work->request;
    ShowWords *words = &work->words;
    const Option options[] = {
        {"--content", OPTION_TEXT, "PICTURE", "the codes that the display shows", &words->content},
        {"-o", OPTION_TEXT, "FRAME.exr", "the frame, cd/m2", &request->output,
         .file = OPTION_OUTPUT},
        {"--png", OPTION_TEXT, "FILE", "the picture of it (PNG, JPEG, TIFF by ending)",
         &request->png, .file = OPTION_OUTPUT},
        EYE_ROWS(work, words),
        LIGHT_ROWS(work, words),
        LOOK_OPTIONS(&request->look),
        {"--false-colour", OPTION_CHOICE, "luminance", "show luminance on a scale of colours",
         &words->false_colour, .given = &request->look.false_colour},
        {"--size", OPTION_SIZE, "WxH", "pixels (default: 1280 along the display's longer side)",
         words->size, .given = &words->has_size},
        {"--spp", OPTION_INTEGER, "N", "samples a pixel, at most (default 32)", &words->spp,
         .low = 1, .high = FILM_SAMPLES_MAX},
        {"--noise", OPTION_TEXT, "[AREA:]R",
         "as many samples as leave this relative error, as of `render`", &words->noise},
        {"--seed", OPTION_INTEGER, "N", "another set of random numbers (default 0)", &words->seed,
         .low = 0, .high = 4294967295.0},
        {"--layers", OPTION_TEXT, "LIST",
         "of the frame, as of `render`: display, xyz, all ... (default R, G, B alone)",
         &words->layers},
    };
    const CliCommand command = {
        "panel show",
        command_panel_show.summary,
        "X.panel --content PICTURE --png FILE [-o FRAME.exr] [--theta DEG] [--ambient LUX]",
        "parhelion panel show assets/panels/ips_cluster.panel --content "
        "assets/content/cluster.png --theta 50 --ambient 500 --png cluster.png",
        options,
        COUNT_OF(options),
        1,
        1,
        .answers = (const Answer[]){{"", &render_answer_kind}, {"", &ABOUT_KIND}, {0}}};
    return cli_parse(&command, argc, argv, arena, &request->cli, err);
}

static Outcome run_show(int argc, char **argv, Arena *arena, Error *err) {
    ShowRun work = {.words = {.distance_m = USUAL_DISTANCE_M, .spp = 32}};
    if (!parse(argc, argv, arena, &work, err)) return OUTCOME_FAILED;
    if (work.request.cli.help_shown) return OUTCOME_DONE;
    if (!work.words.content)
        return error_set(err, ERROR_USAGE, "panel show wants --content PICTURE");
    if (!check_outputs(&work.request, err) || !find_eye(&work, err) || !find_light(&work, err) ||
        !find_display(&work, work.request.cli.arguments[0], *arena, err) ||
        !show_frame(&work.scene, work.words.has_size, work.words.size, &work.request.camera.fov_deg,
                    err))
        return OUTCOME_FAILED;
    set_words(&work, argc, argv, arena);
    return show(&work, arena, err);
}

const Command command_panel_show = {"show", "a bare display as an eye sees it, in given light",
                                    run_show};
