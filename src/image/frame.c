/* SPDX-License-Identifier: Apache-2.0 */
#include "image/frame.h"

#include <assert.h>
#include <limits.h>
#include <math.h>
#include <stddef.h>
#include <stdio.h>
#include <string.h>

#include "base/file.h"
#include "base/file_write.h"
#include "base/number.h"
#include "image/colour.h"

#define MAX_FILE_BYTES ((size_t)4 << 30)

static const double ONE = 1;

FrameImage frame_create(int width, int height, ExrWindow data, int channel_room, int attribute_room,
                        Arena *arena) {
    FrameImage frame = {.display = {0, 0, width, height},
                        .data = data,
                        .channel_room = channel_room,
                        .attribute_room = attribute_room + 2};
    frame.channels = ARENA_NEW(arena, ExrChannel, frame.channel_room);
    frame.attributes = ARENA_NEW(arena, ExrAttribute, frame.attribute_room);
    frame_set_values(&frame, "chromaticities", EXR_CHROMATICITIES, REC709_CHROMATICITIES, arena);
    frame_set_values(&frame, "whiteLuminance", EXR_FLOAT, &ONE, arena);
    return frame;
}

float *frame_add_channel(FrameImage *frame, const char *name, bool is_whole, Arena *arena) {
    assert(!frame_channel(frame, name));
    if (frame->channel_count == frame->channel_room) {
        frame->channel_room = 2 * frame->channel_room + 4;
        frame->channels = ARENA_GROW(arena, ExrChannel, frame->channels, frame->channel_count,
                                     frame->channel_room);
    }
    size_t width = (size_t)(frame->data.x1 - frame->data.x0);
    size_t count = frame->rows ? width * (size_t)frame->rows->count : frame_pixel_count(frame);
    float *values = ARENA_NEW(arena, float, count);
    frame->channels[frame->channel_count++] =
        (ExrChannel){arena_string(arena, name, strlen(name)), is_whole, values};
    return values;
}

