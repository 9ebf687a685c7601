/* SPDX-License-Identifier: Apache-2.0 */
#include "base/count.h"
#include "base/number.h"
#include "cli/render/render_request.h"

#include <math.h>
#include <string.h>

#include "cli/options/look_options.h"
#include "cli/options/outputs.h"
#include "cli/render/command_line.h"
#include "cli/render/path_options.h"
#include "cli/render/render_columns.h"
#include "text/nearest_word.h"

#define DEFAULT_SPP 256
#define DEFAULT_BOUNCES 64
#define DEFAULT_CHECKPOINT_S 60

/* Values as typed, before they are checked against each other. */
typedef struct RenderWords {
    const char *samples, *part, *noise, *favoured, *layers;
    int size[2], false_colour;
    long spp, max_bounces, seed;
    double crop[4], replay[3];
    SceneWords scene;
    PolarisedWords polarised;
    bool has_spp, has_size, has_crop, has_replay, has_interval, previews;
} RenderWords;

/* ---- layers ------------------------------------------------------------------------------ */

#define LAYER_NAME(NAME, bit, of, option, letters, reader, sums) {option, LAYER_##NAME},

static const struct {
    const char *name;
    unsigned bits;
} layer_names[] = {{"all", LAYER_ALL},
                   {"display", LAYER_DISPLAYS},
                   {"compare", LAYER_COMPARED},
                   FILM_LAYERS(LAYER_NAME){"display.phi", LAYER_DISPLAY_ANGLES},
                   {"display.coverage", LAYER_DISPLAY_FINE}};

#define LAYER_NAME_COUNT COUNT_OF(layer_names)

static bool add_layer(const char *name, unsigned *bits, Error *err) {
    const char *names[LAYER_NAME_COUNT];
    for (int i = 0; i < LAYER_NAME_COUNT; i++) {
        names[i] = layer_names[i].name;
        if (strcmp(name, names[i])) continue;
        *bits |= layer_names[i].bits;
        return true;
    }
    char advice[512];
    return error_set(
        err, ERROR_USAGE, "--layers: no layer is named '%s' — %s", name,
        nearest_word_advice(name, names, LAYER_NAME_COUNT, advice, (int)sizeof advice));
}

bool render_layers_parse(const char *list, unsigned *bits, Error *err) {
    while (list) {
        char name[64] = "";
        const char *comma = strchr(list, ',');
        size_t length = comma ? (size_t)(comma - list) : strlen(list);
        memcpy(name, list, length < sizeof name ? length : sizeof name - 1);
        if (!add_layer(name, bits, err)) return false;
        list = comma ? comma + 1 : NULL;
    }
    return true;
}

const char *render_layer_list(unsigned layers, Arena *arena) {
    const char *list = "";
    unsigned named = 0;
    for (int i = 0; i < LAYER_NAME_COUNT; i++) {
        unsigned bits = layer_names[i].bits;
        if ((bits & (bits - 1)) || !(bits & layers) || (bits & named)) continue;
        list = arena_format(arena, "%s%s%s", list, *list ? "," : "", layer_names[i].name);
        named |= bits;
    }
    return list;
}

/* ---- single values ----------------------------------------------------------------------- */

/* A:B, half-open. */
static bool parse_samples(const char *text, RenderOptions *options, Error *err) {
    uint64_t first, last;
    const char *at = number_read_count(text, &first);
    at = at && *at == ':' ? number_read_count(at + 1, &last) : NULL;
    if (!at || *at || first >= last || last > FILM_SAMPLES_MAX)
        return error_set(err, ERROR_USAGE,
                         "--samples %s: required: A:B, whole numbers with 0 <= A < B <= "
                         "%u",
                         text, FILM_SAMPLES_MAX);
    options->first_sample = (uint32_t)first;
    options->end_sample = (uint32_t)last;
    return true;
}

