/* SPDX-License-Identifier: Apache-2.0 */
#include "review/request/request_conditions.h"

#include <math.h>
#include <string.h>

#include "base/file.h"
#include "base/units.h"
#include "review/request/request_eyes.h"
#include "review/request/request_glasses.h"
#include "scene/load/environment.h"

/* ---- weather ----------------------------------------------------------------------------- */

static bool add_weather(RequestReading *reading, const char *path, Error *err)
{
    ReviewRequest *request = reading->request;
    Arena         *arena = reading->root.arena;
    ReviewWeather  found = {.path = path};
    if (!weather_read(path, arena, &found.weather, err) ||
        !request_note_file(reading, path, err))
        return false;
    found.clock = weather_clock_find(&found.weather, NULL, *arena);
    if (request->weather_count == reading->weather_capacity) {
        reading->weather_capacity = 2 * reading->weather_capacity + 4;
        request->weathers = ARENA_GROW(arena, ReviewWeather, request->weathers,
                                       request->weather_count, reading->weather_capacity);
    }
    request->weathers[request->weather_count++] = found;
    return true;
}

/* "clear" or absent: NO_ID; else the file's place among the request's weathers. */
static bool find_weather(RequestReading *reading, const JsonView *view, int *weather_id,
                         Error *err)
{
    const ReviewRequest *request = reading->request;
    const char          *text = "clear", *path = NULL;
    *weather_id = NO_ID;
    if (!json_view_text(view, "weather", &text, err)) return false;
    if (!strcmp(text, "clear")) return true;
    if (strcmp(path_ending(text), ".epw"))
        return field_fails(view, "weather", err,
                           "is '%.60s', required: 'clear' or a weather file .epw", text);
    if (!field_file(view, "weather", &path, err)) return false;
    for (int i = 0; i < request->weather_count; i++)
        if (!strcmp(request->weathers[i].path, path)) *weather_id = i;
    if (*weather_id != NO_ID) return true;
    *weather_id = request->weather_count;
    return add_weather(reading, path, err);
}

/* A weather file, and by what its lux are known. */
static bool read_weather(RequestReading *reading, const JsonView *view,
                         ReviewCondition *condition, Error *err)
{
    static const char *const rules[] = {"perez", "file"};
    int lux = WEATHER_LUX_PEREZ;
    if (!find_weather(reading, view, &condition->weather_id, err) ||
        !field_choice(view, "weather_lux", (FieldWords){rules, COUNT_OF(rules)}, &lux, err))
        return false;
    condition->weather_lux = (WeatherLux)lux;
    return condition->weather_id != NO_ID || !json_object_get(view->object, "weather_lux") ||
           field_fails(view, "weather_lux", err, "stands without a weather file, required: one "
                       "in 'weather'");
}

#define RANGE_MAX 100000 /* values of one range */
#define SUNS_MAX 10000000
#define STEP_LEAST 1e-4 /* degrees */
#define HEADINGS_MAX 3600
#define WHOLE 1e-6 /* of a step: how much its multiples may miss the last value by */

/* ---- over the sun's direction ------------------------------------------------------------ */

/* The step nearest to the written one that divides first to last into whole steps. */
static double fitting_step(const double value[3])
{
    double length = value[1] - value[0];
    return length / fmax(1, round(length / value[2]));
}

