/* SPDX-License-Identifier: Apache-2.0 */
/* rule.h -- what a glTF document must look like, as tables.
 *
 * The tables (schema_core.c, schema_extensions.c, material_layers.c; ours are rows:
 * our_extensions.c) state for every object which members it may have, of which kind and range,
 * and which list an index refers to. What tables cannot express (cycles, bounds, agreement
 * between objects) is in the check_*.c files.
 */
#pragma once
#include "record/record.h"
#include "scene/check/check.h"

typedef enum RuleKind {
    RULE_NUMBER,  /* min .. max */
    RULE_INTEGER, /* min .. max */
    RULE_BOOLEAN,
    RULE_TEXT,
    RULE_CHOICE,  /* a text among the words of `of`, "a|b|c": another one, which an extension
                     may have added, only warns */
    RULE_CODE,    /* an integer among the numbers of `of`, "1|2|3": as above */
    RULE_INDEX,   /* a place in the list that `of` names */
    RULE_INDICES, /* an array of such places */
    RULE_NUMBERS, /* an array of least .. most numbers, each in min .. max */
    RULE_TEXTS,   /* an array of texts */
    RULE_OBJECT,  /* as in `schema` */
    RULE_OBJECTS, /* an array of such objects */
    RULE_MAP,     /* an object whose members are all indices into `of` */
    RULE_ANY
} RuleKind;

enum {
    RULE_REQUIRED = 1,
    RULE_ABOVE_MIN = 2,      /* min itself is not allowed */
    RULE_WARNS = 8,          /* this member and what is below it only warn */
    RULE_FROM_MIN = 16,      /* min holds, there is no max */
    RULE_CLOSED = 32,        /* no extension adds words to this list */
    RULE_WARNS_AT_REST = 64, /* RULE_WARNS, unless animations are played (--time) */
    RULE_ANY_SIZE = 128      /* beyond floats, too: other numbers are held to them */
};

/* Where the loader keeps a value of a material's layer: bytes into the struct that the layer
 * fills (MaterialLayer), there a float, several (RULE_NUMBERS) or a TextureSlot. */
typedef struct RuleField {
    bool is_kept;
    size_t at;
    float usual; /* of a number that is missing, or of each of several */
} RuleField;

typedef struct Rule {
    const char *name;
    RuleKind kind;
    unsigned flags;
    double min, max; /* both 0, and not RULE_FROM_MIN: any number will do */
    int least, most; /* items of an array; most 0: as many as there are */
    const char *of;
    const char *const *words; /* of a choice, in place of `of`; a NULL ends them */
    const struct Schema *schema;
    const char *needs; /* the member beside it without which it means nothing; NULL: none */
    RuleField field;
} Rule;

typedef struct Schema {
    const char *name; /* "node": extensions and messages refer to it */
    bool is_ours;     /* PARHELION_*: an unknown member is an error, not a warning */
    /* NULL: the table suffices. */
    void (*more)(const DocumentCheck *check, const GltfValue *value);
    const Rule *rules;          /* RULES(...): up to one without a name */
    const RecordFormat *format; /* of ours: rows in place of rules */
} Schema;

#define NO_RULES \
    .rules = (const Rule[]) { \
        { \
            .name = NULL \
        } \
    }
#define RULES(...) \
    .rules = (const Rule[]) { \
        __VA_ARGS__, { \
            .name = NULL \
        } \
    }

#define RULE_MOST_BYTES 9007199254740992.0 /* 2^53: what a double counts exactly */

/* An extension on one kind of object. */
typedef struct ExtensionRule {
    const char *name;
    const char *host;     /* the name of the schema it may stand on; NULL: any */
    const Schema *schema; /* NULL: its content is not looked into */
} ExtensionRule;
