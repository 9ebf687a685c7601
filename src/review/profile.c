/* SPDX-License-Identifier: Apache-2.0 */
#include "review/profile.h"

#include <jansson.h>
#include <math.h>
#include <string.h>

#include "base/count.h"
#include "base/file.h"
#include "review/profile_table.h"
#include "text/json_view.h"
#include "text/nearest_word.h"

#define LARGEST 1e9 /* of any number in a profile */

/* ---- values of any object ---------------------------------------------------------------- */

static bool missing(const JsonView *view, const char *key, Error *err)
{
    return error_at(err, ERROR_INPUT, view->file, view->path, "key '%s' is missing", key);
}

/* A text with something in it. */
static bool read_text(const JsonView *view, const char *key, const char **out, Error *err)
{
    *out = NULL;
    if (!json_view_text(view, key, out, err)) return false;
    if (!*out) return missing(view, key, err);
    return **out || error_at(err, ERROR_INPUT, view->file, json_view_path(view, key),
                             "is an empty text");
}

/* Absent: *out keeps its value, or an error when required. */
static bool read_bool(const JsonView *view, const char *key, bool required, bool *out,
                      Error *err)
{
    const json_t *value = json_object_get(view->object, key);
    if (!value) return !required || missing(view, key, err);
    if (!json_is_boolean(value))
        return error_at(err, ERROR_INPUT, view->file, json_view_path(view, key),
                        "wanted true or false");
    *out = json_is_true(value);
    return true;
}

/* A number above 0. */
static bool read_number(const JsonView *view, const char *key, double *out, Error *err)
{
    double value = NAN;
    if (!json_view_number(view, key, -LARGEST, LARGEST, &value, err)) return false;
    if (isnan(value)) return missing(view, key, err);
    if (!(value > 0))
        return error_at(err, ERROR_INPUT, view->file, json_view_path(view, key),
                        "is %g, wanted a number above 0", value);
    *out = value;
    return true;
}

/* The source, which every number of a profile must name. */
static bool read_source(const JsonView *view, const char **source, bool *was_read, Error *err)
{
    return read_text(view, "source", source, err) &&
           read_bool(view, "read_in_the_standard", true, was_read, err);
}

/* The word's place among the known ones. */
static bool find_word(const JsonView *view, const char *key, const char *word,
                      const char *const *known, int count, Error *err)
{
    char advice[256];
    for (int i = 0; i < count; i++)
        if (!strcmp(word, known[i])) return true;
    return error_at(err, ERROR_INPUT, view->file, json_view_path(view, key), "is \"%s\"; %s",
                    word, nearest_word_advice(word, known, count, advice, sizeof advice));
}

/* The list's item as an object. */
static bool item_of(const JsonView *list_view, const char *key, int i, JsonView *out,
                    Error *err)
{
    json_t     *item = json_array_get(json_object_get(list_view->object, key), (size_t)i);
    const char *path = arena_format(list_view->arena, "%s/%s/%d", list_view->path, key, i);
    if (!json_is_object(item))
        return error_at(err, ERROR_INPUT, list_view->file, path, "wanted an object");
    *out = *list_view;
    out->object = item;
    out->path = path;
    return true;
}

/* How many; an absent list has none. */
static bool list_length(const JsonView *view, const char *key, int *out, Error *err)
{
    const json_t *list = json_object_get(view->object, key);
    if (list && !json_is_array(list))
        return error_at(err, ERROR_INPUT, view->file, json_view_path(view, key),
                        "wanted an array of objects");
    *out = (int)json_array_size(list);
    return true;
}

/* ---- a limit ----------------------------------------------------------------------------- */

