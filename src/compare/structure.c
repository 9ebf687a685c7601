/* SPDX-License-Identifier: Apache-2.0 */
#include "compare/structure.h"

#include <ctype.h>
#include <stdio.h>
#include <string.h>

#include "base/count.h"
#include "base/number.h"
#include "compare/statistic/noisy_pair.h"

#define SHOWN 24 /* letters of a value that is shown */
#define NAMED 8  /* of a list */

/* ---- lists ------------------------------------------------------------------------------- */

const char *structure_joined(const Lines *list, int most) {
    const char *text = "";
    for (int i = 0; i < list->count && i < most; i++)
        text = arena_format(list->arena, "%s%s%s", text, i ? ", " : "", list->list[i]);
    if (list->count <= most) return text;
    return arena_format(list->arena, "%s and %d more", text, list->count - most);
}

static const char *plain_name(const char *name) {
    return strncmp(name, "parhelion:", 10) ? name : name + 10;
}

/* "seed (1, now 2)"; of long values the name alone. */
static void add_values(const char *name, const char *a, const char *b, Lines *to) {
    if (!a || !b) lines_add(to, "%s (only in the %s)", name, a ? "reference" : "test");
    else if (strlen(a) > SHOWN || strlen(b) > SHOWN || strchr(a, '\n') || strchr(b, '\n'))
        lines_add(to, "%s", name);
    else lines_add(to, "%s (%s, now %s)", name, a, b);
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
    while (next_input(&from, &line)) {
        bool found = has_input(other, &line, &same), is_listed = false;
        if (same) continue;
        const char *name = arena_string(to->arena, line.name, (size_t)line.name_length);
        lines_add(to, found ? "%s" : is_reference ? "%s (gone)" : "%s (new)", name);
        for (int i = 0; i < to->count - 1; i++)
            is_listed = is_listed || !strcmp(to->list[i], to->list[to->count - 1]);
        to->count -= is_listed;
    }
}

/* ---- settings ---------------------------------------------------------------------------- */

/* Lines "NAME\tVALUE" of an identity that are inputs, named elsewhere, or follow from others. */
static bool is_setting(const char *line) {
    static const char *const OTHERS[] = {
        "input ",   "version\t",          "isa\t",  "seed\t", "size\t",
        "layers\t", "decoded pictures\t", "field\t"};
    for (int i = 0; i < COUNT_OF(OTHERS); i++)
        if (!strncmp(line, OTHERS[i], strlen(OTHERS[i]))) return false;
    return strcspn(line, "\t") < strcspn(line, "\n");
}

/* The value of that line in another identity; NULL: it has none. */
static const char *setting_in(const char *list, const char *line, size_t name_length) {
    for (; *list; list += strcspn(list, "\n"), list += *list == '\n')
        if (!strncmp(list, line, name_length + 1)) return list + name_length + 1;
    return NULL;
}

/* Numbers of single precision with the digits that they have. */
static const char *rounded(const char *text, Arena *arena) {
    const char *last = strrchr(text, ' '), *number = last ? last + 1 : text;
    double value;
    const char *end = number_read(number, &value);
    return end && !*end ? arena_format(arena, "%.*s%.6g", (int)(number - text), text, value) : text;
}

/* Hashes are those of inputs. */
static bool has_hash(const char *text) {
    return strlen(text) > 16 && strspn(text + strlen(text) - 16, "0123456789abcdef") == 16;
}

/* What two values of a setting do not share, from and to a comma: "level 1", "level 0.8". */
static void add_setting(const char *line, size_t name_length, const char *other, Lines *to) {
    const char *value = line + name_length + 1;
    size_t length = strcspn(value, "\n"), other_length = strcspn(other, "\n"), first = 0, last = 0;
    size_t least = length < other_length ? length : other_length;
    if (length == other_length && !memcmp(value, other, length)) return;
    for (size_t i = 0; i < least && value[i] == other[i]; i++)
        if (value[i] == ',') first = i + 2;
    for (size_t i = 1; first + i <= least && value[length - i] == other[other_length - i]; i++)
        if (value[length - i] == ',') last = i;
    if (first + last > least) first = last = 0;
    const char *a = arena_string(to->arena, value + first, length - first - last);
    const char *b = arena_string(to->arena, other + first, other_length - first - last);
    bool is_display = !strncmp(line, "display ", 8) && first > 0;
    if (has_hash(a) || has_hash(b)) return;
    add_values(arena_format(to->arena, "%.*s%.*s", is_display ? 8 : (int)name_length, line,
                            is_display ? (int)strcspn(value, ",") : 0, value),
               rounded(a, to->arena), rounded(b, to->arena), to);
}

static void add_settings(const char *a, const char *b, Lines *to) {
    for (; *a; a += strcspn(a, "\n"), a += *a == '\n') {
        size_t name = strcspn(a, "\t");
        const char *other = is_setting(a) ? setting_in(b, a, name) : NULL;
        if (other) add_setting(a, name, other, to);
    }
}