static bool read_range(const JsonView *view, const char *key, JsonRange bounds,
                       ReviewRange *out, Error *err)
{
    double value[3];
    if (!field_wanted(view, key, err)) return false;
    const json_t *step = json_array_get(json_object_get(view->object, key), 2);
    if (json_array_size(json_object_get(view->object, key)) == 3 && json_is_number(step) &&
        !(json_number_value(step) >= STEP_LEAST))
        return field_fails(view, key, err, "has a step of %g, required: at least %g",
                           json_number_value(step), STEP_LEAST);
    if (!field_numbers(view, key, bounds, value, NULL, err)) return false;
    if (value[1] < value[0])
        return field_fails(view, key, err,
                           "goes from %g to %g, which is empty; required: [first, last, step] "
                           "with last not below first", value[0], value[1]);
    double steps = (value[1] - value[0]) / value[2];
    if (steps > RANGE_MAX)
        return field_fails(view, key, err, "has %.0f values, required: at most %d", steps + 1,
                           RANGE_MAX);
    if (fabs(steps - round(steps)) > WHOLE)
        return field_fails(view, key, err,
                           "does not come from %g to %g in steps of %g, required: a step such "
                           "as %.6g", value[0], value[1], value[2], fitting_step(value));
    *out = (ReviewRange){value[0], value[1], value[2], (int)round(steps) + 1};
    return true;
}

static bool read_suns(const JsonView *sweep, ReviewCondition *condition, Error *err)
{
    static const char *const keys[] = {"sun", "sky"}, *const skies[] = {"sky"};
    static const char *const axes[] = {"azimuth_deg", "elevation_deg"};
    JsonView sun;
    int      sky = 0;
    condition->kind = CONDITION_SUN_SWEEP;
    if (!json_view_check_keys(sweep, keys, COUNT_OF(keys), err) ||
        !json_view_child(sweep, "sun", true, &sun, err) ||
        !json_view_check_keys(&sun, axes, COUNT_OF(axes), err) ||
        !field_choice(sweep, "sky", (FieldWords){skies, 1}, &sky, err) ||
        !read_range(&sun, axes[0], (JsonRange){-360, 720, 3}, &condition->azimuth_deg, err) ||
        !read_range(&sun, axes[1], (JsonRange){-18, 90, 3}, &condition->elevation_deg, err))
        return false;
    if (condition->azimuth_deg.last - condition->azimuth_deg.first > 360)
        return field_fails(&sun, axes[0], err, "spans %g degrees, required: at most 360",
                           condition->azimuth_deg.last - condition->azimuth_deg.first);
    double suns = (double)condition->azimuth_deg.count * condition->elevation_deg.count;
    return suns <= SUNS_MAX ||
           error_at(err, ERROR_INPUT, sun.file, sun.path, "has %.0f suns, required: at most %d",
                    suns, SUNS_MAX);
}

/* ---- over a year ------------------------------------------------------------------------- */

/* [latitude, longitude] or with an altitude. */
static bool read_place(const JsonView *view, SkyPlace *out, bool *found, Error *err)
{
    double value[3] = {0, 0, 0};
    int    count = 0;
    if (!json_view_numbers(view, "where", (JsonRange){-500, 60000, 3}, value, &count, err))
        return false;
    *found = count > 0;
    if (!count) return true;
    if (count < 2 || fabs(value[0]) > 90 || fabs(value[1]) > 360)
        return field_fails(view, "where", err,
                           "is no place, required: [latitude -90 to 90, longitude -360 to "
                           "360] in degrees north and east, and an altitude in m");
    *out = (SkyPlace){value[0], value[1], value[2]};
    return true;
}

static bool is_same_heading(double a, double b)
{
    return fabs(remainder(a - b, 360)) < 1e-9;
}

/* A heading that stands twice would count twice. */
static bool check_headings(const JsonView *view, const ReviewCondition *condition, Error *err)
{
    for (int i = 0; i < condition->heading_count; i++)
        for (int k = 0; k < i; k++)
            if (is_same_heading(condition->headings_deg[i], condition->headings_deg[k]))
                return field_fails(view, "headings_deg", err,
                                   "holds %g and %g, required: each heading once",
                                   condition->headings_deg[k], condition->headings_deg[i]);
    return true;
}

static bool read_headings(const JsonView *view, ReviewCondition *condition, Error *err)
{
    condition->headings_deg = ARENA_NEW(view->arena, double, HEADINGS_MAX);
    condition->heading_count = 1; /* north */
    return json_view_numbers(view, "headings_deg", (JsonRange){-360, 360, HEADINGS_MAX},
                             condition->headings_deg, &condition->heading_count, err) &&
           check_headings(view, condition, err);
}

