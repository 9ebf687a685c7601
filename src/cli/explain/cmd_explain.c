/* SPDX-License-Identifier: Apache-2.0 */
/* parhelion explain: what a symbol, a display or a pixel sends to an eye, by which chains of
 * objects light comes to it, and what each of them costs. */
#include "cli/explain/cmd_explain.h"

#include <math.h>
#include <strings.h>

#include "base/count.h"
#include "base/file.h"
#include "camera/camera.h"
#include "cli/explain/explain_answer.h"
#include "cli/options/answer.h"
#include "cli/options/cli.h"
#include "cli/options/outputs.h"
#include "cli/options/scene_options.h"
#include "cli/render/render_setup.h"
#include "render/render.h"
#include "review/request/request_check.h"
#include "review/request/request_read.h"
#include "review/run/explain.h"
#include "review/run/symbols.h"
#include "scene/load/scene_load.h"

typedef struct SceneQuestion {
    CameraChoice camera;
    SceneOptions scene;
    EnvironmentChange environment;
    const char *display; /* "cluster", "node:NAME"; NULL: pixels */
    double uv[4];        /* of the content: left, top, right, bottom */
    double region[4];    /* pixels: X0, Y0, X1, Y1 */
    bool has_pixel;      /* it is one pixel: its samples are those of a frame */
    int size[2];
    RenderOptions render; /* threads, isa, seed, bounces and guide alone */
    long paths, most, seed, max_bounces;
    Problems *problems;
    const Outputs *outputs;
} SceneQuestion;

#define BOUNCES 64
#define WAYS 10
#define SEED 0x6578706cu /* of what is no pixel, with --seed 0 */
#define SIDE 32          /* of the raster of a region */

/* Points along the looks of a raster. */
static bool aim_at_region(const SceneQuestion *question, const SceneCamera *camera, Arena *arena,
                          ProbeAim *aim, Error *err) {
    const double *r = question->region;
    Camera seen = camera_from_scene(camera, question->size[0], question->size[1]);
    Vec3 *targets = ARENA_NEW(arena, Vec3, SIDE * SIDE);
    for (int i = 0; i < SIDE * SIDE; i++) {
        double u = (i + 0.5) / (SIDE * SIDE), v = reverse_bits((uint32_t)i) * 0x1p-32;
        float x = (float)(r[0] + u * (r[2] - r[0]));
        float y = (float)(r[1] + (v + 0.5 / (SIDE * SIDE)) * (r[3] - r[1]));
        if (!camera_sees(&seen, x, y)) continue;
        targets[aim->target_count++] = vec3_add(aim->eye, camera_ray(&seen, x, y).direction);
    }
    aim->targets = targets;
    return aim->target_count > 0 ||
           error_set(err, ERROR_USAGE, "pixels %g,%g,%g,%g lie outside the fisheye's circle", r[0],
                     r[1], r[2], r[3]);
}

static bool aim_at_display(const SceneQuestion *question, Arena *arena, ProbeAim *aim, Error *err) {
    const Scene *scene = aim->context->scene;
    const double *uv = question->uv;
    ReviewDisplay display;
    SymbolSurface surface;
    if (!review_display_find(scene, question->display, arena, &display, err))
        return error_prefix(err, "--display %s", question->display);
    SymbolPlace place = {.scene = scene,
                         .display = &display,
                         .uv = {uv[0], uv[1], uv[2], uv[3]},
                         .point_count = SYMBOL_POINTS};
    if (!symbol_surface_build(&place, arena, &surface, err))
        return error_prefix(err, "--display %s", question->display);
    symbol_aim(&surface, arena, aim);
    return aim->target_count > 0 ||
           error_set(err, ERROR_USAGE, "--display %s: the eye sees nothing of it",
                     question->display);
}

/* A sum that has met one number that is none is none. */
static bool check_light(const PixelLight *light, const double pixel[2], Error *err) {
    double sum = 0;
    for (int i = 0; i < 3; i++) sum += light->xyz[i].mean + light->xyz[i].sigma;
    for (int i = 0; i < PIXEL_BANDS; i++) sum += light->radiance[i].mean + light->radiance[i].sigma;
    return isfinite(sum) ||
           error_set(err, ERROR_INPUT,
                     "pixel %g,%g: its light is not finite: a light of the scene, or what a "
                     "material makes of it, has no measure",
                     pixel[0], pixel[1]);
}

