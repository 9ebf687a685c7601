/* SPDX-License-Identifier: Apache-2.0 */
/* tev_packets.h -- a frame in the packets that the viewer tev takes over TCP, and others who
 * speak like it.
 *
 * Source   tev's Ipc.h, Ipc.cpp and VectorGraphics.h (github.com/Tom94/tev). Little endian:
 *     uint32 length of the packet, itself included; uint8 type; the body. Texts end with a
 *     zero byte, a truth is one byte, lists are one item after the other.
 *     4 create   bool focus, text image, int32 width, height, channels, their names
 *     6 update   bool focus, text image, int32 channels, their names, int32 x, y, width,
 *                height, int64 offset and then int64 stride of each channel, in floats, and the
 *                floats
 *     8 draw     bool focus, text image, bool append, int32 commands: each a byte and floats.
 *                Only commands that every tev with this packet knows: 4 colour of strokes
 *                (r, g, b, a), 6 begin, 18 rectangle (x, y, width, height), 5 stroke
 * Units    pixels from the upper left corner of the whole frame.
 * Memory   the caller's: with `data` NULL the bytes are only counted.
 * Threads  no shared state.  Fails  never.
 */
#pragma once
#include "image/frame.h"

typedef struct TevBytes {
    char  *data; /* room for them all, or NULL */
    size_t size;
} TevBytes;

typedef struct TevBox {
    float x, y, width, height;
} TevBox;

/* An image of the frame's display window and channels, in their order; it comes to the front.
 */
void tev_add_create(TevBytes *out, const char *image, const FrameImage *frame);

/* Rows [first, end) of the frame's data window, in updates of tev_rows whole rows at most; each
 * channel is a plane. */
void tev_add_update(TevBytes *out, const char *image, const FrameImage *frame, int first,
                    int end);

/* How many rows have less than 1 MiB of pixels; 1 where one row has more. */
int tev_rows(const FrameImage *frame);

/* Rectangles over the image, instead of those before. */
void tev_add_boxes(TevBytes *out, const char *image, const TevBox *boxes, int count);