/* K/N: a range of the samples of --spp. */
static bool parse_part(const RenderWords *typed, RenderRequest *request, Error *err) {
    RenderOptions *options = &request->render;
    if (typed->samples)
        return error_set(err, ERROR_USAGE,
                         "--part and --samples exclude each other: --part "
                         "deals the samples of --spp");
    if (typed->noise)
        return error_set(err, ERROR_USAGE,
                         "--part does not go with --noise, by which one run "
                         "finds how many samples it takes — say how many "
                         "(--spp N)");
    return dealt_part_parse(typed->part, &request->part)
               ? dealt_part_samples(request->part, &options->first_sample, &options->end_sample,
                                    err)
               : error_set(err, ERROR_USAGE,
                           "--part %s: required: K/N, part K of N, whole "
                           "numbers with 1 <= K <= N <= %u",
                           typed->part, DEALT_PARTS_MAX);
}

static bool is_whole(double value) {
    return value == floor(value) && fabs(value) < 0x1p31;
}

static bool parse_crop(const double crop[4], RenderOptions *options, Error *err) {
    for (int i = 0; i < 4; i++)
        if (!is_whole(crop[i]))
            return error_set(err, ERROR_USAGE, "--crop: %g is no whole number of pixels", crop[i]);
    FilmRect rect = {(int)crop[0], (int)crop[1], (int)crop[2], (int)crop[3]};
    if (rect.x0 < 0 || rect.y0 < 0 || rect.x0 >= rect.x1 || rect.y0 >= rect.y1 ||
        rect.x1 > options->width || rect.y1 > options->height)
        return error_set(
            err, ERROR_USAGE,
            "--crop %d,%d,%d,%d: required: X0,Y0,X1,Y1 with X0 < X1 and Y0 < Y1 inside "
            "the frame of %dx%d pixels",
            rect.x0, rect.y0, rect.x1, rect.y1, options->width, options->height);
    options->crop = rect;
    return true;
}

/* X,Y,SAMPLE: becomes a crop of one pixel and a range of one sample. */
static bool parse_replay(const double replay[3], RenderOptions *options, Error *err) {
    if (!is_whole(replay[0]) || !is_whole(replay[1]) || !is_whole(replay[2]) || replay[0] < 0 ||
        replay[1] < 0 || replay[2] < 0 || replay[0] >= options->width ||
        replay[1] >= options->height)
        return error_set(err, ERROR_USAGE,
                         "--replay %g,%g,%g: required: X,Y,SAMPLE with the pixel inside the "
                         "frame of %dx%d pixels",
                         replay[0], replay[1], replay[2], options->width, options->height);
    int x = (int)replay[0], y = (int)replay[1];
    options->crop = (FilmRect){x, y, x + 1, y + 1};
    options->first_sample = (uint32_t)replay[2];
    options->end_sample = options->first_sample + 1;
    options->threads = 1;
    options->layers = LAYER_ALL;
    options->progress = PROGRESS_NONE;
    return true;
}

static bool ends_with(const char *text, const char *ending) {
    size_t length = strlen(text), tail = strlen(ending);
    return length > tail && !strcmp(text + length - tail, ending);
}

bool render_output_is_radiance(const RenderRequest *request) {
    return request->output && ends_with(request->output, ".hdr");
}

/* R, G, B of a whole frame, or of a crop that nobody merges. */
static bool check_radiance(const RenderWords *typed, const RenderRequest *request, Error *err) {
    const char *option = typed->layers    ? "--layers"
                         : typed->samples ? "--samples"
                         : typed->part    ? "--part"
                                          : NULL;
    if (!render_output_is_radiance(request) || !option) return true;
    return error_set(err, ERROR_USAGE,
                     "%s does not go with -o %s: a Radiance picture holds "
                     "R, G, B alone — required: -o FRAME.exr",
                     option, request->output);
}

/* A file of its own: the others are kept until the render has ended well. */
static bool check_live(const RenderRequest *request, Error *err) {
    const struct {
        const char *path, *what;
    } others[] = {{request->output, "the result"},
                  {request->png, "the picture"},
                  {request->checkpoint, "the checkpoint"},
                  {request->render.field, "what is learnt"}};
    if (!request->live) return true;
    for (int i = 0; i < COUNT_OF(others); i++)
        if (others[i].path && !strcmp(others[i].path, request->live))
            return error_set(err, ERROR_USAGE, "--live %s: %s is to stand there", request->live,
                             others[i].what);
    return ends_with(request->live, ".exr") ||
           error_set(err, ERROR_USAGE, "--live %s: required: a name that ends in .exr",
                     request->live);
}

