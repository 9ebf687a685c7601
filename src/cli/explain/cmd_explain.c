/* SPDX-License-Identifier: Apache-2.0 */
/* parhelion explain: by which chains of objects light comes to a symbol, a display or a pixel,
 * and what each of them costs. */
#include "cli/explain/cmd_explain.h"

#include <math.h>
#include <string.h>
#include <strings.h>

#include "base/count.h"
#include "base/file.h"
#include "base/file_write.h"
#include "cli/explain/explain_answer.h"
#include "cli/explain/explain_scene.h"
#include "cli/explain/ray_option.h"
#include "cli/options/answer.h"
#include "review/chain/outlook_picture.h"
#include "review/output/ray_file.h"
#include "review/request/request_read.h"

typedef struct ExplainWords {
    SceneQuestion scene;
    SceneWords    scene_words;
    const char   *condition, *eye, *symbol, *rays, *outlook;
    double        pixel[2];
    bool          has_pixel, has_region, has_uv, has_size;
    Cli           cli;
} ExplainWords;

static bool is_review(const ExplainWords *words)
{
    return !strcasecmp(path_ending(words->cli.arguments[0]), ".json");
}

/* ---- the command line -------------------------------------------------------------------- */

static bool check_region(const ExplainWords *words, Error *err)
{
    const double *r = words->scene.region;
    const int    *size = words->scene.size;
    if (words->has_pixel && !(r[0] == floor(r[0]) && r[1] == floor(r[1]) && r[0] >= 0 &&
                              r[1] >= 0 && r[0] < size[0] && r[1] < size[1]))
        return error_set(err, ERROR_USAGE,
                         "--pixel %g,%g: is no pixel of a picture of %dx%d, whose first is 0,0 "
                         "at the top left", r[0], r[1], size[0], size[1]);
    for (int i = 0; i < 4; i++)
        if (r[i] != floor(r[i]) || r[i] < 0 || r[i] > size[i % 2])
            return error_set(err, ERROR_USAGE,
                             "--region: %g is no edge of a pixel of a picture of %dx%d", r[i],
                             size[0], size[1]);
    return (r[0] < r[2] && r[1] < r[3]) ||
           error_set(err, ERROR_USAGE, "--region: wanted X0 < X1 and Y0 < Y1");
}

static bool read_eye(ExplainWords *words, Error *err)
{
    CameraChoice *camera = &words->scene.camera;
    if (!words->eye) return true;
    camera->has_eye = cli_numbers(words->eye, 3, camera->eye);
    return camera->has_eye ||
           error_set(err, ERROR_USAGE, "--eye %s: of a scene wanted X,Y,Z in metres",
                     words->eye);
}

static bool read_scene(ExplainWords *words, Arena *arena, Error *err)
{
    SceneQuestion *scene = &words->scene;
    const char *of_review = words->symbol ? "--symbol" : NULL;
    if (words->condition) of_review = "--condition";
    int asked = (scene->display != NULL) + words->has_pixel + words->has_region;
    if (of_review)
        return error_set(err, ERROR_USAGE, "%s: a scene has none; a REVIEW.json has",
                         of_review);
    if (asked != 1)
        return error_set(err, ERROR_USAGE,
                         "wanted one of --display NAME, --pixel X,Y, --region X0,Y0,X1,Y1: "
                         "what of the scene is to be explained?");
    if (words->has_uv && !scene->display)
        return error_set(err, ERROR_USAGE, "--uv: of which --display?");
    if (!(scene->uv[0] < scene->uv[2] && scene->uv[1] < scene->uv[3]))
        return error_set(err, ERROR_USAGE, "--uv: wanted L < R and T < B");
    if (words->has_pixel)
        for (int i = 0; i < 4; i++) scene->region[i] = words->pixel[i % 2] + (int)(i / 2);
    return (scene->display || check_region(words, err)) && read_eye(words, err) &&
           scene_options_read(&words->scene_words, &words->cli, arena, &scene->scene, err);
}

