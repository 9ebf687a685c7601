/* SPDX-License-Identifier: Apache-2.0 */
#include "review/request/request_weather.h"

#include <string.h>

#include "base/file.h"

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
