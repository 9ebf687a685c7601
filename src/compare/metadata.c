#include "compare/metadata.h"

#include <stdio.h>
#include <string.h>

#include "image/colour.h"

#define SHOWN 72 /* letters of a value in a line */

/* ---- what is left out and what decides --------------------------------------------------- */

static bool begins_with_layer(const char *name, const char *layer)
{
    size_t length = strlen(layer);
    return !strncmp(name, layer, length) && (!name[length] || name[length] == '.');
}

bool metadata_ignores(const CompareRules *rules, const char *name)
{
    static const char OWN[] = "parhelion:";
    const char *plain = strncmp(name, OWN, sizeof OWN - 1) ? name : name + sizeof OWN - 1;
    for (int i = 0; i < rules->ignored_count; i++)
        if (begins_with_layer(name, rules->ignored[i]) ||
            begins_with_layer(plain, rules->ignored[i]))
            return true;
    return false;
}

/* What decides the picture, by the whole name or, with a dot at the end, by its beginning. */
static const char *const DECIDING[] = {
    "chromaticities",      "whiteLuminance",       "adoptedNeutral",    "worldToCamera",
    "worldToNDC",          "pixelAspectRatio",     "screenWindowWidth", "parhelion:unit",
    "parhelion:camera",    "parhelion:yfov_deg",   "parhelion:ymag_m",  "parhelion:maxBounces",
    "parhelion:unbiased",  "parhelion:complete",   "parhelion:part.",   "parhelion:display.",
};

static bool decides(const char *name)
{
    for (size_t i = 0; i < sizeof DECIDING / sizeof *DECIDING; i++) {
        size_t length = strlen(DECIDING[i]);
        bool   is_prefix = DECIDING[i][length - 1] == '.';
        if (!strncmp(name, DECIDING[i], length) && (is_prefix || !name[length])) return true;
    }
    return false;
}

/* ---- values as text ---------------------------------------------------------------------- */

static int value_count(ExrKind kind)
{
    switch (kind) {
    case EXR_STRING: return 0;
    case EXR_CHROMATICITIES: return 8;
    case EXR_MATRIX44: return 16;
    default: return 1;
    }
}

static const char *value_text(const ExrAttribute *attribute, Arena *arena)
{
    if (!attribute) return NULL;
    if (attribute->kind == EXR_STRING) return attribute->text ? attribute->text : "";
    const char *text = "";
    for (int i = 0; i < value_count(attribute->kind); i++)
        text = arena_format(arena, "%s%s%.9g", text, i ? " " : "", attribute->values[i]);
    return text;
}

/* Numbers by their bits, so that what prints alike and is not still differs. */
static bool same_value(const ExrAttribute *a, const ExrAttribute *b)
{
    if (!a || !b || a->kind != b->kind) return false;
    if (a->kind == EXR_STRING) return !strcmp(a->text ? a->text : "", b->text ? b->text : "");
    for (int i = 0; i < value_count(a->kind); i++) {
        bool both_nan = a->values[i] != a->values[i] && b->values[i] != b->values[i];
        if (!both_nan && a->values[i] != b->values[i]) return false;
    }
    return true;
}

/* What a file means when it says nothing: writing it down changes no picture. */
static bool is_default(const ExrAttribute *attribute)
{
    if (!strcmp(attribute->name, "chromaticities"))
        return attribute->kind == EXR_CHROMATICITIES &&
               chromaticities_are_rec709(attribute->values);
    return !strcmp(attribute->name, "pixelAspectRatio") && attribute->values[0] == 1;
}

static MetadataRow row_of(const char *name, const FrameImage *reference, const FrameImage *test,
                          const CompareRules *rules, Arena *arena)
{
    const ExrAttribute *a = frame_attribute(reference, name), *b = frame_attribute(test, name);
    bool is_implied = (!a || !b) && is_default(a ? a : b);
    return (MetadataRow){name, value_text(a, arena), value_text(b, arena), !same_value(a, b),
                         decides(name) && !is_implied, metadata_ignores(rules, name)};
}

