/* SPDX-License-Identifier: Apache-2.0 */
#include "review/profile.h"

#include <math.h>
#include <string.h>

#include "base/count.h"
#include "base/file.h"
#include "record/rows.h"
#include "review/profile_table.h"
#include "text/nearest_word.h"
#include "vision/privacy.h"

#define LARGEST 1e9 /* of any number in a profile */
#define SOURCE(source, was_read) \
    TEXT("source", MUST | RECORD_FILLED, source, "Where it was read."), \
        FLAG("read_in_the_standard", MUST, was_read, "Was that the standard itself?")

/* ---- a limit ----------------------------------------------------------------------------- */

#define OWNER LimitSlope

static const RecordRow SLOPE[] = {
    NUMBER("per_arcmin", MUST | RECORD_ABOVE, per_arcmin, 0, LARGEST, NULL),
    NUMBER("reference_arcmin", MUST | RECORD_ABOVE, reference_arcmin, 0, LARGEST, NULL),
    VECTOR("heights_arcmin", MUST, from_arcmin, 2, 0, LARGEST,
           "The heights that it holds for, rising."),
    {0}};
#undef OWNER
_Static_assert(offsetof(LimitSlope, to_arcmin) ==
                   offsetof(LimitSlope, from_arcmin) + sizeof(double),
               "a pair");

static bool check_slope(const JsonView *view, void *item, Error *err) {
    const LimitSlope *slope = item;
    return slope->from_arcmin < slope->to_arcmin ||
           record_fails(view, "heights_arcmin", err,
                        "is [%g, %g], required: [LOW, HIGH] with LOW < HIGH", slope->from_arcmin,
                        slope->to_arcmin);
}

static const RecordFormat slope_format = {
    "slope", sizeof(LimitSlope), SLOPE, .check = check_slope,
    .doc = "For characters of these heights the limit is value + per_arcmin "
           "(reference_arcmin - height), for others there is none."};

static bool add_ambient(const JsonView *view, const char *word, bool *ambients, Error *err) {
    const char *known[AMBIENT_COUNT + 1];
    char advice[256];
    bool is_known = false;
    for (int i = 0; i < AMBIENT_COUNT; i++) known[i] = ambient_names[i];
    known[AMBIENT_COUNT] = "any";
    for (int i = 0; i < AMBIENT_COUNT; i++) {
        bool is_it = !strcmp(word, known[i]), is_any = !strcmp(word, known[AMBIENT_COUNT]);
        ambients[i] |= is_it || is_any;
        is_known |= is_it || is_any;
    }
    return is_known ||
           record_fails(view, "ambient", err, "is '%.60s', required: another word: %s", word,
                        nearest_word_advice(word, known, COUNT_OF(known), advice, sizeof advice));
}

/* One word, or several in an array. */
static bool read_ambients(const JsonView *view, const RecordRow *row, void *item, Error *err) {
    const json_t *value = json_object_get(view->object, row->key);
    bool *ambients = ((ProfileLimit *)item)->ambients;
    if (json_is_string(value)) return add_ambient(view, json_string_value(value), ambients, err);
    bool ok = json_array_size(value) > 0;
    for (size_t i = 0; ok && i < json_array_size(value); i++)
        ok = json_is_string(json_array_get(value, i));
    if (!ok)
        return record_fails(view, row->key, err,
                            "is no such word; required: night, twilight, "
                            "day, sun or any, or an array of them");
    for (size_t i = 0; i < json_array_size(value); i++)
        if (!add_ambient(view, json_string_value(json_array_get(value, i)), ambients, err))
            return false;
    return true;
}

/* Its kind was read before. */
static bool read_unit(const JsonView *view, const RecordRow *row, void *item, Error *err) {
    LimitKind kind = ((ProfileLimit *)item)->kind;
    RecordRow text = {.key = row->key, .kind = RECORD_TEXT};
    const char *unit;
    if (!record_read_kind(view, &text, &unit, err)) return false;
    return !strcmp(unit, quantities[kind]->unit) ||
           record_fails(view, row->key, err, "is '%.60s', required: '%s' for %s", unit,
                        quantities[kind]->unit, limit_kind_names[kind]);
}

