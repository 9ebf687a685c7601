/* SPDX-License-Identifier: Apache-2.0 */
/* parhelion probe: what one pixel sees, bounce by bounce, and its spectrum. */
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "base/count.h"
#include "print/print.h"
#include "cli/explain/cmd_explain.h"
#include "cli/explain/ray_option.h"
#include "cli/options/answer.h"
#include "cli/options/cli.h"
#include "cli/options/scene_options.h"
#include "cli/render/path_options.h"
#include "cli/render/render_setup.h"
#include "light/light_groups.h"
#include "render/render.h"
#include "review/chain/chains.h"
#include "review/chain/causes.h"
#include "review/output/ray_file.h"
#include "scene/load/scene_load.h"
#include "text/json_text.h"

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
    bool        has_pixel, has_size;
    Cli         cli;
} ProbeWords;

/* ---- the answer -------------------------------------------------------------------------- */

/* The light of one pixel. */
typedef struct Probed {
    int  pixel[2], size[2];
    Vec3 eye;
    Chains      chains;
    PixelLight  light;
    LightGroups groups; /* by which lights are named and coloured */
} Probed;

#define BAR 40 /* letters of the longest in the spectrum */

/* One thing that a chain of objects does with light, in the order of the eye's ray. */
typedef struct ProbeBounce {
    const char *what;
    int         part_id;
    Vec3        at;       /* on one of the chain's paths; only if has_place: */
    bool        has_place;
} ProbeBounce;

#define WAY_BOUNCES (2 * CHAIN_STEPS + 2)

typedef struct ProbeWay {
    ProbeBounce bounce[WAY_BOUNCES];
    int         count;
    const char *light;     /* as the scene has it */
    bool        has_from;  /* the light is near: */
    Vec3        from;      /* where that path met it */
} ProbeWay;

/* ---- a chain as bounces ------------------------------------------------------------------ */

static const char *event_word(int event)
{
    static const char *const words[] = {"scatters", "mirror", "refracts"};
    return words[event];
}

static void add_bounce(ProbeWay *way, const char *what, int part_id, const Vec3 *at)
{
    ProbeBounce *bounce = &way->bounce[way->count++];
    *bounce = (ProbeBounce){.what = what, .part_id = part_id, .has_place = at != NULL};
    if (at) bounce->at = *at;
}

static void add_pane(ProbeWay *way, int part_id)
{
    if (part_id != NO_ID) add_bounce(way, "passes", part_id, NULL);
}

static bool is_distant(const Scene *scene, const ChainKey *key)
{
    if (key->source == LIGHTS_EMITTERS) return false;
    return key->source != LIGHTS_PUNCTUAL ||
           scene->lights[key->source_id].kind == LIGHT_DIRECTIONAL;
}

static int group_of(const Probed *probed, const ChainKey *key)
{
    return light_group_of(&probed->groups, (LightSet)key->source, key->source_id);
}

static ProbeWay way_of(const Probed *probed, const Chain *chain)
{
    const ChainKey *key = &chain->key;
    const ChainRay *ray = chain->ray_count ? &chain->rays[0] : NULL;
    ProbeWay way = {.light = probed->groups.said[group_of(probed, key)]};
    for (int i = 0; i < key->count; i++) {
        add_pane(&way, key->link[i].pane_id);
        add_bounce(&way, event_word(key->link[i].event), key->link[i].part_id,
                   ray ? &ray->point[i + 1] : NULL);
    }
    add_pane(&way, key->pane_id);
    way.has_from = ray && !ray->is_cut && !is_distant(probed->chains.scene, key);
    if (way.has_from) way.from = ray->point[ray->count - 1];
    return way;
}

/* ---- as text ----------------------------------------------------------------------------- */

static void print_place(const Scene *scene, Vec3 p)
{
    double at[3];
    world_from_scene(scene->origin, p, at);
    print("  at %.3f, %.3f, %.3f m", at[0], at[1], at[2]);
}