static bool find_place(const RequestReading *reading, const JsonView *sweep,
                       ReviewCondition *condition, Error *err)
{
    bool found;
    if (!read_place(sweep, &condition->where, &found, err)) return false;
    if (found) return true;
    if (condition->weather_id == NO_ID) return field_wanted(sweep, "where", err);
    condition->where = reading->request->weathers[condition->weather_id].weather.place;
    return true;
}

static bool read_year(RequestReading *reading, const JsonView *sweep,
                      ReviewCondition *condition, Error *err)
{
    static const char *const keys[] = {"year",         "where",   "step_minutes",
                                       "headings_deg", "weather", "weather_lux", "night"};
    condition->kind = CONDITION_YEAR_SWEEP;
    condition->step_minutes = 60;
    return json_view_check_keys(sweep, keys, COUNT_OF(keys), err) &&
           field_integer(sweep, "year", (FieldBounds){1900, 2100}, &condition->year, err) &&
           json_view_number(sweep, "step_minutes", 0.5, 1440, &condition->step_minutes, err) &&
           read_headings(sweep, condition, err) &&
           field_boolean(sweep, "night", &condition->with_night, err) &&
           read_weather(reading, sweep, condition, err) &&
           find_place(reading, sweep, condition, err);
}

/* view: of the sweep. Sets the condition's kind and what belongs to it. */
static bool read_sweep(RequestReading *reading, const JsonView *view,
                       ReviewCondition *condition, Error *err)
{
    static const char *const keys[] = {"sun",   "sky",          "year",         "where",
                                       "night", "step_minutes", "headings_deg", "weather",
                                       "weather_lux"};
    bool has_sun = json_object_get(view->object, "sun") != NULL;
    bool has_year = json_object_get(view->object, "year") != NULL;
    if (!json_view_check_keys(view, keys, COUNT_OF(keys), err)) return false;
    if (has_sun == has_year)
        return error_at(err, ERROR_INPUT, view->file, view->path,
                        "has %s, required: one of 'sun' and 'year'",
                        has_sun ? "both" : "neither");
    return has_sun ? read_suns(view, condition, err)
                   : read_year(reading, view, condition, err);
}

/* ---- light ------------------------------------------------------------------------------- */

/* `forward` stands once at the top of the file, a heading once in the condition. */
static bool check_directions(const JsonView *view, const JsonView *environment,
                             const ReviewCondition *condition, Error *err)
{
    bool has_heading = json_object_get(environment->object, "heading_deg") != NULL;
    if (json_object_get(environment->object, "forward"))
        return field_fails(environment, "forward", err,
                           "stands in a condition, required: at the top of the file");
    if (has_heading && condition->has_heading)
        return field_fails(view, "heading_deg", err,
                           "stands in 'environment' as well, required: once");
    if (has_heading &&
        (condition->kind == CONDITION_ROUTE || condition->kind == CONDITION_YEAR_SWEEP))
        return field_fails(environment, "heading_deg", err,
                           "stands in a condition that has headings of its own, required: "
                           "none");
    return true;
}

/* Beside a route or a sweep the environment gives a clear sky's air. */
static bool check_kind(const JsonView *environment, const ReviewCondition *condition,
                       Error *err)
{
    if (condition->kind == CONDITION_MOMENT) return true;
    if (condition->weather_id != NO_ID)
        return error_at(err, ERROR_INPUT, environment->file, environment->path,
                        "stands beside a weather file, required: one of them");
    return condition->environment.kind == ENVIRONMENT_SKY ||
           field_fails(environment, "type", err,
                       "is not 'sky', which is required: a route and a sweep move the "
                       "sun of a clear sky");
}

