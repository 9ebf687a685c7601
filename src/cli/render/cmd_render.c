/* SPDX-License-Identifier: Apache-2.0 */
/* parhelion render: load, render, write, develop, answer. */
#include "cli/render/cmd_render.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

#include "base/file_write.h"
#include "base/machine.h"
#include "cli/options/answer.h"
#include "cli/options/look_options.h"
#include "cli/render/noise_goal.h"
#include "cli/render/render_answer.h"
#include "cli/render/render_identity.h"
#include "cli/render/render_live.h"
#include "cli/render/render_request.h"
#include "cli/render/render_resume.h"
#include "cli/render/render_setup.h"
#include "denoise/denoise.h"
#include "film/film_frame.h"
#include "film/film_quarter.h"
#include "image/light/radiance_picture.h"
#include "missed/missed.h"
#include "print/print.h"
#include "render/signals.h"
#include "scene/load/scene_load.h"

/* Everything of one run of the command. */
typedef struct RenderRun {
    RenderRequest request;
    Arena *arena;
    Problems problems;
    Scene *scene;
    SceneCamera camera;
    RenderSetup setup;
    LightGroups lights;
    const char *identity;
    RenderLive live;
    MissedEye eye; /* the camera, which may miss light */
    MissedLight missed;
} RenderRun;

/* ---- before ------------------------------------------------------------------------------ */

/* Of the film, and of the frame that it becomes. */
static double bytes_of(const RenderOptions *options, unsigned layers) {
    int lights = options->lights ? options->lights->count : 0;
    return (double)film_bytes(options->crop, layers, lights) +
           (double)film_frame_bytes(options->crop, layers, lights);
}

/* Frames that our own reader would refuse, and films that the memory does not hold. */
static bool check_memory(const RenderOptions *options, unsigned layers, const Arena *arena,
                         Error *err) {
    FilmRect crop = options->crop;
    double pixels = (double)options->width * (double)options->height;
    double wanted = bytes_of(options, layers);
    double memory = (double)arena_left(arena);
    if (pixels > EXR_MAX_PIXELS)
        return error_set(err, ERROR_USAGE, "--size %dx%d: %.0f pixels, at most %d are supported",
                         options->width, options->height, pixels, EXR_MAX_PIXELS);
    if (wanted < memory) return true;
    return error_set(
        err, ERROR_MEMORY,
        "the film of %dx%d pixels needs %.1f GB with its frame, there are %.1f GB — use "
        "--crop or fewer --layers",
        crop.x1 - crop.x0, crop.y1 - crop.y0, wanted / 1e9, memory / 1e9);
}

/* The groups of lights, once the scene is known: each is a layer. */
static bool find_lights(RenderRun *work, Error *err) {
    RenderOptions *options = &work->request.render;
    int reported = work->problems.count;
    if (!(options->layers & LAYER_LIGHT) || work->request.replays) return true;
    work->lights =
        light_groups_build(work->scene, work->setup.context.lights, work->arena, &work->problems);
    for (; reported < work->problems.count; reported++)
        print_to(stderr, "parhelion: warning: %s\n", work->problems.list[reported].message);
    if (work->lights.count > FILM_LIGHTS_MAX)
        return error_set(err, ERROR_USAGE,
                         "--layers light: the lights of the scene have %d names, at most %d "
                         "can be told apart — leave out `light`, or give lamps that belong "
                         "together one name",
                         work->lights.count, FILM_LIGHTS_MAX);
    options->lights = &work->lights;
    return check_memory(options, options->layers, work->arena, err);
}

/* Hours of rendering must not end at a folder that cannot be written. */
static bool check_outputs(const RenderRequest *request, Error *err) {
    if (request->output && !file_check_writable(request->output, err)) return false;
    if (!render_check_checkpoint(request, err)) return false;
    if (request->live && !request->replays && !file_check_writable(request->live, err))
        return false;
    return !request->png || file_check_writable(request->png, err);
}

/* A view that does not exist is found now, on a frame of one pixel, a format whose library
 * cannot be loaded here, and a denoiser without weights. */
