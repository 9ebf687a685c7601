/* SPDX-License-Identifier: Apache-2.0 */
#include "review/run/frames.h"


#include "base/parallel.h"
#include "base/units.h"
#include "film/film_frame.h"
#include "image/develop.h"
#include "keep/journal.h"
#include "render/identity.h"
#include "render/render.h"
#include "render/signals.h"
#include "render/train.h"
#include "review/light/setup_eyes.h"
#include "review/keep/frame_kept.h"
#include "review/keep/goes_on.h"
#include "review/pace/work.h"
#include "review/request/request_check.h"
#include "review/run/cases.h"
#include "scene/load/material_data.h"

#define YFOV_DEG 35 /* of an eye that is no camera */
#define WORDS 16    /* of a frame's metadata, at most */
#define FILES_BYTES ((size_t)1 << 36) /* address space: what is not touched costs nothing */

bool frame_camera(const FrameAsk *ask, SceneCamera *out, Arena scratch, Error *err)
{
    const Scene *scene = ask->setup->scene;
    int          id;
    Vec3         from;
    if (!setup_eye_middle(ask->setup, ask->eye, scratch, &from, err)) return false;
    if (ask->eye->kind == EYE_CAMERA) {
        if (!review_camera_find(scene, ask->eye, scratch, &id, err)) return false;
        *out = scene->cameras[id];
        out->world_from_camera.origin = from;
        return true;
    }
    *out = camera_look_at(from, ask->look_at,
                          (float)radians_from_degrees(YFOV_DEG));
    return true;
}

static WorkKind kind_of(const FrameAsk *ask)
{
    return ask->exposure ? WORK_PAIR : WORK_FRAME;
}

static RenderOptions options_of(const FrameAsk *ask)
{
    const ReviewRequest *request = ask->setup->request;
    int by = ask->exposure ? FRAMES_PAIR : 1;
    int width = request->frames.width / by, height = request->frames.height / by;
    FilmRect all = {0, 0, width > 1 ? width : 1, height > 1 ? height : 1};
    return (RenderOptions){
        .width = all.x1, .height = all.y1, .crop = all, .end_sample = FRAMES_SAMPLES,
        .noise = request->frames.noise, .max_bounces = SETUP_BOUNCES,
        .noise_area = {all, FILM_ALL_PIXELS},
        .layers = ask->exposure ? LAYER_VARIANCE
                                : render_layers(ask->setup->scene, LAYER_VARIANCE | LAYER_ID |
                                                                       LAYER_DISPLAYS),
        .threads = ask->setup->tools.threads, .stops_at_once = true,
        .within = &ask->work->progress,
        .within_weight = work_share(ask->work, kind_of(ask),
                                    work_of_frame(request, kind_of(ask)))};
}

/* The attributes of a rendered frame, as far as they are known here. */
static void set_words(FrameImage *frame, const FrameAsk *ask, const SceneCamera *camera,
                      const RenderResult *result, Arena *arena)
{
    frame_set_string(frame, "software", "parhelion " PARHELION_VERSION, arena);
    frame_set_string(frame, "parhelion:unit", "cd/m2", arena);
    const char *assumed = displays_assumed(ask->setup->scene, arena);
    if (assumed) frame_set_string(frame, "parhelion:assumed", assumed, arena);
    frame_set_string(frame, "parhelion:review", ask->setup->request->file, arena);
    frame_set_string(frame, "parhelion:condition", ask->setup->condition->name, arena);
    frame_set_string(frame, "parhelion:camera", ask->eye->name, arena);
    if (camera->is_perspective)
        frame_set_number(frame, "parhelion:yfov_deg",
                         degrees_from_radians((double)camera->yfov), arena);
    frame_set_string(frame, "parhelion:samples", arena_format(arena, "0:%u", result->samples),
                     arena);
    frame_set_number(frame, "parhelion:relativeError", result->error.frame, arena);
    frame_set_whole(frame, "parhelion:complete", result->complete, arena);
    frame_set_whole(frame, "parhelion:unbiased", 1, arena);
}

const char *frame_view(const char *frame, FrameView view, Arena *arena)
{
    static const char *const ENDS[] = {"", "-luminance", "-contrast"};
    int before_ending = (int)(path_ending(frame) - frame);
    return arena_format(arena, "%.*s%s.png", before_ending, frame, ENDS[view]);
}

bool frame_exposure(const char *exr, Arena *arena, const char **out, Error *err)
{
    FrameImage     frame;
    Picture        picture;
    DevelopReport  report;
    DevelopOptions look = {.own_config = true, .frame_name = exr};
    if (!frame_read(exr, arena, &frame, err) ||
        !develop_picture(&frame, &look, arena, &picture, &report, err))
        return false;
    *out = arena_format(arena, "%.9g", report.ev);
    return true;
}

/* All frames have one scale of contrast, so that they can be compared. */
static DevelopOptions look_of(FrameView view, const char *exposure, const char *exr)
{
    const DevelopOptions looks[] = {
        [FRAME_PICTURE] = {.own_config = true, .exposure = exposure, .frame_name = exr},
        [FRAME_LUMINANCE] = {.false_colour = true, .frame_name = exr},
        [FRAME_CONTRAST] = {.layer = "display.contrast", .frame_name = exr,
                            .range = {1, FRAMES_CONTRAST}}};
    return looks[view];
}