static void print_way(const Probed *probed, const Chain *chain, Arena scratch)
{
    ProbeWay way = way_of(probed, chain);
    print("%6.1f %%  %10.4g  %9.2g  %s\n",
          100 * chain->figure.cd_m2 / probed->chains.all.cd_m2, chain->figure.cd_m2,
          chain->figure.sigma, way.light);
    for (int i = 0; i < way.count; i++) {
        const ProbeBounce *bounce = &way.bounce[i];
        print("%34d %-8s %s", i + 1, bounce->what,
              chain_part_words(probed->chains.scene, bounce->part_id, &scratch));
        if (bounce->has_place) print_place(probed->chains.scene, bounce->at);
        print("\n");
    }
    if (chain->key.is_longer) print("%34s further surfaces\n", "");
    if (!way.has_from) return;
    print("%34s begins ", "");
    print_place(probed->chains.scene, way.from);
    print("\n");
}

static void print_ways(const Probed *probed, Arena scratch)
{
    const Chains *chains = &probed->chains;
    if (!(chains->all.cd_m2 > 0)) return;
    print("\n   share       cd/m2      error  light, and what the eye's ray meets before "
          "it\n");
    for (int i = 0; i < chains->count; i++) print_way(probed, &chains->list[i], scratch);
    if (chains->others)
        print("%6.1f %%  %10.4g  %9.2g  %d other ways\n",
              100 * chains->rest.cd_m2 / chains->all.cd_m2, chains->rest.cd_m2,
              chains->rest.sigma, chains->others);
}

static double greatest(const PixelLight *light)
{
    double most = 0;
    for (int i = 0; i < PIXEL_BANDS; i++) most = fmax(most, light->radiance[i].mean);
    return most;
}

static int band_center_nm(int band)
{
    return PIXEL_FIRST_NM + PIXEL_BAND_NM * band + PIXEL_BAND_NM / 2;
}

static void print_spectrum(const PixelLight *light)
{
    double most = greatest(light);
    if (!(most > 0)) return;
    print("\n    nm  W m-2 sr-1 nm-1      error\n");
    for (int i = 0; i < PIXEL_BANDS; i++) {
        const PixelFigure *figure = &light->radiance[i];
        int length = (int)(BAR * fmax(figure->mean, 0) / most + 0.5);
        print("%6d  %15.4g  %9.2g  %.*s\n", band_center_nm(i), figure->mean, figure->sigma,
              length, "########################################");
    }
}

static void print_text(const Probed *probed, Arena scratch)
{
    const PixelFigure *xyz = probed->light.xyz;
    double sum = xyz[0].mean + xyz[1].mean + xyz[2].mean;
    print("pixel      %d,%d of %dx%d, %ld paths\n", probed->pixel[0], probed->pixel[1],
          probed->size[0], probed->size[1], probed->chains.paths);
    print("luminance  %.5g cd/m2, standard error %.2g", xyz[1].mean, xyz[1].sigma);
    if (sum > 0) print("; x %.4f, y %.4f", xyz[0].mean / sum, xyz[1].mean / sum);
    print("\n");
    print_ways(probed, scratch);
    print_spectrum(&probed->light);
}

/* ---- as JSON ----------------------------------------------------------------------------- */

static json_t *json_point(const Scene *scene, Vec3 p)
{
    double at[3];
    world_from_scene(scene->origin, p, at);
    return json_world_point(at);
}

static json_t *json_bounces(const Probed *probed, const ProbeWay *way)
{
    const Scene *scene = probed->chains.scene;
    json_t      *out = json_array();
    for (int i = 0; i < way->count; i++) {
        const ProbeBounce *bounce = &way->bounce[i];
        const Part        *part = &scene->parts[bounce->part_id];
        json_array_append_new(out, json_pack(
            "{s:s, s:o, s:o, s:o}", "what", bounce->what, "material",
            json_text(scene->materials[part->material_id].name), "node", json_text(part->name),
            "at_m",
            bounce->has_place ? json_point(scene, bounce->at) : json_null()));
    }
    return out;
}

static json_t *json_rays(const Scene *scene, const Chain *chain)
{
    json_t *out = json_array();
    for (int i = 0; i < chain->ray_count; i++) {
        json_t *ray = json_array();
        for (int k = 0; k < chain->rays[i].count; k++)
            json_array_append_new(ray, json_point(scene, chain->rays[i].point[k]));
        json_array_append_new(out, ray);
    }
    return out;
}

