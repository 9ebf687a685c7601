/* SPDX-License-Identifier: Apache-2.0 */
#include "image/frame.h"

#include <assert.h>
#include <stddef.h>
#include <stdio.h>
#include <string.h>

#include "base/file.h"
#include "base/file_write.h"
#include "image/colour.h"

#define MAX_FILE_BYTES ((size_t)4 << 30)

static const double ONE = 1;

FrameImage frame_create(int width, int height, ExrWindow data, int channel_room,
                        int attribute_room, Arena *arena)
{
    FrameImage frame = {.display = {0, 0, width, height}, .data = data,
                        .channel_room = channel_room, .attribute_room = attribute_room + 2};
    frame.channels = ARENA_NEW(arena, ExrChannel, frame.channel_room);
    frame.attributes = ARENA_NEW(arena, ExrAttribute, frame.attribute_room);
    frame_set_values(&frame, "chromaticities", EXR_CHROMATICITIES,
                     REC709_CHROMATICITIES, arena);
    frame_set_values(&frame, "whiteLuminance", EXR_FLOAT, &ONE, arena);
    return frame;
}

float *frame_add_channel(FrameImage *frame, const char *name, bool is_whole, Arena *arena)
{
    assert(!frame_channel(frame, name));
    if (frame->channel_count == frame->channel_room) {
        frame->channel_room = 2 * frame->channel_room + 4;
        frame->channels = ARENA_GROW(arena, ExrChannel, frame->channels, frame->channel_count,
                                     frame->channel_room);
    }
    float *values = ARENA_NEW(arena, float, frame_pixel_count(frame));
    frame->channels[frame->channel_count++] =
        (ExrChannel){arena_string(arena, name, strlen(name)), is_whole, values};
    return values;
}

/* The attribute of that name, a new one if there is none. */
static ExrAttribute *attribute_slot(FrameImage *frame, const char *name, Arena *arena)
{
    for (int i = 0; i < frame->attribute_count; i++)
        if (!strcmp(frame->attributes[i].name, name)) return &frame->attributes[i];
    if (frame->attribute_count == frame->attribute_room) {
        frame->attribute_room = 2 * frame->attribute_room + 4;
        frame->attributes = ARENA_GROW(arena, ExrAttribute, frame->attributes,
                                       frame->attribute_count, frame->attribute_room);
    }
    ExrAttribute *slot = &frame->attributes[frame->attribute_count++];
    slot->name = arena_string(arena, name, strlen(name));
    return slot;
}

void frame_set_string(FrameImage *frame, const char *name, const char *text, Arena *arena)
{
    ExrAttribute *slot = attribute_slot(frame, name, arena);
    slot->kind = EXR_STRING;
    slot->text = arena_string(arena, text, strlen(text));
}

void frame_set_number(FrameImage *frame, const char *name, double value, Arena *arena)
{
    frame_set_values(frame, name, EXR_DOUBLE, &value, arena);
}

void frame_set_whole(FrameImage *frame, const char *name, int value, Arena *arena)
{
    double number = value;
    frame_set_values(frame, name, EXR_INT, &number, arena);
}

void frame_set_values(FrameImage *frame, const char *name, ExrKind kind, const double *values,
                      Arena *arena)
{
    size_t        count = kind == EXR_CHROMATICITIES ? 8 : kind == EXR_MATRIX44 ? 16 : 1;
    ExrAttribute *slot = attribute_slot(frame, name, arena);
    slot->kind = kind;
    slot->text = "";
    memcpy(slot->values, values, count * sizeof *values);
}

const float *frame_channel(const FrameImage *frame, const char *name)
{
    for (int i = 0; i < frame->channel_count; i++)
        if (!strcmp(frame->channels[i].name, name)) return frame->channels[i].values;
    return NULL;
}

const ExrAttribute *frame_attribute(const FrameImage *frame, const char *name)
{
    for (int i = 0; i < frame->attribute_count; i++)
        if (!strcmp(frame->attributes[i].name, name)) return &frame->attributes[i];
    return NULL;
}

const char *frame_string(const FrameImage *frame, const char *name)
{
    const ExrAttribute *attribute = frame_attribute(frame, name);
    return attribute && attribute->kind == EXR_STRING ? attribute->text : NULL;
}

bool frame_rgb(const FrameImage *frame, const char *layer, const float *rgb[3])
{
    const float *found[3];
    for (int c = 0; c < 3; c++) {
        char name[256];
        snprintf(name, sizeof name, "%s%s%c", layer, layer[0] ? "." : "", "RGB"[c]);
        found[c] = frame_channel(frame, name);
        if (!found[c]) return false;
    }
    memcpy(rgb, found, sizeof found);
    return true;
}

