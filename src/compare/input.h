/* SPDX-License-Identifier: Apache-2.0 */
/* input.h -- one side of a comparison: a frame of light or a finished picture.
 *
 * A frame is a file of light (image/light/light_file.h). Everything else is a picture of codes,
 * the right way up, and as sRGB codes of the light that its file says they mean
 * (image/light/picture_tags.h); of other primaries these reach out of 0 .. 1.
 *
 * Layout   the display window, row 0 at the top.
 * Memory   pixels come from the arena that is passed in.
 * Threads  plain data.
 * Fails    when the file cannot be read, and for two sides of different kinds.
 */
#pragma once
#include "compare/metrics/planes.h"
#include "image/light/light_file.h"
#include "image/light/picture_tags.h"
#include "image/picture_pages.h"

typedef enum InputKind { INPUT_FRAME, INPUT_PICTURE } InputKind;

typedef struct CompareInput {
    const char *name; /* the file as the user named it */
    InputKind kind;
    Planes light;           /* linear Rec.709: cd m^-2, or 0 .. 1; NaN outside a data window */
    Planes codes;           /* sRGB codes 0 .. 1; of frames once they are developed */
    LightFormat file;       /* frames: of which kind */
    FrameImage frame;       /* frames: channels, windows, attributes */
    ExrPart *parts;         /* frames: further parts of the file, frame.more_parts of them */
    Problems problems;      /* of reading it */
    int bits;               /* pictures: 8 or 16 */
    PictureTags tags;       /* pictures: what their file states */
    PicturePages pages;     /* what else the file holds; the first is looked at */
    const float *lights[3]; /* pictures: the light of each of their codes */
    bool has_alpha;         /* pictures: it is not 1 everywhere */
    const float *alpha;     /* pictures: 0 .. 1; NULL when all of it is 1 */
    Image packed;           /* pictures: as decoded, 4 or 8 bytes a pixel */
} CompareInput;

/* A picture of more than so many pixels stays packed: its planes are sizes only. */
#define INPUT_WHOLE_PIXELS (1L << 26)

/* whole_pixels: 0 for INPUT_WHOLE_PIXELS. */
bool input_read(const char *path, long whole_pixels, Arena *arena, CompareInput *out, Error *err);

/* Takes a frame's light from its channels again. */
bool input_view_light(CompareInput *input, Arena *arena, Error *err);

static inline bool input_is_packed(const CompareInput *input) {
    return input->kind == INPUT_PICTURE && !input->codes.rgb[0];
}

/* Some rows of a picture, as planes of so many rows. */
typedef struct CodeRows {
    Planes codes, light;
    const float *alpha; /* NULL as above */
} CodeRows;

/* Rows [y0, y1) of a picture, from its packed codes. */
CodeRows input_unpack(const CompareInput *input, int y0, int y1, Arena *arena);

/* False, and what to do about it, for a frame against a picture. */
bool input_check_kinds(const CompareInput *reference, const CompareInput *test, Error *err);

/* True when input_read would try it, by the name's ending. */
bool input_has_known_ending(const char *path);