static const char *const BOUNDS[] = {"least", "most", NULL};

static bool read_bound(const JsonView *view, const RecordRow *row, void *item, Error *err) {
    ProfileLimit *limit = item;
    const ReviewQuantity *of = quantities[limit->kind];
    int bound;
    if (!record_read_kind(view, row, &bound, err)) return false;
    limit->is_upper = bound;
    return !of->has_one_bound || limit->is_upper == of->is_upper ||
           record_fails(view, row->key, err, "is '%s', required: '%s' of %s", BOUNDS[bound],
                        BOUNDS[of->is_upper], limit_kind_names[limit->kind]);
}

#define AMBIENTS "{'enum': ['night', 'twilight', 'day', 'sun', 'any']}"

#define OWNER ProfileLimit

static const RecordRow LIMIT[] = {
    {"ambient", RECORD_OWN, MUST, .read = read_ambients,
     .schema =
         "{'oneOf': [" AMBIENTS ", {'type': 'array', 'minItems': 1, 'items': " AMBIENTS "}]}"},
    CHOICE("kind", MUST, kind, limit_kind_names, NULL),
    NUMBER("value", MUST | RECORD_ABOVE, value, 0, LARGEST,
           "In the kind's unit; of a modulation below 1."),
    {"unit", RECORD_OWN, MUST, .read = read_unit,
     .schema = "{'enum': ['1', 'arcmin', '%', 'cd/m2']}"},
    SOURCE(source, read_in_the_standard),
    TEXT("name", 0, name, "For reports; made of kind and ambient unless it is given."),
    {"bound", RECORD_CHOICE, .read = read_bound, .words = BOUNDS},
    FLAG("advice", 0, is_advice, "Preferred, not required: shown, and never fails."),
    PART("slope", slope, slope.has_slope, slope_format, NULL),
    {0}};
#undef OWNER

/* "contrast ratio, day, sun" or "stroke ratio at most". */
static const char *usual_name(const ProfileLimit *limit, Arena *arena) {
    char *name = arena_format(arena, "%s", limit_kind_names[limit->kind]);
    int count = 0;
    for (char *c = name; *c; c++)
        if (*c == '_') *c = ' ';
    if (limit->is_upper) name = arena_format(arena, "%s at most", name);
    for (int i = 0; i < AMBIENT_COUNT; i++) count += limit->ambients[i];
    for (int i = 0; i < AMBIENT_COUNT && count < AMBIENT_COUNT; i++)
        if (limit->ambients[i]) name = arena_format(arena, "%s, %s", name, ambient_names[i]);
    return name;
}

/* A slope leaves the least of the largest characters. */
static bool check_limit(const JsonView *view, void *item, Error *err) {
    ProfileLimit *limit = item;
    const LimitSlope *s = &limit->slope;
    double least = limit->value;
    if (s->has_slope) least += s->per_arcmin * (s->reference_arcmin - s->to_arcmin);
    if (!(least > 0))
        return record_fails(view, "slope", err,
                            "leads to a limit of %g at %g arc minutes, "
                            "required: one above 0",
                            least, s->to_arcmin);
    if (s->has_slope && quantities[limit->kind]->of > OF_PRIVATE)
        return record_fails(view, "slope", err,
                            "is by the height of characters, required: none of %s",
                            limit_kind_names[limit->kind]);
    if (quantities[limit->kind]->has_one_bound) limit->is_upper = quantities[limit->kind]->is_upper;
    double below = quantities[limit->kind]->below;
    if (below > 0 && limit->value >= below)
        return record_fails(view, "value", err, "is %g, required: less than %g: no %s is more",
                            limit->value, below, limit_kind_names[limit->kind]);
    if (!limit->name) limit->name = usual_name(limit, view->arena);
    return true;
}