/* The samples of a pixel are those that a render of the same options takes. */
static bool explain_lit(const SceneQuestion *question, const SceneCamera *camera,
                        const RenderSetup *setup, Arena *arena, ExplainAnswer *out, Error *err) {
    const double *r = question->region;
    const ProbePixel pixel = {&setup->camera, (int)r[0], (int)r[1]};
    const ProbeTools tools = {setup->kernel, question->render.threads};
    ProbeAim aim = {.context = &setup->context,
                    .eye = camera->world_from_camera.origin,
                    .pixel = question->has_pixel ? &pixel : NULL,
                    .seed = (uint32_t)question->seed + (question->has_pixel ? 0 : SEED)};
    if (!(question->display ? aim_at_display(question, arena, &aim, err)
                            : aim_at_region(question, camera, arena, &aim, err)))
        return false;
    ExplainPlace place = {&tools, aim, question->paths, (int)question->most};
    explain_place(&place, arena, &out->found);
    if (!question->has_pixel) return true;
    for (int i = 0; i < 2; i++) {
        out->pixel[i] = (int)r[i];
        out->size[i] = question->size[i];
    }
    return check_light(&out->found.light, r, err);
}

static bool explain_loaded(SceneQuestion *question, const Scene *scene, Arena *arena,
                           ExplainAnswer *out, Error *err) {
    SceneCamera camera;
    RenderSetup setup;
    RenderOptions *render = &question->render;
    Problems unsaid = problems_start(arena); /* about names of a frame's layers */
    render_warn_of_darkness(scene, question->problems);
    if (!render_choose_camera(scene, &question->camera, question->problems, &camera, err) ||
        (question->has_pixel &&
         !render_check_pixel(&camera, question->size, question->region, err)))
        return false;
    render->width = question->size[0];
    render->height = question->size[1];
    render->seed = (uint32_t)question->seed;
    render->max_bounces = (int)question->max_bounces;
    render->is_reading = !question->has_pixel;
    render->no_guiding |= render->is_reading;
    if (!render_prepare(scene, &camera, render, arena, &setup, err)) return false;
    bool ok = explain_lit(question, &camera, &setup, arena, out, err);
    out->lights = light_groups_build(scene, setup.context.lights, arena, &unsaid);
    render_setup_end(&setup);
    return ok;
}

static bool explain_scene(SceneQuestion *question, Arena *arena, ExplainAnswer *out, Error *err) {
    Scene *scene;
    const SceneAsked asked = {&question->scene, &question->environment, question->render.progress,
                              question->outputs};
    if (!scene_options_load(&asked, arena, question->problems, &scene, err)) return false;
    bool ok = explain_loaded(question, scene, arena, out, err);
    scene_close(scene);
    return ok;
}

typedef struct ExplainWords {
    SceneQuestion scene;
    SceneWords scene_words;
    const char *condition, *eye, *symbol;
    double pixel[2];
    bool has_region, has_uv, has_size, has_seed, has_bounces, has_ways;
    Cli cli;
} ExplainWords;

static bool is_review(const ExplainWords *words) {
    return !strcasecmp(path_ending(words->cli.arguments[0]), ".json");
}

/* ---- the command line -------------------------------------------------------------------- */

static bool check_region(const ExplainWords *words, Error *err) {
    const double *r = words->scene.region;
    const int *size = words->scene.size;
    if (words->scene.has_pixel && !(r[0] == floor(r[0]) && r[1] == floor(r[1]) && r[0] >= 0 &&
                                    r[1] >= 0 && r[0] < size[0] && r[1] < size[1]))
        return error_set(err, ERROR_USAGE,
                         "--pixel %g,%g: is no pixel of a picture of %dx%d, whose first is 0,0 "
                         "at the top left",
                         r[0], r[1], size[0], size[1]);
    for (int i = 0; i < 4; i++)
        if (r[i] != floor(r[i]) || r[i] < 0 || r[i] > size[i % 2])
            return error_set(err, ERROR_USAGE,
                             "--region: %g is no edge of a pixel of a picture of %dx%d", r[i],
                             size[0], size[1]);
    return (r[0] < r[2] && r[1] < r[3]) ||
           error_set(err, ERROR_USAGE, "--region: required: X0 < X1 and Y0 < Y1");
}

static bool read_eye(ExplainWords *words, Error *err) {
    CameraChoice *camera = &words->scene.camera;
    if (!words->eye) return true;
    camera->has_eye = cli_numbers(words->eye, 3, camera->eye);
    return camera->has_eye ||
           error_set(err, ERROR_USAGE, "--eye %s: required of a scene: X,Y,Z in metres",
                     words->eye);
}