static bool add_ambient(const JsonView *view, const char *word, bool *ambients, Error *err)
{
    static const char *const ANY = "any";
    const char *known[AMBIENT_COUNT + 1];
    for (int i = 0; i < AMBIENT_COUNT; i++) known[i] = ambient_names[i];
    known[AMBIENT_COUNT] = ANY;
    if (!find_word(view, "ambient", word, known, COUNT_OF(known), err)) return false;
    for (int i = 0; i < AMBIENT_COUNT; i++)
        if (!strcmp(word, ANY) || !strcmp(word, ambient_names[i])) ambients[i] = true;
    return true;
}

/* One word, or several in an array. */
static bool read_ambients(const JsonView *view, bool *ambients, Error *err)
{
    const json_t *value = json_object_get(view->object, "ambient");
    if (!value) return missing(view, "ambient", err);
    if (json_is_string(value))
        return add_ambient(view, json_string_value(value), ambients, err);
    bool ok = json_array_size(value) > 0;
    for (size_t i = 0; ok && i < json_array_size(value); i++)
        ok = json_is_string(json_array_get(value, i));
    if (!ok)
        return error_at(err, ERROR_INPUT, view->file, json_view_path(view, "ambient"),
                        "wanted night, twilight, day, sun or any, or an array of them");
    for (size_t i = 0; i < json_array_size(value); i++)
        if (!add_ambient(view, json_string_value(json_array_get(value, i)), ambients, err))
            return false;
    return true;
}

static bool read_kind(const JsonView *view, LimitKind *out, Error *err)
{
    const char *known[LIMIT_KIND_COUNT], *word, *unit;
    for (int i = 0; i < LIMIT_KIND_COUNT; i++) known[i] = limit_kinds[i].name;
    if (!read_text(view, "kind", &word, err) ||
        !find_word(view, "kind", word, known, COUNT_OF(known), err) ||
        !read_text(view, "unit", &unit, err))
        return false;
    int kind = 0;
    while (strcmp(word, known[kind])) kind++;
    if (strcmp(unit, limit_kinds[kind].unit))
        return error_at(err, ERROR_INPUT, view->file, json_view_path(view, "unit"),
                        "is \"%s\", wanted \"%s\" for %s", unit, limit_kinds[kind].unit, word);
    *out = (LimitKind)kind;
    return true;
}

static bool read_slope(const JsonView *view, LimitSlope *out, Error *err)
{
    static const char *const KEYS[] = {"per_arcmin", "reference_arcmin", "heights_arcmin"};
    JsonView slope;
    double   ends[2];
    int      count = 0;
    if (!json_view_child(view, "slope", false, &slope, err)) return false;
    if (!slope.object) return true;
    if (!json_view_check_keys(&slope, KEYS, COUNT_OF(KEYS), err) ||
        !read_number(&slope, KEYS[0], &out->per_arcmin, err) ||
        !read_number(&slope, KEYS[1], &out->reference_arcmin, err) ||
        !json_view_numbers(&slope, KEYS[2], (JsonRange){0, LARGEST, 2}, ends, &count, err))
        return false;
    if (count != 2 || !(ends[0] < ends[1]))
        return error_at(err, ERROR_INPUT, slope.file, json_view_path(&slope, KEYS[2]),
                        "wanted [LOW, HIGH] with LOW < HIGH");
    out->from_arcmin = ends[0];
    out->to_arcmin = ends[1];
    out->has_slope = true;
    return true;
}

/* "contrast ratio, day, sun" or "stroke ratio at most". */
static const char *usual_name(const ProfileLimit *limit, Arena *arena)
{
    char *name = arena_format(arena, "%s", limit_kinds[limit->kind].name);
    int   count = 0;
    for (char *c = name; *c; c++)
        if (*c == '_') *c = ' ';
    if (limit->is_upper) name = arena_format(arena, "%s at most", name);
    for (int i = 0; i < AMBIENT_COUNT; i++) count += limit->ambients[i];
    for (int i = 0; i < AMBIENT_COUNT && count < AMBIENT_COUNT; i++)
        if (limit->ambients[i]) name = arena_format(arena, "%s, %s", name, ambient_names[i]);
    return name;
}

