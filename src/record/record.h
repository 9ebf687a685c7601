/* SPDX-License-Identifier: Apache-2.0 */
/* record.h -- a format of JSON is a table: one row a key.
 *
 * A row says of what kind the value is, where it goes in a struct, what range it has, whether
 * it is required, and what it means. A file is read from these rows (here) and its JSON Schema
 * is written (record_schema.h). What rows cannot say (one list is as long as another) is a
 * function of the format, called when the rows of the object have been read.
 *
 * Reading  refuses an unknown key (with the nearest known one), a required key that is missing,
 *          null, another kind, and a value out of range; each error names file, JSON path, what
 *          was found and what is required. What is absent leaves the struct as it is: a caller
 *          or `start` sets the defaults.
 * Units    a row's: numbers are taken as they stand in the file.
 * Memory   texts and lists lie in the view's arena. Threads: tables are constant.
 */
#pragma once
#include <stddef.h>

#include "text/json_view.h"

typedef enum RecordKind {
    RECORD_NUMBER,  /* double, in [low, high] */
    RECORD_INTEGER, /* int, likewise */
    RECORD_NUMBERS, /* double[most] in place, least to most of them, each in [low, high]; if
                       `count` is given, the int there: how many */
    RECORD_FIGURES, /* const double *, the same; int at `count` */
    RECORD_WHOLES,  /* int[most] in place */
    RECORD_FLAG,    /* bool */
    RECORD_TEXT,    /* const char * */
    RECORD_NOTE,    /* a text for people: nothing is kept */
    RECORD_TEXTS,   /* const char **, least to most of them; int at `count` */
    RECORD_CHOICE,  /* int: the place of the word among `words` */
    RECORD_WORD,    /* const char *: the word itself, as `words` has it */
    RECORD_CONST,   /* nothing is kept: the text is words[0], or the number is low */
    RECORD_OBJECT,  /* a struct `of`, in place; if `count` is given, the bool there: is it? */
    RECORD_LIST,    /* const struct *, least to most of them; int at `count` */
    RECORD_OWN      /* whatever `read` makes of it; `schema` is its JSON Schema. NULL: it is one
                       of `words` */
} RecordKind;

enum RecordFlags {
    RECORD_REQUIRED = 1,
    RECORD_ABOVE = 2,    /* low itself is out of range */
    RECORD_FILLED = 4,   /* a text has something in it */
    RECORD_WHOLE = 8,    /* of numbers: whole ones */
    RECORD_RADIANS = 16, /* degrees in the file */
    RECORD_METRES = 32,  /* millimetres in the file */
    RECORD_UNIT = 64     /* of three numbers: a direction, which becomes a unit vector */
};

typedef struct RecordFormat RecordFormat;
typedef struct RecordRow RecordRow;

struct RecordRow {
    const char *key;
    RecordKind  kind;
    unsigned    flags;
    size_t      offset; /* of the value in the struct */
    double      low, high;
    int         least, most;       /* items of a list; most 0: any number */
    size_t      count;             /* offset of how many, or of whether it is there; 0: none */
    const char *const  *words;     /* a NULL ends them */
    size_t              stride;    /* bytes from one to the next: they are members of a table's
                                      structs. 0: an array of texts */
    const RecordFormat *of;
    bool (*read)(const JsonView *view, const RecordRow *row, void *item, Error *err);
    const char *schema;            /* of RECORD_OWN, JSON */
    const char *doc;               /* one sentence; NULL: the key says it */
};

/* Of a row: where the value goes, and its range. */
#define RECORD_AT(Type, member) .offset = offsetof(Type, member)
#define RECORD_RANGE(bottom, top) .low = (bottom), .high = (top)

/* Usual rows, short enough for one line. */
#define RECORD_NUMBER_ROW(key, Type, member, bottom, top, words)                               \
    {key, RECORD_NUMBER, RECORD_AT(Type, member), RECORD_RANGE(bottom, top), .doc = words}
#define RECORD_PAIR_ROW(key, Type, member, bottom, top, words)                                 \
    {key, RECORD_NUMBERS, RECORD_AT(Type, member), RECORD_RANGE(bottom, top), .least = 2,      \
     .most = 2, .doc = words}
#define RECORD_TEXT_ROW(key, Type, member, words)                                              \
    {key, RECORD_TEXT, RECORD_AT(Type, member), .doc = words}

struct RecordFormat {
    const char      *name;  /* in a schema's "$defs" */
    size_t           size;  /* of the struct */
    const RecordRow *rows;  /* a key that is NULL ends them */
    void (*start)(void *item); /* defaults of a whole file, of a list's item; NULL: zeros.
                                  A number's default that is NaN means that it has none */
    bool (*check)(const JsonView *view, void *item, Error *err); /* NULL: rows say all */
    const char *rules; /* what `check` wants, as members of a JSON Schema; NULL: nothing */
    const char *doc;
};

/* All members of an object. item: a struct of the format, with its defaults. */
bool record_read(const JsonView *view, const RecordFormat *format, void *item, Error *err);

/* Word i of a row; NULL behind the last one. */
const char *record_word(const RecordRow *row, int i);

/* One member, which is there; item: what the row's offset counts from. */
bool record_read_value(const JsonView *view, const RecordRow *row, void *item, Error *err);

/* A fault of a member: "..., required: ...". Always false. */
bool record_fails(const JsonView *view, const char *key, Error *err, const char *format, ...)
    __attribute__((format(printf, 4, 5)));