static bool check_look(const RenderRequest *request, Arena scratch, Error *err) {
    if (request->look.is_denoised && !denoise_check(err)) return false;
    if (!request->png) return true;
    FrameImage frame = frame_create(1, 1, (ExrWindow){0, 0, 1, 1}, 3, 0, &scratch);
    Picture picture;
    FileBytes file;
    DevelopReport report;
    for (const char *name = "RGB"; *name; name++)
        frame_add_channel(&frame, arena_format(&scratch, "%c", *name), false, &scratch)[0] = 1;
    return picture_check_name(request->png, 8, err) &&
           develop_picture(&frame, &request->look, &scratch, &picture, &report, err) &&
           picture_encode(request->png, &picture, (PictureFile){.bits = 8}, &scratch, &file, err);
}

/* One sample that is replayed has none of them. */
static void set_areas(RenderRequest *request) {
    RenderOptions *options = &request->render;
    bool favours = request->favoured.option && !request->replays;
    options->noise = request->replays ? 0 : request->noise.error;
    options->noise_area = request->noise.of.area;
    options->favours_noise = options->favours_noise && favours;
    options->favoured = favours && !options->favours_noise ? &request->favoured.area : NULL;
}

/* A part of a frame is merged with others. */
static void warn_of_halves(const RenderRequest *request, Problems *problems) {
    const RenderOptions *options = &request->render;
    uint32_t count = options->end_sample - options->first_sample;
    uint32_t least = film_halves_samples(options->first_sample);
    if (request->names_halves && !request->is_part && count < least)
        problems_add(problems, SEVERITY_WARNING, "--layers", "",
                     "halves are known from %u samples a pixel on, %u are rendered: they will "
                     "be NaN",
                     least, count);
}

static bool load(RenderRun *work, Error *err) {
    RenderRequest *request = &work->request;
    work->problems = problems_start(work->arena);
    const SceneAsked asked = {&request->scene, &request->environment, request->render.progress,
                              &request->cli.outputs};
    bool loaded =
        scene_options_load(&asked, work->arena, &work->problems, &work->scene, err) &&
        render_choose_camera(work->scene, &request->camera, &work->problems, &work->camera, err) &&
        frame_area_find(work->scene, *work->arena, &request->noise.of, err) &&
        frame_area_find(work->scene, *work->arena, &request->favoured, err);
    if (loaded) set_areas(request);
    if (loaded) request->render.layers = render_layers(work->scene, request->render.layers);
    if (loaded && !request->replays)
        loaded = check_memory(&request->render, request->render.layers, work->arena, err);
    if (loaded) render_warn_of_darkness(work->scene, &work->problems);
    if (loaded) warn_of_halves(request, &work->problems);
    cli_print_warnings(&work->problems);
    return loaded;
}

static bool identify(RenderRun *work, Error *err) {
    RenderOptions *options = &work->request.render;
    work->request.field_hash = work->setup.field_hash;
    work->identity = render_identity(&work->request, work->scene, &work->camera, work->setup.kernel,
                                     work->arena);
    return render_find_checkpoint(&work->request, work->identity, work->arena, &options->resume,
                                  err);
}

/* ---- after ------------------------------------------------------------------------------- */

static bool write_frame(const RenderRun *work, const RenderResult *result, Error *err) {
    Arena scratch = *work->arena;
    if (work->request.only_png) return true;
    bool is_radiance = render_output_is_radiance(&work->request);
    FrameImage frame = render_make_frame(&work->request, work->scene, &work->camera, result,
                                         is_radiance ? FRAME_PICTURE : FRAME_FILE, &scratch);
    if (!is_radiance) return frame_write(work->request.output, &frame, err);
    return radiance_picture_write(work->request.output, &frame, work->request.command_line, scratch,
                                  err);
}

static void write_snapshot(void *user, const RenderResult *so_far) {
    const RenderRun *work = user;
    Error err;
    if (write_frame(work, so_far, &err))
        print_to(stderr, "parhelion: %s: snapshot after %u samples a pixel\n", work->request.output,
                 so_far->samples);
    else cli_report_error(&err, false);
}

