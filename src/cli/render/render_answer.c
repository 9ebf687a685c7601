/* SPDX-License-Identifier: Apache-2.0 */
#include "cli/render/render_answer.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <time.h>

#include "base/machine.h"
#include "base/number.h"
#include "base/units.h"
#include "cli/options/answer.h"
#include "cli/options/environment_options.h"
#include "cli/options/missed_answer.h"
#include "cli/render/render_columns.h"
#include "cli/render/render_identity.h"
#include "denoise/denoise.h"
#include "film/film_frame.h"
#include "film/film_part.h"
#include "image/frame_view.h"
#include "missed/missed.h"
#include "render/favour.h"
#include "render/pilot.h"
#include "scene/load/material_data.h"
#include "text/json_text.h"

/* ---- the frame --------------------------------------------------------------------------- */

/* How far along the axis the scene's coordinates begin. */
static double origin_along(const Scene *scene, Vec3 axis) {
    const double *o = scene->origin;
    return o[0] * (double)axis.x + o[1] * (double)axis.y + o[2] * (double)axis.z;
}

/* For row vectors, as OpenEXR has it: p_camera = p_world * M. Zeros are all positive. */
static void set_world_to_camera(FrameImage *frame, const Scene *scene, const Transform *t,
                                Arena *arena) {
    const Vec3 axes[3] = {t->x, t->y, t->z};
    double matrix[16] = {[15] = 1};
    for (int i = 0; i < 3; i++) {
        matrix[i] = 0.0 + (double)axes[i].x;
        matrix[4 + i] = 0.0 + (double)axes[i].y;
        matrix[8 + i] = 0.0 + (double)axes[i].z;
        matrix[12 + i] = 0.0 - (double)vec3_dot(t->origin, axes[i]) - origin_along(scene, axes[i]);
    }
    frame_set_values(frame, "worldToCamera", EXR_MATRIX44, matrix, arena);
}

static void set_camera(FrameImage *frame, const Scene *scene, const SceneCamera *camera,
                       Arena *arena) {
    set_world_to_camera(frame, scene, &camera->world_from_camera, arena);
    frame_set_string(frame, "parhelion:camera",
                     camera->node_name[0] ? camera->node_name : camera->camera_name, arena);
    if (camera->fisheye) frame_set_fisheye(frame, camera->fisheye, arena);
    else if (camera->is_perspective)
        frame_set_number(frame, "parhelion:yfov_deg", degrees_from_radians((double)camera->yfov),
                         arena);
    else frame_set_number(frame, "parhelion:ymag_m", (double)camera->ymag, arena);
}

static void set_inputs(FrameImage *frame, const Scene *scene, Arena *arena) {
    const char *list = "";
    for (int i = 0; i < scene->input_count; i++)
        list = arena_format(arena, "%s%016llx  %s\n", list,
                            (unsigned long long)scene->input_hashes[i], scene->inputs[i]);
    frame_set_string(frame, "parhelion:inputs", list, arena);
}

/* Which names the numbers of id.part and id.display stand for. */
static void set_names(FrameImage *frame, const Scene *scene, unsigned layers, Arena *arena) {
    for (int i = 0; (layers & LAYER_ID) && i < scene->part_count; i++)
        frame_set_string(frame, arena_format(arena, "parhelion:part.%d", i), scene->parts[i].name,
                         arena);
    for (int i = 0; (layers & (LAYER_ID | LAYER_DISPLAYS)) && i < scene->display_count; i++)
        frame_set_string(frame, arena_format(arena, "parhelion:display.%d", i),
                         scene->displays[i].name, arena);
}

/* Records the approximations with the frame. */
static void set_eye(FrameImage *frame, const PolarisedEye *eye, Arena *arena) {
    frame_set_string(frame, "parhelion:polarised",
                     "by glass, covers, gloss and metals of n, k, displays that say so and the "
                     "clear sky; other metals as perfect mirrors, coated sheets and solids as "
                     "bare ones; haze and matt surfaces depolarise",
                     arena);
    if (!eye->has_glasses) return;
    frame_set_string(frame, "parhelion:sunglasses",
                     arena_format(arena, "axis right %.6g, up %.6g; across it %.6g",
                                  (double)eye->axis[0], (double)eye->axis[1], (double)eye->blocks),
                     arena);
}

