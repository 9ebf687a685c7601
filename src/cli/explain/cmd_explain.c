/* SPDX-License-Identifier: Apache-2.0 */
/* parhelion explain: by which chains of objects light comes to a symbol, a display or a pixel,
 * and what each of them costs. */
#include "cli/explain/cmd_explain.h"

#include <math.h>
#include <stdio.h>
#include <strings.h>

#include "base/count.h"
#include "base/file.h"
#include "base/file_write.h"
#include "print/print.h"
#include "camera/camera.h"
#include "cli/explain/ray_option.h"
#include "cli/options/answer.h"
#include "cli/options/cli.h"
#include "cli/options/outputs.h"
#include "cli/options/scene_options.h"
#include "cli/render/render_setup.h"
#include "review/chain/outlook.h"
#include "review/output/ray_file.h"
#include "review/output/case_json.h"
#include "review/output/review_words.h"
#include "review/request/request_check.h"
#include "review/request/request_read.h"
#include "review/review_decide.h"
#include "review/run/explain.h"
#include "review/run/symbols.h"
#include "scene/load/scene_load.h"
#include "text/interval_text.h"
#include "text/json_text.h"

/* ---- what of a scene is to be explained -------------------------------------------------- */

typedef struct SceneQuestion {
    CameraChoice      camera;
    SceneOptions      scene;
    EnvironmentChange environment;
    const char       *display; /* "cluster", "node:NAME"; NULL: pixels */
    double            uv[4];   /* of the content: left, top, right, bottom */
    double            region[4]; /* pixels: X0, Y0, X1, Y1 */
    int               size[2];
    const char       *isa;
    long              paths;
    int               threads;
    ProgressMode      progress; /* of loading */
    bool              with_outlook;
    Problems         *problems;
    const Outputs    *outputs;
} SceneQuestion;

#define BOUNCES 64
#define SIDE 32 /* of the raster of a region */

/* Points along the looks of a raster. */
static bool aim_at_region(const SceneQuestion *question, const SceneCamera *camera,
                          Arena *arena, ProbeAim *aim, Error *err)
{
    const double *r = question->region;
    Camera seen = camera_from_scene(camera, question->size[0], question->size[1]);
    Vec3  *targets = ARENA_NEW(arena, Vec3, SIDE * SIDE);
    for (int i = 0; i < SIDE * SIDE; i++) {
        double u = (i + 0.5) / (SIDE * SIDE), v = reverse_bits((uint32_t)i) * 0x1p-32;
        float  x = (float)(r[0] + u * (r[2] - r[0]));
        float  y = (float)(r[1] + (v + 0.5 / (SIDE * SIDE)) * (r[3] - r[1]));
        if (!camera_sees(&seen, x, y)) continue;
        targets[aim->target_count++] = vec3_add(aim->eye, camera_ray(&seen, x, y).direction);
    }
    aim->targets = targets;
    return aim->target_count > 0 ||
           error_set(err, ERROR_USAGE, "pixels %g,%g,%g,%g lie outside the fisheye's circle",
                     r[0], r[1], r[2], r[3]);
}

static bool aim_at_display(const SceneQuestion *question, Arena *arena, ProbeAim *aim,
                           Error *err)
{
    const Scene  *scene = aim->context->scene;
    const double *uv = question->uv;
    ReviewDisplay display;
    SymbolSurface surface;
    if (!review_display_find(scene, question->display, arena, &display, err))
        return error_prefix(err, "--display %s", question->display);
    SymbolPlace place = {.scene = scene, .display = &display,
                         .uv = {uv[0], uv[1], uv[2], uv[3]}, .point_count = SYMBOL_POINTS};
    if (!symbol_surface_build(&place, arena, &surface, err))
        return error_prefix(err, "--display %s", question->display);
    bool *is_visible = ARENA_NEW(arena, bool, surface.point_count);
    symbol_visibility(&surface, aim->context, aim->eye, is_visible);
    symbol_aim(&surface, is_visible, arena, aim);
    return aim->target_count > 0 ||
           error_set(err, ERROR_USAGE, "--display %s: the eye sees nothing of it",
                     question->display);
}

