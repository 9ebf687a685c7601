#include "review/request/request_weather.h"

#include <string.h>

#include "base/file.h"

#define HOURS_OF_YEAR 8760

/* A share of the year that fails says nothing when some of its hours are not known. */
static bool check_whole(const Weather *weather, Arena *arena, Error *err)
{
    int wanted = HOURS_OF_YEAR * weather->rows_per_hour, missing = 0, first = NO_ID;
    for (int i = 0; i < weather->count; i++) {
        if (weather->hour[i].has_light) continue;
        if (!missing++) first = i;
    }
    if (missing)
        return error_at(err, ERROR_INPUT, weather->file,
                        arena_format(arena, "line %d", weather->hour[first].line),
                        "has no direct or no diffuse radiation, as %d of %d rows, wanted a "
                        "year without gaps", missing, weather->count);
    return weather->count >= wanted ||
           error_at(err, ERROR_INPUT, weather->file, "",
                    "has %d rows, wanted the %d of a year", weather->count, wanted);
}

static bool add_weather(RequestReading *reading, const char *path, Error *err)
{
    ReviewRequest *request = reading->request;
    Arena         *arena = reading->root.arena;
    ReviewWeather  found = {.path = path};
    if (!weather_read(path, arena, &found.weather, err) ||
        !check_whole(&found.weather, arena, err) || !request_note_file(reading, path, err))
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

bool request_weather_read(RequestReading *reading, const JsonView *view, int *weather_id,
                          Error *err)
{
    const ReviewRequest *request = reading->request;
    const char          *text = "clear", *path = NULL;
    *weather_id = NO_ID;
    if (!json_view_text(view, "weather", &text, err)) return false;
    if (!strcmp(text, "clear")) return true;
    if (strcmp(path_ending(text), ".epw"))
        return field_fails(view, "weather", err,
                           "is '%.60s', wanted 'clear' or a weather file .epw", text);
    if (!field_file(view, "weather", &path, err)) return false;
    for (int i = 0; i < request->weather_count; i++)
        if (!strcmp(request->weathers[i].path, path)) *weather_id = i;
    if (*weather_id != NO_ID) return true;
    *weather_id = request->weather_count;
    return add_weather(reading, path, err);
}
