/* SPDX-License-Identifier: Apache-2.0 */
#include "review/request/request_levels.h"

#include <math.h>

#define LEVELS_MAX 1000
#define FIXED_MAX 1000
#define POINTS_MAX 10000
#define LEVEL_MAX 100.0      /* that a panel may be driven to, 1: as measured */
#define BRIGHTNESS_MAX 100.0 /* times as bright as it stands */
#define LUX_MAX 1e7

/* ---- fixed ------------------------------------------------------------------------------- */

/* 25 is meant as 25 %: a level above what was measured has to say so. */
static bool check_level(const JsonView *view, const char *place, double level, double most,
                        Error *err)
{
    return (level >= 0 && level <= most) ||
           field_fails(view, place, err,
                       "is %.9g, required: a level from 0 to %g: 1 is as measured, 0.25 a "
                       "quarter of it; \"max_level\" of the request allows panels driven "
                       "above that", level, most);
}

static bool read_fixed(const FieldMembers *members, double most, ReviewFixedLevel **out,
                       Error *err)
{
    ReviewFixedLevel *fixed = ARENA_NEW(members->view.arena, ReviewFixedLevel, members->count);
    for (int i = 0; i < members->count; i++) {
        const char *name = fixed[i].display = members->name[i];
        if (!json_view_number(&members->view, name, -INFINITY, INFINITY, &fixed[i].level,
                              err) ||
            !check_level(&members->view, name, fixed[i].level, most, err))
            return false;
    }
    *out = fixed;
    return true;
}

bool request_brightness_read(const FieldMembers *members, ReviewFixedLevel **out, Error *err)
{
    ReviewFixedLevel *list = ARENA_NEW(members->view.arena, ReviewFixedLevel, members->count);
    for (int i = 0; i < members->count; i++) {
        list[i].display = members->name[i];
        if (!json_view_number(&members->view, members->name[i], 0, BRIGHTNESS_MAX,
                              &list[i].level, err))
            return false;
    }
    *out = list;
    return true;
}

/* ---- by a sensor ------------------------------------------------------------------------- */

static bool read_sensor(const JsonView *view, ReviewLevel *level, Error *err)
{
    static const char *const keys[] = {"position_m", "normal"};
    JsonView sensor;
    return json_view_child(view, "sensor", true, &sensor, err) &&
           json_view_check_keys(&sensor, keys, COUNT_OF(keys), err) &&
           field_wanted(&sensor, "position_m", err) && field_wanted(&sensor, "normal", err) &&
           field_numbers(&sensor, "position_m", (JsonRange){-1e6, 1e6, 3},
                         level->position_m, NULL, err) &&
           field_unit_vector(&sensor, "normal", level->normal, NULL, err);
}

/* Row i of the table, held against the one before. */
static bool read_row(const JsonView *view, int i, double most, ReviewLevel *level, Error *err)
{
    json_t     *row = json_array_get(json_object_get(view->object, "table_lx"), (size_t)i);
    const char *place = arena_format(view->arena, "table_lx/%d", i);
    double      value[2];
    for (int k = 0; k < 2; k++) {
        const json_t *number = json_array_get(row, (size_t)k);
        if (json_array_size(row) != 2 || !json_is_number(number))
            return json_view_wrong_kind(view, place, row, "a pair [illuminance in lx, level]",
                                        err);
        value[k] = json_number_value(number);
    }
    if (!(value[0] >= 0 && value[0] <= LUX_MAX))
        return field_fails(view, place, err, "holds %g, required: an illuminance from 0 to %g",
                           value[0], LUX_MAX);
    if (!check_level(view, arena_format(view->arena, "%s/1", place), value[1], most, err))
        return false;
    if (i && !(value[0] > level->lux[i - 1]))
        return field_fails(view, place, err, "is at %g lx behind %g lx, required: more lx",
                           value[0], level->lux[i - 1]);
    if (i && value[1] < level->level[i - 1])
        return field_fails(view, place, err,
                           "falls from level %g to %g, required: one that does not fall",
                           level->level[i - 1], value[1]);
    level->lux[i] = value[0];
    level->level[i] = value[1];
    return true;
}

static bool read_curve(const JsonView *view, double most, ReviewLevel *level, Error *err)
{
    static const char *const keys[] = {"sensor", "table_lx"};
    level->is_curve = true;
    if (!json_view_check_keys(view, keys, COUNT_OF(keys), err) ||
        !read_sensor(view, level, err) || !field_wanted(view, "table_lx", err) ||
        !field_list(view, "table_lx", POINTS_MAX, &level->point_count, err))
        return false;
    level->lux = ARENA_NEW(view->arena, double, level->point_count);
    level->level = ARENA_NEW(view->arena, double, level->point_count);
    for (int i = 0; i < level->point_count; i++)
        if (!read_row(view, i, most, level, err)) return false;
    return true;
}

static bool read_level(const FieldMembers *members, int i, double most, ReviewLevel *level,
                       Error *err)
{
    FieldMembers parts;
    level->name = members->name[i];
    if (!field_members(&members->view, level->name, FIXED_MAX, &parts, err)) return false;
    bool is_curve = json_object_get(parts.view.object, "sensor") ||
                    json_object_get(parts.view.object, "table_lx");
    level->fixed_count = is_curve ? 0 : parts.count;
    return is_curve ? read_curve(&parts.view, most, level, err)
                    : read_fixed(&parts, most, &level->fixed, err);
}

bool request_levels_of(const JsonView *view, double most, ReviewLevel **out, int *count,
                       Error *err)
{
    FieldMembers members;
    if (!field_members(view, "levels", LEVELS_MAX, &members, err)) return false;
    *out = ARENA_NEW(view->arena, ReviewLevel, members.count);
    *count = members.count;
    for (int i = 0; i < members.count; i++)
        if (!read_level(&members, i, most, &(*out)[i], err)) return false;
    return true;
}

bool request_levels_read(RequestReading *reading, Error *err)
{
    ReviewRequest *request = reading->request;
    request->max_level = 1;
    return json_view_number(&reading->root, "max_level", 1, LEVEL_MAX, &request->max_level,
                            err) &&
           request_levels_of(&reading->root, request->max_level, &request->levels,
                             &request->level_count, err);
}
