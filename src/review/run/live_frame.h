/* SPDX-License-Identifier: Apache-2.0 */
/* live_frame.h -- a frame as a sum of two pictures: what displays emit to the eye, and the
 * rest; smaller, and as an eye spreads them.
 *
 * Units    cd m^-2, R, G, B of Rec.709 in planes.
 * Memory   from the arena.
 * Threads  live_frame_spread starts its own; the same bits for any count.
 * Fails    for a frame without the layers, and when memory is out.
 */
#pragma once
#include "image/frame.h"
#include "vision/human_eye.h"

typedef struct LivePlanes {
    int    width, height;
    float *rgb[3];
} LivePlanes;

typedef struct LiveFrame {
    LivePlanes scene, displays; /* add up to the frame's R, G, B */
} LiveFrame;

/* Wants display.emitted and display.coverage. */
bool live_frame_split(const FrameImage *frame, Arena *arena, LiveFrame *out, Error *err);

/* At most so large, as it is or smaller: each pixel is the mean over its area. */
LivePlanes live_frame_shrink(const LivePlanes *planes, int width, int height, Arena *arena);

/* Both pictures. A perspective view, yfov_deg high. */
bool live_frame_spread(LiveFrame *frame, double yfov_deg, HumanEye eye, int threads,
                       Arena *arena, Error *err);