/* And the names of layers for those of lights. */
static void set_lights(FrameImage *frame, const LightGroups *lights, Arena *arena) {
    for (int i = 0; lights && i < lights->count; i++)
        frame_set_string(frame, arena_format(arena, "parhelion:light.%s", lights->names[i]),
                         lights->said[i], arena);
}

static void set_sampling(FrameImage *frame, const RenderRequest *request,
                         const RenderResult *result, Arena *arena) {
    const RenderOptions *options = &request->render;
    const FrameOutcome outcome = {.first_sample = options->first_sample,
                                  .end_sample = options->first_sample + result->samples,
                                  .complete = result->complete,
                                  .relative_error = result->error.frame,
                                  .rare_error = result->rare_error,
                                  .dropped_samples = film_dropped(result->film).count};
    frame_set_outcome(frame, &outcome, arena);
    if (request->part.count)
        frame_set_string(frame, DEALT_PART_ATTRIBUTE,
                         arena_format(arena, "%u/%u", request->part.number, request->part.count),
                         arena);
    frame_set_string(frame, "parhelion:isa", result->kernel->isa, arena);
    frame_set_string(frame, "parhelion:seed", arena_format(arena, "%u", options->seed), arena);
    frame_set_whole(frame, "parhelion:maxBounces", options->max_bounces, arena);
    frame_set_whole(frame, "parhelion:unbiased", 1, arena);
    if (options->favoured)
        frame_set_string(frame, "parhelion:for",
                         arena_format(arena, "all samples for %s, of other pixels 1 in %u",
                                      frame_area_words(&request->favoured, arena), FAVOUR_OTHERS),
                         arena);
    if (options->favours_noise)
        frame_set_string(
            frame, "parhelion:for",
            arena_format(arena, "samples where %u of each pixel found noise", PILOT_SAMPLES),
            arena);
    if (options->eye) set_eye(frame, options->eye, arena);
    if (result->field_hash)
        frame_set_string(frame, "parhelion:field",
                         arena_format(arena, "%016llx", (unsigned long long)result->field_hash),
                         arena);
}

/* A part carries the film's sums, so that it can be merged with the others. */
static void attach_sums(FrameImage *frame, const RenderOptions *options, const RenderResult *result,
                        Arena *arena) {
    const PathStatistics *cost = &result->statistics;
    uint32_t first = options->first_sample;
    FilmPart part = film_part_of(result->film, first, first + result->samples);
    if (!result->complete) part.asked_end = options->end_sample;
    part.paths = cost->samples;
    part.camera_rays = cost->camera_rays;
    part.bounce_rays = cost->bounce_rays;
    part.shadow_rays = cost->shadow_rays;
    film_part_attach(frame, result->film, &part, arena);
}

/* NULL: nothing worth a word. */
static const char *missed_text(const RenderRequest *request, Arena *arena) {
    return request->missed ? missed_words(request->scene_lit, request->missed, arena) : NULL;
}

static unsigned look_layers(const RenderRequest *request) {
    unsigned layers = 0;
    Error never;
    if (request->look.is_denoised) render_layers_parse(DENOISE_LAYERS, &layers, &never);
    return layers;
}

FrameImage render_make_frame(const RenderRequest *request, const Scene *scene,
                             const SceneCamera *camera, const RenderResult *result, FrameUse use,
                             Arena *arena) {
    int room = 32 + scene->part_count + scene->display_count + FILM_LIGHTS_MAX;
    FrameImage frame = use == FRAME_FILE
                           ? film_to_rows(result->film, room, arena)
                           : film_to_picture(result->film, look_layers(request), room, arena);
    frame_set_string(&frame, "software", "parhelion " PARHELION_VERSION, arena);
    frame_set_string(&frame, "parhelion:commandLine", request->command_line, arena);
    frame_set_string(&frame, "parhelion:identity",
                     render_identity(request, scene, camera, result->kernel, arena), arena);
    frame_set_string(&frame, "parhelion:unit", "cd/m2", arena);
    set_inputs(&frame, scene, arena);
    const char *assumed = displays_assumed(scene, arena);
    if (assumed) frame_set_string(&frame, "parhelion:assumed", assumed, arena);
    const char *weather = weather_option_text(&scene->environment, arena);
    if (weather) frame_set_string(&frame, "parhelion:weather", weather, arena);
    const char *missed = missed_text(request, arena);
    if (missed) frame_set_string(&frame, "parhelion:mayMiss", missed, arena);
    set_sampling(&frame, request, result, arena);
    set_camera(&frame, scene, camera, arena);
    set_names(&frame, scene, request->render.layers, arena);
    set_lights(&frame, request->render.lights, arena);
    if (request->is_part) attach_sums(&frame, &request->render, result, arena);
    return frame;
}

