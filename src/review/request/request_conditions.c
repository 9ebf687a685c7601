/* SPDX-License-Identifier: Apache-2.0 */
#include "review/request/request_conditions.h"

#include <string.h>

#include "review/request/request_light.h"
#include "review/request/request_sweep.h"
#include "review/request/request_symbols.h"
#include "review/request/request_weather.h"

#define CONDITIONS_MAX 10000
#define CONTENTS_MAX 1000

static const char *const KEYS[] = {"name",     "environment", "lights", "heading_deg", "level",
                                   "with",     "polarity",    "contents", "route",     "when",
                                   "weather",  "sweep"};

static bool has(const JsonView *view, const char *key)
{
    return json_object_get(view->object, key) != NULL;
}

/* ---- displays and people ----------------------------------------------------------------- */

static bool find_level(const RequestReading *reading, const JsonView *view,
                       ReviewCondition *condition, Error *err)
{
    const ReviewRequest *request = reading->request;
    const char **names = ARENA_NEW(view->arena, const char *, request->level_count);
    for (int i = 0; i < request->level_count; i++) names[i] = request->levels[i].name;
    return request_find_name(view, "level", (FieldWords){names, request->level_count},
                             "levels", &condition->level_id, err);
}

static bool find_with(const RequestReading *reading, const JsonView *view,
                      ReviewCondition *condition, Error *err)
{
    const ReviewRequest *request = reading->request;
    const char **names = ARENA_NEW(view->arena, const char *, request->with_count);
    for (int i = 0; i < request->with_count; i++) names[i] = request->withs[i].name;
    return request_find_name(view, "with", (FieldWords){names, request->with_count}, "with",
                             &condition->with_id, err);
}

static int find_symbol(const ReviewRequest *request, const char *name)
{
    for (int i = 0; i < request->symbol_count; i++)
        if (!strcmp(request->symbols[i].name, name)) return i;
    return NO_ID;
}

/* An object with symbols' names as keys. */
static bool read_polarities(const RequestReading *reading, const JsonView *view,
                            ReviewCondition *condition, Error *err)
{
    FieldMembers         members;
    const ReviewRequest *request = reading->request;
    if (!field_members(view, "polarity", request->symbol_count, &members, err)) return false;
    const char **names = ARENA_NEW(view->arena, const char *, request->symbol_count);
    for (int i = 0; i < request->symbol_count; i++) names[i] = request->symbols[i].name;
    if (!json_view_check_keys(&members.view, names, request->symbol_count, err)) return false;
    for (int i = 0; i < members.count; i++) {
        int symbol = find_symbol(request, members.name[i]);
        if (!request_polarity_read(&members.view, members.name[i],
                                   &condition->polarity[symbol], err))
            return false;
    }
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

static bool read_contents(const JsonView *view, ReviewCondition *condition, Error *err)
{
    FieldMembers members;
    if (!field_members(view, "contents", CONTENTS_MAX, &members, err)) return false;
    condition->contents = ARENA_NEW(view->arena, ReviewContent, members.count);
    condition->content_count = members.count;
    for (int i = 0; i < members.count; i++) {
        condition->contents[i].display = members.name[i];
        if (!field_file(&members.view, members.name[i], &condition->contents[i].path, err))
            return false;
    }
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
           request_weather_read(reading, view, &condition->weather_id, err);
}

/* Keys that mean nothing beside others are errors, not skipped. */
static bool check_together(const JsonView *view, Error *err)
{
    if (has(view, "route") && has(view, "sweep"))
        return error_at(err, ERROR_INPUT, view->file, view->path,
                        "has both 'route' and 'sweep', wanted one of them");
    for (int i = 0; i < 2 && !has(view, "route"); i++) {
        const char *key = i ? "weather" : "when";
        if (has(view, key))
            return field_fails(view, key, err, "stands without 'route', wanted it %s",
                               i ? "beside a route or in the year of a sweep"
                                 : "beside a route or in 'environment'");
    }
    if (has(view, "heading_deg") && has(view, "route"))
        return field_fails(view, "heading_deg", err,
                           "stands beside 'route', wanted the route's own headings alone");
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
    return request_sweep_read(reading, &sweep, condition, err) &&
           (condition->kind != CONDITION_YEAR_SWEEP || !has(view, "heading_deg") ||
            field_fails(view, "heading_deg", err, "stands beside the sweep of a year, wanted "
                        "'headings_deg' in it"));
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
            return field_fails(&view, "name", err, "is '%.60s' as that of condition %d, wanted "
                               "another name", condition->name, k);
    return find_level(reading, &view, condition, err) &&
           find_with(reading, &view, condition, err) &&
           field_files(&view, "lights", &condition->lights, &condition->light_count, err) &&
           read_polarity(reading, &view, condition, err) &&
           read_contents(&view, condition, err) && read_heading(&view, condition, err) &&
           read_time(reading, &view, condition, err) &&
           request_light_read(reading, &view, i, condition, err);
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
