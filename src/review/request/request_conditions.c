/* SPDX-License-Identifier: Apache-2.0 */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/file.h"
#include "base/units.h"
#include "record/rows.h"
#include "review/request/request_format.h"
#include "scene/check/our_extensions.h"
#include "scene/load/environment.h"

#define OWNER ReviewCondition

/* ---- weather ----------------------------------------------------------------------------- */

static bool add_weather(const JsonView *view, const char *path, Error *err) {
    ReviewRequest *request = view->whole;
    ReviewWeather found = {.path = path};
    int count = request->weather_count;
    if (!weather_read(path, view->arena, &found.weather, err) ||
        !request_note_file(view, path, err))
        return false;
    found.clock = weather_clock_find(&found.weather, NULL, *view->arena);
    if (!(count & (count - 1))) /* full: it doubles */
        request->weathers =
            ARENA_GROW(view->arena, ReviewWeather, request->weathers, count, count ? 2 * count : 1);
    request->weathers[request->weather_count++] = found;
    return true;
}

/* "clear": NO_ID; else the file's place among the request's weathers. */
static bool read_weather(const JsonView *view, const RecordRow *row, void *item, Error *err) {
    const ReviewRequest *request = view->whole;
    int *weather_id = &((ReviewCondition *)item)->weather_id;
    RecordRow word = {.key = row->key, .kind = RECORD_TEXT};
    const char *text, *path;
    if (!record_read_kind(view, &word, &text, err)) return false;
    if (!strcmp(text, "clear")) return true;
    if (strcmp(path_ending(text), ".epw"))
        return record_fails(view, row->key, err,
                            "is '%.60s', required: 'clear' or a weather file .epw", text);
    if (!record_read_kind(view, row, &path, err)) return false;
    for (int i = 0; i < request->weather_count; i++)
        if (!strcmp(request->weathers[i].path, path)) *weather_id = i;
    if (*weather_id != NO_ID) return true;
    *weather_id = request->weather_count;
    return add_weather(view, path, err);
}

static bool check_weather(const JsonView *view, const ReviewCondition *condition, Error *err) {
    return condition->weather_id != NO_ID || !record_has(view, "weather_lux") ||
           record_fails(view, "weather_lux", err,
                        "stands without a weather file, required: one in 'weather'");
}

static const char *const LUX[] = {[WEATHER_LUX_PEREZ] = "perez", [WEATHER_LUX_FILE] = "file", NULL};

/* ---- over the sun's direction ------------------------------------------------------------ */

#define RANGE_MAX 100000 /* values of one range */
#define SUNS_MAX 10000000
#define STEP_LEAST 1e-4 /* degrees */
#define STEP_SLACK 1e-6 /* of a step: how much its multiples may miss the last value by */

/* The step nearest to the written one that divides first to last into whole steps. */
static double fitting_step(const double value[3]) {
    double length = value[1] - value[0];
    return length / fmax(1, round(length / value[2]));
}

static bool read_range(const JsonView *view, const RecordRow *row, void *item, Error *err) {
    double value[3];
    const char *key = row->key;
    RecordRow own = *row;
    const json_t *step = json_array_get(json_object_get(view->object, key), 2);
    if (json_array_size(json_object_get(view->object, key)) == 3 && json_is_number(step) &&
        !(json_number_value(step) >= STEP_LEAST))
        return record_fails(view, key, err, "has a step of %g, required: at least %g",
                            json_number_value(step), STEP_LEAST);
    own.offset = 0;
    if (!record_read_kind(view, &own, value, err)) return false;
    if (value[1] < value[0])
        return record_fails(view, key, err,
                            "goes from %g to %g, which is empty; required: [first, last, step] "
                            "with last not below first",
                            value[0], value[1]);
    double steps = (value[1] - value[0]) / value[2];
    if (steps > RANGE_MAX)
        return record_fails(view, key, err, "has %.0f values, required: at most %d", steps + 1,
                            RANGE_MAX);
    if (fabs(steps - round(steps)) > STEP_SLACK)
        return record_fails(view, key, err,
                            "does not come from %g to %g in steps of %g, required: a step such "
                            "as %.6g",
                            value[0], value[1], value[2], fitting_step(value));
    *(ReviewRange *)(void *)((char *)item + row->offset) =
        (ReviewRange){value[0], value[1], value[2], (int)round(steps) + 1};
    return true;
}