#define WORDS_BYTES ((size_t)1 << 16)
#define WORST_PIXELS 5         /* in the answer */
#define WORST_LEAST_SAMPLES 32 /* a line of its own for the worst: from here on, */
#define WORST_RATIO 20         /* and when it is so many times the frame's mean */

/* ---- the answer -------------------------------------------------------------------------- */

static double ray_count(const PathStatistics *statistics) {
    return (double)statistics->camera_rays + (double)statistics->bounce_rays +
           (double)statistics->shadow_rays;
}

static double per_second(double count, double seconds) {
    return seconds > 0 ? count / seconds : 0;
}

static json_t *worst_pixels(const Film *film) {
    FilmWorst worst[WORST_PIXELS];
    json_t *list = json_array();
    int count = film_worst_pixels(film, WORST_PIXELS, worst);
    for (int i = 0; i < count; i++)
        json_array_append_new(list,
                              json_pack("{s:i, s:i, s:o, s:o}", "x", worst[i].x, "y", worst[i].y,
                                        "luminance_cd_m2", json_figure(worst[i].luminance),
                                        "relative_error", json_figure(worst[i].error)));
    return list;
}

/* The training before the first sample; null: none. */
static json_t *training_document(const RenderResult *result) {
    char hash[17];
    if (!result->field_hash) return json_null();
    snprintf(hash, sizeof hash, "%016llx", (unsigned long long)result->field_hash);
    return json_pack("{s:s, s:f, s:I}", "field", hash, "seconds", result->training_seconds, "paths",
                     (json_int_t)result->training_paths);
}

static double mean_samples(const RenderRequest *request, const RenderResult *result) {
    const RenderOptions *options = &request->render;
    const FilmRect crop = options->crop;
    double pixels = (double)(crop.x1 - crop.x0) * (crop.y1 - crop.y0);
    return (double)sample_shares_sum(&result->shares, crop, options->first_sample,
                                     options->first_sample + result->samples) /
           pixels;
}

/* What all samples were for; null: every pixel. */
static json_t *favour_document(const RenderRequest *request, const RenderResult *result) {
    const RenderOptions *options = &request->render;
    uint32_t first = options->first_sample, share = SAMPLE_SHARE_ALL / FAVOUR_OTHERS;
    uint32_t others =
        sample_shares_own(share, first + result->samples) - sample_shares_own(share, first);
    if (!options->favoured && !options->favours_noise) return json_null();
    return json_pack("{s:o, s:I, s:o, s:o, s:f}", "area", json_text(request->favoured.text),
                     "pixels", (json_int_t)sample_shares_whole(&result->shares), "others",
                     options->favoured ? json_real(1.0 / FAVOUR_OTHERS) : json_null(),
                     "samples_of_others", options->favoured ? json_integer(others) : json_null(),
                     "mean_samples", mean_samples(request, result));
}

/* What --noise required and what came of it; null: nothing was required. The answer's error is
 * of the frame's own samples, the pilot's of those that decided. */
static json_t *noise_document(const RenderRequest *request, const RenderResult *result) {
    const RenderOptions *options = &request->render;
    const NoiseStop *stop = &result->stop;
    bool is_rare = render_noise_is_rare(result);
    if (!(options->noise > 0)) return json_null();
    json_t *pilot = json_pack("{s:i, s:o, s:I, s:f}", "pixels", stop->pixels, "relative_error",
                              json_figure(stop->error), "paths", (json_int_t)stop->paths, "seconds",
                              stop->seconds);
    return json_pack("{s:o, s:f, s:b, s:o, s:b, s:o, s:o}", "area",
                     json_text(request->noise.of.text ? request->noise.of.text : "frame"),
                     "required", options->noise, "reached",
                     !is_rare && (stop->reached || result->noise <= options->noise),
                     "relative_error", json_figure(result->noise), "rare_light", is_rare,
                     "error_may_be", json_figure(result->noise_doubt), "pilot", pilot);
}

