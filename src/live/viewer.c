/* SPDX-License-Identifier: Apache-2.0 */
#include "live/viewer.h"

#include <stdlib.h>
#include <string.h>

#include "base/progress.h"
#include "live/viewer_socket.h"

/* ---- addresses --------------------------------------------------------------------------- */

#define HOST_LONGEST 253 /* of a name, RFC 1035 */
#define NAME_BYTES "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789.-_"

/* A text inside another. */
typedef struct AddressWord {
    const char *begin;
    size_t      length;
} AddressWord;

static bool parse_port(const char *text, ViewerAddress *out, Error *err)
{
    size_t length = strlen(text);
    long   port = length <= 5 && strspn(text, "0123456789") == length ? atol(text) : 0;
    if (port < 1 || port > 65535)
        return error_set(err, ERROR_USAGE, "'%.64s' is no port, required: 1 to 65535",
                         text);
    memcpy(out->port, text, length + 1);
    return true;
}

static bool set_host(AddressWord word, ViewerAddress *out, Error *err)
{
    if (word.length < 1 || word.length > HOST_LONGEST)
        return error_set(err, ERROR_USAGE, "the host has %zu letters, required: 1 to %d",
                         word.length, HOST_LONGEST);
    memcpy(out->host, word.begin, word.length);
    out->host[word.length] = '\0';
    return true;
}

static bool check_host(const char *host, bool is_bracketed, Error *err)
{
    if (is_bracketed)
        return viewer_socket_is_ipv6(host) ||
               error_set(err, ERROR_USAGE, "'%.64s' is no IPv6 address, which brackets hold",
                         host);
    if (host[strspn(host, NAME_BYTES)])
        return error_set(err, ERROR_USAGE, "'%.64s' is no host's name: letters, digits, '-' "
                                           "and '.' are required", host);
    if (!host[strspn(host, "0123456789.")] && !viewer_socket_is_ipv4(host))
        return error_set(err, ERROR_USAGE, "'%.64s' is no IPv4 address", host);
    return true;
}

static bool split(const char *text, ViewerAddress *out, Error *err)
{
    bool        is_bracketed = text[0] == '[';
    const char *end = is_bracketed ? strchr(text, ']') : text + strcspn(text, ":");
    if (!end) return error_set(err, ERROR_USAGE, "the bracket is never closed");
    const char *port = end + is_bracketed;
    if (!is_bracketed && *port && strchr(port + 1, ':'))
        return error_set(err, ERROR_USAGE, "an IPv6 address stands in brackets: [::1]:%s",
                         VIEWER_PORT);
    if (*port && *port != ':')
        return error_set(err, ERROR_USAGE, "'%.64s' follows the bracket, required: "
                                           ":PORT", port);
    const AddressWord host = {text + is_bracketed, (size_t)(end - text) - is_bracketed};
    return set_host(host, out, err) && check_host(out->host, is_bracketed, err) &&
           parse_port(*port ? port + 1 : VIEWER_PORT, out, err);
}

bool viewer_address_parse(const char *text, ViewerAddress *out, Error *err)
{
    ViewerAddress address;
    if (!split(text, &address, err)) return false;
    *out = address;
    return true;
}

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
    viewer->room = viewer->size = viewer->sent = 0;
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

/* Room for so many bytes in a queue from which all is taken. */
static bool make_room(Viewer *viewer, size_t size)
{
    if (size <= viewer->room) return true;
    free(viewer->queue);
    viewer->queue = malloc(size);
    viewer->room = viewer->queue ? size : 0;
    if (viewer->queue) return true;
    error_set(&viewer->loss, ERROR_MEMORY, "there are no %zu MB of memory for its frames",
              size >> 20);
    viewer_lose(viewer);
    return false;
}

static void begin_sending(Viewer *viewer, size_t size)
{
    viewer->size = size;
    viewer->sent = 0;
    viewer->moved_s = monotonic_seconds();
}

static size_t encode_image(const Viewer *viewer, const FrameImage *outline,
                           const TevBox *boxes, int box_count, char *data)
{
    TevBytes bytes = {data, 0};
    tev_add_create(&bytes, viewer->image, outline);
    if (box_count) tev_add_boxes(&bytes, viewer->image, boxes, box_count);
    return bytes.size;
}

void viewer_make_image(Viewer *viewer, const FrameImage *outline, const TevBox *boxes,
                       int box_count)
{
    if (!make_room(viewer, encode_image(viewer, outline, boxes, box_count, NULL))) return;
    begin_sending(viewer, encode_image(viewer, outline, boxes, box_count, viewer->queue));
    viewer->has_image = true;
}

static size_t encode_rows(const Viewer *viewer, const FrameImage *frame, int first, int end,
                          char *data)
{
    TevBytes bytes = {data, 0};
    tev_add_update(&bytes, viewer->image, frame, first, end);
    return bytes.size;
}

static void offer_rows(Viewer *viewer, const FrameImage *frame, int first, int end)
{
    if (!make_room(viewer, encode_rows(viewer, frame, first, end, NULL))) return;
    begin_sending(viewer, encode_rows(viewer, frame, first, end, viewer->queue));
}

void viewer_offer(Viewer *viewer, const FrameImage *frame)
{
    offer_rows(viewer, frame, 0, frame->data.y1 - frame->data.y0);
}

/* Packet by packet: a queue of the whole frame would be memory to fill and to empty. */
void viewer_send(Viewer *viewer, const FrameImage *frame)
{
    int rows = frame->data.y1 - frame->data.y0, most = tev_rows(frame);
    for (int row = 0; row < rows && viewer->handle >= 0; row += most) {
        offer_rows(viewer, frame, row, rows - row < most ? rows : row + most);
        viewer_finish(viewer);
    }
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