#define RANGE(key, member, low, high, words) \
    {key, \
     RECORD_NUMBERS, \
     MUST, \
     RECORD_AT(OWNER, member), \
     RECORD_RANGE(low, high), \
     RECORD_COUNT(3, 3), \
     .read = read_range, \
     .doc = words}

static const RecordRow SUN[] = {
    RANGE("azimuth_deg", azimuth_deg, -360, 720,
          "[first, last, step], both ends in. From north over east; without heading_deg from "
          "ahead over right."),
    RANGE("elevation_deg", elevation_deg, -18, 90, "[first, last, step], both ends in."),
    {0}};

static bool check_sun(const JsonView *view, void *item, Error *err) {
    const ReviewCondition *condition = item;
    const ReviewRange *azimuth = &condition->azimuth_deg;
    if (azimuth->last - azimuth->first > 360)
        return record_fails(view, "azimuth_deg", err, "spans %g degrees, required: at most 360",
                            azimuth->last - azimuth->first);
    double suns = (double)azimuth->count * condition->elevation_deg.count;
    return suns <= SUNS_MAX || error_at(err, ERROR_INPUT, view->file, view->path,
                                        "has %.0f suns, required: at most %d", suns, SUNS_MAX);
}

static const RecordFormat sun_format = {"sun", sizeof(OWNER), SUN, .check = check_sun};

/* ---- over a year ------------------------------------------------------------------------- */

static bool read_place(const JsonView *view, const RecordRow *row, void *item, Error *err) {
    double place[3] = {0, 0, 0};
    if (!record_read_kind(view, row, place, err)) return false;
    if (fabs(place[0]) > 90 || fabs(place[1]) > 360)
        return record_fails(view, row->key, err,
                            "is no place, required: [latitude -90 to 90, longitude -360 to "
                            "360] in degrees north and east, and an altitude in m");
    ((ReviewCondition *)item)->where = (SkyPlace){place[0], place[1], place[2]};
    return true;
}

/* A heading that stands twice would count twice. */
static bool check_headings(const JsonView *view, const ReviewCondition *condition, Error *err) {
    const double *degrees = condition->headings_deg;
    for (int i = 0; i < condition->heading_count; i++)
        for (int k = 0; k < i; k++)
            if (fabs(remainder(degrees[i] - degrees[k], 360)) < 1e-9)
                return record_fails(view, "headings_deg", err,
                                    "holds %g and %g, required: each heading once", degrees[k],
                                    degrees[i]);
    return true;
}

/* What is not said: each hour, heading north, where the weather was measured. */
static bool check_year(const JsonView *view, ReviewCondition *condition, Error *err) {
    static const double NORTH[1];
    const ReviewRequest *request = view->whole;
    if (!check_weather(view, condition, err) || !check_headings(view, condition, err)) return false;
    if (!record_has(view, "step_minutes")) condition->step_minutes = 60;
    if (!record_has(view, "headings_deg")) {
        condition->headings_deg = NORTH;
        condition->heading_count = 1;
    }
    if (record_has(view, "where")) return true;
    if (condition->weather_id == NO_ID) return record_misses(view, "where", err);
    condition->where = request->weathers[condition->weather_id].weather.place;
    return true;
}

/* ---- a sweep ----------------------------------------------------------------------------- */

static const char *const SKY[] = {"sky", NULL};