static const RecordFormat limit_format = {
    "limit",
    sizeof(ProfileLimit),
    LIMIT,
    .check = check_limit,
    .doc = "Of any quantity: assets/schemas/profile.md lists them with their units.",
    .rules = "{'if': {'properties': {'kind': {'enum': ['character_height', "
             "'threshold_increment', 'gaze_veil', 'mirrored_sun']}}}, "
             "'else': {'properties': {'unit': {'const': '1'}}}}"};

/* ---- facts ------------------------------------------------------------------------------- */

#define OWNER ProfileFact

static const RecordRow FACT[] = {TEXT("name", MUST | RECORD_FILLED, name, NULL),
                                 TEXT("text", 0, text, NULL),
                                 NUMBER("value", 0, value, -LARGEST, LARGEST, NULL),
                                 TEXT("unit", 0, unit, NULL),
                                 SOURCE(source, read_in_the_standard),
                                 {0}};

#undef OWNER

static void start_fact(void *item) {
    *(ProfileFact *)item = (ProfileFact){.text = "", .unit = "", .value = NAN};
}

static bool check_fact(const JsonView *view, void *item, Error *err) {
    const ProfileFact *fact = item;
    if (isnan(fact->value) ? !fact->unit[0] && fact->text[0] : fact->unit[0] != 0) return true;
    return error_at(err, ERROR_INPUT, view->file, view->path,
                    "has no text and no value with its unit; required: a value with its unit, "
                    "a text, or all three");
}

static const RecordFormat fact_format = {
    "fact",
    sizeof(ProfileFact),
    FACT,
    .start = start_fact,
    .check = check_fact,
    .rules = "{'dependentRequired': {'value': ['unit'], 'unit': ['value']}, "
             "'anyOf': [{'required': ['text']}, {'required': ['value']}]}"};

/* ---- the whole --------------------------------------------------------------------------- */

#define OWNER Profile

static const RecordRow AMBIENT[] = {NUMBER("night_below_lx", MUST | RECORD_ABOVE, night_below_lx, 0,
                                           LARGEST, "Of the display's face."),
                                    NUMBER("twilight_below_lx", MUST | RECORD_ABOVE,
                                           twilight_below_lx, 0, LARGEST,
                                           "More than night_below_lx."),
                                    SOURCE(ambient_source, ambient_read_in_the_standard),
                                    {0}};

static bool check_ambient(const JsonView *view, void *item, Error *err) {
    const Profile *p = item;
    return p->night_below_lx < p->twilight_below_lx ||
           record_fails(view, "twilight_below_lx", err,
                        "is %g, required: more than night_below_lx, %g", p->twilight_below_lx,
                        p->night_below_lx);
}

static const RecordFormat ambient_format = {"ambient", sizeof(Profile), AMBIENT,
                                            .check = check_ambient};

static const RecordRow PROFILE[] = {
    TEXT("title", MUST | RECORD_FILLED, title, "The standard's, as a report prints it."),
    TEXT("edition", MUST | RECORD_FILLED, edition, NULL),
    TEXT("superseded_by", RECORD_FILLED, superseded_by,
         "The standard in its place, where it is no longer in force: every report says so."),
    FLAG("veil", 0, uses_veil,
         "Contrast counts with the veil that stray light in the eye lays over it."),
    NUMBER("threshold_increment_max_pct", RECORD_OPEN | RECORD_ABOVE, increment_most_pct, 0, 1000,
           "Of a gaze at a road that is lit by night, per cent. Your own: no profile that "
           "ships has one."),
    {"ambient", RECORD_OBJECT, MUST, .of = &ambient_format,
     .doc = "Which illuminance of a display's face is night, and which is twilight."},
    LIST("limits", MUST, limits, limit_count, 0, 0, limit_format, NULL),
    LIST("facts", 0, facts, fact_count, 0, 0, fact_format, "What readers should know."),
    {0}};

static void start_profile(void *item) {
    *(Profile *)item = (Profile){.increment_most_pct = NAN};
}