static bool explain_lit(const SceneQuestion *question, const PathContext *context,
                        const ReadingTools *tools, Arena *arena, Explained *out, Error *err)
{
    SceneCamera camera;
    if (!render_choose_camera(context->scene, &question->camera, question->problems, &camera,
                              err))
        return false;
    ProbeAim aim = {.context = context, .eye = camera.world_from_camera.origin};
    if (!(question->display ? aim_at_display(question, arena, &aim, err)
                            : aim_at_region(question, &camera, arena, &aim, err)))
        return false;
    ExplainPlace place = {tools, aim, question->paths, question->with_outlook};
    explain_place(&place, arena, out);
    return true;
}

static bool explain_scene(const SceneQuestion *question, Arena *arena, Explained *out,
                          Error *err)
{
    ReadingTools tools = {NULL, question->threads};
    Scene       *scene;
    Bvh         *bvh = NULL;
    Lights      *lights;
    const SceneAsked asked = {&question->scene, &question->environment, question->progress,
                              question->outputs};
    if (!kernel_choose(question->isa, &tools.kernel, err) ||
        !scene_options_load(&asked, arena, question->problems, &scene, err))
        return false;
    render_warn_of_darkness(scene, question->problems);
    bool ok = bvh_create(scene, question->threads, question->isa, &bvh, err) &&
              lights_build(scene, arena, &lights, err);
    if (ok) {
        PathContext context = path_context_build(scene, bvh, lights, BOUNCES, arena);
        ok = explain_lit(question, &context, &tools, arena, out, err);
    }
    bvh_destroy(bvh);
    scene_close(scene);
    return ok;
}

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

/* ---- the answer -------------------------------------------------------------------------- */

/* ---- as text ----------------------------------------------------------------------------- */

static void print_where(const ReviewCase *c)
{
    if (c->symbol)
        print("symbol     %s on %s, seen by %s, %s\n", c->symbol, c->display, c->eye,
              c->condition);
    else if (c->display) print("display    %s\n", c->display);
    print("eye        %.3f, %.3f, %.3f m\n", c->eye_m[0], c->eye_m[1], c->eye_m[2]);
}

static void print_light(const Explained *explained, Arena scratch)
{
    const ReviewCase     *c = &explained->of;
    const CaseLuminances *l = &c->luminance_cd_m2;
    const char *light = c->display ? "reflected" : "luminance";
    if (c->symbol)
        print("sends      %.4g cd/m2 foreground, %.4g background\n", l->foreground,
              l->background);
    else if (c->display)
        print("sends      %.4g cd/m2; white %.4g, black %.4g\n", explained->shown,
              l->foreground, l->background);
    print("%-10s %s cd/m2", light,
          interval_text(l->reflected, c->reflected_range.low, c->reflected_range.high,
                        &scratch));
    if (c->display) print(": mirror %.4g, scattered %.4g", l->mirror, l->scattered);
    print("\n");
    if (c->display)
        print("contrast   %s : 1; %.4g : 1 if nothing were reflected\n",
              interval_text(c->contrast_ratio, c->contrast_low, c->contrast_high, &scratch),
              luminance_contrast(l->foreground, l->background, 0));
}

/* Of a review's case: the quantity of the limit that decides it. */
static void print_judged(const ReviewCase *c, Arena scratch)
{
    const LimitVerdict *limit = case_worst_limit(c);
    if (!limit) return;
    print("judged     %s: %s %s, required %s\n", verdict_names[c->verdict], words_kind(limit),
          words_measured(limit, &scratch), words_required(limit, &scratch));
}

static void print_cause(const CaseCause *cause, bool has_contrast, Arena scratch)
{
    print("%6.1f %%  %8s  %8s to %-8s", 100 * cause->share,
          words_within(cause->cd_m2, cause->low, cause->high, &scratch),
          words_within(cause->low, cause->low, cause->high, &scratch),
          words_within(cause->high, cause->low, cause->high, &scratch));
    if (has_contrast) print("  %7.3g : 1", cause->contrast_without);
    for (int i = 0; i < cause->links; i++)
        print("%s%s", i ? " > " : "  ", cause->chain[i]);
    print("\n");
}

