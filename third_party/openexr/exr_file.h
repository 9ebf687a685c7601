/* SPDX-License-Identifier: Apache-2.0 */
/* exr_file.h -- pictures with named channels, windows and attributes, as OpenEXR bytes.
 * The only C view of OpenEXR in this program.
 *
 * Layout   planar: a channel is one array over the data window, row 0 at the top.
 * Windows  half-open, in pixels; the display window is the whole picture.
 * Memory   readers and encoded bytes are handles with a destroy; planes belong to the caller.
 * Threads  one handle belongs to one thread at a time.
 * Fails    with the library's reason. Only exr_reader_open touches a file.
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
    const char *name; /* "R", "depth.Z" */
    bool is_whole;    /* stored as 32-bit unsigned: whole numbers 0 .. 2^24; -1 is "none",
                         stored as 4294967295 */
    float *values;    /* data window, row by row; NULL in a description */
} ExrChannel;

typedef enum ExrKind {
    EXR_STRING,
    EXR_INT,            /* 1 value */
    EXR_FLOAT,          /* 1 value, single precision */
    EXR_DOUBLE,         /* 1 value */
    EXR_CHROMATICITIES, /* 8 values: x, y of red, green, blue, white */
    EXR_MATRIX44,       /* 16 values, rows, for row vectors (a translation is the last row) */
    EXR_OTHER           /* text: its type and its bytes; is not written */
} ExrKind;

typedef struct ExrAttribute {
    const char *name;
    ExrKind kind;
    const char *text;  /* EXR_STRING, EXR_OTHER */
    double values[16]; /* the other kinds */
} ExrAttribute;

/* Rows that are made when they are written. */
typedef struct ExrRows {
    int count;                                /* that the planes (or words) hold (exr_rows_in) */
    void (*make)(void *from, int y0, int y1); /* fills them with these rows of the data window */
    void *from;
} ExrRows;

/* Rows of `all` whose `row` bytes each fit into so many, in whole chunks as files have them, at
 * least one. */
static inline int exr_rows_in(size_t bytes, size_t row, int all) {
    const int chunk = 16; /* of ZIP compression */
    int rows = (int)(bytes / row) / chunk * chunk;
    if (rows < chunk) rows = chunk;
    return rows < all ? rows : all;
}

/* 32-bit words of every pixel of a picture, kept as they are in a part of their own, of which
 * those who want the picture need not know. */
typedef struct ExrWords {
    const char *name;         /* of the part, "film" */
    int count;                /* words a pixel */
    const char *const *names; /* of the words, all different; files keep them sorted */
    const void *values;       /* pixel after pixel, row by row: `count` words each; NULL in a
                                 description */
    int attribute_count;
    const ExrAttribute *attributes;
    const ExrRows *rows; /* NULL: all rows are there */
} ExrWords;

typedef struct ExrPicture {
    ExrWindow display, data; /* for writing, data must lie inside display */
    int channel_count;
    ExrChannel *channels;
    int attribute_count;
    ExrAttribute *attributes;         /* files keep them sorted by name */
    int channel_room, attribute_room; /* what the lists hold; not looked at here */
    const ExrRows *rows;              /* NULL: the planes hold all rows */
    const ExrWords *words;            /* a second part that is written; NULL: none, and when read */
    int more_parts; /* of a file that is read: those behind the first, less words */
} ExrPicture;

/* Whole-file limits, refused before memory is taken for pixels. */
enum {
    EXR_MAX_SIDE = 65536,
    EXR_MAX_PIXELS = 1 << 28,
    EXR_MAX_CHANNELS = 1024,
    EXR_MAX_WORDS = 4096
};

typedef struct ExrReader ExrReader; /* owns C++ objects */

/* The first part of a file that lies in memory. bytes must outlive the reader; name is for
 * messages. Deep pictures and channels that are sampled more coarsely than the pixels are
 * refused. */
bool exr_reader_create(const char *name, const void *bytes, size_t size, ExrReader **out,
                       Error *err);

/* The same for a file on disk, which is read as pixels are asked for. */
bool exr_reader_open(const char *path, ExrReader **out, Error *err);

/* Channels without values; lives as long as the reader. What a file states of how it is stored
 * ("name", "type", "compression" ...) is not among the attributes. */
const ExrPicture *exr_reader_picture(const ExrReader *reader);

/* A part behind the first that is no words: 0 <= i < more_parts. */
typedef struct ExrPart {
    const char *name; /* lives as long as the reader */
    bool is_flat;
    unsigned long long digest; /* of a flat part: of its channels, of their values, and of
                                  what else decides what they show */
} ExrPart;

bool exr_reader_part(ExrReader *reader, int i, ExrPart *out, Error *err);

/* planes: one array of (data window) floats for each channel, in the picture's order; NULL
 * skips a channel. Half, float and unsigned become float. A file cut off or damaged is
 * refused. */
bool exr_reader_read(ExrReader *reader, float *const *planes, Error *err);

/* The words that a part of this name behind the first one holds; *out is NULL when there is no
 * such part, and lives as long as the reader. A part that is not of unsigned words in the
 * picture's windows is refused. */
bool exr_reader_words(ExrReader *reader, const char *name, const ExrWords **out, Error *err);

/* Rows [y0, y1) of what exr_reader_words found last, pixel after pixel: of each the words of
 * `wanted`, in its order. values holds them all. */
bool exr_reader_read_words(ExrReader *reader, const ExrWords *wanted, int y0, int y1, void *values,
                           Error *err);

void exr_reader_destroy(ExrReader *reader); /* NULL is fine */

typedef struct ExrBytes ExrBytes; /* owns bytes */

/* 32-bit floats and unsigned, ZIP (lossless). The same picture gives the same bytes. */
bool exr_encode(const ExrPicture *picture, ExrBytes **out, Error *err);

const void *exr_bytes(const ExrBytes *encoded, size_t *size);
void exr_bytes_destroy(ExrBytes *encoded); /* NULL is fine */

#ifdef __cplusplus
}
#endif