static json_t *json_way(const Probed *probed, const Chain *chain)
{
    static const char *const kinds[] = {"sun", "sky", "surface", "lamp"};
    const Scene *scene = probed->chains.scene;
    ProbeWay     way = way_of(probed, chain);
    return json_pack("{s:o, s:s, s:o, s:f, s:f, s:f, s:o, s:b, s:o}", "light",
                     json_text(way.light), "kind", kinds[chain->key.source], "from_m",
                     way.has_from ? json_point(scene, way.from) : json_null(), "cd_m2",
                     chain->figure.cd_m2, "standard_error_cd_m2", chain->figure.sigma, "share",
                     chain->figure.cd_m2 / probed->chains.all.cd_m2, "bounces",
                     json_bounces(probed, &way), "has_further_surfaces",
                     chain->key.is_longer, "rays", json_rays(scene, chain));
}

static json_t *json_spectrum(const PixelLight *light)
{
    json_t *nm = json_array(), *radiance = json_array(), *error = json_array();
    for (int i = 0; i < PIXEL_BANDS; i++) {
        json_array_append_new(nm, json_integer(band_center_nm(i)));
        json_array_append_new(radiance, json_real(light->radiance[i].mean));
        json_array_append_new(error, json_real(light->radiance[i].sigma));
    }
    return json_pack("{s:s, s:i, s:o, s:o, s:o}", "unit", "W m-2 sr-1 nm-1", "band_nm",
                     PIXEL_BAND_NM, "nm", nm, "radiance", radiance, "standard_error", error);
}

static bool print_json(const Probed *probed, Error *err)
{
    const Chains      *chains = &probed->chains;
    const PixelFigure *xyz = probed->light.xyz;
    json_t *ways = json_array();
    for (int i = 0; i < chains->count; i++)
        json_array_append_new(ways, json_way(probed, &chains->list[i]));
    return cli_print_json(
        json_pack("{s:[i,i], s:[i,i], s:I, s:o, s:[f,f,f], s:f, s:f, s:o, s:{s:i,s:f,s:f}, "
                  "s:o}",
                  "pixel", probed->pixel[0], probed->pixel[1], "size", probed->size[0],
                  probed->size[1], "paths", (json_int_t)chains->paths, "eye_m",
                  json_point(chains->scene, probed->eye), "XYZ", xyz[0].mean,
                  xyz[1].mean, xyz[2].mean, "luminance_cd_m2", xyz[1].mean,
                  "standard_error_cd_m2", xyz[1].sigma, "ways", ways, "other_ways",
                  "count", chains->others, "cd_m2", chains->rest.cd_m2,
                  "standard_error_cd_m2", chains->rest.sigma, "spectrum",
                  json_spectrum(&probed->light)),
        err);
}

static bool probe_answer(const Cli *cli, const Probed *probed, Arena *arena, Error *err)
{
    if (cli->json) return print_json(probed, err);
    print_text(probed, *arena);
    return true;
}

/* ---- rays -------------------------------------------------------------------------------- */

static CaseRay ray_of(const ChainRay *from)
{
    return (CaseRay){from->point, from->count};
}

