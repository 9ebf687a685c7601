/* input.h -- one side of a comparison: a frame of light or a finished picture.
 *
 * A frame is an OpenEXR file, in cd m^-2; a Radiance picture or a TIFF of floats is taken for
 * one that carries no metadata. Everything else is a picture of sRGB codes.
 *
 * Layout   the display window, row 0 at the top.
 * Memory   pixels come from the arena that is passed in.
 * Threads  plain data.
 * Fails    when the file cannot be read, and for two sides of different kinds.
 */
#pragma once
#include "compare/metrics/planes.h"
#include "image/frame.h"

typedef enum InputKind { INPUT_FRAME, INPUT_PICTURE } InputKind;

typedef struct CompareInput {
    const char *name; /* the file as the user named it */
    InputKind kind;
    Planes      light; /* linear Rec.709: cd m^-2, or 0 .. 1; NaN outside a data window */
    Planes      codes; /* sRGB codes 0 .. 1; of frames once they are developed */
    bool        has_metadata; /* OpenEXR */
    FrameImage  frame;        /* frames: channels, windows, attributes */
    int         bits;         /* pictures: 8 or 16 */
    const float *alpha;       /* pictures: 0 .. 1; NULL when all of it is 1 */
} CompareInput;

bool input_read(const char *path, Arena *arena, CompareInput *out, Error *err);

/* False, and what to do about it, for a frame against a picture. */
bool input_check_kinds(const CompareInput *reference, const CompareInput *test, Error *err);

/* True when input_read would try it, by the name's ending. */
bool input_has_known_ending(const char *path);