static const RecordRow SWEEP[] = {
    {"sun", RECORD_OBJECT, .of = &sun_format, .doc = "Over its directions, in a clear sky."},
    {"sky", RECORD_CONST, .words = SKY, .doc = "Beside sun: the clear atmosphere."},
    WHOLE("year", RECORD_OPEN, year, 1900, 2100, "Over its hours; the rest stands beside it."),
    {"where", RECORD_NUMBERS, RECORD_RANGE(-500, 60000), RECORD_COUNT(2, 3), .read = read_place,
     .doc = "Latitude (degrees north), longitude (degrees east), altitude (m); default: the "
            "weather file's."},
    NUMBER("step_minutes", 0, step_minutes, 0.5, 1440, "Default: 60."),
    FIGURES("headings_deg", 0, headings_deg, heading_count, 1, 3600, -360, 360,
            "None twice; default: north."),
    {"weather", RECORD_FILE, .read = read_weather,
     .doc = "clear, or a weather file with a row for every step that counts; excludes "
            "environment unless clear."},
    CHOICE("weather_lux", 0, weather_lux, LUX,
           "A weather file's lux: its irradiances times Perez 1990's luminous efficacies "
           "with water by the dew point, or the file's own columns."),
    FLAG("night", 0, with_night, "Whether hours without sun count too."),
    {0}};
#define OF_SUN 2 /* rows */

/* Sets the condition's kind and what belongs to it. */
static bool check_sweep(const JsonView *view, void *item, Error *err) {
    ReviewCondition *condition = item;
    bool has_sun = record_has(view, "sun");
    if (!record_one_of(view, "sun", "year", err)) return false;
    for (int i = 0; SWEEP[i].key; i++)
        if (record_has(view, SWEEP[i].key) && (i < OF_SUN) != has_sun)
            return record_fails(view, SWEEP[i].key, err, "stands beside '%s', required: '%s'",
                                has_sun ? "sun" : "year", has_sun ? "year" : "sun");
    condition->kind = has_sun ? CONDITION_SUN_SWEEP : CONDITION_YEAR_SWEEP;
    return has_sun || check_year(view, condition, err);
}

static const RecordFormat sweep_format = {
    "sweep", sizeof(OWNER), SWEEP, .check = check_sweep,
    .rules = "{'oneOf': [{'required': ['sun']}, {'required': ['year'], "
             "'anyOf': [{'required': ['where']}, {'required': ['weather']}]}], "
             "'dependentRequired': {'sky': ['sun'], 'weather_lux': ['weather'], "
             "'weather': ['year'], 'night': ['year']}}"};

/* ---- light ------------------------------------------------------------------------------- */

/* `forward` stands once at the top of the file, a heading once in the condition. */
static bool check_directions(const JsonView *view, const JsonView *environment,
                             const ReviewCondition *condition, Error *err) {
    bool has_heading = record_has(environment, "heading_deg");
    if (record_has(environment, "forward"))
        return record_fails(environment, "forward", err,
                            "stands in a condition, required: at the top of the file");
    if (has_heading && record_has(view, "heading_deg"))
        return record_fails(view, "heading_deg", err,
                            "stands in 'environment' as well, required: once");
    return !has_heading || condition->kind != CONDITION_YEAR_SWEEP ||
           record_fails(environment, "heading_deg", err,
                        "stands in a condition that has headings of its own, required: none");
}

/* Beside a sweep the environment gives a clear sky's air. */
static bool check_kind(const JsonView *environment, const ReviewCondition *condition, Error *err) {
    if (condition->kind == CONDITION_MOMENT) return true;
    if (condition->weather_id != NO_ID)
        return error_at(err, ERROR_INPUT, environment->file, environment->path,
                        "stands beside a weather file, required: one of them");
    return condition->environment.kind == ENVIRONMENT_SKY ||
           record_fails(environment, "type", err,
                        "is not 'sky', which is required: a sweep moves the sun of a clear sky");
}