/* view: of condition i, whose time and heading are read already. */
static bool read_light(RequestReading *reading, const JsonView *view, int i,
                       ReviewCondition *condition, Error *err)
{
    EnvironmentFound found;
    JsonView         environment;
    if (!json_view_child(view, "environment", false, &environment, err)) return false;
    if (!environment.object) return true;
    const GltfValue *item = tree_item(tree_member(reading->tree, "conditions"), i);
    EnvironmentText  text = {view->file, tree_member(item, "environment"), view->root};
    if (!check_directions(view, &environment, condition, err) ||
        !environment_text_read(&text, view->arena, reading->problems, &found, err))
        return false;
    condition->has_environment = true;
    condition->environment = found.environment;
    if (json_object_get(environment.object, "heading_deg")) {
        condition->has_heading = true;
        condition->heading_deg = json_number_value(json_object_get(environment.object,
                                                                   "heading_deg"));
    }
    condition->environment.forward = vec3_from_doubles(reading->request->forward);
    condition->environment.heading = (float)radians_from_degrees(condition->heading_deg);
    if (found.picture) request_note_input(reading, found.picture, found.picture_hash);
    return check_kind(&environment, condition, err);
}

#define CONDITIONS_MAX 10000

static const char *const KEYS[] = {"name",     "environment", "lights", "heading_deg", "level",
                                   "with",     "polarity",    "contents", "route",     "when",
                                   "weather",  "weather_lux", "sweep",  "sunglasses"};

static bool has(const JsonView *view, const char *key)
{
    return json_object_get(view->object, key) != NULL;
}

/* ---- displays and people ----------------------------------------------------------------- */

static bool find_level(const RequestReading *reading, const JsonView *view,
                       ReviewCondition *condition, Error *err)
{
    const ReviewRequest *request = reading->request;
    return request_find_name(view, "level", request_level_names(request, view->arena), "levels",
                             &condition->level_id, err);
}

static bool find_with(const RequestReading *reading, const JsonView *view,
                      ReviewCondition *condition, Error *err)
{
    const ReviewRequest *request = reading->request;
    FieldWords names = field_names_of(request->withs, sizeof *request->withs,
                                      request->with_count, view->arena);
    return request_find_name(view, "with", names, "with", &condition->with_id, err);
}

/* An object with symbols' names as keys. */
static bool read_polarities(const RequestReading *reading, const JsonView *view,
                            ReviewCondition *condition, Error *err)
{
    FieldMembers         members;
    const ReviewRequest *request = reading->request;
    FieldWords names = field_names_of(request->symbols, sizeof *request->symbols,
                                      request->symbol_count, view->arena);
    if (!field_named_members(view, "polarity", names, "symbol", &members, err)) return false;
    for (int i = 0; i < names.count; i++)
        if (!request_polarity_read(&members.view, names.word[i], &condition->polarity[i], err))
            return false;
    return true;
}

static bool read_polarity(const RequestReading *reading, const JsonView *view,
                          ReviewCondition *condition, Error *err)
{
    const ReviewRequest *request = reading->request;
    condition->polarity = ARENA_NEW(view->arena, ReviewPolarity, request->symbol_count);
    for (int i = 0; i < request->symbol_count; i++)
        condition->polarity[i] = request->symbols[i].polarity;
    if (json_is_object(json_object_get(view->object, "polarity")))
        return read_polarities(reading, view, condition, err);
    for (int i = 0; i < request->symbol_count; i++)
        if (!request_polarity_read(view, "polarity", &condition->polarity[i], err))
            return false;
    return true;
}

/* ---- time -------------------------------------------------------------------------------- */

static bool read_start(const JsonView *view, Route *route, Error *err)
{
    Error       why;
    SkyTime     when;
    const char *text = NULL;
    if (!json_view_text(view, "when", &text, err)) return false;
    if (!text) return true;
    if (!sky_time_parse(text, "", &when, &why))
        return field_fails(view, "when", err, "%s", why.text);
    route_start_at(route, &when);
    return true;
}