/* ---- metadata ---------------------------------------------------------------------------- */

/* What explains a difference: inputs by their hashes, seed, samples, program, settings. */
static void find_causes(const FrameImage *reference, const FrameImage *test, Structure *out) {
    static const char *const NAMED_KEYS[][2] = {{"parhelion:seed", "seed"},
                                                {"parhelion:samples", "samples"},
                                                {"software", "program"},
                                                {"parhelion:isa", "isa"}};
    const char *a = frame_string(reference, "parhelion:inputs");
    const char *b = frame_string(test, "parhelion:inputs");
    out->knows_inputs = a && b;
    if (out->knows_inputs) {
        add_inputs(a, b, true, &out->inputs);
        add_inputs(b, a, false, &out->inputs);
    }
    for (int i = 0; i < COUNT_OF(NAMED_KEYS); i++) {
        a = frame_string(reference, NAMED_KEYS[i][0]);
        b = frame_string(test, NAMED_KEYS[i][0]);
        if (a && b && strcmp(a, b) != 0) add_values(NAMED_KEYS[i][1], a, b, &out->settings);
    }
    a = frame_string(reference, "parhelion:identity");
    b = frame_string(test, "parhelion:identity");
    if (a && b) add_settings(a, b, &out->settings);
}

/* The letters of a name up to the number at its end; 0 without one. */
static size_t stem_of(const char *name) {
    size_t length = strlen(name), stem = length;
    while (stem > 0 && isdigit((unsigned char)name[stem - 1])) stem--;
    return stem < length && stem > 0 && name[stem - 1] == '.' ? stem : 0;
}

/* One line, however many rows differ. */
static void report(const Structure *s, bool decides, const char *why, Lines *to) {
    const MetadataRow **rows = ARENA_NEW(to->arena, const MetadataRow *, s->metadata_count);
    Lines list = {.arena = to->arena};
    int count = 0;
    for (int i = 0; i < s->metadata_count; i++) {
        const MetadataRow *row = &s->metadata[i];
        bool is_inputs = s->knows_inputs && !strcmp(row->name, "parhelion:inputs");
        if (row->differs && !row->is_ignored && row->decides == decides &&
            (!is_inputs || s->inputs.count))
            rows[count++] = row;
    }
    for (int i = 0, kin; i < count; i += kin) { /* names stand in order */
        const char *name = plain_name(rows[i]->name);
        size_t stem = stem_of(name);
        for (kin = 1; stem && i + kin < count; kin++)
            if (strncmp(plain_name(rows[i + kin]->name), name, stem) != 0) break;
        if (kin > 1) lines_add(&list, "%.*s* (%d of them)", (int)stem, name, kin);
        else if (s->knows_inputs && !strcmp(name, "inputs"))
            lines_add(&list, "inputs (%s)", structure_joined(&s->inputs, 2));
        else add_values(name, rows[i]->reference, rows[i]->test, &list);
    }
    if (count)
        lines_add(to, "other metadata%s: %s%s",
                  decides ? " that decides what the picture shows" : "",
                  structure_joined(&list, NAMED), why);
}

/* ---- sizes and windows ------------------------------------------------------------------- */

static bool same_window(ExrWindow a, ExrWindow b) {
    return a.x0 == b.x0 && a.y0 == b.y0 && a.x1 == b.x1 && a.y1 == b.y1;
}

static bool compare_window(const char *what, ExrWindow a, ExrWindow b, Lines *reasons) {
    if (same_window(a, b)) return true;
    lines_add(reasons, "other %s window: %d,%d,%d,%d, now %d,%d,%d,%d", what, a.x0, a.y0, a.x1,
              a.y1, b.x0, b.y0, b.x1, b.y1);
    return false;
}

static bool compare_sizes(const CompareInput *reference, const CompareInput *test, Lines *reasons) {
    const Planes *a = &reference->light, *b = &test->light;
    bool ok = a->width == b->width && a->height == b->height;
    if (!ok)
        lines_add(reasons, "other size: %d x %d pixels, now %d x %d", a->width, a->height, b->width,
                  b->height);
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
    Structure out = {.same_pixels = compare_sizes(reference, test, reasons),
                     .inputs = {.arena = arena},
                     .settings = {.arena = arena}};
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
    out.shares_field =
        out.shares_paths && same_string(&reference->frame, &test->frame, "parhelion:field");
    compare_parts(reference, test, rules, reasons);
    if (reference->file == test->file && reference->file != LIGHT_FILE_FLOATS) {
        out.metadata =
            metadata_compare(&reference->frame, &test->frame, rules, arena, &out.metadata_count);
        find_causes(&reference->frame, &test->frame, &out);
        report(&out, true, "", reasons);
        report(&out, false, rules->strict ? " (--strict)" : "", rules->strict ? reasons : notes);
    }
    note_kinds(reference, test, notes);
    return out;
}
