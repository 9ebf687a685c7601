/* exr_file.h -- pictures with named channels, windows and attributes, as OpenEXR bytes.
 * The only C view of OpenEXR in this program.
 *
 * Layout   planar: a channel is one array over the data window, row 0 at the top.
 * Windows  half-open, in pixels; the display window is the whole picture.
 * Memory   readers and encoded bytes are handles with a destroy; planes belong to the caller.
 * Threads  one handle belongs to one thread at a time.
 * Fails    with the library's reason; no file is touched here.
 */
#pragma once
#include <stddef.h>

#include "base/error.h"
#ifdef __cplusplus
extern "C" {
#endif

typedef struct ExrWindow {
    int x0, y0, x1, y1; /* half-open */
} ExrWindow;

typedef struct ExrChannel {
    const char *name;     /* "R", "depth.Z" */
    bool        is_whole; /* stored as 32-bit unsigned: whole numbers 0 .. 2^24; -1 is "none",
                             stored as 4294967295 */
    float      *values;   /* data window, row by row; NULL in a description */
} ExrChannel;

typedef enum ExrKind {
    EXR_STRING,
    EXR_INT,            /* 1 value */
    EXR_FLOAT,          /* 1 value, single precision */
    EXR_DOUBLE,         /* 1 value */
    EXR_CHROMATICITIES, /* 8 values: x, y of red, green, blue, white */
    EXR_MATRIX44        /* 16 values, rows, for row vectors (a translation is the last row) */
} ExrKind;

typedef struct ExrAttribute {
    const char *name;
    ExrKind     kind;
    const char *text;       /* EXR_STRING */
    double      values[16]; /* the other kinds */
} ExrAttribute;

typedef struct ExrPicture {
    ExrWindow     display, data; /* for writing, data must lie inside display */
    int           channel_count;
    ExrChannel   *channels;
    int           attribute_count;
    ExrAttribute *attributes; /* files keep them sorted by name; other kinds are left out */
    int           channel_room, attribute_room; /* what the lists hold; not looked at here */
} ExrPicture;

/* Whole-file limits, refused before memory is taken for pixels. */
enum { EXR_MAX_SIDE = 65536, EXR_MAX_PIXELS = 1 << 28, EXR_MAX_CHANNELS = 1024 };

typedef struct ExrReader ExrReader; /* owns C++ objects */

/* The first part of a file that lies in memory. bytes must outlive the reader; name is for
 * messages. Deep pictures and channels that are sampled more coarsely than the pixels are
 * refused. */
bool exr_reader_create(const char *name, const void *bytes, size_t size, ExrReader **out,
                       Error *err);

/* Channels without values; lives as long as the reader. */
const ExrPicture *exr_reader_picture(const ExrReader *reader);

/* planes: one array of (data window) floats for each channel, in the picture's order; NULL
 * skips a channel. Half, float and unsigned become float. A file cut off or damaged is
 * refused. */
bool exr_reader_read(ExrReader *reader, float *const *planes, Error *err);

void exr_reader_destroy(ExrReader *reader); /* NULL is fine */

typedef struct ExrBytes ExrBytes; /* owns bytes */

/* 32-bit floats and unsigned, ZIP (lossless). The same picture gives the same bytes. */
bool exr_encode(const ExrPicture *picture, ExrBytes **out, Error *err);

const void *exr_bytes(const ExrBytes *encoded, size_t *size);
void exr_bytes_destroy(ExrBytes *encoded); /* NULL is fine */

#ifdef __cplusplus
}
#endif
