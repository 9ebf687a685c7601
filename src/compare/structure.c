/* SPDX-License-Identifier: Apache-2.0 */
#include "compare/structure.h"

#include <ctype.h>
#include <stdio.h>
#include <string.h>

#include "base/lines.h"
#include "compare/metadata.h"
#include "compare/statistic/noisy_pair.h"

/* ---- differences of metadata in words: one line, however many they are ------------------- */

#define SHOWN 72       /* letters of a value in a line of its own */
#define SHOWN_SHORT 24 /* letters of one among many */
#define NAMED 8        /* keys of a list */
#define NAMED_INPUTS 2 /* among other keys */

/* ---- lists ------------------------------------------------------------------------------- */

/* The first of a list with commas, and how many more there are. */
static const char *joined(const Lines *list, int most) {
    const char *text = "";
    for (int i = 0; i < list->count && i < most; i++)
        text = arena_format(list->arena, "%s%s%s", text, i ? ", " : "", list->list[i]);
    if (list->count <= most) return text;
    return arena_format(list->arena, "%s and %d more", text, list->count - most);
}

/* ---- values ------------------------------------------------------------------------------ */

/* The line of a text that begins at `at`, from `from` of its letters on, cut to what fits. */
static void shorten(const char *at, size_t from, char out[SHOWN + 12]) {
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
                         char out_b[SHOWN + 12]) {
    size_t line = 0, same = 0;
    while (a[same] && a[same] == b[same]) {
        if (a[same] == '\n') line = same + 1;
        same++;
    }
    size_t column = same - line, from = column > SHOWN - 24 ? column - 16 : 0;
    shorten(a + line, from, out_a);
    shorten(b + line, from, out_b);
}

/* ---- inputs ------------------------------------------------------------------------------ */

/* One line "HASH  PATH" of the list of inputs. */
typedef struct InputLine {
    const char *hash, *name; /* name: behind the path's last slash */
    int hash_length, name_length;
} InputLine;

/* The line at *list, which moves on to the next one; false at the end. */
static bool next_input(const char **list, InputLine *out) {
    const char *line = *list;
    size_t length = strcspn(line, "\n"), hash = strcspn(line, " \n");
    if (!*line) return false;
    const char *end = line + length, *name = hash + 2 <= length ? line + hash + 2 : end;
    for (const char *mark = name; mark < end; mark++)
        if (*mark == '/') name = mark + 1;
    *out = (InputLine){line, name, (int)hash, (int)(end - name)};
    *list = *end ? end + 1 : end;
    return true;
}