/* On stderr at once, and among the answer's warnings. */
static void warn(RenderRun *work, const char *text) {
    print_to(stderr, "parhelion: warning: %s\n", text);
    problems_add(&work->problems, SEVERITY_WARNING, "", "", "%s", text);
}

/* A warning of an error that the render survives. */
static void warn_of(RenderRun *work, const Error *err) {
    char line[2048];
    error_line(err, line, (int)sizeof line);
    warn(work, arena_string(work->arena, line, strlen(line)));
}

/* Half of the memory: others need some, and so do the scene and what writes the file. */
static void warn_of_memory(RenderRun *work) {
    const RenderOptions *options = &work->request.render;
    double wanted = bytes_of(options, options->layers), memory = (double)machine_memory_bytes();
    if (wanted <= memory / 2 || work->request.replays) return;
    warn(work,
         arena_format(work->arena,
                      "--layers: the film and the frame take up to %.1f of the %.1f GB here%s",
                      wanted / 1e9, memory / 1e9,
                      options->layers & ~(unsigned)LAYER_COMPARED
                          ? " — --layers compare takes less, or --crop"
                          : ""));
}

static void warn_of_dropped(RenderRun *work, const RenderResult *result) {
    const char *line = work->request.command_line;
    const char *text = frame_dropped_warning(result->film, line, work->arena);
    if (text && !work->request.replays) warn(work, text);
}

/* Of a part that was dealt the others may have what it lacks. */
static bool check_dropped(const RenderRun *work, const RenderResult *result, Error *err) {
    const RenderRequest *request = &work->request;
    if (request->replays || request->part.count ||
        frame_check_dropped(result->film, request->command_line, *work->arena, err))
        return true;
    render_remove_checkpoint(request);
    return false;
}

/* What paths will miss of the light, before the first of them. */
static void find_missed(RenderRun *work) {
    if (work->request.replays) return;
    work->eye = (MissedEye){.name = "", .camera = &work->setup.camera, .display_id = NO_ID};
    work->missed = missed_light_find(&work->setup.context, &work->eye, 1, work->arena);
    work->request.missed = &work->missed;
    work->request.scene_lit = work->scene;
    const char *line;
    for (int i = 0; (line = missed_line(work->scene, &work->missed, i, work->arena)); i++)
        warn(work, line);
}

static void warn_of_noise(RenderRun *work, const RenderResult *result) {
    const RenderOptions *options = &work->request.render;
    const char *area = frame_area_words(&work->request.noise.of, work->arena);
    if (!(options->noise > 0) || !result->complete) return;
    if (isnan(result->noise))
        warn(work, arena_format(work->arena,
                                "nothing of %s is in view: --noise had nothing to go by", area));
    else if (!result->stop.reached && result->noise > options->noise)
        warn(work, arena_format(work->arena,
                                "the relative error of %s is %.3g, not the %.3g of --noise, "
                                "after all %u samples a pixel",
                                area, result->noise, options->noise, result->samples));
    if (render_noise_is_rare(result))
        warn(work, arena_format(work->arena,
                                "rare light: the relative error of %s is not yet known: %.3g "
                                "is measured, but where single samples bring most of the light "
                                "it may be %.3g — a smaller --noise takes more samples",
                                area, result->noise, result->noise_doubt));
}

/* A crop may well lie beside the area. */
static void warn_of_favour(RenderRun *work, const RenderResult *result) {
    const RenderOptions *options = &work->request.render;
    const FilmRect all = {0, 0, options->width, options->height};
    if (!options->favoured || memcmp(&all, &options->crop, sizeof all) != 0 ||
        sample_shares_whole(&result->shares))
        return;
    warn(work, arena_format(work->arena,
                            "nothing of %s is in view: --for left an eighth of the samples to "
                            "all pixels",
                            frame_area_words(&work->request.favoured, work->arena)));
}