/* Each adds up to all of the light. */
static void print_groups(const ReviewCase *c)
{
    static const char *const NAMES[CAUSE_GROUPS] = {"began at", "came by", "met at"};
    for (int g = 0; g < CAUSE_GROUPS; g++) {
        const CaseGroup *group = &c->groups[g];
        if (group->count && g) print("\n");
        for (int i = 0; i < group->count; i++)
            print("%s%.3g %% %s", i ? ", " : "", 100 * group->list[i].share,
                  group->list[i].what);
        if (group->count) print(" (%s)", NAMES[g]);
    }
    print("\n");
}

static void print_causes(const ReviewCase *c, Arena scratch)
{
    bool has_contrast = c->display != NULL;
    if (!c->cause_count) return;
    print("\n   share     cd/m2   95 %% interval     %s  via\n",
          has_contrast ? "without it " : "");
    for (int i = 0; i < c->cause_count; i++) print_cause(&c->causes[i], has_contrast, scratch);
}

static void print_remedies(const ReviewCase *c, Arena scratch)
{
    if (c->remedy_count) print("\n");
    for (int i = 0; i < c->remedy_count; i++)
        print("remedy     %s: %s\n", c->remedies[i].what,
              words_remedy(&c->remedies[i], &scratch));
}

static void print_text(const Explained *explained, Arena *arena)
{
    print_where(&explained->of);
    if (explained->of.hider_count)
        print("hidden     %s\n", words_hiders(&explained->of, arena));
    if (!case_is_seen(&explained->of)) {
        print("%s\n", words_reason(&explained->of, arena));
        return;
    }
    print_light(explained, *arena);
    print_judged(&explained->of, *arena);
    print_groups(&explained->of);
    print_causes(&explained->of, *arena);
    const char *seat = words_empty_seat(&explained->of, arena);
    if (seat[0]) print("\nnote       %s\n", seat);
    print_remedies(&explained->of, *arena);
    if (explained->has_outlook) print("\nsees       %s\n", outlook_words(&explained->outlook,
                                                                         arena));
}

/* ---- as JSON ----------------------------------------------------------------------------- */

static json_t *json_rays(const ReviewCase *c, const CaseCause *cause)
{
    json_t *out = json_array();
    for (int i = 0; i < cause->ray_count; i++) {
        json_t *ray = json_array();
        for (int k = 0; k < cause->rays[i].count; k++) {
            double at[3];
            world_from_scene(c->origin_m, cause->rays[i].points[k], at);
            json_array_append_new(ray, json_world_point(at));
        }
        json_array_append_new(out, ray);
    }
    return out;
}

static json_t *json_chains(const ReviewCase *c)
{
    json_t *out = json_array();
    for (int i = 0; i < c->cause_count; i++) {
        const CaseCause *cause = &c->causes[i];
        double lost = cause->contrast_without - c->contrast_ratio;
        json_array_append_new(out, json_pack(
            "{s:o, s:o, s:o, s:[o,o], s:o, s:o, s:o}", "chain",
            json_texts(cause->chain, cause->links), "share", json_figure(cause->share), "cd_m2",
            json_figure(cause->cd_m2), "interval", json_figure(cause->low),
            json_figure(cause->high), "contrast_without", json_figure(cause->contrast_without),
            "contrast_lost", json_figure(lost), "rays", json_rays(c, cause)));
    }
    return out;
}

static json_t *json_light(const Explained *explained)
{
    const CaseLuminances *l = &explained->of.luminance_cd_m2;
    if (!explained->of.display) return json_pack("{s:o}", "all", json_figure(l->reflected));
    json_t *out = json_pack("{s:o, s:o, s:o}", "reflected", json_figure(l->reflected), "mirror",
                            json_figure(l->mirror), "scattered", json_figure(l->scattered));
    bool is_symbol = explained->of.symbol != NULL;
    json_object_set_new(out, is_symbol ? "foreground" : "white", json_figure(l->foreground));
    json_object_set_new(out, is_symbol ? "background" : "black", json_figure(l->background));
    if (!is_symbol) json_object_set_new(out, "emitted", json_figure(explained->shown));
    return out;
}