/* Light that may be missing; null: none that is worth a word. */
static json_t *missed_document(const RenderRequest *request) {
    const MissedLight *missed = request->missed;
    Arena scratch = arena_reserve(WORDS_BYTES);
    const char *words = missed_text(request, &scratch);
    json_t *out = words ? json_pack("{s:s, s:f, s:f, s:o}", "words", words, "cd_m2",
                                    missed->all.light, "share", missed->all.share, "lights",
                                    missed_pairs_json(request->scene_lit, missed))
                        : json_null();
    arena_release(&scratch);
    return out;
}

#define NOTES_MOST 3

/* What a reader of the frame must know. */
static json_t *notes(const RenderRequest *request, const RenderResult *result) {
    Arena scratch = arena_reserve(WORDS_BYTES);
    const char *list[NOTES_MOST];
    int count = 0;
    FilmWorst worst;
    if (request->camera.projection)
        list[count++] = result->statistics.samples
                            ? "a fisheye of 180 degrees: pixels outside its circle are black and "
                              "have no samples"
                            : "a fisheye of 180 degrees: all pixels rendered lie outside its "
                              "circle, they are black and have no samples";
    if (render_output_is_radiance(request))
        list[count++] = "W/m2/sr in Radiance's primaries: luminance is 179 (0.265 R + 0.670 G + "
                        "0.065 B); its codes are right within 0.4 %, layers are only in .exr";
    /* One pixel far beyond what chance makes of even noise: a caustic, or a lamp that is hardly
     * found. */
    if (result->samples >= WORST_LEAST_SAMPLES && film_worst_pixels(result->film, 1, &worst) &&
        worst.error > WORST_RATIO * result->error.frame)
        list[count++] = arena_format(&scratch,
                                     "pixel %d,%d is the noisiest: %.4g cd/m2 with a relative "
                                     "error of %.0f%%",
                                     worst.x, worst.y, worst.luminance, 100 * worst.error);
    json_t *out = json_texts(list, count);
    arena_release(&scratch);
    return out;
}

bool render_print_answer(const RenderRequest *request, const RenderResult *result, double live_s,
                         json_t *pictures, const Problems *problems, Error *err) {
    const PathStatistics *counts = &result->statistics;
    json_t *answer = json_pack(
        "{s:o, s:[i,i], s:I, s:f, s:f, s:I, s:f, s:f, s:I, s:I, s:o, s:o, s:b, s:o}", "output",
        json_text(request->output), "size", request->render.width, request->render.height,
        "samples", (json_int_t)result->samples, "seconds", result->seconds, "build_seconds",
        result->build_seconds, "rays", (json_int_t)ray_count(counts), "samples_per_s",
        per_second((double)counts->samples, result->seconds), "rays_per_s",
        per_second(ray_count(counts), result->seconds), "peak_memory_bytes",
        (json_int_t)machine_peak_bytes(), "nonfinite_samples",
        (json_int_t)film_dropped(result->film).count, "relative_error",
        json_figure(result->error.frame), "relative_error_displays",
        json_figure(result->error.displays), "complete", result->complete, "warnings",
        cli_json_problems(problems, SEVERITY_WARNING));
    json_object_set_new(answer, "build_peak_memory_bytes",
                        json_integer((json_int_t)result->build_peak_bytes));
    json_object_set_new(answer, "projection",
                        json_string(render_projection_name(&request->camera)));
    json_object_set_new(answer, "for", favour_document(request, result));
    json_object_set_new(answer, "noise", noise_document(request, result));
    json_object_set_new(answer, "rare_error", json_figure(result->rare_error));
    json_object_set_new(answer, "may_miss", missed_document(request));
    json_object_set_new(answer, "notes", notes(request, result));
    json_object_set_new(answer, "pictures", pictures);
    json_object_set_new(answer, "isa", json_string(result->kernel->isa));
    json_object_set_new(answer, "training", training_document(result));
    json_object_set_new(answer, "resumed_samples", json_integer(result->resumed_samples));
    json_object_set_new(answer, "worst_pixels", worst_pixels(result->film));
    if (request->about) json_object_update(answer, request->about);
    json_object_set_new(answer, "rays_by_class",
                        json_pack("{s:I, s:I, s:I}", "camera", (json_int_t)counts->camera_rays,
                                  "bounce", (json_int_t)counts->bounce_rays, "shadow",
                                  (json_int_t)counts->shadow_rays));
    json_object_set_new(answer, "live_seconds", json_real(live_s));
    return cli_print_answer(&render_answer_kind, answer, request->cli.json, err);
}