/* ---- all of them ------------------------------------------------------------------------- */

static bool check_outputs(const RenderRequest *request, Error *err) {
    const DevelopOptions *look = &request->look;
    if (!request->png && (look->exposure || look->config || look->display || look->view ||
                          look->false_colour || look->adapt || look->is_denoised))
        return error_set(err, ERROR_USAGE, "a look is asked for, but no picture — add --png FILE");
    if (request->replays) return true;
    if (!request->output) return error_set(err, ERROR_USAGE, "no output — add -o FRAME.exr");
    if (!ends_with(request->output, ".exr") && !render_output_is_radiance(request))
        return error_set(err, ERROR_USAGE,
                         "-o %s: required: a name that ends in .exr, or in "
                         ".hdr for a Radiance picture",
                         request->output);
    return check_live(request, err);
}

/* An area of the frame, whatever is rendered of it; or wherever noise is. */
static bool read_favoured(const char *text, RenderRequest *request, Error *err) {
    RenderOptions *options = &request->render;
    request->favoured = frame_area_all((FilmRect){0, 0, options->width, options->height});
    request->favoured.option = "--for";
    request->favoured.instead = "noise, ";
    request->favoured.text = text;
    options->favours_noise = !strcmp(text, "noise");
    return options->favours_noise || frame_area_parse(text, "", &request->favoured, err);
}

enum { PREVIEW_SAMPLES = 4 };

/* A picture for looking at: few samples, denoised. */
static bool set_preview(const RenderWords *typed, RenderRequest *request, Error *err) {
    const char *other = typed->noise ? "--noise" : typed->samples ? "--samples" : NULL;
    if (other)
        return error_set(err, ERROR_USAGE,
                         "--preview and %s exclude each other: a preview is "
                         "a denoised picture of %d samples, or of --spp N",
                         other, PREVIEW_SAMPLES);
    request->previews = request->look.is_denoised = true;
    if (!typed->has_spp) request->render.end_sample = PREVIEW_SAMPLES;
    /* what is learnt is kept for other frames, too */
    if (!request->render.field) request->render.guided_samples = request->render.end_sample;
    return true;
}

static bool check_render(const RenderWords *typed, Arena *arena, RenderRequest *request,
                         Error *err) {
    RenderOptions *options = &request->render;
    options->width = typed->size[0];
    options->height = typed->size[1];
    options->crop = (FilmRect){0, 0, options->width, options->height};
    options->end_sample = (uint32_t)typed->spp;
    if (typed->previews && !set_preview(typed, request, err)) return false;
    options->max_bounces = (int)typed->max_bounces;
    options->seed = (uint32_t)typed->seed;
    if (options->field && options->no_guiding)
        return error_set(err, ERROR_USAGE,
                         "--field %s keeps what is learnt — leave out "
                         "--no-guiding",
                         options->field);
    options->threads = request->cli.threads;
    options->progress = request->cli.progress;
    if (typed->has_spp && typed->samples)
        return error_set(err, ERROR_USAGE,
                         "--spp and --samples exclude each other — --samples "
                         "0:N is --spp N");
    if (typed->samples && !parse_samples(typed->samples, options, err)) return false;
    if (typed->part && !parse_part(typed, request, err)) return false;
    if (typed->layers && !render_layers_parse(typed->layers, &options->layers, err)) return false;
    request->names_halves = typed->layers && strstr(typed->layers, "halves");
    if (request->look.is_denoised && !render_layers_parse(DENOISE_LAYERS, &options->layers, err))
        return false;
    if (typed->has_crop && !parse_crop(typed->crop, options, err)) return false;
    if (typed->noise && !noise_goal_parse(typed->noise, options->crop, arena, &request->noise, err))
        return false;
    if (typed->favoured && !read_favoured(typed->favoured, request, err)) return false;
    if (!polarised_options_read(&typed->polarised, (options->layers & LAYER_ALL) == LAYER_ALL,
                                &options->layers, arena, &options->eye, err))
        return false;
    if (typed->has_replay && !parse_replay(typed->replay, options, err)) return false;
    request->replays = typed->has_replay;
    request->is_part = typed->samples || typed->part || typed->has_crop;
    return true;
}