static bool read_scene(ExplainWords *words, Arena *arena, Error *err) {
    SceneQuestion *scene = &words->scene;
    const char *of_review = words->symbol ? "--symbol" : NULL;
    if (words->condition) of_review = "--condition";
    int asked = (scene->display != NULL) + scene->has_pixel + words->has_region;
    if (of_review)
        return error_set(err, ERROR_USAGE, "%s: a scene has none; a REVIEW.json has", of_review);
    if (asked != 1)
        return error_set(err, ERROR_USAGE,
                         "required: one of --display NAME, --pixel X,Y, --region X0,Y0,X1,Y1: "
                         "what of the scene is to be explained?");
    if (!render_check_size(&scene->camera, words->has_size, scene->size, err)) return false;
    if (words->has_uv && !scene->display)
        return error_set(err, ERROR_USAGE, "--uv: of which --display?");
    if (!(scene->uv[0] < scene->uv[2] && scene->uv[1] < scene->uv[3]))
        return error_set(err, ERROR_USAGE, "--uv: required: L < R and T < B");
    if (scene->has_pixel)
        for (int i = 0; i < 4; i++) scene->region[i] = words->pixel[i % 2] + (int)(i / 2);
    return (scene->display || check_region(words, err)) && read_eye(words, err) &&
           scene_options_read(&words->scene_words, &words->cli, arena, &scene->scene, err);
}

/* An option that a review sets itself; NULL: none is there. */
static const char *option_of_scene(const ExplainWords *words) {
    const CameraChoice *camera = &words->scene.camera;
    EnvironmentChange no_sun = words->scene.environment;
    SceneWords no_state = words->scene_words;
    no_sun.sun = NULL;
    no_state.state = (StateWords){.has_time = false};
    const struct {
        bool is_given;
        const char *option;
    } options[] = {{camera->name != NULL, "--camera"},
                   {words->scene.display != NULL, "--display"},
                   {words->has_uv, "--uv"},
                   {words->scene.has_pixel, "--pixel"},
                   {words->has_region, "--region"},
                   {words->has_size, "--size"},
                   {camera->projection != 0, "--projection"},
                   {camera->has_look_at, "--look-at"},
                   {camera->has_fov, "--fov"},
                   {words->has_seed, "--seed"},
                   {words->has_bounces, "--max-bounces"},
                   {words->has_ways, "--ways"},
                   {words->scene.render.no_guiding, "--no-guiding"}};
    for (int i = 0; i < COUNT_OF(options); i++)
        if (options[i].is_given) return options[i].option;
    return scene_options_given(&no_state, &no_sun);
}

static bool check_review(ExplainWords *words, Error *err) {
    const char *of_scene = option_of_scene(words);
    if (of_scene)
        return error_set(err, ERROR_USAGE,
                         "%s: a review says that itself; --condition, --eye "
                         "and --symbol choose from it",
                         of_scene);
    if (words->cli.argument_count > 1)
        return error_set(err, ERROR_USAGE, "%s: one review at a time is explained",
                         words->cli.arguments[1]);
    return state_options_read(&words->scene_words.state, &words->scene.scene.state, err);
}

static bool parse(int argc, char **argv, Arena *arena, ExplainWords *out, Error *err) {
    SceneQuestion *scene = &out->scene;
    const Option options[] = {
        {"--condition", OPTION_TEXT, "NAME", "of a review: in which (default: the only one)",
         &out->condition},
        {"--symbol", OPTION_TEXT, "NAME", "of a review: what is looked at", &out->symbol},
        {"--eye", OPTION_TEXT, "NAME|X,Y,Z", "of a review: who looks; of a scene: where, m",
         &out->eye},
        {"--display", OPTION_TEXT, "MATERIAL|node:NAME", "of a scene: a display that is seen",
         &scene->display},
        {"--uv", OPTION_NUMBERS, "L,T,R,B", "a rectangle of its content, 0 to 1, v down", scene->uv,
         .low = 0, .high = 1, .count = 4, .given = &out->has_uv},
        {"--pixel", OPTION_NUMBERS, "X,Y", "of a scene: a pixel of the camera's picture",
         out->pixel, .low = -1e9, .high = 1e9, .count = 2, .given = &scene->has_pixel},
        {"--region", OPTION_NUMBERS, "X0,Y0,X1,Y1", "pixels, half-open, from the top left",
         scene->region, .low = 0, .high = 65536, .count = 4, .given = &out->has_region},
        {"--size", OPTION_SIZE, "WxH", "of that picture (default 1280x720, of a fisheye 1024x1024)",
         scene->size, .given = &out->has_size},
        {"--camera", OPTION_TEXT, "NAME|INDEX", "node's or camera's name, or place (default 0)",
         &scene->camera.name},
        PROJECTION_OPTION(&scene->camera),
        {"--look-at", OPTION_NUMBERS, "X,Y,Z", "with --eye: the middle of the picture",
         scene->camera.look_at, .low = -1e6, .high = 1e6, .count = 3,
         .given = &scene->camera.has_look_at},
        {"--fov", OPTION_NUMBER, "DEG", "with --eye: the picture's height as an angle (40)",
         &scene->camera.fov_deg, .low = 0.01, .high = 179, .given = &scene->camera.has_fov},
        {"--paths", OPTION_INTEGER, "N",
         "rounded up to whole chunks of 64; of a pixel its samples (default 65536)", &scene->paths,
         .low = CHAIN_PATHS_LEAST, .high = 1 << 24},
        {"--ways", OPTION_INTEGER, "N",
         "of a scene: chains that are listed by themselves, at most (default 10)", &scene->most,
         .low = 1, .high = 1000, .given = &out->has_ways},
        {"--seed", OPTION_INTEGER, "N", "of a scene: other random numbers (default 0)",
         &scene->seed, .low = 0, .high = 4294967295.0, .given = &out->has_seed},
        {"--max-bounces", OPTION_INTEGER, "N",
         "of a scene: 0 emission only, 1 adds direct light (default 64)", &scene->max_bounces,
         .low = 0, .high = 100000, .given = &out->has_bounces},
        {"--no-guiding", OPTION_FLAG, NULL,
         "of a pixel: as a frame that was rendered with this option", &scene->render.no_guiding},
        {"--isa", OPTION_TEXT, "NAME", "sse2, avx2, avx512 (default: the processor's best)",
         &scene->render.isa},
        SCENE_OPTIONS(&out->scene_words, &scene->scene, &scene->environment),
    };
    const CliCommand command = {
        "explain",
        command_explain.summary,
        "REVIEW.json [--condition NAME] [--symbol NAME] [--eye NAME] | SCENE... --display NAME "
        "| SCENE... --pixel X,Y",
        "parhelion explain scenes/glance.review.json --condition night",
        options,
        COUNT_OF(options),
        1,
        -1,
        .answers = explain_answers};
    if (!cli_parse(&command, argc, argv, arena, &out->cli, err)) return false;
    if (out->cli.help_shown) return true;
    scene->render.threads = out->cli.threads;
    scene->render.progress = out->cli.progress;
    scene->outputs = &out->cli.outputs;
    return is_review(out) ? check_review(out, err) : read_scene(out, arena, err);
}