static json_t *json_outlook(const Explained *explained)
{
    const Outlook *o = &explained->outlook;
    if (!explained->has_outlook) return json_null();
    json_t *shares = json_array();
    for (int i = 0; i < o->share_count; i++)
        json_array_append_new(shares, json_pack("{s:o, s:o, s:o}", "what",
                                                json_text(o->shares[i].what), "share",
                                                json_figure(o->shares[i].share), "lux",
                                                json_figure(o->shares[i].lux)));
    return json_pack("{s:o, s:o, s:o, s:{s:o, s:o}}", "lux", json_figure(o->lux), "shares",
                     shares, "rest", json_figure(o->rest), "mirror", "what",
                     json_text_or_null(o->mirror_what), "cd_m2", json_figure(o->mirror_cd_m2));
}

static bool print_json(const Explained *explained, Error *err)
{
    const ReviewCase *c = &explained->of;
    json_t *out = json_pack(
        "{s:o, s:o, s:o, s:o, s:o, s:o, s:o, s:[o,o], s:I}", "condition",
        json_text_or_null(c->condition), "eye", json_text_or_null(c->eye), "symbol",
        json_text_or_null(c->symbol), "display", json_text_or_null(c->display), "eye_m",
        json_world_point(c->eye_m), "luminance_cd_m2", json_light(explained), "contrast_ratio",
        json_figure(c->contrast_ratio), "contrast_interval", json_figure(c->contrast_low),
        json_figure(c->contrast_high), "paths", (json_int_t)explained->paths);
    json_object_set_new(out, "visible_share", json_figure(c->visible_share));
    case_whole_json(c, out);
    json_object_set_new(out, "hidden_by", case_hiders_json(c));
    json_object_set_new(out, "reflected_interval",
                        json_pack("[o,o]", json_figure(c->reflected_range.low),
                                  json_figure(c->reflected_range.high)));
    json_object_set_new(out, "cause_groups", case_groups_json(c));
    json_object_set_new(out, "chains", json_chains(c));
    json_object_set_new(out, "remedies", case_remedies_json(c));
    json_object_set_new(out, "outlook", json_outlook(explained));
    return cli_print_json(out, err);
}

static bool explain_answer(const Cli *cli, const Explained *explained, Arena *arena, Error *err)
{
    if (cli->json) return print_json(explained, err);
    print_text(explained, arena);
    return true;
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
           error_set(err, ERROR_USAGE, "--region: required: X0 < X1 and Y0 < Y1");
}