/* False after a warning: the render is worth more than its checkpoint. */
static bool keep_checkpoint(RenderRun *work, const RenderResult *so_far) {
    Error err;
    char line[2048];
    if (!work->request.checkpoint) return false;
    if (render_keep_checkpoint(&work->request, work->identity, so_far, *work->arena, &err))
        return true;
    error_line(&err, line, (int)sizeof line);
    warn(work, arena_format(work->arena, "no checkpoint after %u samples a pixel: %s",
                            so_far->samples, line));
    return false;
}

static void keep_checkpoint_meanwhile(void *user, const RenderResult *so_far) {
    keep_checkpoint(user, so_far);
}

/* ---- who watches ------------------------------------------------------------------------- */

/* It has no sums, also of a part: they would be out of date before anybody merges them. */
static bool write_live_file(RenderRun *work, const RenderResult *so_far, Error *err) {
    Arena scratch = *work->arena;
    double begun_s = monotonic_seconds();
    RenderRequest request = work->request;
    RenderResult result = *so_far;
    request.is_part = false;
    result.error = film_relative_error(so_far->film);
    FrameImage frame =
        render_make_frame(&request, work->scene, &work->camera, &result, FRAME_FILE, &scratch);
    return render_live_write(&work->live, &frame, begun_s, err);
}

static void show_pass(void *user, const RenderResult *so_far, const Progress *shown) {
    RenderRun *work = user;
    Error err;
    if (!render_live_is_due(&work->live) || write_live_file(work, so_far, &err)) return;
    progress_clear(shown);
    warn_of(work, &err);
}

/* The file is a copy of the frame in the end, but for a part's sums. */
static void show_end(RenderRun *work, const RenderResult *result) {
    Error err;
    if (work->live.path && !write_live_file(work, result, &err)) warn_of(work, &err);
}

/* The partial frame is written and the answer given: only the line is left. */
static Outcome report_interruption(const RenderRun *work, const RenderResult *result,
                                   bool is_kept) {
    const RenderOptions *options = &work->request.render;
    print_to(stderr,
             "parhelion: %s: stopped by %s after %u of %u samples a pixel; the frame is marked "
             "incomplete — %s%s\n",
             work->request.output, signals_name(result->stopped_by), result->samples,
             options->end_sample - options->first_sample,
             is_kept ? "go on with: " : "run the same command again for the whole",
             is_kept ? work->request.resume_line : "");
    return OUTCOME_STOPPED;
}

static bool develop(const RenderRun *work, const RenderResult *result, Arena *scratch,
                    LookReport *look, Error *err) {
    FrameImage frame = render_make_frame(&work->request, work->scene, &work->camera, result,
                                         FRAME_PICTURE, scratch);
    const LookRequest request = {&frame, &work->request.look, work->request.png,
                                 work->request.cli.threads};
    return look_options_develop(&request, *scratch, look, err);
}

static bool add_picture(const RenderRun *work, const RenderResult *result, json_t *pictures,
                        Error *err) {
    Arena scratch = *work->arena;
    LookReport look;
    if (!work->request.png) return true;
    if (!develop(work, result, &scratch, &look, err)) return false;
    json_array_append_new(pictures, look_options_json(work->request.png, &look));
    return true;
}

#define LOOK_PIXELS (1 << 17) /* a smaller picture is soon there itself */

static bool has_first_look(const RenderRequest *request) {
    const FilmRect crop = request->render.crop;
    return request->previews && request->png && !request->replays &&
           (int64_t)(crop.x1 - crop.x0) * (crop.y1 - crop.y0) >= LOOK_PIXELS;
}

static void show_first_look(void *user, const RenderResult *so_far, const Progress *shown) {
    RenderRun *work = user;
    Arena scratch = *work->arena;
    RenderResult quarter = *so_far;
    LookReport look;
    Error err;
    quarter.film = film_quarter(so_far->film, work->request.cli.threads, &scratch);
    bool done = develop(work, &quarter, &scratch, &look, &err);
    progress_clear(shown);
    if (!done) warn_of(work, &err);
    else if (shown->mode == PROGRESS_BAR || shown->mode == PROGRESS_PLAIN)
        print_to(stderr,
                 "parhelion: %s: a first look, of a quarter of the pixels; the picture will take "
                 "its place\n",
                 work->request.png);
}

