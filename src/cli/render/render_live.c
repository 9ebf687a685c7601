/* SPDX-License-Identifier: Apache-2.0 */
#include "cli/render/render_live.h"

#include "camera/film_box.h"
#include "film/film_frame.h"

#define VIEWER_SHARE 0.005 /* without the first and the last frame */
#define FILE_SHARE 0.05
#define FILE_INTERVAL_S 10

bool render_live_open(RenderLive *live, const RenderRequest *request, Error *err)
{
    double now_s = monotonic_seconds();
    *live = (RenderLive){.request = request,
                         .has_file = request->live && !request->replays,
                         .viewer_time = {.share = VIEWER_SHARE, .begun_s = now_s},
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
    return live->viewer_time.spent_s + live->file_time.spent_s;
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
        if (is_display(scene, i) && film_box_of_part(camera, scene, i, &box))
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

/* A film that leaves no room for its frame is not worth the render. */
static bool check_memory(const Film *film, const Arena *scratch, Error *err)
{
    size_t wanted = film_frame_bytes_most(film), left = (size_t)(scratch->end - scratch->next);
    return wanted <= left ||
           error_set(err, ERROR_MEMORY, "a frame beside the film needs up to %zu MB, %zu MB "
                                        "are left", wanted >> 20, left >> 20);
}

static void offer(RenderLive *live, const Film *film, Arena scratch)
{
    Viewer *viewer = &live->viewer;
    if (!viewer_is_ready(viewer)) return;
    if (!check_memory(film, &scratch, &viewer->loss)) {
        viewer_lose(viewer);
        return;
    }
    FrameImage frame = film_to_frame(film, 0, &scratch);
    film_add_error(film, &frame, &scratch);
    viewer_offer(viewer, &frame, live->boxes, live->box_count);
}

static void spend(TimeShare *time, double begun_s)
{
    time_share_spend(time, monotonic_seconds() - begun_s);
}

bool render_live_show(RenderLive *live, const Film *film, Arena scratch, Error *err)
{
    double begun_s = monotonic_seconds();
    if (!live->has_viewer) return true;
    if (viewer_is_ready(&live->viewer) && time_share_allows(&live->viewer_time, begun_s)) {
        time_share_begin(&live->viewer_time);
        offer(live, film, scratch);
        spend(&live->viewer_time, begun_s);
    }
    return check_viewer(live, err);
}

void render_live_push(RenderLive *live)
{
    if (!live->has_viewer || viewer_is_ready(&live->viewer)) return;
    double begun_s = monotonic_seconds();
    viewer_push(&live->viewer);
    spend(&live->viewer_time, begun_s);
}

bool render_live_finish(RenderLive *live, const Film *film, Arena scratch, Error *err)
{
    double begun_s = monotonic_seconds();
    if (!live->has_viewer) return true;
    viewer_finish(&live->viewer);
    offer(live, film, scratch);
    viewer_finish(&live->viewer);
    spend(&live->viewer_time, begun_s);
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
