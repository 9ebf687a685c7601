/* SPDX-License-Identifier: Apache-2.0 */
#include "live/viewer.h"

#include <stdlib.h>

#include "base/progress.h"
#include "live/viewer_socket.h"

bool viewer_open(const ViewerAddress *address, const char *image, Viewer *out, Error *err)
{
    Viewer viewer = {.image = image, .patience_s = VIEWER_PATIENCE_S};
    if (!viewer_socket_open(address->host, address->port, &viewer.patience_s, &viewer.handle,
                            err))
        return false;
    *out = viewer;
    return true;
}

/* ---- lost -------------------------------------------------------------------------------- */

void viewer_close(Viewer *viewer)
{
    if (viewer->handle >= 0) viewer_socket_close(viewer->handle);
    viewer->handle = -1;
    free(viewer->queue);
    viewer->queue = NULL;
    viewer->size = viewer->sent = 0;
}

void viewer_lose(Viewer *viewer)
{
    viewer->is_lost = true;
    viewer_close(viewer);
}

bool viewer_check(Viewer *viewer, Error *err)
{
    if (!viewer->is_lost) return true;
    viewer->is_lost = false;
    *err = viewer->loss;
    return false;
}

/* ---- sending ----------------------------------------------------------------------------- */

bool viewer_is_ready(const Viewer *viewer)
{
    return viewer->handle >= 0 && viewer->sent == viewer->size;
}

static size_t encode(const Viewer *viewer, const FrameImage *frame, const TevBox *boxes,
                     int box_count, char *data)
{
    TevBytes bytes = {data, 0};
    if (!viewer->queue) tev_add_create(&bytes, viewer->image, frame);
    tev_add_update(&bytes, viewer->image, frame);
    if (!viewer->queue && box_count) tev_add_boxes(&bytes, viewer->image, boxes, box_count);
    return bytes.size;
}

/* The first frame's packets are the most. */
void viewer_offer(Viewer *viewer, const FrameImage *frame, const TevBox *boxes, int box_count)
{
    size_t size = encode(viewer, frame, boxes, box_count, NULL);
    char  *queue = viewer->queue ? viewer->queue : malloc(size);
    if (!queue) {
        error_set(&viewer->loss, ERROR_MEMORY, "there are no %zu MB of memory for its frames",
                  size >> 20);
        viewer_lose(viewer);
        return;
    }
    viewer->size = encode(viewer, frame, boxes, box_count, queue);
    viewer->queue = queue;
    viewer->sent = 0;
    viewer->moved_s = monotonic_seconds();
}

static bool has_waiting(const Viewer *viewer)
{
    return viewer->handle >= 0 && viewer->sent < viewer->size;
}

void viewer_push(Viewer *viewer)
{
    size_t taken;
    if (!has_waiting(viewer)) return;
    if (!viewer_socket_send(viewer->handle, viewer->queue + viewer->sent,
                            viewer->size - viewer->sent, &taken, &viewer->loss)) {
        viewer_lose(viewer);
        return;
    }
    viewer->sent += taken;
    if (taken) viewer->moved_s = monotonic_seconds();
    if (taken || monotonic_seconds() - viewer->moved_s <= VIEWER_PATIENCE_S) return;
    error_set(&viewer->loss, ERROR_OUTPUT, "it took nothing for %g s", VIEWER_PATIENCE_S);
    viewer_lose(viewer);
}

void viewer_finish(Viewer *viewer)
{
    viewer_push(viewer);
    while (has_waiting(viewer) && viewer->patience_s > 0) {
        viewer_socket_wait(viewer->handle, &viewer->patience_s);
        viewer_push(viewer);
    }
    if (!has_waiting(viewer)) return;
    error_set(&viewer->loss, ERROR_OUTPUT, "it did not take the last frame within %g s",
              VIEWER_PATIENCE_S);
    viewer_lose(viewer);
}