/* Of a threshold increment the least is what displays are dimmed to. */
static bool check_profile(const JsonView *view, void *item, Error *err) {
    Profile *p = item;
    bool has_key = !isnan(p->increment_most_pct);
    for (int i = 0; i < p->limit_count; i++) {
        if (p->limits[i].kind != LIMIT_THRESHOLD_INCREMENT || p->limits[i].is_advice) continue;
        if (has_key)
            return record_fails(view, "threshold_increment_max_pct", err,
                                "is there beside a limit of threshold_increment, required: one "
                                "of the two");
        p->increment_most_pct = fmin(p->increment_most_pct, p->limits[i].value);
    }
    return true;
}

const RecordFormat profile_format = {"profile",
                                     sizeof(Profile),
                                     PROFILE,
                                     .start = start_profile,
                                     .check = check_profile,
                                     .doc = "assets/schemas/profile.md explains the keys."};

/* ---- what must not be read --------------------------------------------------------------- */

static ProfileLimit security_of(double least, const char *source) {
    return (ProfileLimit){.name = "visual security",
                          .kind = LIMIT_VISUAL_SECURITY,
                          .ambients = {true, true, true, true},
                          .value = least,
                          .source = source};
}

const Profile *profile_with_security(const Profile *profile, double least, Arena *arena) {
    Profile *own = ARENA_NEW(arena, Profile, 1);
    *own = *profile;
    own->security = security_of(least, "the review's own: privacy, security_min_s");
    own->is_security_own = true;
    return own;
}

/* ---- where it stands --------------------------------------------------------------------- */

const char *profile_names(Arena *arena) {
    const char *names = "";
    for (int i = 0; i < profile_count; i++)
        names = arena_format(arena, "%s%s%s", names, i ? ", " : "", profile_table[i].name);
    return names;
}

/* One of the program's own, as if it were a file. */
static bool open_shipped(const char *name, Arena *arena, JsonView *out, Error *err) {
    for (int i = 0; i < profile_count; i++) {
        if (strcmp(name, profile_table[i].name)) continue;
        json_error_t fault;
        json_t *root = json_loads(profile_table[i].text, JSON_REJECT_DUPLICATES, &fault);
        const char *file = arena_format(arena, "assets/profiles/%s.json", name);
        if (!root) return error_at(err, ERROR_INPUT, file, "", "not valid JSON: %s", fault.text);
        *out = (JsonView){.object = root, .file = file, .path = "", .arena = arena};
        return true;
    }
    return error_set(err, ERROR_INPUT,
                     "there is no profile \"%s\"; required: %s, or a file by "
                     "a path that holds '/' or ends in .json",
                     name, profile_names(arena));
}

bool profile_load(const char *name_or_path, Arena *arena, const Profile **out, Error *err) {
    JsonView root;
    bool is_path = strchr(name_or_path, '/') || !strcmp(path_ending(name_or_path), ".json");
    bool ok = is_path ? json_view_open(name_or_path, arena, &root, err)
                      : open_shipped(name_or_path, arena, &root, err);
    if (!ok) return false;
    Profile *profile = ARENA_NEW(arena, Profile, 1);
    profile_format.start(profile);
    profile->id = arena_string(arena, name_or_path, strlen(name_or_path));
    profile->file_hash = root.hash;
    profile->security =
        security_of(SECURITY_OBSCURED, "assumed: from there on a picture is "
                                       "usually called obscured; no source of that was read");
    ok = record_read(&root, &profile_format, profile, err);
    json_view_close(&root);
    if (ok) *out = profile;
    return ok;
}

Ambient profile_ambient(const Profile *profile, double display_lux, bool sun_on_display) {
    if (sun_on_display) return AMBIENT_SUN;
    if (display_lux < profile->night_below_lx) return AMBIENT_NIGHT;
    return display_lux < profile->twilight_below_lx ? AMBIENT_TWILIGHT : AMBIENT_DAY;
}

bool profile_has(const Profile *profile, LimitKind kind) {
    for (int i = 0; i < profile->limit_count; i++)
        if (profile->limits[i].kind == kind) return true;
    return false;
}
