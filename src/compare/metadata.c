/* SPDX-License-Identifier: Apache-2.0 */
#include "compare/metadata.h"

#include <string.h>

#include "base/count.h"

/* ---- what is left out and what decides --------------------------------------------------- */

static bool begins_with_layer(const char *name, const char *layer) {
    size_t length = strlen(layer);
    return !strncmp(name, layer, length) && (!name[length] || name[length] == '.');
}

bool metadata_ignores(const CompareRules *rules, const char *name) {
    static const char OWN[] = "parhelion:";
    const char *plain = strncmp(name, OWN, sizeof OWN - 1) ? name : name + sizeof OWN - 1;
    for (int i = 0; i < rules->ignored_count; i++)
        if (begins_with_layer(name, rules->ignored[i]) ||
            begins_with_layer(plain, rules->ignored[i]))
            return true;
    return false;
}

/* Attributes that decide the picture, by their whole names or, with a dot at the end,
 * prefixes. */
static const char *const DECIDING[] = {
    "adoptedNeutral",
    "envmap",
    "view",
    "worldToCamera",
    "worldToNDC",
    "pixelAspectRatio",
    "screenWindowWidth",
    "screenWindowCenter",
    "parhelion:unit",
    "parhelion:camera",
    "parhelion:yfov_deg",
    "parhelion:ymag_m",
    "parhelion:maxBounces",
    "parhelion:projection",
    "VIEW",
    "parhelion:unbiased",
    "parhelion:complete",
    "parhelion:part.",
    "parhelion:display.",
};

static bool decides(const char *name) {
    for (size_t i = 0; i < sizeof DECIDING / sizeof *DECIDING; i++) {
        size_t length = strlen(DECIDING[i]);
        bool is_prefix = DECIDING[i][length - 1] == '.';
        if (!strncmp(name, DECIDING[i], length) && (is_prefix || !name[length])) return true;
    }
    return false;
}

/* ---- values as text ---------------------------------------------------------------------- */

static int value_count(ExrKind kind) {
    switch (kind) {
    case EXR_STRING:
    case EXR_OTHER: return 0;
    case EXR_CHROMATICITIES: return 8;
    case EXR_MATRIX44: return 16;
    default: return 1;
    }
}

static bool has_text(const ExrAttribute *attribute) {
    return attribute->kind == EXR_STRING || attribute->kind == EXR_OTHER;
}

static const char *value_text(const ExrAttribute *attribute, Arena *arena) {
    if (!attribute) return NULL;
    if (has_text(attribute)) return attribute->text ? attribute->text : "";
    const char *text = "";
    for (int i = 0; i < value_count(attribute->kind); i++)
        text = arena_format(arena, "%s%s%.9g", text, i ? " " : "", attribute->values[i]);
    return text;
}

/* Numbers by their bits, so that what prints alike and is not still differs. */
static bool same_value(const ExrAttribute *a, const ExrAttribute *b) {
    if (!a || !b || a->kind != b->kind) return false;
    if (has_text(a)) return !strcmp(a->text ? a->text : "", b->text ? b->text : "");
    for (int i = 0; i < value_count(a->kind); i++) {
        bool both_nan = a->values[i] != a->values[i] && b->values[i] != b->values[i];
        if (!both_nan && a->values[i] != b->values[i]) return false;
    }
    return true;
}

/* Whether it has the value that a missing attribute stands for: such a one changes no picture.
 * What a file says of its light is applied when it is read, and these two are the same in all
 * frames; those that stand in their place explain (frame.h). */
static bool is_default(const ExrAttribute *attribute) {
    return !strcmp(attribute->name, "chromaticities") ||
           !strcmp(attribute->name, "whiteLuminance") ||
           (!strcmp(attribute->name, "pixelAspectRatio") && attribute->values[0] == 1);
}

static bool has_attributes(const FrameImage *frame, const char *prefix) {
    for (int i = 0; i < frame->attribute_count; i++)
        if (!strncmp(frame->attributes[i].name, prefix, strlen(prefix))) return true;
    return false;
}

/* The names of a layer's numbers, which a frame without that layer lacks. */
static bool names_missing_layer(const char *name, const FrameImage *other) {
    static const char *const PREFIXES[] = {"parhelion:part.", "parhelion:display."};
    for (int i = 0; i < COUNT_OF(PREFIXES); i++)
        if (!strncmp(name, PREFIXES[i], strlen(PREFIXES[i])))
            return !has_attributes(other, PREFIXES[i]);
    return false;
}

static MetadataRow row_of(const char *name, const FrameImage *reference, const FrameImage *test,
                          const CompareRules *rules, Arena *arena) {
    const ExrAttribute *a = frame_attribute(reference, name), *b = frame_attribute(test, name);
    bool is_implied =
        (!a || !b) && (is_default(a ? a : b) || names_missing_layer(name, a ? test : reference));
    return (MetadataRow){name,
                         value_text(a, arena),
                         value_text(b, arena),
                         !same_value(a, b),
                         decides(name) && !is_implied,
                         metadata_ignores(rules, name)};
}

MetadataRow *metadata_compare(const FrameImage *reference, const FrameImage *test,
                              const CompareRules *rules, Arena *arena, int *count) {
    MetadataRow *rows =
        ARENA_NEW(arena, MetadataRow, reference->attribute_count + test->attribute_count);
    int n = 0;
    for (int i = 0; i < reference->attribute_count; i++)
        rows[n++] = row_of(reference->attributes[i].name, reference, test, rules, arena);
    for (int i = 0; i < test->attribute_count; i++) {
        const char *name = test->attributes[i].name;
        if (!frame_attribute(reference, name))
            rows[n++] = row_of(name, reference, test, rules, arena);
    }
    *count = n;
    return rows;
}
