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
 * Order    that of the rows: a `read` or `check` may use what stands before it, also in the
 *          outermost struct (JsonView.whole). A list, its count, and the names of a map
 *          are set before its items are read.
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
    RECORD_FLOATS,  /* const float[most] *, finite, as one text of digits (text/base64.h); int at
                       `count`: how many items of `most` floats */
    RECORD_WHOLES,  /* int[most] in place */
    RECORD_FLAG,    /* bool */
    RECORD_TEXT,    /* const char * */
    RECORD_NOTE,    /* a text for people: nothing is kept */
    RECORD_TEXTS,   /* const char **, least to most of them; int at `count` */
    RECORD_CHOICE,  /* int: the place of the word among `words` */
    RECORD_WORD,    /* const char *: the word itself, as `words` has it */
    RECORD_CONST,   /* nothing is kept: the text is words[0], or the number is low */
    RECORD_FILE,    /* const char *: the path of a file that can be read. In the document it is
                       a relative URI, percent-encoded (base/reference.h says how far) */
    RECORD_PATH,    /* const char *: a path as it stands, seen from the document's folder; it
                       need not be there */
    RECORD_REFER,   /* int: the place of a name in a list that was read before, `among` */
    RECORD_OBJECT,  /* a struct `of`, in place; if `count` is given, the bool there: is it? */
    RECORD_LIST,    /* const struct *, least to most of them; int at `count` */
    RECORD_MAP,     /* the same, by names: the first member of each struct, const char *. With
                       `among` each is a name of that list */
    RECORD_EITHER,  /* one of `forms`: the first of the value's JSON type. A form's offset
                       counts from the row's */
    RECORD_OWN      /* whatever `read` makes of it; `schema` is its JSON Schema. NULL: that of
                       `of`, or one of `words` */
} RecordKind;

enum RecordFlags {
    RECORD_REQUIRED = 1,
    RECORD_ABOVE = 2,      /* low itself is out of range */
    RECORD_FILLED = 4,     /* a text has something in it */
    RECORD_WHOLE = 8,      /* of numbers: whole ones */
    RECORD_RADIANS = 16,   /* degrees in the file */
    RECORD_METRES = 32,    /* millimetres in the file */
    RECORD_UNIT = 64,      /* of three numbers: a direction, which becomes a unit vector */
    RECORD_FLOAT = 128,    /* of a number, of numbers: float, not double */
    RECORD_APART = 256,    /* of an object: const struct *; NULL: it is absent */
    RECORD_OPEN = 512,     /* absent it means no number: the schema has no default */
    RECORD_NULL = 1024,    /* null, or absent: of numbers NaN, of a text NULL, of a choice 0 (its
                              words are 1, 2, ...), of an object that it is not there */
    RECORD_LONG = 2048,    /* of an integer: long, not int */
    RECORD_WRITTEN = 4096, /* it is not read back */
    RECORD_BRIEF = 8192,   /* null, false and an empty list are not written */
    RECORD_KEPT = 16384 /* only of a document that the program keeps for itself (JsonView.is_kept,
                           record_write.h); of what is RECORD_WRITTEN: there read back, too.
                           What is RECORD_OWN and not that has no place there */
};

/* Named structs of the outermost struct that is read (JsonView.whole). */
typedef struct RecordNames {
    const char *key, *one; /* "eyes", "eye" */
    size_t list, count;    /* offsets: of the pointer to the first, of the int how many */
    size_t size;           /* of one; its first member is its name, const char * */
} RecordNames;

typedef struct RecordFormat RecordFormat;
typedef struct RecordRow RecordRow;

struct RecordRow {
    const char *key;
    RecordKind kind;
    unsigned flags;
    size_t offset; /* of the value in the struct */
    double low, high;
    int least, most;          /* items of a list; most 0: any number */
    size_t count;             /* offset of how many, or of whether it is there; 0: none */
    const char *const *words; /* a NULL ends them */
    size_t stride;            /* bytes from one to the next: they are members of a table's
                                 structs. 0: an array of texts */
    const RecordFormat *of;
    const RecordNames *among;
    const RecordRow *forms; /* the key of each says what it is: "a name" */
    bool (*read)(const JsonView *view, const RecordRow *row, void *item, Error *err);
    /* instead of the kind's own reading; NULL: that */
    json_t *(*write)(const void *item); /* likewise, of the struct; record_write.h */
    const char *schema;                 /* of RECORD_OWN, JSON; ' may stand for " */
    const char *doc;                    /* one sentence; NULL: the key says it */
};

/* Of a row: where the value goes, and its range. */
#define RECORD_AT(Type, member) .offset = offsetof(Type, member)
#define RECORD_RANGE(bottom, top) .low = (bottom), .high = (top)

/* Of a list or map, or numbers that are counted; and how many there may be. */
#define RECORD_MANY(Type, member, counted) RECORD_AT(Type, member), .count = offsetof(Type, counted)
#define RECORD_COUNT(fewest, greatest) .least = (fewest), .most = (greatest)

struct RecordFormat {
    const char *name;          /* in a schema's "$defs" */
    size_t size;               /* of the struct */
    const RecordRow *rows;     /* a key that is NULL ends them */
    void (*start)(void *item); /* defaults of a whole file, of a list's item; NULL: zeros.
                                  A number's default that is NaN means that it has none */
    bool (*check)(const JsonView *view, void *item, Error *err); /* NULL: rows say all. View: of
                                  the object; of what is none, of the list or map about it */
    const char *rules; /* what `check` requires, as members of a JSON Schema (' as in a
                          row); NULL: nothing */
    const char *doc;
    bool takes_more;        /* keys of a later version are passed over */
    const RecordRow *value; /* instead of rows, where the items of a list or map are no objects:
                               what each is */
};

/* Of a list's items: a file each, const char *. */
extern const RecordFormat record_files;

/* All members of an object. item: a struct of the format, with its defaults. */
bool record_read(const JsonView *view, const RecordFormat *format, void *item, Error *err);

/* Does reading look for the row? */
bool record_is_read(const RecordRow *row, bool is_kept);

/* Of a document that is kept: figures that JSON has not. */
extern const char record_infinite[], record_infinite_below[];

/* Word i of a row; NULL behind the last one. */
const char *record_word(const RecordRow *row, int i);

/* One member, which is there; item: what the row's offset counts from. */
bool record_read_value(const JsonView *view, const RecordRow *row, void *item, Error *err);

/* The same as its kind has it, for a `read` that begins with that. */
bool record_read_kind(const JsonView *view, const RecordRow *row, void *item, Error *err);

/* Is there such a member? */
bool record_has(const JsonView *view, const char *key);

/* "key 'x' is missing": always false. */
bool record_misses(const JsonView *view, const char *key, Error *err);

/* Is there exactly one of two members? */
bool record_one_of(const JsonView *view, const char *one, const char *other, Error *err);

/* The items that names are of, as the outermost struct has them now. */
int record_names(const JsonView *view, const RecordNames *among, const char ***out);

/* A fault of a member: "..., required: ...". Always false. */
bool record_fails(const JsonView *view, const char *key, Error *err, const char *format, ...)
    __attribute__((format(printf, 4, 5)));
