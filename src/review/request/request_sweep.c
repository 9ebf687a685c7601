/* SPDX-License-Identifier: Apache-2.0 */
#include "review/request/request_sweep.h"

#include <math.h>

#include "review/request/request_weather.h"

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
        return field_fails(view, key, err, "has a step of %g, wanted at least %g",
                           json_number_value(step), STEP_LEAST);
    if (!field_numbers(view, key, bounds, value, NULL, err)) return false;
    if (value[1] < value[0])
        return field_fails(view, key, err,
                           "goes from %g to %g, which is empty; wanted [first, last, step] "
                           "with last not below first", value[0], value[1]);
    double steps = (value[1] - value[0]) / value[2];
    if (steps > RANGE_MAX)
        return field_fails(view, key, err, "has %.0f values, wanted at most %d", steps + 1,
                           RANGE_MAX);
    if (fabs(steps - round(steps)) > WHOLE)
        return field_fails(view, key, err,
                           "does not come from %g to %g in steps of %g, wanted a step such as "
                           "%.6g", value[0], value[1], value[2], fitting_step(value));
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
        return field_fails(&sun, axes[0], err, "spans %g degrees, wanted at most 360",
                           condition->azimuth_deg.last - condition->azimuth_deg.first);
    double suns = (double)condition->azimuth_deg.count * condition->elevation_deg.count;
    return suns <= SUNS_MAX ||
           error_at(err, ERROR_INPUT, sun.file, sun.path, "has %.0f suns, wanted at most %d",
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
                           "is no place, wanted [latitude -90 to 90, longitude -360 to 360] in "
                           "degrees north and east, and an altitude in m");
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
                                   "holds %g and %g, wanted each heading once",
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
                                       "headings_deg", "weather", "night"};
    condition->kind = CONDITION_YEAR_SWEEP;
    condition->step_minutes = 60;
    return json_view_check_keys(sweep, keys, COUNT_OF(keys), err) &&
           field_integer(sweep, "year", (FieldBounds){1900, 2100}, &condition->year, err) &&
           json_view_number(sweep, "step_minutes", 0.5, 1440, &condition->step_minutes, err) &&
           read_headings(sweep, condition, err) &&
           field_boolean(sweep, "night", &condition->with_night, err) &&
           request_weather_read(reading, sweep, &condition->weather_id, err) &&
           find_place(reading, sweep, condition, err);
}

bool request_sweep_read(RequestReading *reading, const JsonView *view,
                        ReviewCondition *condition, Error *err)
{
    static const char *const keys[] = {"sun",   "sky",          "year",         "where",
                                       "night", "step_minutes", "headings_deg", "weather"};
    bool has_sun = json_object_get(view->object, "sun") != NULL;
    bool has_year = json_object_get(view->object, "year") != NULL;
    if (!json_view_check_keys(view, keys, COUNT_OF(keys), err)) return false;
    if (has_sun == has_year)
        return error_at(err, ERROR_INPUT, view->file, view->path,
                        "has %s, wanted one of 'sun' and 'year'",
                        has_sun ? "both" : "neither");
    return has_sun ? read_suns(view, condition, err)
                   : read_year(reading, view, condition, err);
}