MetadataRow *metadata_compare(const FrameImage *reference, const FrameImage *test,
                              const CompareRules *rules, Arena *arena, int *count)
{
    MetadataRow *rows = ARENA_NEW(arena, MetadataRow,
                                  reference->attribute_count + test->attribute_count);
    int          n = 0;
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

/* ---- lines ------------------------------------------------------------------------------- */

/* The line of a text that begins at `at`, from `from` of its letters on, cut to what fits. */
static void shorten(const char *at, size_t from, char out[SHOWN + 12])
{
    size_t length = strcspn(at, "\n");
    if (from > length) from = length;
    while (from > 0 && ((unsigned char)at[from] & 0xc0) == 0x80) from--;
    size_t rest = length - from > SHOWN ? SHOWN : length - from;
    while (rest > 0 && rest < length - from && ((unsigned char)at[from + rest] & 0xc0) == 0x80)
        rest--;
    snprintf(out, SHOWN + 12, "%s%.*s%s", from ? "…" : "", (int)rest, at + from,
             rest < length - from ? "…" : "");
}

/* Both values where they begin to differ: the first such line, and of a long one the part from
 * shortly before. */
static void shorten_both(const char *a, const char *b, char out_a[SHOWN + 12],
                         char out_b[SHOWN + 12])
{
    size_t line = 0, same = 0;
    while (a[same] && a[same] == b[same]) {
        if (a[same] == '\n') line = same + 1;
        same++;
    }
    size_t column = same - line, from = column > SHOWN - 24 ? column - 16 : 0;
    shorten(a + line, from, out_a);
    shorten(b + line, from, out_b);
}

static const char *plain_name(const char *name)
{
    return strncmp(name, "parhelion:", 10) ? name : name + 10;
}

static void add_line(const MetadataRow *row, Lines *to, const char *why)
{
    char a[SHOWN + 12], b[SHOWN + 12];
    if (!row->reference || !row->test) {
        lines_add(to, "metadata %s is missing in the %s%s", plain_name(row->name),
                  row->reference ? "test" : "reference", why);
        return;
    }
    shorten_both(row->reference, row->test, a, b);
    lines_add(to, "metadata %s differs: %s in the reference, %s in the test%s",
              plain_name(row->name), a, b, why);
}

/* One line "HASH  PATH" of the list of inputs. */
typedef struct InputLine {
    const char *hash, *name; /* name: behind the path's last slash */
    int         hash_length, name_length;
} InputLine;

/* The line at *list, which moves on to the next one; false at the end. */
static bool next_input(const char **list, InputLine *out)
{
    const char *line = *list;
    size_t      length = strcspn(line, "\n"), hash = strcspn(line, " \n");
    if (!*line) return false;
    const char *end = line + length, *name = hash + 2 <= length ? line + hash + 2 : end;
    for (const char *mark = name; mark < end; mark++)
        if (*mark == '/') name = mark + 1;
    *out = (InputLine){line, name, (int)hash, (int)(end - name)};
    *list = *end ? end + 1 : end;
    return true;
}

/* Whether the list has a file of this name, in whatever folder; *same: with these contents. */
static bool has_input(const char *list, const InputLine *wanted, bool *same)
{
    InputLine line;
    bool      found = false;
    *same = false;
    while (!*same && next_input(&list, &line)) {
        if (line.name_length != wanted->name_length ||
            memcmp(line.name, wanted->name, (size_t)line.name_length) != 0)
            continue;
        found = true;
        *same = line.hash_length == wanted->hash_length &&
                !memcmp(line.hash, wanted->hash, (size_t)line.hash_length);
    }
    return found;
}

/* Which input files changed, or are on one side only. Folders make no difference: two checkouts
 * of one scene have the same inputs. */
static void add_inputs(const char *from, const char *other, bool is_reference, Lines *to)
{
    InputLine line;
    bool      same;
    while (next_input(&from, &line))
        if (!has_input(other, &line, &same))
            lines_add(to, "input %.*s is only in the %s", line.name_length, line.name,
                      is_reference ? "reference" : "test");
        else if (is_reference && !same)
            lines_add(to, "input %.*s has changed", line.name_length, line.name);
}

void metadata_report(const MetadataRow *rows, int count, bool strict, Lines *reasons,
                     Lines *notes)
{
    for (int i = 0; i < count; i++) {
        const MetadataRow *row = &rows[i];
        bool               is_reason = row->decides || strict;
        if (!row->differs || row->is_ignored) continue;
        if (!strcmp(row->name, "parhelion:inputs") && row->reference && row->test) {
            add_inputs(row->reference, row->test, true, is_reason ? reasons : notes);
            add_inputs(row->test, row->reference, false, is_reason ? reasons : notes);
        } else {
            add_line(row, is_reason ? reasons : notes,
                     is_reason && !row->decides ? " (--strict)" : "");
        }
    }
}