int frame_id_of(const FrameImage *frame, const char *what, const char *name)
{
    char prefix[64];
    snprintf(prefix, sizeof prefix, "parhelion:%s.", what);
    for (int i = 0; i < frame->attribute_count; i++) {
        const ExrAttribute *a = &frame->attributes[i];
        size_t length = strlen(prefix);
        int    id;
        if (a->kind == EXR_STRING && !strncmp(a->name, prefix, length) &&
            !strcmp(a->text, name) && sscanf(a->name + length, "%d", &id) == 1)
            return id;
    }
    return -1;
}

const char *frame_display_names(const FrameImage *frame, Arena *arena)
{
    const char *names = "";
    for (int i = 0; i < frame->attribute_count; i++) {
        const ExrAttribute *a = &frame->attributes[i];
        if (a->kind == EXR_STRING && !strncmp(a->name, "parhelion:display.", 18))
            names = arena_format(arena, "%s%s%s", names, names[0] ? ", " : "", a->text);
    }
    return names[0] ? names : "none";
}

bool frame_write(const char *path, const FrameImage *frame, Error *err)
{
    ExrBytes *encoded;
    size_t    size;
    if (!exr_encode(frame, &encoded, err)) return error_in_file(err, path);
    const void *bytes = exr_bytes(encoded, &size);
    bool        ok = file_write(path, bytes, size, err);
    exr_bytes_destroy(encoded);
    return ok;
}

/* ---- reading ------------------------------------------------------------------------- */

static const char *copy_text(const char *text, Arena *arena)
{
    return arena_string(arena, text, strlen(text));
}

/* A copy of a reader's picture whose strings and values live in the arena. */
static FrameImage copy_description(const ExrPicture *from, Arena *arena)
{
    FrameImage to = *from;
    size_t     count = frame_pixel_count(from);
    to.channel_room = to.channel_count;
    to.attribute_room = to.attribute_count;
    to.channels = ARENA_NEW(arena, ExrChannel, from->channel_count);
    to.attributes = ARENA_NEW(arena, ExrAttribute, from->attribute_count);
    for (int i = 0; i < to.channel_count; i++) {
        const ExrChannel *c = &from->channels[i];
        to.channels[i] = (ExrChannel){copy_text(c->name, arena), c->is_whole,
                                      ARENA_NEW(arena, float, count)};
    }
    for (int i = 0; i < to.attribute_count; i++) {
        to.attributes[i] = from->attributes[i];
        to.attributes[i].name = copy_text(from->attributes[i].name, arena);
        to.attributes[i].text = copy_text(
            from->attributes[i].text ? from->attributes[i].text : "", arena);
    }
    return to;
}

static bool check_memory(const ExrPicture *picture, const Arena *arena, Error *err)
{
    size_t left = (size_t)(arena->end - arena->next), margin = 1u << 20;
    size_t bytes = frame_pixel_count(picture) * (size_t)picture->channel_count * sizeof(float);
    if (bytes + margin <= left) return true;
    return error_set(err, ERROR_MEMORY,
                     "%d channels of %zu pixels need %zu MB, %zu MB are left",
                     picture->channel_count, frame_pixel_count(picture), bytes >> 20,
                     left >> 20);
}

static bool read_picture(ExrReader *reader, Arena *arena, FrameImage *out, Error *err)
{
    const ExrPicture *picture = exr_reader_picture(reader);
    if (!check_memory(picture, arena, err)) return false;
    Arena      kept = *arena;
    FrameImage frame = copy_description(picture, &kept);
    Arena      scratch = kept;
    float    **planes = ARENA_NEW(&scratch, float *, frame.channel_count);
    for (int i = 0; i < frame.channel_count; i++) planes[i] = frame.channels[i].values;
    if (!exr_reader_read(reader, planes, err)) return false;
    *arena = kept;
    *out = frame;
    return true;
}

bool frame_read_memory(const void *bytes, size_t size, const char *name, Arena *arena,
                       FrameImage *out, Error *err)
{
    ExrReader *reader;
    if (!exr_reader_create(name, bytes, size, &reader, err)) return error_in_file(err, name);
    bool ok = read_picture(reader, arena, out, err);
    exr_reader_destroy(reader);
    return ok || error_in_file(err, name);
}

bool frame_read(const char *path, Arena *arena, FrameImage *out, Error *err)
{
    Arena     file = arena_reserve(MAX_FILE_BYTES + 4096);
    FileBytes bytes;
    bool      ok = file_read(path, MAX_FILE_BYTES, &file, &bytes, err) &&
              frame_read_memory(bytes.data, bytes.size, path, arena, out, err);
    arena_release(&file);
    return ok;
}