/* The attribute of that name, a new one if there is none. */
static ExrAttribute *attribute_slot(FrameImage *frame, const char *name, Arena *arena) {
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

void frame_set_string(FrameImage *frame, const char *name, const char *text, Arena *arena) {
    ExrAttribute *slot = attribute_slot(frame, name, arena);
    slot->kind = EXR_STRING;
    slot->text = arena_string(arena, text, strlen(text));
}

void frame_set_number(FrameImage *frame, const char *name, double value, Arena *arena) {
    frame_set_values(frame, name, EXR_DOUBLE, &value, arena);
}

void frame_set_whole(FrameImage *frame, const char *name, int value, Arena *arena) {
    double number = value;
    frame_set_values(frame, name, EXR_INT, &number, arena);
}

void frame_set_values(FrameImage *frame, const char *name, ExrKind kind, const double *values,
                      Arena *arena) {
    size_t count = kind == EXR_CHROMATICITIES ? 8 : kind == EXR_MATRIX44 ? 16 : 1;
    ExrAttribute *slot = attribute_slot(frame, name, arena);
    slot->kind = kind;
    slot->text = "";
    memcpy(slot->values, values, count * sizeof *values);
}

const float *frame_channel(const FrameImage *frame, const char *name) {
    for (int i = 0; i < frame->channel_count; i++)
        if (!strcmp(frame->channels[i].name, name)) return frame->channels[i].values;
    return NULL;
}

const ExrAttribute *frame_attribute(const FrameImage *frame, const char *name) {
    for (int i = 0; i < frame->attribute_count; i++)
        if (!strcmp(frame->attributes[i].name, name)) return &frame->attributes[i];
    return NULL;
}

const char *frame_string(const FrameImage *frame, const char *name) {
    const ExrAttribute *attribute = frame_attribute(frame, name);
    return attribute && attribute->kind == EXR_STRING ? attribute->text : NULL;
}

bool frame_rgb(const FrameImage *frame, const char *layer, const float *rgb[3]) {
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

FrameImage frame_with_rgb(const FrameImage *frame, float *const planes[3], Arena *arena) {
    FrameImage out = *frame;
    const float *rgb[3];
    frame_rgb(frame, "", rgb);
    out.channels = ARENA_NEW(arena, ExrChannel, frame->channel_count);
    out.channel_room = frame->channel_count;
    for (int i = 0; i < frame->channel_count; i++) {
        out.channels[i] = frame->channels[i];
        for (int c = 0; c < 3; c++)
            if (frame->channels[i].values == rgb[c]) out.channels[i].values = planes[c];
    }
    return out;
}

int frame_id_of(const FrameImage *frame, const char *what, const char *name) {
    char prefix[64];
    snprintf(prefix, sizeof prefix, "parhelion:%s.", what);
    for (int i = 0; i < frame->attribute_count; i++) {
        const ExrAttribute *a = &frame->attributes[i];
        size_t length = strlen(prefix);
        uint64_t id;
        if (a->kind == EXR_STRING && !strncmp(a->name, prefix, length) && !strcmp(a->text, name) &&
            number_read_count(a->name + length, &id) && id <= INT_MAX)
            return (int)id;
    }
    return -1;
}

const char *frame_display_names(const FrameImage *frame, Arena *arena) {
    const char *names = "";
    for (int i = 0; i < frame->attribute_count; i++) {
        const ExrAttribute *a = &frame->attributes[i];
        if (a->kind == EXR_STRING && !strncmp(a->name, "parhelion:display.", 18))
            names = arena_format(arena, "%s%s%s", names, names[0] ? ", " : "", a->text);
    }
    return names[0] ? names : "none";
}

bool frame_write(const char *path, const FrameImage *frame, Error *err) {
    ExrBytes *encoded;
    size_t size;
    if (!exr_encode(frame, &encoded, err)) return error_in_file(err, path);
    const void *bytes = exr_bytes(encoded, &size);
    bool ok = file_write(path, bytes, size, err);
    exr_bytes_destroy(encoded);
    return ok;
}

/* ---- reading ------------------------------------------------------------------------- */

static const char *copy_text(const char *text, Arena *arena) {
    return arena_string(arena, text, strlen(text));
}

/* A copy of a reader's picture whose strings and values live in the arena. */
static FrameImage copy_description(const ExrPicture *from, Arena *arena) {
    FrameImage to = *from;
    size_t count = frame_pixel_count(from);
    to.channel_room = to.channel_count;
    to.attribute_room = to.attribute_count;
    to.channels = ARENA_NEW(arena, ExrChannel, from->channel_count);
    to.attributes = ARENA_NEW(arena, ExrAttribute, from->attribute_count);
    for (int i = 0; i < to.channel_count; i++) {
        const ExrChannel *c = &from->channels[i];
        to.channels[i] =
            (ExrChannel){copy_text(c->name, arena), c->is_whole, ARENA_NEW(arena, float, count)};
    }
    for (int i = 0; i < to.attribute_count; i++) {
        to.attributes[i] = from->attributes[i];
        to.attributes[i].name = copy_text(from->attributes[i].name, arena);
        to.attributes[i].text =
            copy_text(from->attributes[i].text ? from->attributes[i].text : "", arena);
    }
    return to;
}

static bool check_memory(const ExrPicture *picture, const Arena *arena, Error *err) {
    size_t left = (size_t)(arena->end - arena->next), margin = 1u << 20;
    size_t planes = (size_t)picture->channel_count + 2; /* a grey one may become three */
    size_t bytes = frame_pixel_count(picture) * planes * sizeof(float);
    if (bytes + margin <= left) return true;
    return error_set(err, ERROR_MEMORY, "%d channels of %zu pixels need %zu MB, %zu MB are left",
                     picture->channel_count, frame_pixel_count(picture), bytes >> 20, left >> 20);
}

/* ---- what a file states of its light ---------------------------------------------------- */

bool frame_needs_rec709(const FrameImage *frame, ColourMatrix *out) {
    const ExrAttribute *a = frame_attribute(frame, "chromaticities");
    if (!a || a->kind != EXR_CHROMATICITIES || !chromaticities_are_usable(a->values) ||
        chromaticities_are_rec709(a->values))
        return false;
    *out = rec709_from_primaries(a->values);
    return true;
}

static bool check_statements(const FrameImage *frame, Error *err) {
    const ExrAttribute *colours = frame_attribute(frame, "chromaticities");
    const ExrAttribute *white = frame_attribute(frame, "whiteLuminance");
    bool is_number =
        !white || white->kind == EXR_FLOAT || white->kind == EXR_DOUBLE || white->kind == EXR_INT;
    if (colours &&
        (colours->kind != EXR_CHROMATICITIES || !chromaticities_are_usable(colours->values)))
        return error_set(err, ERROR_INPUT,
                         "chromaticities: required: x and y of red, green, "
                         "blue and white, of primaries that light can be mixed from");
    if (!is_number) return error_set(err, ERROR_INPUT, "whiteLuminance is no number");
    return !white || (white->values[0] > 0 && isfinite(white->values[0])) ||
           error_set(err, ERROR_INPUT,
                     "whiteLuminance is %g, required: the cd/m2 of white, "
                     "above 0",
                     white->values[0]);
}

/* From stored values to cd/m2 of Rec.709. */
typedef struct StatedLight {
    bool has_matrix;
    ColourMatrix matrix;
    double white;
} StatedLight;

/* Three variances at once: the greatest that mixed colours can have, as if they rose and fell
 * together. */
static void convert_variance(const StatedLight *stated, const float in[3], float out[3]) {
    for (int c = 0; c < 3; c++) {
        double sigma = 0;
        for (int k = 0; k < 3 && stated->has_matrix; k++)
            sigma += fabs(stated->matrix.m[c][k]) * sqrt((double)in[k]);
        double variance = stated->has_matrix ? sigma * sigma : (double)in[c];
        out[c] = (float)(variance * stated->white * stated->white);
    }
}

static void convert_light(const StatedLight *stated, const float in[3], float out[3]) {
    memcpy(out, in, 3 * sizeof *out);
    if (stated->has_matrix) colour_apply(&stated->matrix, in, out);
    for (int c = 0; c < 3; c++) out[c] = (float)((double)out[c] * stated->white);
}

/* The layer whose red is channel i, if it is one. */
static void convert_layer(FrameImage *frame, int i, const StatedLight *stated, Arena scratch) {
    const char *name = frame->channels[i].name, *dot = strrchr(name, '.');
    const float *rgb[3];
    StatedLight own = *stated;
    size_t length = dot ? (size_t)(dot - name) : 0;
    char *layer = arena_string(&scratch, name, length);
    if (strcmp(dot ? dot + 1 : name, "R") != 0 || !frame_rgb(frame, layer, rgb)) return;
    if (!strcmp(layer, "albedo")) own.white = 1;
    bool is_variance = length >= 8 && !strcmp(layer + length - 8, "variance");
    for (size_t k = 0; k < frame_pixel_count(frame); k++) {
        float in[3] = {rgb[0][k], rgb[1][k], rgb[2][k]}, out[3];
        if (is_variance) convert_variance(&own, in, out);
        else convert_light(&own, in, out);
        for (int c = 0; c < 3; c++) ((float *)rgb[c])[k] = out[c];
    }
}

/* A grey picture has the colour of the file's white. */
static void spread_grey(FrameImage *frame, Arena *arena) {
    const size_t bytes = frame_pixel_count(frame) * sizeof(float);
    for (int i = 0; i < frame->channel_count; i++) {
        const float *grey = frame->channels[i].values;
        if (strcmp(frame->channels[i].name, "Y") != 0 || frame_channel(frame, "R")) continue;
        frame->channels[i].name = "R";
        memcpy(frame_add_channel(frame, "G", false, arena), grey, bytes);
        memcpy(frame_add_channel(frame, "B", false, arena), grey, bytes);
        return;
    }
}

/* Channels X, Y and Z without R are CIE XYZ, whatever the chromaticities. */
static bool rename_xyz(FrameImage *frame) {
    static const char *const NAMES[3] = {"R", "G", "B"};
    ExrChannel *found[3] = {NULL};
    for (int i = 0; i < frame->channel_count; i++) {
        const char *name = frame->channels[i].name;
        if (name[0] && !name[1] && strchr("XYZ", name[0]))
            found[name[0] - 'X'] = &frame->channels[i];
    }
    if (!found[0] || !found[1] || !found[2] || frame_channel(frame, "R")) return false;
    for (int c = 0; c < 3; c++) found[c]->name = NAMES[c];
    return true;
}

static bool apply_statements(FrameImage *frame, Arena *arena, Error *err) {
    const ExrAttribute *white = frame_attribute(frame, "whiteLuminance");
    StatedLight stated = {.white = white ? white->values[0] : 1};
    if (!check_statements(frame, err)) return false;
    stated.has_matrix = frame_needs_rec709(frame, &stated.matrix);
    const StatedLight xyz = {true, rec709_from_primaries(XYZ_CHROMATICITIES), stated.white};
    bool is_xyz = rename_xyz(frame);
    spread_grey(frame, arena);
    if (!stated.has_matrix && !is_xyz && stated.white == 1) return true;
    for (int i = 0; i < frame->channel_count; i++) {
        bool is_own = !strcmp(frame->channels[i].name, "R");
        convert_layer(frame, i, is_xyz && is_own ? &xyz : &stated, *arena);
    }
    if (stated.white != 1) {
        frame_set_values(frame, "whiteLuminance", EXR_FLOAT, &ONE, arena);
        frame_set_values(frame, "parhelion:whiteLuminance", EXR_FLOAT, &stated.white, arena);
    }
    if (stated.has_matrix) {
        double own[8];
        memcpy(own, frame_attribute(frame, "chromaticities")->values, sizeof own);
        frame_set_values(frame, "chromaticities", EXR_CHROMATICITIES, REC709_CHROMATICITIES, arena);
        frame_set_values(frame, "parhelion:chromaticities", EXR_CHROMATICITIES, own, arena);
    }
    return true;
}

static bool read_picture(ExrReader *reader, Arena *arena, FrameImage *out, Error *err) {
    const ExrPicture *picture = exr_reader_picture(reader);
    if (!check_memory(picture, arena, err)) return false;
    Arena kept = *arena;
    FrameImage frame = copy_description(picture, &kept);
    Arena scratch = kept;
    float **planes = ARENA_NEW(&scratch, float *, frame.channel_count);
    for (int i = 0; i < frame.channel_count; i++) planes[i] = frame.channels[i].values;
    if (!exr_reader_read(reader, planes, err)) return false;
    if (!apply_statements(&frame, &kept, err)) return false;
    *arena = kept;
    *out = frame;
    return true;
}

bool frame_read_memory(const void *bytes, size_t size, const char *name, Arena *arena,
                       FrameImage *out, Error *err) {
    ExrReader *reader;
    if (!exr_reader_create(name, bytes, size, &reader, err)) return error_in_file(err, name);
    bool ok = read_picture(reader, arena, out, err);
    exr_reader_destroy(reader);
    return ok || error_in_file(err, name);
}

bool frame_read(const char *path, Arena *arena, FrameImage *out, Error *err) {
    Arena file = arena_reserve(MAX_FILE_BYTES + 4096);
    FileBytes bytes;
    bool ok = file_read(path, MAX_FILE_BYTES, &file, &bytes, err) &&
              frame_read_memory(bytes.data, bytes.size, path, arena, out, err);
    arena_release(&file);
    return ok;
}