/* The frame's file and its views, written beside each other. */
typedef struct FrameFiles {
    const FrameImage *frame;
    const char       *exr, *exposure; /* FrameAsk's */
} FrameFiles;

static bool write_file(void *context, int item, Error *err)
{
    const FrameFiles *files = context;
    if (item == 0) return frame_write(files->exr, files->frame, err);
    FrameView      view = (FrameView)(item - 1);
    DevelopOptions look = look_of(view, files->exposure, files->exr);
    Arena          own = arena_reserve(FILES_BYTES);
    bool ok = develop_frame(files->frame, &look, frame_view(files->exr, view, &own), own, NULL,
                            err);
    arena_release(&own);
    return ok;
}

/* A pair has the picture alone. */
static int views_of(const FrameAsk *ask)
{
    return ask->exposure ? 1 : FRAME_VIEWS;
}

static const char *exr_of(const FrameAsk *ask, Arena *arena)
{
    return arena_format(arena, "%s/frames/%s.exr", ask->folder, ask->name);
}

static bool write_frame(const FrameAsk *ask, const SceneCamera *camera,
                        const RenderResult *result, Arena scratch, Error *err)
{
    const char *exr = exr_of(ask, &scratch);
    FrameImage  frame = film_to_frame(result->film, WORDS, &scratch);
    set_words(&frame, ask, camera, result, &scratch);
    FrameFiles files = {&frame, exr, ask->exposure};
    return parallel_try(ask->setup->tools.threads, 1 + views_of(ask), write_file, &files,
                        scratch, err);
}

/* ---- of all that decides it -------------------------------------------------------------- */

static const char *identity_of(const FrameAsk *ask, const SceneCamera *camera,
                               const RenderOptions *options, Arena *arena)
{
    const Scene *scene = ask->setup->scene;
    Text text = {.arena = arena};
    JournalKey base = ask->setup->tools.base; /* pictures of skies, too */
    text_add(&text, ask->setup->identity);
    identity_line(&text, "files", "%016llx%016llx", (unsigned long long)base.high,
                  (unsigned long long)base.low);
    identity_line(&text, "name", "%s", ask->name);
    identity_line(&text, "condition", "%s", ask->setup->condition->name);
    identity_line(&text, "review", "%s", ask->setup->request->file);
    identity_line(&text, "size", "%dx%d", options->width, options->height);
    identity_line(&text, "layers", "%u", options->layers);
    identity_line(&text, "samples", "%u", options->end_sample);
    if (ask->exposure) identity_line(&text, "exposure", "%s", ask->exposure);
    identity_number(&text, "noise", options->noise);
    identity_line(&text, "eye", "%s", ask->eye->name);
    for (int i = 0; i < scene->display_count; i++)
        identity_float(&text, arena_format(arena, "level %d", i), scene->displays[i].level);
    identity_add_environment(&text, scene);
    identity_add_camera(&text, camera);
    return text.data;
}

/* ---- making it --------------------------------------------------------------------------- */

static bool render(const FrameAsk *ask, FrameKept *kept, const SceneCamera *camera,
                   RenderOptions *options, RenderResult *result, Error *err)
{
    const Setup *setup = ask->setup;
    RenderSetup  render = {.kernel = setup->tools.kernel, .bvh = setup->bvh,
                          .context = setup->context};
    TrainOptions train = {setup->tools.kernel, options->threads, true};
    Arena       *arena = kept->arena;
    if (!frame_kept_begin(kept, options, err)) return false;
    render.camera = camera_from_scene(camera, options->width, options->height);
    render.context.cone = camera_cone(&render.camera);
    render.context.guide =
        train_guide(&setup->context, &render.camera, &train, arena, &render.training);
    if (!review_goes_on(setup->tools.journal, err) ||
        !render_prepared(&render, options, arena, result, err))
        return false;
    if (!result->stopped_by) return true;
    return signals_stopped(err);
}

bool frame_make(const FrameAsk *ask, Arena *arena, const char **out, Error *err)
{
    RenderOptions options = options_of(ask);
    SceneCamera   camera;
    RenderResult  result;
    const char   *name = arena_format(arena, "frames/%s.png", ask->name);
    const char   *exr = exr_of(ask, arena);
    Arena         scratch = *arena;
    if (!frame_camera(ask, &camera, scratch, err)) return false;
    FrameKept kept = {.journal = ask->setup->tools.journal, .unfinished = ask->unfinished,
                      .identity = identity_of(ask, &camera, &options, &scratch),
                      .arena = &scratch};
    kept.files[kept.file_count++] = exr;
    for (FrameView view = FRAME_PICTURE; (int)view < views_of(ask); view++)
        kept.files[kept.file_count++] = frame_view(exr, view, &scratch);
    if (!frame_kept_is_whole(&kept) &&
        (!render(ask, &kept, &camera, &options, &result, err) ||
         !write_frame(ask, &camera, &result, scratch, err) || !frame_kept_end(&kept, err)))
        return false;
    work_add(ask->work, kind_of(ask), work_of_frame(ask->setup->request, kind_of(ask)));
    *out = name;
    return true;
}