/* An option that a review sets itself; NULL: none is there. */
static const char *option_of_scene(const ExplainWords *words)
{
    const CameraChoice *camera = &words->scene.camera;
    EnvironmentChange   no_sun = words->scene.environment;
    SceneWords          no_state = words->scene_words;
    no_sun.sun = NULL;
    no_state.state = (StateWords){.has_time = false};
    const struct {
        bool        is_given;
        const char *option;
    } options[] = {
        {camera->name != NULL, "--camera"}, {words->scene.display != NULL, "--display"},
        {words->has_uv, "--uv"}, {words->has_pixel, "--pixel"},
        {words->has_region, "--region"}, {words->has_size, "--size"},
        {camera->has_look_at, "--look-at"}, {camera->has_fov, "--fov"}};
    for (int i = 0; i < COUNT_OF(options); i++)
        if (options[i].is_given) return options[i].option;
    return scene_options_given(&no_state, &no_sun);
}

static bool check_review(ExplainWords *words, Error *err)
{
    const char *of_scene = option_of_scene(words);
    if (of_scene)
        return error_set(err, ERROR_USAGE, "%s: a review says that itself; --condition, --eye "
                         "and --symbol choose from it", of_scene);
    if (words->cli.argument_count > 1)
        return error_set(err, ERROR_USAGE, "%s: one review at a time is explained",
                         words->cli.arguments[1]);
    return state_options_read(&words->scene_words.state, &words->scene.scene.state, err);
}

static bool check_outputs(const ExplainWords *words, Error *err)
{
    return ray_option_check(words->rays, &words->cli, err) &&
           (!words->outlook || (picture_check_name(words->outlook, 8, err) &&
                                file_check_writable(words->outlook, err)));
}

static bool parse(int argc, char **argv, Arena *arena, ExplainWords *out, Error *err)
{
    SceneQuestion *scene = &out->scene;
    const Option options[] = {
        {"--condition", OPTION_TEXT, "NAME", "of a review: in which (default: the only one)",
         &out->condition},
        {"--symbol", OPTION_TEXT, "NAME", "of a review: what is looked at", &out->symbol},
        {"--eye", OPTION_TEXT, "NAME|X,Y,Z", "of a review: who looks; of a scene: where, m",
         &out->eye},
        {"--display", OPTION_TEXT, "MATERIAL|node:NAME", "of a scene: a display that is seen",
         &scene->display},
        {"--uv", OPTION_NUMBERS, "L,T,R,B", "a rectangle of its content, 0 to 1, v down",
         scene->uv, .low = 0, .high = 1, .count = 4, .given = &out->has_uv},
        {"--pixel", OPTION_NUMBERS, "X,Y", "of a scene: a pixel of the camera's picture",
         out->pixel, .low = 0, .high = 65535, .count = 2, .given = &out->has_pixel},
        {"--region", OPTION_NUMBERS, "X0,Y0,X1,Y1", "pixels, half-open, from the top left",
         scene->region, .low = 0, .high = 65536, .count = 4, .given = &out->has_region},
        {"--size", OPTION_SIZE, "WxH", "of that picture (default 1280x720)", scene->size,
         .given = &out->has_size},
        {"--camera", OPTION_TEXT, "NAME|INDEX", "node's or camera's name, or place (default 0)",
         &scene->camera.name},
        {"--look-at", OPTION_NUMBERS, "X,Y,Z", "with --eye: the middle of the picture",
         scene->camera.look_at, .low = -1e6, .high = 1e6, .count = 3,
         .given = &scene->camera.has_look_at},
        {"--fov", OPTION_NUMBER, "DEG", "with --eye: the picture's height as an angle (40)",
         &scene->camera.fov_deg, .low = 0.01, .high = 179, .given = &scene->camera.has_fov},
        {"--paths", OPTION_INTEGER, "N", "more make the figures surer (default 65536)",
         &scene->paths, .low = 1024, .high = 1 << 24},
        {"-o", OPTION_TEXT, "FILE.gltf|.glb", "the rays, to be opened beside the scene",
         &out->rays},
        {"--outlook", OPTION_TEXT, "FILE.png", "what the surface sees, as a fisheye",
         &out->outlook},
        {"--isa", OPTION_TEXT, "NAME", "sse2, avx2, avx512 (default: the processor's best)",
         &scene->isa},
        SCENE_OPTIONS(&out->scene_words, &scene->scene, &scene->environment),
    };
    const CliCommand command = {
        "explain", "by which ways light comes to a display or a pixel, and what each costs",
        "REVIEW.json [--condition NAME] [--symbol NAME] [--eye NAME] | SCENE... --display NAME "
        "| SCENE... --pixel X,Y",
        "parhelion explain scenes/glance.review.json --condition night -o ways.gltf",
        options, COUNT_OF(options), 1, -1};
    if (!cli_parse(&command, argc, argv, arena, &out->cli, err)) return false;
    if (out->cli.help_shown) return true;
    scene->threads = out->cli.threads;
    scene->progress = out->cli.progress;
    scene->with_outlook = out->outlook != NULL;
    if (!(is_review(out) ? check_review(out, err) : read_scene(out, arena, err))) return false;
    return check_outputs(out, err);
}

