/* SPDX-License-Identifier: Apache-2.0 */
/* parhelion probe: what one pixel sees, bounce by bounce, and its spectrum. */
#include <math.h>

#include "base/count.h"
#include "cli/explain/cmd_explain.h"
#include "cli/explain/probe_answer.h"
#include "cli/explain/ray_option.h"
#include "cli/options/answer.h"
#include "cli/options/camera_options.h"
#include "cli/options/scene_options.h"
#include "cli/render/guiding_options.h"
#include "cli/render/render_setup.h"
#include "render/render.h"
#include "scene/load/scene_load.h"

#define SPP 4096
#define WAYS 10
#define BOUNCES 64

typedef struct ProbeWords {
    RenderOptions     render;
    CameraChoice      camera;
    SceneOptions      scene;
    SceneWords        scene_words;
    EnvironmentChange environment;
    const char *rays;
    double      pixel[2];
    int         size[2];
    long        spp, ways, seed, max_bounces;
    bool        has_pixel;
    Cli         cli;
} ProbeWords;

/* ---- the command line -------------------------------------------------------------------- */

static bool check_pixel(const ProbeWords *words, Error *err)
{
    const double *p = words->pixel;
    if (!words->has_pixel)
        return error_set(err, ERROR_USAGE, "no pixel — add --pixel X,Y");
    return (p[0] == floor(p[0]) && p[1] == floor(p[1]) && p[0] >= 0 && p[1] >= 0 &&
            p[0] < words->size[0] && p[1] < words->size[1]) ||
           error_set(err, ERROR_USAGE,
                     "--pixel %g,%g: is no pixel of a picture of %dx%d, whose first is 0,0 at "
                     "the top left",
                     p[0], p[1], words->size[0], words->size[1]);
}

static bool check(ProbeWords *words, Arena *arena, Error *err)
{
    RenderOptions *render = &words->render;
    if (!check_pixel(words, err)) return false;
    if (!guiding_options_check(render, err)) return false;
    render->width = words->size[0];
    render->height = words->size[1];
    render->seed = (uint32_t)words->seed;
    render->max_bounces = (int)words->max_bounces;
    render->threads = words->cli.threads;
    render->progress = words->cli.progress;
    return scene_options_read(&words->scene_words, &words->cli, arena, &words->scene, err) &&
           ray_option_check(words->rays, &words->cli, err);
}

static bool parse(int argc, char **argv, Arena *arena, ProbeWords *out, Error *err)
{
    const Option options[] = {
        {"--pixel", OPTION_NUMBERS, "X,Y", "of the camera's picture, 0,0 at the top left",
         out->pixel, .low = -1e9, .high = 1e9, .count = 2, .given = &out->has_pixel},
        {"--size", OPTION_SIZE, "WxH", "of that picture (default 1280x720)", out->size},
        CAMERA_OPTIONS(&out->camera),
        {"--spp", OPTION_INTEGER, "N",
         "paths, rounded up to whole chunks of 64 (default 4096)", &out->spp,
         .low = CHAIN_PATHS_LEAST, .high = 1 << 24},
        {"--seed", OPTION_INTEGER, "N", "another set of random numbers (default 0)",
         &out->seed, .low = 0, .high = 4294967295.0},
        {"--max-bounces", OPTION_INTEGER, "N",
         "0 emission only, 1 adds direct light (default 64)", &out->max_bounces, .low = 0,
         .high = 100000},
        {"--ways", OPTION_INTEGER, "N", "that are told by themselves, at most (default 10)",
         &out->ways, .low = 1, .high = 1000},
        {"--gltf", OPTION_TEXT, "FILE.gltf|.glb",
         "the ways as lines in the colours of their lights, to be opened beside the scene",
         &out->rays},
        {"--no-mirrors", OPTION_FLAG, NULL, "leave the sun's reflections to chance",
         &out->render.no_mirrors},
        GUIDING_OPTIONS(&out->render),
        {"--isa", OPTION_TEXT, "NAME", "sse2, avx2, avx512 (default: the processor's best)",
         &out->render.isa},
        SCENE_OPTIONS(&out->scene_words, &out->scene, &out->environment),
    };
    const CliCommand command = {
        "probe", "what one pixel sees, bounce by bounce, and its spectrum",
        "SCENE.gltf|.glb [LIGHTS.gltf|.glb ...] --pixel X,Y",
        "parhelion probe scenes/car_dashboard.gltf scenes/noon.gltf --pixel 640,400 "
        "--gltf ways.gltf",
        options, COUNT_OF(options), 1, -1};
    if (!cli_parse(&command, argc, argv, arena, &out->cli, err)) return false;
    return out->cli.help_shown || check(out, arena, err);
}