/* A slope asks the least of the largest characters. */
static bool check_value(const JsonView *view, const ProfileLimit *limit, Error *err)
{
    const LimitSlope *s = &limit->slope;
    double least = limit->value;
    if (s->has_slope) least += s->per_arcmin * (s->reference_arcmin - s->to_arcmin);
    if (!(least > 0))
        return error_at(err, ERROR_INPUT, view->file, json_view_path(view, "slope"),
                        "leads to a limit of %g at %g arc minutes, wanted one above 0", least,
                        s->to_arcmin);
    if (limit->kind == LIMIT_MODULATION && limit->value >= 1)
        return error_at(err, ERROR_INPUT, view->file, json_view_path(view, "value"),
                        "is %g, wanted less than 1: no modulation is more", limit->value);
    return true;
}

static bool read_limit(const JsonView *view, ProfileLimit *out, Error *err)
{
    static const char *const KEYS[] = {"ambient", "kind", "value", "unit", "source",
                                       "read_in_the_standard", "name", "bound", "advice",
                                       "slope"};
    static const char *const BOUNDS[] = {"least", "most"};
    const char *bound = BOUNDS[0];
    if (!json_view_check_keys(view, KEYS, COUNT_OF(KEYS), err) ||
        !read_ambients(view, out->ambients, err) || !read_kind(view, &out->kind, err) ||
        !read_number(view, "value", &out->value, err) ||
        !read_source(view, &out->source, &out->read_in_the_standard, err) ||
        !json_view_text(view, "name", &out->name, err) ||
        !json_view_text(view, "bound", &bound, err) ||
        !find_word(view, "bound", bound, BOUNDS, COUNT_OF(BOUNDS), err) ||
        !read_bool(view, "advice", false, &out->is_advice, err) ||
        !read_slope(view, &out->slope, err) || !check_value(view, out, err))
        return false;
    out->is_upper = !strcmp(bound, BOUNDS[1]);
    if (!out->name) out->name = usual_name(out, view->arena);
    return true;
}

static bool read_limits(const JsonView *root, Profile *out, Error *err)
{
    JsonView item;
    if (!json_object_get(root->object, "limits")) return missing(root, "limits", err);
    if (!list_length(root, "limits", &out->limit_count, err)) return false;
    ProfileLimit *limits = ARENA_NEW(root->arena, ProfileLimit, out->limit_count);
    for (int i = 0; i < out->limit_count; i++)
        if (!item_of(root, "limits", i, &item, err) || !read_limit(&item, &limits[i], err))
            return false;
    out->limits = limits;
    return true;
}

/* ---- facts ------------------------------------------------------------------------------- */

static bool read_fact(const JsonView *view, ProfileFact *out, Error *err)
{
    static const char *const KEYS[] = {"name", "text", "value", "unit", "source",
                                       "read_in_the_standard"};
    *out = (ProfileFact){.text = "", .unit = "", .value = NAN};
    if (!json_view_check_keys(view, KEYS, COUNT_OF(KEYS), err) ||
        !read_text(view, "name", &out->name, err) ||
        !json_view_text(view, "text", &out->text, err) ||
        !json_view_number(view, "value", -LARGEST, LARGEST, &out->value, err) ||
        !json_view_text(view, "unit", &out->unit, err) ||
        !read_source(view, &out->source, &out->read_in_the_standard, err))
        return false;
    if (isnan(out->value) ? !out->unit[0] && out->text[0] : out->unit[0] != 0) return true;
    return error_at(err, ERROR_INPUT, view->file, view->path,
                    "wanted a value with its unit, a text, or all three");
}

static bool read_facts(const JsonView *root, Profile *out, Error *err)
{
    JsonView item;
    if (!list_length(root, "facts", &out->fact_count, err)) return false;
    ProfileFact *facts = ARENA_NEW(root->arena, ProfileFact, out->fact_count);
    for (int i = 0; i < out->fact_count; i++)
        if (!item_of(root, "facts", i, &item, err) || !read_fact(&item, &facts[i], err))
            return false;
    out->facts = facts;
    return true;
}