/* ---- replay ------------------------------------------------------------------------------ */

static double value_of(const FrameImage *frame, const char *channel) {
    const float *values = frame_channel(frame, channel);
    return values ? (double)values[0] : (double)NAN;
}

static json_t *triple(const FrameImage *frame, const char *a, const char *b, const char *c) {
    return json_pack("[o,o,o]", json_figure(value_of(frame, a)), json_figure(value_of(frame, b)),
                     json_figure(value_of(frame, c)));
}

bool render_print_replay(const RenderRequest *request, const Scene *scene,
                         const RenderResult *result, Arena *arena, Error *err) {
    const RenderOptions *options = &request->render;
    FrameImage frame = film_to_frame(result->film, 0, arena);
    int part = (int)value_of(&frame, "id.part"), display = (int)value_of(&frame, "id.display");
    bool has_part = part >= 0 && part < scene->part_count;
    bool has_display = display >= 0 && display < scene->display_count;
    json_t *answer = json_pack(
        "{s:i, s:i, s:I, s:b, s:o, s:o, s:o, s:o, s:o}", "x", options->crop.x0, "y",
        options->crop.y0, "sample", (json_int_t)options->first_sample, "finite",
        film_dropped(result->film).count == 0, "XYZ", triple(&frame, "xyz.X", "xyz.Y", "xyz.Z"),
        "RGB", triple(&frame, "R", "G", "B"), "depth_m", json_figure(value_of(&frame, "depth.Z")),
        "part", json_text_or_null(has_part ? scene->parts[part].name : NULL), "display",
        json_text_or_null(has_display ? scene->displays[display].name : NULL));
    return cli_print_answer(&render_replay_kind, answer, request->cli.json, err);
}

static void set_time(FrameImage *frame, Arena *arena) {
    const char *epoch = getenv("SOURCE_DATE_EPOCH");
    if (!epoch) return;
    uint64_t count;
    const char *end = number_read_count(epoch, &count);
    time_t seconds = end ? (time_t)count : 0;
    struct tm date;
    char text[32];
    if (!end || *end || !gmtime_r(&seconds, &date)) return;
    strftime(text, sizeof text, "%Y:%m:%d %H:%M:%S", &date);
    frame_set_string(frame, "capDate", text, arena);
    frame_set_values(frame, "utcOffset", EXR_FLOAT, (const double[]){0}, arena);
}

/* Of the film's samples so many are gone, and where the first can be seen again. */
static const char *dropped_words(const Film *film, const char *line, Arena *arena) {
    FilmDropped dropped = film_dropped(film);
    uint64_t all = dropped.count + film_kept_samples(film);
    const char *again = "";
    if (line)
        again = arena_format(arena, "; to see the first again: %s --replay %d,%d,%u", line,
                             dropped.first[0].x, dropped.first[0].y, dropped.first[0].sample_index);
    return arena_format(arena,
                        "%llu of %llu samples (%.3g %%) are not finite, or above %.2g cd/m2, "
                        "and are left out%s",
                        (unsigned long long)dropped.count, (unsigned long long)all,
                        100 * (double)dropped.count / (double)all, FILM_MOST_CD_M2, again);
}

const char *frame_dropped_warning(const Film *film, const char *line, Arena *arena) {
    return film_dropped(film).count ? dropped_words(film, line, arena) : NULL;
}

bool frame_check_dropped(const Film *film, const char *line, Arena scratch, Error *err) {
    return !film_dropped(film).count || film_kept_samples(film) ||
           error_set(err, ERROR_INPUT, "there is no frame: %s",
                     dropped_words(film, line, &scratch));
}

void frame_set_outcome(FrameImage *frame, const FrameOutcome *outcome, Arena *arena) {
    frame_set_string(frame, "parhelion:samples",
                     arena_format(arena, "%u:%u", outcome->first_sample, outcome->end_sample),
                     arena);
    frame_set_whole(frame, "parhelion:complete", outcome->complete, arena);
    frame_set_number(frame, "parhelion:relativeError", outcome->relative_error, arena);
    if (!isnan(outcome->rare_error))
        frame_set_number(frame, "parhelion:rareError", outcome->rare_error, arena);
    frame_set_number(frame, "parhelion:droppedSamples", (double)outcome->dropped_samples, arena);
    set_time(frame, arena);
}
