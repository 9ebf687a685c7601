#include "review/run/frames.h"

#include <string.h>

#include "base/units.h"
#include "film/film_frame.h"
#include "image/develop.h"
#include "render/render.h"
#include "render/train.h"
#include "review/run/cases.h"
#include "review/request/request_check.h"

#define YFOV_DEG 35 /* of an eye that is no camera */

const char *file_name_of(const char *text, Arena *arena)
{
    char *name = arena_string(arena, text, strlen(text));
    for (char *c = name; *c; c++) {
        bool is_plain = (*c >= 'a' && *c <= 'z') || (*c >= 'A' && *c <= 'Z') ||
                        (*c >= '0' && *c <= '9') || *c == '_';
        if (!is_plain) *c = '-';
    }
    return name;
}

static bool camera_of(const FrameAsk *ask, SceneCamera *out, Arena scratch, Error *err)
{
    const Scene *scene = ask->stage->scene;
    int          id, count;
    if (ask->eye->kind == EYE_CAMERA) {
        if (!review_camera_find(scene, ask->eye, scratch, &id, err)) return false;
        *out = scene->cameras[id];
        return true;
    }
    Vec3 *points = stage_eye_points(ask->stage, ask->eye, &count, &scratch, err);
    if (!points) return false;
    *out = camera_look_at(points[count / 2], ask->look_at,
                          (float)radians_from_degrees(YFOV_DEG));
    return true;
}

static RenderOptions options_of(const FrameAsk *ask)
{
    const ReviewFrames *frames = &ask->stage->request->frames;
    return (RenderOptions){
        .width = frames->width, .height = frames->height,
        .crop = {0, 0, frames->width, frames->height}, .end_sample = FRAMES_SAMPLES,
        .noise = frames->noise, .max_bounces = STAGE_BOUNCES,
        .noise_area = {{0, 0, frames->width, frames->height}, FILM_ALL_PIXELS},
        .layers = LAYER_VARIANCE | LAYER_ID | (LAYER_DISPLAYS & ~LAYER_DISPLAY_FINE),
        .threads = ask->stage->tools.threads, .progress = ask->progress};
}

static bool write_frame(const FrameAsk *ask, const Film *film, const char *png, Arena scratch,
                        Error *err)
{
    const char *exr = arena_format(&scratch, "%s/frames/%s.exr", ask->folder, ask->name);
    FrameImage  frame = film_to_frame(film, 0, &scratch);
    DevelopOptions look = {.own_config = true, .frame_name = exr};
    return frame_write(exr, &frame, err) &&
           develop_frame(&frame, &look, png, scratch, NULL, err);
}

bool frame_make(const FrameAsk *ask, Arena *arena, const char **out, Error *err)
{
    const Stage  *stage = ask->stage;
    RenderOptions options = options_of(ask);
    RenderSetup   setup = {.kernel = stage->tools.kernel, .bvh = stage->bvh,
                           .context = stage->context};
    TrainOptions  train = {stage->tools.kernel, options.threads};
    SceneCamera   camera;
    RenderResult  result;
    const char   *name = arena_format(arena, "frames/%s.png", ask->name);
    const char   *png = arena_format(arena, "%s/%s", ask->folder, name);
    Arena         scratch = *arena;
    if (!camera_of(ask, &camera, scratch, err)) return false;
    setup.camera = camera_from_scene(&camera, options.width, options.height);
    setup.context.guide =
        train_guide(&stage->context, &setup.camera, &train, &scratch, &setup.training);
    if (!render_prepared(&setup, &options, &scratch, &result, err)) return false;
    if (result.stopped_by)
        return error_set(err, (ErrorCode)(128 + result.stopped_by),
                         "stopped while a frame was made; all but frames is written");
    if (!write_frame(ask, result.film, png, scratch, err)) return false;
    *out = name;
    return true;
}
