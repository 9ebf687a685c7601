/* SPDX-License-Identifier: Apache-2.0 */
/* viewer.h -- somebody who watches a frame while it is made, elsewhere or on this machine.
 *
 * A viewer must never cost a render more than moments: what it does not take at once waits, and
 * while it waits no newer frame is offered. Waiting happens when it is opened and at the end
 * alone, VIEWER_PATIENCE_S together; one that takes nothing for that long meanwhile is lost.
 *
 * Memory   what waits to be taken is on the heap, as much as the largest frame that was
 *          offered; viewer_close releases it.
 * Threads  one at a time.
 * Fails    once: viewer_check reports why the viewer is lost, and everything is idle from then.
 */
#pragma once
#include "base/error.h"
#include "live/tev_packets.h"

#define VIEWER_PORT "14158" /* tev's, where none is given */

typedef struct ViewerAddress {
    char host[256]; /* without brackets */
    char port[8];
} ViewerAddress;

/* HOST or HOST:PORT as a user types it: HOST is a name, an IPv4 address or an IPv6 address in
 * brackets; PORT is 1 to 65535. Fails with ERROR_USAGE, what is wrong in the text and what is
 * required; whether a name is one of a machine is not checked here. */
bool viewer_address_parse(const char *text, ViewerAddress *out, Error *err);

#define VIEWER_PATIENCE_S 3.0

typedef struct Viewer {
    const char *image;      /* what it calls the frame */
    int         handle;     /* -1: closed */
    double      patience_s; /* that is left for waiting */
    double      moved_s;    /* when it last took bytes, monotonic */
    bool        has_image;  /* it was made there */
    char       *queue;
    size_t      room;       /* of the queue */
    size_t      size;       /* that is in it */
    size_t      sent;       /* of that */
    Error       loss;       /* why it is lost, until that is reported */
    bool        is_lost;
} Viewer;

/* False: nobody is there; nothing to be closed. image must outlive it. */
bool viewer_open(const ViewerAddress *address, const char *image, Viewer *out, Error *err);

/* Whether all that it was offered is taken, so that it may be offered more. */
bool viewer_is_ready(const Viewer *viewer);

/* The image itself, with the channels of all frames to come, and boxes over it; to a viewer
 * that has none yet. */
void viewer_make_image(Viewer *viewer, const FrameImage *outline, const TevBox *boxes,
                       int box_count);

/* To one that has an image and is ready: all or some of its channels. */
void viewer_offer(Viewer *viewer, const FrameImage *frame);

/* The same, and waits until it is taken, with the patience that is left. */
void viewer_send(Viewer *viewer, const FrameImage *frame);

/* Sends as much as is taken at once: milliseconds at most. */
void viewer_push(Viewer *viewer);

/* Sends the rest, with the patience that is left. */
void viewer_finish(Viewer *viewer);

/* False with the reason, once, when it is lost. */
bool viewer_check(Viewer *viewer, Error *err);

/* Gives it up; viewer->loss holds the reason already. */
void viewer_lose(Viewer *viewer);

void viewer_close(Viewer *viewer);