/* The rays as lines of a glTF file, each in the colour of its light (ray_file.h). */
static bool probe_write_rays(const Probed *probed, const char *path, Arena *arena, Error *err)
{
    const Chains *chains = &probed->chains;
    Arena         scratch = *arena;
    CaseCause    *causes = ARENA_NEW(&scratch, CaseCause, chains->count);
    for (int i = 0; i < chains->count; i++) {
        const Chain *chain = &chains->list[i];
        CaseRay     *rays = ARENA_NEW(&scratch, CaseRay, chain->ray_count);
        for (int k = 0; k < chain->ray_count; k++) rays[k] = ray_of(&chain->rays[k]);
        causes[i] = (CaseCause){.share = chain->figure.cd_m2 / chains->all.cd_m2,
                                .cd_m2 = chain->figure.cd_m2, .rays = rays,
                                .ray_count = chain->ray_count,
                                .contrast_without = (double)NAN,
                                .light = 1 + group_of(probed, &chain->key)};
        causes[i].chain = chain_words(chains->scene, &chain->key, &causes[i].links, &scratch);
    }
    ReviewCase all = {.causes = causes, .cause_count = chains->count};
    memcpy(all.origin_m, chains->scene->origin, sizeof all.origin_m);
    return ray_file_write(&all, path, err);
}

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
    if (!render_check_size(&words->camera, words->has_size, words->size, err) ||
        !check_pixel(words, err))
        return false;
    if (!guiding_options_check(render, err)) return false;
    render->width = words->size[0];
    render->height = words->size[1];
    render->seed = (uint32_t)words->seed;
    render->max_bounces = (int)words->max_bounces;
    render->threads = words->cli.threads;
    render->progress = words->cli.progress;
    return scene_options_read(&words->scene_words, &words->cli, arena, &words->scene, err) &&
           ray_option_check(words->rays, err);
}

static bool parse(int argc, char **argv, Arena *arena, ProbeWords *out, Error *err)
{
    const Option options[] = {
        {"--pixel", OPTION_NUMBERS, "X,Y", "of the camera's picture, 0,0 at the top left",
         out->pixel, .low = -1e9, .high = 1e9, .count = 2, .given = &out->has_pixel},
        {"--size", OPTION_SIZE, "WxH",
         "of that picture (default 1280x720, of a fisheye 1024x1024)", out->size,
         .given = &out->has_size},
        CAMERA_OPTIONS(&out->camera),
        {"--spp", OPTION_INTEGER, "N",
         "paths, rounded up to whole chunks of 64 (default 4096)", &out->spp,
         .low = CHAIN_PATHS_LEAST, .high = 1 << 24},
        {"--seed", OPTION_INTEGER, "N", "another set of random numbers (default 0)",
         &out->seed, .low = 0, .high = 4294967295.0},
        {"--max-bounces", OPTION_INTEGER, "N",
         "0 emission only, 1 adds direct light (default 64)", &out->max_bounces, .low = 0,
         .high = 100000},
        {"--ways", OPTION_INTEGER, "N", "that are listed by themselves, at most (default 10)",
         &out->ways, .low = 1, .high = 1000},
        {"--gltf", OPTION_TEXT, "FILE.gltf|.glb",
         "the ways as lines in the colours of their lights, to be opened beside the scene",
         &out->rays, .file = OPTION_OUTPUT},
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
    ChainArgs args = {&aim, &tools, words->spp, (int)words->ways, true, NULL, true};
    *out = (Probed){.pixel = {pixel.x, pixel.y}, .size = {words->size[0], words->size[1]},
                    .eye = aim.eye, .chains = chains_find(&args, arena),
                    .light = pixel_light_find(&args)};
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
    if (!render_check_pixel(&camera, words->size, words->pixel, err) ||
        !render_prepare(scene, &camera, &words->render, arena, &setup, err))
        return false;
    look(words, &setup, arena, &found);
    found.groups = light_groups_build(scene, setup.context.lights, arena, problems);
    render_setup_end(&setup);
    return check_light(&found, err) &&
           (!words->rays || probe_write_rays(&found, words->rays, arena, err)) &&
           probe_answer(&words->cli, &found, arena, err);
}

static Outcome run(int argc, char **argv, Arena *arena, Error *err)
{
    Problems   problems = problems_start(arena);
    Scene     *scene = NULL;
    ProbeWords words = {.spp = SPP, .ways = WAYS,
                        .max_bounces = BOUNCES};
    if (!parse(argc, argv, arena, &words, err)) return OUTCOME_FAILED;
    if (words.cli.help_shown) return OUTCOME_DONE;
    const SceneAsked asked = {&words.scene, &words.environment, words.cli.progress,
                              &words.cli.outputs};
    bool ok = scene_options_load(&asked, arena, &problems, &scene, err) &&
              probe(&words, scene, &problems, arena, err);
    scene_close(scene);
    return outcome_of(ok);
}

const Command command_probe = {
    "probe", "what one pixel sees, bounce by bounce, and its spectrum", run, NULL, 0};
