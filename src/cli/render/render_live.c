/* SPDX-License-Identifier: Apache-2.0 */
#include "cli/render/render_live.h"

#include <string.h>

#include "camera/camera.h"
#include "denoise/denoise.h"
#include "film/film_frame.h"
#include "image/develop.h"

#define PICTURE_SHARE 0.004
#define LAYERS_SHARE 0.002 /* without the last frame */
#define DENOISED_SHARE 0.02
#define PICTURE_CHANNELS 4 /* R, G, B, error.Y */
#define DENOISE_PIXEL_S 1e-5  /* of a processor, until it is measured here */
#define DENOISE_COLUMN_BYTES 160000 /* scratch, denoise.h */
#define FILE_SHARE 0.05
#define FILE_INTERVAL_S 10

bool render_live_open(RenderLive *live, const RenderRequest *request, Error *err)
{
    double now_s = monotonic_seconds();
    *live = (RenderLive){.request = request,
                         .has_file = request->live && !request->replays,
                         .picture_time = {.share = PICTURE_SHARE, .begun_s = now_s},
                         .layers_time = {.share = LAYERS_SHARE, .begun_s = now_s},
                         .denoised_time = {.share = DENOISED_SHARE, .begun_s = now_s},
                         .file_time = {.share = FILE_SHARE, .begun_s = now_s}};
    if (!request->tev || request->replays) return true;
    live->has_viewer = viewer_open(&request->viewer, request->output, &live->viewer, err);
    return live->has_viewer || error_prefix(err, "--tev %.80s: no viewer is there, the render "
                                            "goes on without one", request->tev);
}

void render_live_close(RenderLive *live)
{
    if (live->has_viewer) viewer_close(&live->viewer);
    live->has_viewer = false;
}

double render_live_seconds(const RenderLive *live)
{
    return live->picture_time.spent_s + live->layers_time.spent_s +
           live->denoised_time.spent_s + live->file_time.spent_s;
}

/* ---- the viewer -------------------------------------------------------------------------- */

static bool is_display(const Scene *scene, int part_id)
{
    return scene->materials[scene->parts[part_id].material_id].display_id != NO_ID;
}

/* A box each for screens that share a display. */
void render_live_find_displays(RenderLive *live, const Scene *scene, const Camera *camera,
                               Arena *arena)
{
    FilmBox box;
    live->boxes = ARENA_NEW(arena, TevBox, scene->part_count);
    for (int i = 0; i < scene->part_count; i++)
        if (is_display(scene, i) && camera_box_of_part(camera, scene, i, &box))
            live->boxes[live->box_count++] =
                (TevBox){box.x0, box.y0, box.x1 - box.x0, box.y1 - box.y0};
}

static bool check_viewer(RenderLive *live, Error *err)
{
    if (viewer_check(&live->viewer, err)) return true;
    render_live_close(live);
    return error_prefix(err, "--tev %.80s: the viewer is lost, the render goes on without it",
                        live->request->tev);
}

static size_t pixels_of(const RenderLive *live)
{
    FilmRect crop = live->request->render.crop;
    return (size_t)(crop.x1 - crop.x0) * (size_t)(crop.y1 - crop.y0);
}

/* A film that leaves no room for its frame is not worth the render. */
static bool has_room(RenderLive *live, const Film *film, const Arena *scratch)
{
    Viewer *viewer = &live->viewer;
    size_t  wanted = film_frame_bytes_most(film, *scratch), left = arena_left(scratch);
    size_t  planes = pixels_of(live) * 6 * sizeof(float);
    if (live->request->look.is_denoised)
        wanted += planes + (size_t)live->request->render.width * DENOISE_COLUMN_BYTES;
    if (wanted <= left) return true;
    error_set(&viewer->loss, ERROR_MEMORY,
              "a frame beside the film needs up to %zu MB, %zu MB are left", wanted >> 20,
              left >> 20);
    viewer_lose(viewer);
    return false;
}

/* ---- the denoised picture ---------------------------------------------------------------- */

/* The channels say themselves what they are not for. */
static void add_denoised(FrameImage *frame, float *out[3], Arena *arena)
{
    static const char *const names[] = {DENOISED_WORDS ".R", DENOISED_WORDS ".G",
                                        DENOISED_WORDS ".B"};
    for (int c = 0; c < 3; c++) out[c] = frame_add_channel(frame, names[c], false, arena);
}

/* *out: these channels alone. */
static bool denoise_film(const RenderLive *live, const Film *film, Arena *arena,
                         FrameImage *out, Error *err)
{
    FrameImage    frame = film_to_view(film, true, arena), filtered;
    DenoiseReport unused;
    const float  *rgb[3];
    float        *planes[3];
    if (!denoise_frame(&frame, live->request->cli.threads, arena, &filtered, &unused, err) ||
        !frame_rgb(&filtered, "", rgb))
        return false;
    *out = frame_create(frame.display.x1, frame.display.y1, frame.data, 3, 0, arena);
    add_denoised(out, planes, arena);
    for (int c = 0; c < 3; c++)
        memcpy(planes[c], rgb[c], frame_pixel_count(&frame) * sizeof(float));
    return true;
}

