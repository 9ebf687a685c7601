/* SPDX-License-Identifier: Apache-2.0 */
#include "live/tev_packets.h"

#include <stdint.h>
#include <string.h>

_Static_assert(__BYTE_ORDER__ == __ORDER_LITTLE_ENDIAN__, "numbers are sent as they lie");

#define PACKET_MOST ((size_t)1 << 20) /* bytes of pixels: what tev's buffer holds at first */

enum { CREATE_IMAGE = 4, UPDATE_IMAGE = 6, VECTOR_GRAPHICS = 8 };
enum { STROKE_COLOR = 4, STROKE = 5, BEGIN_PATH = 6, RECTANGLE = 18 };

/* ---- numbers and texts ------------------------------------------------------------------- */

static void put(TevBytes *out, const void *bytes, size_t size)
{
    if (out->data) memcpy(out->data + out->size, bytes, size);
    out->size += size;
}

static void put_byte(TevBytes *out, uint8_t value)
{
    put(out, &value, 1);
}

static void put_int(TevBytes *out, int32_t value)
{
    put(out, &value, sizeof value);
}

static void put_long(TevBytes *out, int64_t value)
{
    put(out, &value, sizeof value);
}

static void put_text(TevBytes *out, const char *text)
{
    put(out, text, strlen(text) + 1);
}

static void put_names(TevBytes *out, const FrameImage *frame)
{
    put_int(out, frame->channel_count);
    for (int i = 0; i < frame->channel_count; i++) put_text(out, frame->channels[i].name);
}

/* Returns where the packet begins, for end_packet. */
static size_t begin_packet(TevBytes *out, uint8_t type, bool takes_focus, const char *image)
{
    size_t begin = out->size;
    put_int(out, 0);
    put_byte(out, type);
    put_byte(out, takes_focus);
    put_text(out, image);
    return begin;
}

static void end_packet(TevBytes *out, size_t begin)
{
    uint32_t length = (uint32_t)(out->size - begin);
    if (out->data) memcpy(out->data + begin, &length, sizeof length);
}

/* ---- packets ----------------------------------------------------------------------------- */

void tev_add_create(TevBytes *out, const char *image, const FrameImage *frame)
{
    size_t begin = begin_packet(out, CREATE_IMAGE, true, image);
    put_int(out, frame->display.x1 - frame->display.x0);
    put_int(out, frame->display.y1 - frame->display.y0);
    put_names(out, frame);
    end_packet(out, begin);
}

/* first, count: rows of the data window. */
static void add_rows(TevBytes *out, const char *image, const FrameImage *frame, int first,
                     int count)
{
    const ExrWindow *data = &frame->data;
    size_t width = (size_t)(data->x1 - data->x0), pixels = width * (size_t)count;
    size_t begin = begin_packet(out, UPDATE_IMAGE, false, image);
    put_names(out, frame);
    put_int(out, data->x0 - frame->display.x0);
    put_int(out, data->y0 - frame->display.y0 + first);
    put_int(out, (int32_t)width);
    put_int(out, count);
    for (int i = 0; i < frame->channel_count; i++) put_long(out, (int64_t)pixels * i);
    for (int i = 0; i < frame->channel_count; i++) put_long(out, 1);
    for (int i = 0; i < frame->channel_count; i++)
        put(out, frame->channels[i].values + width * (size_t)first, pixels * sizeof(float));
    end_packet(out, begin);
}

int tev_rows(const FrameImage *frame)
{
    size_t row_bytes = (size_t)(frame->data.x1 - frame->data.x0) *
                       (size_t)frame->channel_count * sizeof(float);
    return row_bytes < PACKET_MOST ? (int)(PACKET_MOST / row_bytes) : 1;
}

void tev_add_update(TevBytes *out, const char *image, const FrameImage *frame, int first,
                    int end)
{
    int most = tev_rows(frame);
    for (int row = first; row < end; row += most)
        add_rows(out, image, frame, row, end - row < most ? end - row : most);
}

void tev_add_boxes(TevBytes *out, const char *image, const TevBox *boxes, int count)
{
    static const float color[4] = {0.1f, 0.9f, 1.0f, 1.0f};
    size_t begin = begin_packet(out, VECTOR_GRAPHICS, false, image);
    put_byte(out, false);
    put_int(out, 3 + count);
    put_byte(out, STROKE_COLOR);
    put(out, color, sizeof color);
    put_byte(out, BEGIN_PATH);
    for (int i = 0; i < count; i++) {
        put_byte(out, RECTANGLE);
        put(out, &boxes[i], sizeof boxes[i]);
    }
    put_byte(out, STROKE);
    end_packet(out, begin);
}