/* Whether the list has a file of this name, in any folder; *same: with these contents. */
static bool has_input(const char *list, const InputLine *wanted, bool *same) {
    InputLine line;
    bool found = false;
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

/* Adds which input files changed, or are on one side only. Folders make no difference: two
 * checkouts of one scene have the same inputs. */
static void add_inputs(const char *from, const char *other, bool is_reference, Lines *to) {
    InputLine line;
    bool same;
    while (next_input(&from, &line))
        if (!has_input(other, &line, &same))
            lines_add(to, "%.*s is only in the %s", line.name_length, line.name,
                      is_reference ? "reference" : "test");
        else if (is_reference && !same)
            lines_add(to, "%.*s has changed", line.name_length, line.name);
}

static bool is_inputs(const MetadataRow *row) {
    return !strcmp(row->name, "parhelion:inputs") && row->reference && row->test;
}

/* "" when only the folders differ. */
static const char *inputs_text(const MetadataRow *row, int most, Arena *arena) {
    Lines list = {.arena = arena};
    add_inputs(row->reference, row->test, true, &list);
    add_inputs(row->test, row->reference, false, &list);
    return joined(&list, most);
}

/* ---- one row ----------------------------------------------------------------------------- */

static const char *plain_name(const char *name) {
    return strncmp(name, "parhelion:", 10) ? name : name + 10;
}

/* The only one: with both values. */
static const char *whole_text(const MetadataRow *row, Arena *arena) {
    char a[SHOWN + 12], b[SHOWN + 12];
    if (is_inputs(row)) return arena_format(arena, "inputs: %s", inputs_text(row, NAMED, arena));
    if (!row->reference || !row->test)
        return arena_format(arena, "metadata %s is missing in the %s", plain_name(row->name),
                            row->reference ? "test" : "reference");
    shorten_both(row->reference, row->test, a, b);
    return arena_format(arena, "metadata %s differs: %s in the reference, %s in the test",
                        plain_name(row->name), a, b);
}

static bool is_short(const char *value) {
    return strlen(value) <= SHOWN_SHORT && !strchr(value, '\n');
}

/* One among many: its values where they are short. */
static const char *short_text(const MetadataRow *row, Arena *arena) {
    const char *name = plain_name(row->name);
    if (is_inputs(row))
        return arena_format(arena, "inputs (%s)", inputs_text(row, NAMED_INPUTS, arena));
    if (!row->reference || !row->test)
        return arena_format(arena, "%s (only in the %s)", name,
                            row->reference ? "reference" : "test");
    if (!is_short(row->reference) || !is_short(row->test)) return name;
    return arena_format(arena, "%s (%s, now %s)", name, row->reference, row->test);
}

/* ---- all rows ---------------------------------------------------------------------------- */

/* The letters of a name up to the number at its end; 0 without one. */
static size_t stem_of(const char *name) {
    size_t length = strlen(name), stem = length;
    while (stem > 0 && isdigit((unsigned char)name[stem - 1])) stem--;
    return stem < length && stem > 0 && name[stem - 1] == '.' ? stem : 0;
}

/* Rows of the list with the same stem, row i among them; *is_first: none stands before it. */
static int kin_of(const MetadataRow *const *rows, int count, int i, bool *is_first) {
    size_t stem = stem_of(rows[i]->name);
    int kin = 0;
    *is_first = true;
    if (!stem) return 1;
    for (int k = 0; k < count; k++) {
        if (stem_of(rows[k]->name) != stem || strncmp(rows[k]->name, rows[i]->name, stem) != 0)
            continue;
        if (k < i) *is_first = false;
        kin++;
    }
    return kin;
}

static const char *rows_text(const MetadataRow *const *rows, int count, Arena *arena) {
    Lines list = {.arena = arena};
    for (int i = 0; i < count; i++) {
        bool is_first;
        int kin = kin_of(rows, count, i, &is_first);
        const char *name = plain_name(rows[i]->name);
        if (!is_first) continue;
        if (kin > 1) lines_add(&list, "%.*s* (%d of them)", (int)stem_of(name), name, kin);
        else lines_add(&list, "%s", short_text(rows[i], arena));
    }
    return joined(&list, NAMED);
}

static bool is_listed(const MetadataRow *row, bool decides, Arena scratch) {
    if (!row->differs || row->is_ignored || row->decides != decides) return false;
    return !is_inputs(row) || inputs_text(row, NAMED, &scratch)[0];
}

static void report(const MetadataRow *rows, int count, bool decides, const char *why, Lines *to) {
    Arena *arena = to->arena;
    const MetadataRow **listed = ARENA_NEW(arena, const MetadataRow *, count);
    int n = 0;
    for (int i = 0; i < count; i++)
        if (is_listed(&rows[i], decides, *arena)) listed[n++] = &rows[i];
    if (n == 1) lines_add(to, "%s%s", whole_text(listed[0], arena), why);
    if (n > 1)
        lines_add(to, "metadata differs in %d keys%s: %s%s; all values: --json or --report", n,
                  decides ? " that decide what the picture shows" : "", rows_text(listed, n, arena),
                  why);
}

/* One reason for all rows that decide what the picture shows, one note (with `strict` a
 * reason) for all that explain it. A single row is reported with both values; of several, the
 * names, some values and their number. */
static void metadata_report(const MetadataRow *rows, int count, bool strict, Lines *reasons,
                            Lines *notes) {
    report(rows, count, true, "", reasons);
    report(rows, count, false, strict ? " (--strict)" : "", strict ? reasons : notes);
}

/* ---- sizes and windows ------------------------------------------------------------------- */

static bool same_window(ExrWindow a, ExrWindow b) {
    return a.x0 == b.x0 && a.y0 == b.y0 && a.x1 == b.x1 && a.y1 == b.y1;
}

static bool compare_window(const char *what, ExrWindow a, ExrWindow b, Lines *reasons) {
    if (same_window(a, b)) return true;
    lines_add(reasons,
              "the %s windows differ: %d,%d,%d,%d in the reference, %d,%d,%d,%d in "
              "the test",
              what, a.x0, a.y0, a.x1, a.y1, b.x0, b.y0, b.x1, b.y1);
    return false;
}

static bool compare_sizes(const CompareInput *reference, const CompareInput *test, Lines *reasons) {
    const Planes *a = &reference->light, *b = &test->light;
    bool ok = a->width == b->width && a->height == b->height;
    if (!ok)
        lines_add(reasons, "the sizes differ: %dx%d pixels in the reference, %dx%d in the test",
                  a->width, a->height, b->width, b->height);
    if (reference->kind != INPUT_FRAME) return ok;
    const FrameImage *f = &reference->frame, *g = &test->frame;
    bool display_ok = !ok || compare_window("display", f->display, g->display, reasons);
    bool data_ok = !ok || compare_window("data", f->data, g->data, reasons);
    return ok && display_ok && data_ok;
}

/* ---- channels ---------------------------------------------------------------------------- */

static bool has_beginning(const FrameImage *frame, const char *beginning, size_t length) {
    for (int i = 0; i < frame->channel_count; i++)
        if (!strncmp(frame->channels[i].name, beginning, length)) return true;
    return false;
}

/* The letters of what the other frame has nothing of: "light", or "light.sun" when it has other
 * lights, or the whole name. */
static size_t missing_length(const char *channel, const FrameImage *other) {
    for (const char *dot = strchr(channel, '.'); dot; dot = strchr(dot + 1, '.')) {
        size_t length = (size_t)(dot - channel);
        if (!has_beginning(other, channel, length + 1)) return length;
    }
    return strlen(channel);
}

/* Names of `from` that `other` lacks, with commas, "" when there is none: layers, or channels
 * of the picture itself, which have no dot. */
static const char *missing(const FrameImage *from, const FrameImage *other, bool wants_layers,
                           const CompareRules *rules, Arena *arena) {
    const char *names = "", *last = "";
    for (int i = 0; i < from->channel_count; i++) {
        const char *name = from->channels[i].name;
        if (frame_channel(other, name) || metadata_ignores(rules, name)) continue;
        if (!strchr(name, '.') == wants_layers) continue;
        name = arena_string(arena, name, missing_length(name, other));
        if (!strcmp(name, last)) continue; /* channels of a layer stand together */
        names = arena_format(arena, "%s%s%s", names, names[0] ? ", " : "", name);
        last = name;
    }
    return names;
}

static void compare_layers(const CompareInput *reference, const CompareInput *test,
                           const CompareRules *rules, Arena *arena, Lines *to) {
    const char *gone = missing(&reference->frame, &test->frame, true, rules, arena);
    const char *more = missing(&test->frame, &reference->frame, true, rules, arena);
    if (!gone[0] && !more[0]) return;
    lines_add(to, "layers that are not compared: %s%s%s%s%s%s",
              gone[0] ? "only the reference has " : "", gone, gone[0] && more[0] ? "; " : "",
              more[0] ? "only the test has " : "", more, rules->strict ? " (--strict)" : "");
}

static void compare_channels(const CompareInput *reference, const CompareInput *test,
                             const CompareRules *rules, Arena *arena, Lines *reasons) {
    const char *gone = missing(&reference->frame, &test->frame, false, rules, arena);
    const char *more = missing(&test->frame, &reference->frame, false, rules, arena);
    if (gone[0]) lines_add(reasons, "channels are missing in the test: %s", gone);
    if (more[0]) lines_add(reasons, "channels are missing in the reference: %s", more);
}

/* Codes are compared as light where their files say which they mean. */
static void compare_tags(const CompareInput *reference, const CompareInput *test, Lines *reasons,
                         Lines *notes) {
    const PictureTags *a = &reference->tags, *b = &test->tags;
    const char *texts[2] = {picture_tags_text(a, notes->arena), picture_tags_text(b, notes->arena)};
    for (int side = 0; side < 2; side++)
        if (texts[side][0])
            lines_add(notes, "the %s states %s", side ? "test" : "reference", texts[side]);
    if (a->is_known && b->is_known) return;
    if (a->digest == b->digest)
        lines_add(notes, "both state the same of their codes, which is not read: they are "
                         "taken for sRGB");
    else
        lines_add(reasons,
                  "what the %s states of its codes is not read (%s): required: sRGB, "
                  "a profile of a matrix and curves, gAMA and cHRM",
                  a->is_known ? "test" : "reference", a->is_known ? b->words : a->words);
}

static void compare_pictures(const CompareInput *reference, const CompareInput *test,
                             const CompareRules *rules, Lines *reasons, Lines *notes) {
    compare_tags(reference, test, reasons, notes);
    if (reference->bits != test->bits)
        lines_add(notes,
                  "the reference has %d bits, the test %d: codes are compared as "
                  "fractions",
                  reference->bits, test->bits);
    if (reference->has_alpha != test->has_alpha && !metadata_ignores(rules, "A"))
        lines_add(reasons, "only the %s is transparent in places (--ignore A leaves that out)",
                  reference->has_alpha ? "reference" : "test");
}

/* ---- files of light ---------------------------------------------------------------------- */

static const ExrPart *part_of(const CompareInput *input, const char *name) {
    for (int i = 0; i < input->frame.more_parts; i++)
        if (!strcmp(input->parts[i].name, name)) return &input->parts[i];
    return NULL;
}

/* Pixels are those of the first parts. Of others it is known whether they are the same. */
static void compare_part(const char *name, const ExrPart *a, const ExrPart *b, Lines *reasons) {
    char text[256];
    snprintf(text, sizeof text, "(--ignore %s leaves it out)", name);
    if (!a || !b)
        lines_add(reasons, "part %s is missing in the %s %s", name, a ? "test" : "reference", text);
    else if (!a->is_flat || !b->is_flat)
        lines_add(reasons,
                  "part %s is deep, or has channels coarser than its pixels, and is "
                  "not compared %s",
                  name, text);
    else if (a->digest != b->digest)
        lines_add(reasons, "part %s differs: pixels are compared of the first part alone %s", name,
                  text);
}

static void compare_parts(const CompareInput *reference, const CompareInput *test,
                          const CompareRules *rules, Lines *reasons) {
    for (int i = 0; i < reference->frame.more_parts; i++) {
        const char *name = reference->parts[i].name;
        if (!metadata_ignores(rules, name))
            compare_part(name, &reference->parts[i], part_of(test, name), reasons);
    }
    for (int i = 0; i < test->frame.more_parts; i++) {
        const char *name = test->parts[i].name;
        if (!metadata_ignores(rules, name) && !part_of(reference, name))
            compare_part(name, NULL, &test->parts[i], reasons);
    }
}

/* Pixels are those of the first pages. Of others it is known whether they are the same bytes. */
static void compare_pages(const PicturePages *a, const PicturePages *b, Lines *reasons,
                          Lines *notes) {
    if (a->count != b->count)
        lines_add(reasons, "the numbers of %s differ: %d in the reference, %d in the test",
                  a->count > 1 ? a->name : b->name, a->count, b->count);
    else if (a->digest != b->digest)
        lines_add(reasons,
                  "%s behind the first differ in their bytes (%d of them): pixels are compared of "
                  "the first alone; make each a picture of its own to compare it",
                  a->name, a->count - 1);
    else if (a->count > 1)
        lines_add(notes, "of %d %s the first are compared, the others are the same bytes", a->count,
                  a->name);
}

static void note_problems(const Problems *problems, Lines *notes) {
    for (int i = 0; i < problems->count; i++) {
        const Problem *p = &problems->list[i];
        lines_add(notes, "%s: %s%s%s", p->file, p->path, p->path[0] ? ": " : "", p->message);
    }
}

static void note_kinds(const CompareInput *reference, const CompareInput *test, Lines *notes) {
    note_problems(&reference->problems, notes);
    note_problems(&test->problems, notes);
    if (reference->file == LIGHT_FILE_FLOATS || test->file == LIGHT_FILE_FLOATS)
        lines_add(notes, "%s carries no metadata and no unit: its light is taken for cd/m2",
                  reference->file == LIGHT_FILE_FLOATS ? "the reference" : "the test");
    else if (reference->file != test->file)
        lines_add(notes, "the %s is a Radiance picture: its metadata is not compared",
                  reference->file == LIGHT_FILE_RADIANCE ? "reference" : "test");
}

/* ---- both ------------------------------------------------------------------------------- */

static bool same_string(const FrameImage *a, const FrameImage *b, const char *name) {
    const char *one = frame_string(a, name), *other = frame_string(b, name);
    return one && other ? !strcmp(one, other) : one == other;
}

Structure structure_compare(const CompareInput *reference, const CompareInput *test,
                            const CompareRules *rules, Arena *arena, Lines *reasons, Lines *notes) {
    Structure out = {.same_pixels = compare_sizes(reference, test, reasons)};
    compare_pages(&reference->pages, &test->pages, reasons, notes);
    if (reference->kind == INPUT_PICTURE) {
        compare_pictures(reference, test, rules, reasons, notes);
        return out;
    }
    compare_channels(reference, test, rules, arena, reasons);
    compare_layers(reference, test, rules, arena, rules->strict ? reasons : notes);
    out.shares_paths = noisy_pair_shares_noise(&reference->frame, &test->frame) &&
                       same_string(&reference->frame, &test->frame, "parhelion:isa") &&
                       same_string(&reference->frame, &test->frame, "software");
    compare_parts(reference, test, rules, reasons);
    if (reference->file == test->file && reference->file != LIGHT_FILE_FLOATS) {
        out.metadata =
            metadata_compare(&reference->frame, &test->frame, rules, arena, &out.metadata_count);
        metadata_report(out.metadata, out.metadata_count, rules->strict, reasons, notes);
    }
    note_kinds(reference, test, notes);
    return out;
}