/* ---- the answer -------------------------------------------------------------------------- */

/* As far as a sweep's may go. */
static bool read_sun(const char *text, double out_deg[2], Error *err)
{
    return (cli_numbers(text, 2, out_deg) && fabs(out_deg[0]) <= 720 && out_deg[1] >= -18 &&
            out_deg[1] <= 90) ||
           error_set(err, ERROR_USAGE, "--sun %s: wanted AZ,EL in degrees, the azimuth of "
                     "the vehicle: 0 ahead, 90 right; the elevation from -18 to 90", text);
}

static bool review_question(const ExplainWords *words, Arena *arena, Explained *out,
                            Error *err)
{
    const SceneQuestion *scene = &words->scene;
    const char     *root = scene->scene.root, *sun = scene->environment.sun;
    ReviewRequest   request;
    ExplainOptions  options = {.condition = words->condition, .eye = words->eye,
                               .symbol = words->symbol, .has_sun = sun != NULL, .root = root,
                               .state = scene->scene.state,
                               .isa = scene->isa, .threads = scene->threads,
                               .paths = scene->paths, .with_outlook = scene->with_outlook,
                               .problems = scene->problems};
    if (sun && !read_sun(sun, options.sun_deg, err)) return false;
    return review_request_read(words->cli.arguments[0], root, arena, scene->problems, &request,
                               err) &&
           (profile_load(request.profile, arena, &options.profile, err) ||
            error_in_file(err, request.file)) &&
           explain_review(&request, &options, arena, out, err);
}

static bool write_outlook(const ExplainWords *words, const Explained *explained, Arena *arena,
                          Error *err)
{
    if (!words->outlook) return true;
    PictureFile file = {.bits = 8, .is_srgb = true,
                        .description = outlook_words(&explained->outlook, arena)};
    Picture     picture = outlook_picture(&explained->outlook, arena);
    return picture_write(words->outlook, &picture, file, *arena, err);
}

static bool run(int argc, char **argv, Arena *arena, Error *err)
{
    Problems     problems = problems_start(arena);
    ExplainWords words = {.scene = {.uv = {0, 0, 1, 1}, .size = {1280, 720},
                                    .paths = 65536, .problems = &problems}};
    Explained    explained;
    if (!parse(argc, argv, arena, &words, err)) return false;
    if (words.cli.help_shown) return true;
    if (!(is_review(&words)
              ? review_question(&words, arena, &explained, err)
              : explain_scene(&words.scene, arena, &explained, err)))
        return false;
    if (words.outlook && !explained.has_outlook)
        return error_set(err, ERROR_INPUT, "--outlook %s: the eye meets no surface there, "
                         "wanted one to look out from", words.outlook);
    cli_print_warnings(&problems);
    return (!words.rays || ray_file_write(&explained.of, words.rays, err)) &&
           write_outlook(&words, &explained, arena, err) &&
           explain_answer(&words.cli, &explained, arena, err);
}

const Command command_explain = {
    "explain", "by which ways light comes to a display or a pixel, and what each costs", run,
    NULL, 0};
