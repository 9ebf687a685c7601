/* schema.h -- what a glTF document must look like, as tables, and the check against them.
 *
 * The tables (schema_core.c, schema_extensions.c) say for every object which members it may
 * have, of which kind and range, and which list an index refers to. What tables cannot say
 * (cycles, bounds, agreement between objects) is in the check_*.c files.
 *
 * An error is what makes the picture undefined or wrong; what breaks the specification but
 * leaves no doubt about the picture is a warning. Parts that are skipped (animations,
 * extensions that are not shown) warn only.
 */
#pragma once
#include "scene/load.h"

typedef enum RuleKind {
    RULE_NUMBER,  /* min .. max */
    RULE_INTEGER, /* min .. max */
    RULE_BOOLEAN,
    RULE_TEXT,
    RULE_CHOICE,  /* a text among the words of `of`, "a|b|c" */
    RULE_CODE,    /* an integer among the numbers of `of`, "1|2|3" */
    RULE_INDEX,   /* a place in the list that `of` names */
    RULE_INDICES, /* an array of such places, none twice */
    RULE_NUMBERS, /* an array of least .. most numbers, each in min .. max */
    RULE_TEXTS,   /* an array of texts, none twice */
    RULE_OBJECT,  /* as `schema` says */
    RULE_OBJECTS, /* an array of such objects */
    RULE_MAP,     /* an object whose members are all indices into `of` */
    RULE_ANY
} RuleKind;

enum {
    RULE_REQUIRED = 1,
    RULE_ABOVE_MIN = 2, /* min itself is not allowed */
    RULE_MAY_BE_EMPTY = 4,
    RULE_WARNS = 8,      /* this member and what is below it only warn */
    RULE_HAS_RANGE = 16, /* min and max hold; otherwise any number will do */
    RULE_FROM_MIN = 32   /* min holds, there is no max */
};

typedef struct Rule {
    const char *name;
    RuleKind kind;
    unsigned flags;
    double min, max;
    int least, most; /* items of an array; most 0: as many as there are */
    const char *of;
    const struct Schema *schema;
} Rule;

typedef struct Check {
    GltfFile *file;
    Severity severity; /* of what is found here */
} Check;

typedef struct Schema {
    const char *name; /* "node": what extensions are asked by, and what messages say */
    const Rule *rules;
    int rule_count;
    bool is_ours; /* PARHELION_*: an unknown member is an error, not a warning */
    void (*more)(const Check *check, const GltfValue *value); /* NULL: the table says all */
} Schema;

/* An extension on one kind of object. */
typedef struct ExtensionRule {
    const char *name;
    const char *host;     /* the name of the schema it may stand on */
    const Schema *schema; /* NULL: its content is not looked into */
} ExtensionRule;

extern const Schema SCHEMA_ROOT;
extern const Schema SCHEMA_TEXTURE_INFO;

/* The rule for an extension on this host; *is_known: it may stand on some object. */
const ExtensionRule *extension_rule(const char *name, const char *host, bool *is_known);

/* What the program honours, so that it may be required. */
bool extension_is_supported(const char *name);

/* Checks a value and everything below it. */
void schema_check(const Check *check, const GltfValue *value, const Schema *schema);

/* A problem of the check's severity. */
void check_fails(const Check *check, const GltfValue *at, const char *format, ...)
    __attribute__((format(printf, 3, 4)));
void check_warns(const Check *check, const GltfValue *at, const char *format, ...)
    __attribute__((format(printf, 3, 4)));

/* ---- what tables cannot say ------------------------------------------------------------ */

/* check_document.c, check_graph.c ...: called for their objects by the tables. */
void check_asset(const Check *check, const GltfValue *asset);
void check_node(const Check *check, const GltfValue *node);
void check_camera(const Check *check, const GltfValue *camera);
void check_image(const Check *check, const GltfValue *image);
void check_buffer_view(const Check *check, const GltfValue *view);
void check_accessor(const Check *check, const GltfValue *accessor);
void check_mesh(const Check *check, const GltfValue *mesh);
void check_primitive(const Check *check, const GltfValue *primitive);
void check_skin(const Check *check, const GltfValue *skin);
void check_animation(const Check *check, const GltfValue *animation);
void check_light(const Check *check, const GltfValue *light);
void check_environment(const Check *check, const GltfValue *environment);
void check_display(const Check *check, const GltfValue *display);
void check_animation_pointer(const Check *check, const GltfValue *extension);
/* Of the whole document, after its objects. */
void check_extensions(const Check *check, const GltfValue *root);
void check_hierarchy(const Check *check, const GltfValue *root);
/* check_data.c: the bytes behind the accessors; only when everything else is sound. */
void check_data(GltfFile *file);