/* As far as a sweep's may go. */
static bool read_sun(const char *text, double out_deg[2], Error *err) {
    return (cli_numbers(text, 2, out_deg) && fabs(out_deg[0]) <= 720 && out_deg[1] >= -18 &&
            out_deg[1] <= 90) ||
           error_set(err, ERROR_USAGE,
                     "--sun %s: required: AZ,EL in degrees, the azimuth of "
                     "the vehicle: 0 ahead, 90 right; the elevation from -18 to 90",
                     text);
}

static bool spare_scene(void *user, const Scene *scene, Error *err) {
    return outputs_spare(user, scene->inputs, scene->input_count, err);
}

static bool review_question(const ExplainWords *words, Arena *arena, Explained *out, Error *err) {
    const SceneQuestion *scene = &words->scene;
    const char *root = scene->scene.root, *sun = scene->environment.sun;
    Outputs outputs = words->cli.outputs;
    ReviewRequest request;
    ExplainOptions options = {.condition = words->condition,
                              .eye = words->eye,
                              .symbol = words->symbol,
                              .has_sun = sun != NULL,
                              .means = {.root = root,
                                        .state = scene->scene.state,
                                        .isa = scene->render.isa,
                                        .threads = scene->render.threads},
                              .paths = scene->paths,
                              .problems = scene->problems,
                              .read = spare_scene,
                              .user = &outputs};
    if (sun && !read_sun(sun, options.sun_deg, err)) return false;
    if (!review_request_read(words->cli.arguments[0], root, arena, scene->problems, &request, err))
        return false;
    const Lines files = review_request_files(&request, arena);
    if (!outputs_spare(&outputs, files.list, files.count, err)) return false;
    if (!profile_load(request.profile, arena, &options.profile, err))
        return error_in_file(err, request.file);
    if (request.privacy.is_given)
        options.profile =
            profile_with_security(options.profile, request.privacy.security_min, arena);
    return explain_review(&request, &options, arena, out, err);
}

static Outcome run(int argc, char **argv, Arena *arena, Error *err) {
    Problems problems = problems_start(arena);
    ExplainWords words = {.scene = {.uv = {0, 0, 1, 1},
                                    .paths = 65536,
                                    .most = WAYS,
                                    .max_bounces = BOUNCES,
                                    .problems = &problems}};
    ExplainAnswer answer = {.size = {0, 0}};
    if (!parse(argc, argv, arena, &words, err)) return OUTCOME_FAILED;
    if (words.cli.help_shown) return OUTCOME_DONE;
    if (!(is_review(&words) ? review_question(&words, arena, &answer.found, err)
                            : explain_scene(&words.scene, arena, &answer, err)))
        return OUTCOME_FAILED;
    cli_print_warnings(&problems);
    return outcome_of(explain_answer(&words.cli, &answer, arena, err));
}

const Command command_explain = {
    "explain", "by which ways light comes to a symbol, a display or a pixel", run};