/* They are kept while rendering as soon as any of their options is there. */
static void set_checkpoint(const RenderWords *typed, Arena *arena, RenderRequest *request) {
    request->keeps_checkpoints =
        !request->replays && (request->checkpoint || typed->has_interval || request->resumes);
    if (request->checkpoint || !request->output) return;
    request->checkpoint = arena_format(arena, "%s.checkpoint", request->output);
    outputs_note(&request->cli.outputs, "-o", request->checkpoint);
}

/* --resume stands behind the command's name, so that it stands before any `--`. */
static const char *resume_line(int argc, char **argv, bool resumes, Arena *arena) {
    char option[] = "--resume";
    char **words = ARENA_NEW(arena, char *, argc + 1);
    if (resumes) return command_line_join(argc, argv, true, arena);
    words[0] = argv[0];
    words[1] = option;
    for (int i = 1; i < argc; i++) words[i + 1] = argv[i];
    return command_line_join(argc + 1, words, true, arena);
}

/* ---- rows of the option table that belong together --------------------------------------- */

#define OUTPUT_OPTIONS(request) \
    {"-o", \
     OPTION_TEXT, \
     "FRAME.exr|.hdr", \
     "the frame; .hdr: R, G, B as a Radiance picture with its view", \
     &(request)->output, \
     .file = OPTION_OUTPUT}, \
    { \
        "--png", OPTION_TEXT, "FILE", "develop the frame as well (PNG, JPEG, TIFF by ending)", \
            &(request)->png, .file = OPTION_OUTPUT \
    }

#define CHECKPOINT_OPTIONS(request, typed) \
    {"--checkpoint", \
     OPTION_TEXT, \
     "FILE", \
     "keep what is done, here (default FRAME.exr.checkpoint); INT, TERM and HUP always do; " \
     "gone with the finished frame", \
     &(request)->checkpoint, \
     .file = OPTION_KEPT}, \
        {"--checkpoint-interval", \
         OPTION_NUMBER, \
         "SECONDS", \
         "how often (default 60)", \
         &(request)->render.checkpoint_interval_s, \
         .low = 0, \
         .high = 1e6, \
         .given = &(typed)->has_interval}, \
    { \
        "--resume", OPTION_FLAG, NULL, \
            "go on from the checkpoint, to the same frame bit for bit; without one begin", \
            &(request)->resumes \
    }