/* ---- the pixel --------------------------------------------------------------------------- */

/* The samples are those that a render of the same options takes. */
static void look(const ProbeWords *words, const RenderSetup *setup, Arena *arena, Probed *out)
{
    const ProbePixel   pixel = {&setup->camera, (int)words->pixel[0], (int)words->pixel[1]};
    const ReadingTools tools = {.kernel = setup->kernel, .threads = words->cli.threads};
    float    x = (float)pixel.x + 0.5f, y = (float)pixel.y + 0.5f;
    ProbeAim aim = {.context = &setup->context, .eye = camera_ray(&setup->camera, x, y).origin,
                    .pixel = &pixel, .seed = words->render.seed};
    ChainAsk ask = {&aim, &tools, words->spp, (int)words->ways, true, true};
    *out = (Probed){.pixel = {pixel.x, pixel.y}, .size = {words->size[0], words->size[1]},
                    .eye = aim.eye, .chains = chains_find(&ask, arena),
                    .light = pixel_light_find(&ask)};
}

/* A sum that has met one number that is none is none. */
static bool check_light(const Probed *found, Error *err)
{
    double sum = 0;
    for (int i = 0; i < 3; i++) sum += found->light.xyz[i].mean + found->light.xyz[i].sigma;
    for (int i = 0; i < PIXEL_BANDS; i++)
        sum += found->light.radiance[i].mean + found->light.radiance[i].sigma;
    return isfinite(sum) ||
           error_set(err, ERROR_INPUT,
                     "pixel %d,%d: its light is not finite: a light of the scene, or what a "
                     "material makes of it, has no measure",
                     found->pixel[0], found->pixel[1]);
}

static bool probe(const ProbeWords *words, const Scene *scene, Problems *problems,
                  Arena *arena, Error *err)
{
    SceneCamera camera;
    RenderSetup setup;
    Probed      found;
    if (!render_choose_camera(scene, &words->camera, problems, &camera, err)) return false;
    render_warn_of_darkness(scene, problems);
    cli_print_warnings(problems);
    if (!render_prepare(scene, &camera, &words->render, arena, &setup, err)) return false;
    look(words, &setup, arena, &found);
    found.groups = light_groups_build(scene, setup.context.lights, arena, problems);
    render_setup_end(&setup);
    return check_light(&found, err) &&
           (!words->rays || probe_write_rays(&found, words->rays, arena, err)) &&
           probe_answer(&words->cli, &found, arena, err);
}

static bool run(int argc, char **argv, Arena *arena, Error *err)
{
    Problems   problems = problems_start(arena);
    Scene     *scene = NULL;
    ProbeWords words = {.size = {1280, 720}, .spp = SPP, .ways = WAYS,
                        .max_bounces = BOUNCES};
    if (!parse(argc, argv, arena, &words, err)) return false;
    if (words.cli.help_shown) return true;
    const SceneAsked asked = {&words.scene, &words.environment, words.cli.progress};
    bool ok = scene_options_load(&asked, arena, &problems, &scene, err) &&
              probe(&words, scene, &problems, arena, err);
    scene_close(scene);
    return ok;
}

const Command command_probe = {
    "probe", "what one pixel sees, bounce by bounce, and its spectrum", run, NULL, 0};