static bool read_ambient_light(const JsonView *root, Profile *out, Error *err)
{
    static const char *const KEYS[] = {"night_below_lx", "twilight_below_lx", "source",
                                       "read_in_the_standard"};
    JsonView view;
    if (!json_view_child(root, "ambient", true, &view, err) ||
        !json_view_check_keys(&view, KEYS, COUNT_OF(KEYS), err) ||
        !read_number(&view, KEYS[0], &out->night_below_lx, err) ||
        !read_number(&view, KEYS[1], &out->twilight_below_lx, err) ||
        !read_source(&view, &out->ambient_source, &out->ambient_read_in_the_standard, err))
        return false;
    if (out->night_below_lx < out->twilight_below_lx) return true;
    return error_at(err, ERROR_INPUT, view.file, json_view_path(&view, KEYS[1]),
                    "is %g, wanted more than night_below_lx, %g", out->twilight_below_lx,
                    out->night_below_lx);
}

static bool read_profile(const JsonView *root, Profile *out, Error *err)
{
    static const char *const KEYS[] = {"title", "edition", "veil",
                                       "ambient", "limits", "facts"};
    return json_view_check_keys(root, KEYS, COUNT_OF(KEYS), err) &&
           read_text(root, "title", &out->title, err) &&
           read_text(root, "edition", &out->edition, err) &&
           read_bool(root, "veil", false, &out->uses_veil, err) &&
           read_ambient_light(root, out, err) && read_limits(root, out, err) &&
           read_facts(root, out, err);
}

/* ---- where it stands --------------------------------------------------------------------- */

const char *profile_names(Arena *arena)
{
    const char *names = "";
    for (int i = 0; i < profile_count; i++)
        names = arena_format(arena, "%s%s%s", names, i ? ", " : "", profile_table[i].name);
    return names;
}

/* One of the program's own, as if it were a file. */
static bool open_shipped(const char *name, Arena *arena, JsonView *out, Error *err)
{
    for (int i = 0; i < profile_count; i++) {
        if (strcmp(name, profile_table[i].name)) continue;
        json_error_t fault;
        json_t *root = json_loads(profile_table[i].text, JSON_REJECT_DUPLICATES, &fault);
        const char *file = arena_format(arena, "assets/profiles/%s.json", name);
        if (!root)
            return error_at(err, ERROR_INPUT, file, "", "not valid JSON: %s", fault.text);
        *out = (JsonView){root, file, "", arena, NULL, NULL, 0};
        return true;
    }
    return error_set(err, ERROR_INPUT, "there is no profile \"%s\"; wanted %s, or a file by a "
                     "path that holds '/' or ends in .json", name, profile_names(arena));
}

bool profile_load(const char *name_or_path, Arena *arena, const Profile **out, Error *err)
{
    JsonView root;
    bool     is_path = strchr(name_or_path, '/') || !strcmp(path_ending(name_or_path), ".json");
    bool     ok = is_path ? json_view_open(name_or_path, arena, &root, err)
                          : open_shipped(name_or_path, arena, &root, err);
    if (!ok) return false;
    Profile *profile = ARENA_NEW(arena, Profile, 1);
    profile->id = arena_string(arena, name_or_path, strlen(name_or_path));
    profile->file_hash = root.hash;
    ok = read_profile(&root, profile, err);
    json_view_close(&root);
    if (ok) *out = profile;
    return ok;
}

Ambient profile_ambient(const Profile *profile, double display_lux, bool sun_on_display)
{
    if (sun_on_display) return AMBIENT_SUN;
    if (display_lux < profile->night_below_lx) return AMBIENT_NIGHT;
    return display_lux < profile->twilight_below_lx ? AMBIENT_TWILIGHT : AMBIENT_DAY;
}