static bool parse_line(int argc, char **argv, Arena *arena, RenderWords *typed,
                       RenderRequest *request, Error *err) {
    EnvironmentChange *outside = &request->environment;
    const Option options[] = {
        OUTPUT_OPTIONS(request),
        LOOK_OPTIONS(&request->look),
        {"--false-colour", OPTION_CHOICE, "luminance", "show luminance on a scale of colours",
         &typed->false_colour, .given = &request->look.false_colour},
        CAMERA_OPTIONS(&request->camera),
        {"--size", OPTION_SIZE, "WxH",
         "pixels of the whole frame (default 1280x720, of a fisheye 1024x1024)", typed->size,
         .given = &typed->has_size},
        {"--spp", OPTION_INTEGER, "N", "samples a pixel, at most (default 256)", &typed->spp,
         .low = 1, .high = FILM_SAMPLES_MAX, .given = &typed->has_spp},
        {"--preview", OPTION_FLAG, NULL, "for looking: --denoise, 4 samples", &typed->previews},
        {"--noise", OPTION_TEXT, "[AREA:]R",
         "as many samples as leave this relative error in the frame, or in an AREA: display, "
         "display:NAME or X0,Y0,X1,Y1; other samples, of some pixels, decide how many",
         &typed->noise},
        {"--for", OPTION_TEXT, "AREA",
         "all samples for this AREA, one of eight for what lies around it; noise: samples "
         "where a pilot finds it, a quarter on average",
         &typed->favoured},
        {"--max-bounces", OPTION_INTEGER, "N", "0 emission only, 1 adds direct light (default 64)",
         &typed->max_bounces, .low = 0, .high = 100000},
        {"--no-mirrors", OPTION_FLAG, NULL,
         "leave the sun's reflections on other surfaces to chance (slow; to compare)",
         &request->render.no_mirrors},
        POLARISED_OPTIONS(&typed->polarised),
        {"--seed", OPTION_INTEGER, "N", "another set of random numbers (default 0)", &typed->seed,
         .low = 0, .high = 4294967295.0},
        {"--no-guiding", OPTION_FLAG, NULL,
         "do not learn first where light comes from: the plain estimator, of more noise",
         &request->render.no_guiding},
        {"--field", OPTION_TEXT, "FILE",
         "what is learnt: taken from this file if it is there, else kept there",
         &request->render.field, .file = OPTION_KEPT},
        {"--crop", OPTION_NUMBERS, "X0,Y0,X1,Y1", "only these pixels, half-open, from top left",
         typed->crop, .count = 4, .given = &typed->has_crop},
        {"--samples", OPTION_TEXT, "A:B", "only these sample indices, half-open", &typed->samples},
        {"--part", OPTION_TEXT, "K/N", "part K of N of the samples, for `merge`", &typed->part},
        {"--layers", OPTION_TEXT, "LIST",
         "all, compare (what `compare` reads), or names with commas: xyz,depth,normal,... "
         "(halves: of 24 samples and more)",
         &typed->layers},
        SCENE_OPTIONS(&typed->scene, &request->scene, outside),
        {"--isa", OPTION_TEXT, "NAME", "sse2, avx2, avx512 (default: the processor's best)",
         &request->render.isa},
        CHECKPOINT_OPTIONS(request, typed),
        {"--live", OPTION_TEXT, "FILE.exr",
         "the frame so far, for any viewer: written anew about every ten seconds", &request->live,
         .file = OPTION_OUTPUT},
        {"--replay", OPTION_NUMBERS, "X,Y,SAMPLE", "one sample of one pixel, printed",
         typed->replay, .count = 3, .given = &typed->has_replay},
    };
    const CliCommand command = {
        "render",
        RENDER_SUMMARY,
        "SCENE.gltf|.glb [LIGHTS.gltf|.glb ...] -o FRAME.exr",
        "parhelion render scenes/car_dashboard.gltf scenes/noon.gltf -o noon.exr "
        "--png noon.png --spp 64",
        options,
        COUNT_OF(options),
        1,
        -1,
        .answers =
            (const Answer[]){{"", &render_answer_kind}, {"--replay", &render_replay_kind}, {0}}};
    return cli_parse(&command, argc, argv, arena, &request->cli, err);
}

bool render_request_parse(int argc, char **argv, Arena *arena, RenderRequest *out, Error *err) {
    RenderRequest request = {.command_line = command_line_join(argc, argv, false, arena),
                             .render.checkpoint_interval_s = DEFAULT_CHECKPOINT_S};
    RenderWords typed = {.spp = DEFAULT_SPP, .max_bounces = DEFAULT_BOUNCES};
    if (!parse_line(argc, argv, arena, &typed, &request, err)) return false;
    if (!request.cli.help_shown &&
        (!render_check_size(&request.camera, typed.has_size, typed.size, err) ||
         !check_render(&typed, arena, &request, err) || !check_outputs(&request, err) ||
         !check_radiance(&typed, &request, err) ||
         !scene_options_read(&typed.scene, &request.cli, arena, &request.scene, err)))
        return false;
    set_checkpoint(&typed, arena, &request);
    request.resume_line = resume_line(argc, argv, request.resumes, arena);
    *out = request;
    return true;
}