/* The checkpoint comes first: who stopped the render may not wait for long. */
static Outcome hand_over(RenderRun *work, const RenderResult *result, Error *err) {
    if (!check_dropped(work, result, err)) return OUTCOME_FAILED;
    warn_of_dropped(work, result);
    warn_of_noise(work, result);
    warn_of_favour(work, result);
    if (work->request.replays)
        return outcome_of(
            render_print_replay(&work->request, work->scene, result, work->arena, err));
    bool is_kept = !result->complete && keep_checkpoint(work, result);
    if (!write_frame(work, result, err)) return OUTCOME_FAILED;
    if (result->complete) render_remove_checkpoint(&work->request);
    show_end(work, result);
    json_t *pictures = json_array();
    if (!add_picture(work, result, pictures, err)) {
        json_decref(pictures);
        return OUTCOME_FAILED;
    }
    if (!render_print_answer(&work->request, result, work->live.spent_s, pictures, &work->problems,
                             err))
        return OUTCOME_FAILED;
    return result->complete ? OUTCOME_DONE : report_interruption(work, result, is_kept);
}

/* A pixel that is replayed has samples; a Radiance picture can say the view. */
static bool check_view(const RenderRun *work, Error *err) {
    const RenderOptions *options = &work->request.render;
    const double at[2] = {options->crop.x0, options->crop.y0};
    const int size[2] = {options->width, options->height};
    if (work->request.replays) return render_check_pixel(&work->camera, size, at, err);
    if (!render_output_is_radiance(&work->request) || work->camera.fisheye != FISHEYE_EQUISOLID)
        return true;
    return error_set(err, ERROR_USAGE,
                     "-o %s: a Radiance picture cannot say an equisolid view "
                     "— add --projection equidistant, or -o FRAME.exr",
                     work->request.output);
}

static Outcome run(RenderRun *work, Error *err) {
    RenderOptions *options = &work->request.render;
    RenderResult result;
    bool keeps_frame = !work->request.replays && !work->request.only_png;
    options->snapshot = keeps_frame ? write_snapshot : NULL;
    options->checkpoint = work->request.keeps_checkpoints ? keep_checkpoint_meanwhile : NULL;
    options->user = work;
    /* whether the scene has a second display is not known yet */
    if (!check_memory(options, options->layers & ~(unsigned)LAYER_DISPLAY_SECOND, work->arena,
                      err) ||
        !check_outputs(&work->request, err) || !check_look(&work->request, *work->arena, err) ||
        !load(work, err))
        return OUTCOME_FAILED;
    if (!check_view(work, err)) return OUTCOME_FAILED;
    work->live = render_live_begin(&work->request);
    if (work->live.path) options->pass_ended = show_pass;
    if (has_first_look(&work->request)) options->first_look = show_first_look;
    if (!render_prepare(work->scene, &work->camera, options, work->arena, &work->setup, err))
        return OUTCOME_FAILED;
    bool done = find_lights(work, err) && identify(work, err);
    if (done) warn_of_memory(work);
    if (done) find_missed(work);
    done = done && render_prepared(&work->setup, options, work->arena, &result, err);
    render_setup_end(&work->setup);
    return done ? hand_over(work, &result, err) : OUTCOME_FAILED;
}

Outcome cmd_render_request(const RenderRequest *request, Arena *arena, Error *err) {
    RenderRun work = {.request = *request, .arena = arena};
    Outcome outcome = run(&work, err);
    scene_close(work.scene);
    return outcome;
}

static Outcome run_render(int argc, char **argv, Arena *arena, Error *err) {
    RenderRequest request;
    if (!render_request_parse(argc, argv, arena, &request, err)) return OUTCOME_FAILED;
    return request.cli.help_shown ? OUTCOME_DONE : cmd_render_request(&request, arena, err);
}

const Command command_render = {"render", RENDER_SUMMARY, run_render};
