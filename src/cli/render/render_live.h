/* SPDX-License-Identifier: Apache-2.0 */
/* render_live.h -- how a render is watched: --tev shows the frame so far to a viewer, --live
 * keeps it in a file. Neither changes the frame, and a render never ends because of them.
 *
 * Time     between passes and tiles; how often, follows from what it took so far. A viewer
 *          gets R, G, B and error.Y first and for 4 thousandths of the time, and every layer
 *          for 2, as soon as these are enough; with --denoise the filtered picture as a layer
 *          more, for 2 hundredths; besides them the last frame, which has all and cannot be put
 *          off. The file is written at most every ten seconds and gets a
 *          twentieth.
 *          viewer.h states how long a viewer may hold up the ends of a render.
 * Memory   scratch; and the viewer's queue until render_live_close.
 * Threads  the one that called render_prepared.
 * Fails    once each: with why the viewer is lost or the file is not written; from then on
 *          there is none.
 */
#pragma once
#include "camera/camera.h"
#include "cli/render/render_request.h"
#include "live/time_share.h"
#include "live/viewer.h"

typedef struct RenderLive {
    const RenderRequest *request;
    bool      has_viewer, has_file;
    Viewer    viewer;
    TevBox   *boxes;          /* of the displays in view */
    int       box_count;
    int       channel_count;  /* of the viewer's image; 0: not known yet */
    TimeShare picture_time, layers_time, denoised_time, file_time;
    TimeShare *shown_time;    /* of what the viewer is being sent */
    double    file_written_s; /* when the file was last written; 0: never */
} RenderLive;

/* Looks for the viewer; false when it is not there: the rest can be used all the same. */
bool render_live_open(RenderLive *live, const RenderRequest *request, Error *err);

/* Where the displays are on the film. */
void render_live_find_displays(RenderLive *live, const Scene *scene, const Camera *camera,
                               Arena *arena);

/* After a pass: the viewer is shown the film if it has taken what it was shown before. */
bool render_live_show(RenderLive *live, const Film *film, Arena scratch, Error *err);

/* Between tiles: sends on. */
void render_live_push(RenderLive *live);

/* After the last pass: the viewer is shown the film, and has some time to take it. */
bool render_live_finish(RenderLive *live, const Film *film, Arena scratch, Error *err);

/* Whether the file should be written now. */
bool render_live_wants_file(const RenderLive *live);

/* The frame so far becomes the file. begun_s: when its making began, monotonic. */
bool render_live_write(RenderLive *live, const FrameImage *frame, double begun_s, Error *err);

/* Seconds that all of it took. */
double render_live_seconds(const RenderLive *live);

void render_live_close(RenderLive *live);