/* As in a scene; the condition's time and heading are read already. */
static bool read_environment(const JsonView *view, const RecordRow *row, void *item, Error *err) {
    EnvironmentFound found;
    JsonView inside;
    ReviewCondition *condition = item;
    const ReviewRequest *request = view->whole;
    if (!json_view_child(view, row->key, &inside, err) ||
        !check_directions(view, &inside, condition, err))
        return false;
    char *text = json_dumps(inside.object, JSON_COMPACT);
    bool is_read =
        environment_text_read(&(EnvironmentText){view->file, inside.path, text, view->root},
                              view->arena, view->problems, &found, err);
    free(text);
    if (!is_read) return false;
    condition->has_environment = true;
    condition->environment = found.environment;
    condition->environment.daylight.cloud_relief_m = 0; /* review/light/setup.h */
    if (record_has(&inside, "heading_deg")) {
        condition->has_heading = true;
        condition->heading_deg = json_number_value(json_object_get(inside.object, "heading_deg"));
    }
    condition->environment.forward = vec3_from_doubles(request->forward);
    condition->environment.heading = (float)radians_from_degrees(condition->heading_deg);
    if (found.picture) request_note_input(view, found.picture, found.picture_hash);
    return check_kind(&inside, condition, err);
}

/* ---- all of it --------------------------------------------------------------------------- */

static bool read_polarity(const JsonView *view, const RecordRow *row, void *item, Error *err) {
    ReviewCondition *condition = item;
    const ReviewRequest *request = view->whole;
    if (!condition->polarity)
        condition->polarity = ARENA_NEW(view->arena, ReviewPolarity, request->symbol_count);
    for (int i = 0; i < request->symbol_count; i++)
        condition->polarity[i] = request->symbols[i].polarity;
    return !row || request_read_words(view, row, (int *)condition->polarity, err);
}

static const RecordRow CONDITION[] = {
    TEXT("name", MUST | RECORD_FILLED, name, "Each has its own."),
    {"level", RECORD_REFER, RECORD_AT(OWNER, level_id), .among = &review_level_names,
     .doc = "One of levels; default: as the scene says."},
    {"with", RECORD_REFER, RECORD_AT(OWNER, with_id), .among = &review_with_names,
     .doc = "One of with: who sits there."},
    FILES("lights", 0, lights, light_count, 256, "More files of the scene, with lamps."),
    {"polarity", RECORD_EITHER, .forms = review_polarity_forms, .read = read_polarity},
    MAP("contents", 0, contents, content_count, 1000, review_content_format,
        "What displays show instead."),
    NUMBER("heading_deg", RECORD_OPEN, heading_deg, -360, 360,
           "Where the vehicle heads to, from north over east."),
    {"sweep", RECORD_OBJECT, .of = &sweep_format},
    OBJECT("sunglasses", RECORD_APART, glasses, review_glasses_format,
           "What the observer wears; default: none."),
    {"environment", RECORD_OWN, .read = read_environment, .of = &environment_extension},
    {0}};

static void start_condition(void *item) {
    *(ReviewCondition *)item =
        (ReviewCondition){.level_id = NO_ID, .with_id = NO_ID, .weather_id = NO_ID};
}

/* Keys that mean nothing beside others are errors, not skipped. */
static bool check_together(const JsonView *view, const ReviewCondition *condition, Error *err) {
    const ReviewGlasses *glasses = condition->glasses;
    if (record_has(view, "heading_deg") && condition->kind == CONDITION_YEAR_SWEEP)
        return record_fails(view, "heading_deg", err,
                            "stands beside the sweep of a year, "
                            "required: 'headings_deg' in it");
    if (glasses && (glasses->curve || glasses->is_polarising) &&
        condition->kind != CONDITION_MOMENT)
        return record_fails(view, "sunglasses", err,
                            "is coloured or polarising beside a sweep, "
                            "required: a grey one, or a moment");
    return true;
}

static bool check_condition(const JsonView *view, void *item, Error *err) {
    ReviewCondition *condition = item;
    const ReviewRequest *request = view->whole;
    for (const ReviewCondition *before = request->conditions; before < condition; before++)
        if (!strcmp(before->name, condition->name))
            return record_fails(view, "name", err,
                                "is '%.60s' as that of condition %d, "
                                "required: another name",
                                condition->name, (int)(before - request->conditions));
    condition->has_heading |= record_has(view, "heading_deg");
    if (!condition->polarity) read_polarity(view, NULL, condition, err);
    return check_together(view, condition, err);
}

const RecordFormat review_condition_format = {"condition", sizeof(OWNER), CONDITION,
                                              .start = start_condition, .check = check_condition};