/* False: it is not taken yet, or the viewer is lost. */
static bool make_image(RenderLive *live, const Film *film, Arena scratch)
{
    Viewer *viewer = &live->viewer;
    if (viewer->has_image) return viewer_is_ready(viewer);
    FrameImage outline = film_view_outline(film, &scratch);
    live->channel_count = outline.channel_count;
    float *unused[3];
    if (live->request->look.is_denoised) add_denoised(&outline, unused, &scratch);
    viewer_make_image(viewer, &outline, live->boxes, live->box_count);
    viewer_push(viewer);
    return viewer_is_ready(viewer);
}

static void offer(RenderLive *live, const Film *film, const TimeShare *time, Arena scratch)
{
    Viewer    *viewer = &live->viewer;
    FrameImage frame;
    if (!has_room(live, film, &scratch) || !make_image(live, film, scratch)) return;
    if (time != &live->denoised_time) {
        frame = film_to_view(film, time == &live->layers_time, &scratch);
    } else if (!denoise_film(live, film, &scratch, &frame, &viewer->loss)) {
        viewer_lose(viewer);
        return;
    }
    viewer_offer(viewer, &frame);
}

static void send_last(RenderLive *live, const Film *film, Arena scratch)
{
    Viewer *viewer = &live->viewer;
    viewer_finish(viewer);
    if (viewer->handle < 0 || !has_room(live, film, &scratch)) return;
    if (!make_image(live, film, scratch)) viewer_finish(viewer);
    Arena      own = scratch;
    FrameImage frame = film_to_view(film, true, &own);
    viewer_send(viewer, &frame);
    if (viewer->handle < 0 || !live->request->look.is_denoised) return;
    if (denoise_film(live, film, &scratch, &frame, &viewer->loss)) viewer_send(viewer, &frame);
    else viewer_lose(viewer);
}

static void spend(TimeShare *time, double begun_s)
{
    time_share_spend(time, monotonic_seconds() - begun_s);
}

static bool may_denoise(RenderLive *live, double now_s)
{
    TimeShare *time = &live->denoised_time;
    if (!live->request->look.is_denoised || live->picture_time.spent_s <= 0) return false;
    if (time->spent_s <= 0)
        time->dearest_s = (double)pixels_of(live) * DENOISE_PIXEL_S /
                          live->request->cli.threads;
    return time_share_allows(time, now_s);
}

/* The update that there is time for; NULL: none. The picture comes first: its time predicts
 * that of all layers. */
static TimeShare *affordable(RenderLive *live, double now_s)
{
    TimeShare *picture = &live->picture_time, *layers = &live->layers_time;
    if (layers->spent_s <= 0)
        layers->dearest_s = picture->dearest_s * live->channel_count / PICTURE_CHANNELS;
    bool has_layers = live->channel_count > PICTURE_CHANNELS;
    if (has_layers && picture->spent_s > 0 && time_share_allows(layers, now_s)) return layers;
    if (may_denoise(live, now_s)) return &live->denoised_time;
    return time_share_allows(picture, now_s) ? picture : NULL;
}

bool render_live_show(RenderLive *live, const Film *film, Arena scratch, Error *err)
{
    double begun_s = monotonic_seconds();
    if (!live->has_viewer) return true;
    TimeShare *time = viewer_is_ready(&live->viewer) ? affordable(live, begun_s) : NULL;
    if (time) {
        live->shown_time = time;
        time_share_begin(time);
        offer(live, film, time, scratch);
        spend(time, begun_s);
    }
    return check_viewer(live, err);
}

void render_live_push(RenderLive *live)
{
    if (!live->has_viewer || viewer_is_ready(&live->viewer)) return;
    double begun_s = monotonic_seconds();
    viewer_push(&live->viewer);
    spend(live->shown_time, begun_s);
}

bool render_live_finish(RenderLive *live, const Film *film, Arena scratch, Error *err)
{
    double begun_s = monotonic_seconds();
    if (!live->has_viewer) return true;
    send_last(live, film, scratch);
    spend(&live->layers_time, begun_s);
    return check_viewer(live, err);
}

/* ---- the file ---------------------------------------------------------------------------- */

bool render_live_wants_file(const RenderLive *live)
{
    double now_s = monotonic_seconds();
    if (!live->has_file || !live->file_written_s) return live->has_file;
    return now_s - live->file_written_s >= FILE_INTERVAL_S &&
           time_share_allows(&live->file_time, now_s);
}

bool render_live_write(RenderLive *live, const FrameImage *frame, double begun_s, Error *err)
{
    live->has_file = frame_write(live->request->live, frame, err);
    time_share_begin(&live->file_time);
    spend(&live->file_time, begun_s);
    live->file_written_s = monotonic_seconds();
    return live->has_file ||
           error_prefix(err, "--live: the frame is not shown there any more");
}