static bool read_eye(ExplainWords *words, Error *err)
{
    CameraChoice *camera = &words->scene.camera;
    if (!words->eye) return true;
    camera->has_eye = cli_numbers(words->eye, 3, camera->eye);
    return camera->has_eye ||
           error_set(err, ERROR_USAGE, "--eye %s: required of a scene: X,Y,Z in metres",
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
                         "required: one of --display NAME, --pixel X,Y, --region X0,Y0,X1,Y1: "
                         "what of the scene is to be explained?");
    if (!render_check_size(&scene->camera, words->has_size, scene->size, err)) return false;
    if (words->has_uv && !scene->display)
        return error_set(err, ERROR_USAGE, "--uv: of which --display?");
    if (!(scene->uv[0] < scene->uv[2] && scene->uv[1] < scene->uv[3]))
        return error_set(err, ERROR_USAGE, "--uv: required: L < R and T < B");
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
        {camera->projection != 0, "--projection"},
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
    return ray_option_check(words->rays, err) &&
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
        {"--size", OPTION_SIZE, "WxH",
         "of that picture (default 1280x720, of a fisheye 1024x1024)", scene->size,
         .given = &out->has_size},
        {"--camera", OPTION_TEXT, "NAME|INDEX", "node's or camera's name, or place (default 0)",
         &scene->camera.name},
        PROJECTION_OPTION(&scene->camera),
        {"--look-at", OPTION_NUMBERS, "X,Y,Z", "with --eye: the middle of the picture",
         scene->camera.look_at, .low = -1e6, .high = 1e6, .count = 3,
         .given = &scene->camera.has_look_at},
        {"--fov", OPTION_NUMBER, "DEG", "with --eye: the picture's height as an angle (40)",
         &scene->camera.fov_deg, .low = 0.01, .high = 179, .given = &scene->camera.has_fov},
        {"--paths", OPTION_INTEGER, "N", "more make the figures surer (default 65536)",
         &scene->paths, .low = 1024, .high = 1 << 24},
        {"-o", OPTION_TEXT, "FILE.gltf|.glb", "the rays, to be opened beside the scene",
         &out->rays, .file = OPTION_OUTPUT},
        {"--outlook", OPTION_TEXT, "FILE.png", "what the surface sees, as a fisheye",
         &out->outlook, .file = OPTION_OUTPUT},
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
    scene->outputs = &out->cli.outputs;
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
           error_set(err, ERROR_USAGE, "--sun %s: required: AZ,EL in degrees, the azimuth of "
                     "the vehicle: 0 ahead, 90 right; the elevation from -18 to 90", text);
}

static bool spare_scene(void *user, const Scene *scene, Error *err)
{
    return outputs_spare(user, scene->inputs, scene->input_count, err);
}

static bool review_question(const ExplainWords *words, Arena *arena, Explained *out,
                            Error *err)
{
    const SceneQuestion *scene = &words->scene;
    const char     *root = scene->scene.root, *sun = scene->environment.sun;
    Outputs         outputs = words->cli.outputs;
    ReviewRequest   request;
    ExplainOptions  options = {.condition = words->condition, .eye = words->eye,
                               .symbol = words->symbol, .has_sun = sun != NULL,
                               .means = {.root = root, .state = scene->scene.state,
                                         .isa = scene->isa, .threads = scene->threads},
                               .paths = scene->paths, .with_outlook = scene->with_outlook,
                               .problems = scene->problems, .read = spare_scene,
                               .user = &outputs};
    if (sun && !read_sun(sun, options.sun_deg, err)) return false;
    if (!review_request_read(words->cli.arguments[0], root, arena, scene->problems, &request,
                             err))
        return false;
    const Lines files = review_request_files(&request, arena);
    if (!outputs_spare(&outputs, files.list, files.count, err)) return false;
    if (!profile_load(request.profile, arena, &options.profile, err))
        return error_in_file(err, request.file);
    if (request.privacy.is_given)
        options.profile = profile_with_security(options.profile, request.privacy.security_min,
                                                arena);
    return explain_review(&request, &options, arena, out, err);
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

static Outcome run(int argc, char **argv, Arena *arena, Error *err)
{
    Problems     problems = problems_start(arena);
    ExplainWords words = {.scene = {.uv = {0, 0, 1, 1}, .paths = 65536, .problems = &problems}};
    Explained    explained;
    if (!parse(argc, argv, arena, &words, err)) return OUTCOME_FAILED;
    if (words.cli.help_shown) return OUTCOME_DONE;
    if (!(is_review(&words)
              ? review_question(&words, arena, &explained, err)
              : explain_scene(&words.scene, arena, &explained, err)))
        return OUTCOME_FAILED;
    if (words.outlook && !explained.has_outlook)
        return error_set(err, ERROR_INPUT, "--outlook %s: the eye meets no surface there, "
                         "required: one to look out from", words.outlook);
    cli_print_warnings(&problems);
    return outcome_of((!words.rays || ray_file_write(&explained.of, words.rays, err)) &&
                      write_outlook(&words, &explained, arena, err) &&
                      explain_answer(&words.cli, &explained, arena, err));
}

const Command command_explain = {
    "explain", "by which ways light comes to a display or a pixel, and what each costs", run,
    NULL, 0};