static bool read_route(RequestReading *reading, const JsonView *view,
                       ReviewCondition *condition, Error *err)
{
    const char *path = NULL;
    condition->kind = CONDITION_ROUTE;
    return field_file(view, "route", &path, err) &&
           route_read(path, view->arena, &condition->route, err) &&
           request_note_file(reading, path, err) &&
           read_start(view, &condition->route, err) &&
           read_weather(reading, view, condition, err);
}

/* Keys that mean nothing beside others are errors, not skipped. */
static bool check_together(const JsonView *view, Error *err)
{
    if (has(view, "route") && has(view, "sweep"))
        return error_at(err, ERROR_INPUT, view->file, view->path,
                        "has both 'route' and 'sweep', required: one of them");
    static const char *const of_routes[] = {"when", "weather", "weather_lux"};
    for (int i = 0; i < COUNT_OF(of_routes) && !has(view, "route"); i++) {
        const char *key = of_routes[i];
        if (has(view, key))
            return field_fails(view, key, err, "stands without 'route', required: %s",
                               i ? "beside a route or in the year of a sweep"
                                 : "beside a route or in 'environment'");
    }
    if (has(view, "heading_deg") && has(view, "route"))
        return field_fails(view, "heading_deg", err,
                           "stands beside 'route', required: the route's own headings alone");
    return true;
}

static bool read_time(RequestReading *reading, const JsonView *view,
                      ReviewCondition *condition, Error *err)
{
    JsonView sweep;
    if (!check_together(view, err) || !json_view_child(view, "sweep", false, &sweep, err))
        return false;
    if (has(view, "route")) return read_route(reading, view, condition, err);
    if (!sweep.object) return true;
    return read_sweep(reading, &sweep, condition, err) &&
           (condition->kind != CONDITION_YEAR_SWEEP || !has(view, "heading_deg") ||
            field_fails(view, "heading_deg", err, "stands beside the sweep of a year, "
                                                  "required: 'headings_deg' in it"));
}

/* ---- all of it --------------------------------------------------------------------------- */

static bool read_heading(const JsonView *view, ReviewCondition *condition, Error *err)
{
    condition->has_heading = has(view, "heading_deg");
    return json_view_number(view, "heading_deg", -360, 360, &condition->heading_deg, err);
}

static bool read_condition(RequestReading *reading, int i, Error *err)
{
    JsonView         view;
    ReviewRequest   *request = reading->request;
    ReviewCondition *condition = &request->conditions[i];
    *condition = (ReviewCondition){.level_id = NO_ID, .with_id = NO_ID, .weather_id = NO_ID};
    if (!field_item(&reading->root, "conditions", i, (FieldWords){KEYS, COUNT_OF(KEYS)}, &view,
                    err) ||
        !field_name(&view, "name", &condition->name, err))
        return false;
    for (int k = 0; k < i; k++)
        if (!strcmp(request->conditions[k].name, condition->name))
            return field_fails(&view, "name", err, "is '%.60s' as that of condition %d, "
                               "required: another name", condition->name, k);
    return find_level(reading, &view, condition, err) &&
           find_with(reading, &view, condition, err) &&
           field_files(&view, "lights", &condition->lights, &condition->light_count, err) &&
           read_polarity(reading, &view, condition, err) &&
           request_contents_read(&view, &condition->contents, &condition->content_count, err) &&
           read_heading(&view, condition, err) &&
           read_time(reading, &view, condition, err) &&
           request_glasses_read(reading, &view, condition, err) &&
           read_light(reading, &view, i, condition, err);
}

bool request_conditions_read(RequestReading *reading, Error *err)
{
    ReviewRequest *request = reading->request;
    if (!field_wanted(&reading->root, "conditions", err) ||
        !field_list(&reading->root, "conditions", CONDITIONS_MAX, &request->condition_count,
                    err))
        return false;
    request->conditions = ARENA_NEW(reading->root.arena, ReviewCondition,
                                    request->condition_count);
    for (int i = 0; i < request->condition_count; i++)
        if (!read_condition(reading, i, err)) return false;
    return true;
}
