/* SPDX-License-Identifier: Apache-2.0 */
#include "cli/options/weather_option.h"

#include <math.h>

#include "text/json_text.h"

#define CLOCK_OFF_H 1.5 /* farther than this is no convention of instants */

/* ---- telling ----------------------------------------------------------------------------- */

static void warn_of_clock(const EnvironmentWeather *weather, Problems *problems)
{
    const WeatherClock *clock = &weather->clock;
    if (clock->rows && !clock->closes)
        problems_add(problems, SEVERITY_WARNING, weather->file, "",
                     "GHI = DHI + DNI sin(elevation) holds at no instant: the mean difference "
                     "is at least %.1f W/m2 (%.2f h from the label; %.1f as hour means) of "
                     "%.1f W/m2 in %d rows — their instants are taken %+.2f h from the label "
                     "(%s), the sun may not fit their light; --weather-offset H sets them",
                     clock->best_closure_w_m2, clock->best_offset_h, clock->means_closure_w_m2,
                     clock->mean_global_w_m2, clock->rows,
                     clock->offset_h, weather_clock_source_text(clock->source));
    if (clock->source == WEATHER_CLOCK_CLOSURE && fabs(clock->offset_h) > CLOCK_OFF_H)
        problems_add(problems, SEVERITY_WARNING, weather->file, "",
                     "the light of its rows belongs to %+.2f h from their labels: its clock or "
                     "its time zone is wrong, the rows are taken where the sun fits them",
                     clock->offset_h);
}

const char *weather_option_text(const Environment *environment, Arena *arena)
{
    const EnvironmentWeather *weather = &environment->weather;
    const WeatherClock *clock = &weather->clock;
    if (!weather->line) return NULL;
    const char *closure =
        clock->rows ? arena_format(arena, "closes to %.1f W/m2, %.1f as hour means",
                                   clock->closure_w_m2, clock->means_closure_w_m2)
                    : "closure not known";
    return arena_format(arena, "line %d (%02d-%02d, label %02d:%02d), %.0f min %s; its instant "
                        "%+.2f h from the label by %s, %s", weather->line, weather->month,
                        weather->day, (int)weather->label_h,
                        (int)lround(fmod(weather->label_h, 1) * 60) % 60,
                        fabs(weather->apart_min), weather->apart_min < 0 ? "before" : "after",
                        clock->offset_h, weather_clock_source_text(clock->source), closure);
}

static json_t *number_or_null(bool is_known, double value)
{
    return is_known ? json_real(value) : json_null();
}

json_t *weather_option_json(const Environment *environment)
{
    const EnvironmentWeather *weather = &environment->weather;
    const WeatherClock *clock = &weather->clock;
    if (!weather->line) return json_null();
    bool known = clock->rows > 0;
    return json_pack("{s:o, s:i, s:i, s:i, s:f, s:f, s:f, s:s, s:b, s:i, s:o, s:o, s:o, s:o}",
                     "file", json_text(weather->file), "line", weather->line, "month",
                     weather->month, "day", weather->day, "label_h", weather->label_h,
                     "instant_minus_when_min", weather->apart_min, "offset_h", clock->offset_h,
                     "offset_source", weather_clock_source_text(clock->source), "closes",
                     (int)clock->closes, "closure_rows", clock->rows, "closure_w_m2",
                     number_or_null(known, clock->closure_w_m2), "closure_hour_means_w_m2",
                     number_or_null(known, clock->means_closure_w_m2), "best_offset_h",
                     number_or_null(known, clock->best_offset_h), "best_closure_w_m2",
                     number_or_null(known, clock->best_closure_w_m2));
}

/* ---- taking a row ------------------------------------------------------------------------ */

static bool check_row(const WeatherAsk *ask, const WeatherHour *hour, double apart_min,
                      Error *err)
{
    const SkyTime *when = &ask->when;
    if (!hour || !hour->has_light)
        return error_at(err, ERROR_INPUT, ask->file, "",
                        "has no hour with light for month %d, day %d, %02d:%02d", when->month,
                        when->day, when->hour, when->minute);
    return hour->diffuse_horizontal_w_m2 > 0 ||
           error_at(err, ERROR_INPUT, ask->file, "",
                    "month %d, day %d, hour %g (line %d, whose instant is %+.0f min from "
                    "--when) is dark (0 W/m2 diffuse), wanted an hour by day — for a night use "
                    "--environment sky:clear", hour->month, hour->day, hour->label_h,
                    hour->line, apart_min);
}

bool weather_option_apply(const WeatherAsk *ask, Environment *environment, Arena *arena,
                          Problems *problems, Error *err)
{
    Weather weather;
    double  apart_min = 0;
    if (!weather_read(ask->file, arena, &weather, err)) return false;
    WeatherClock clock = weather_clock_find(&weather, ask->offset_h, *arena);
    const WeatherHour *hour = weather_clock_row(&weather, &clock, &ask->when, &apart_min);
    if (!check_row(ask, hour, apart_min, err)) return false;
    environment->weather = (EnvironmentWeather){ask->file,     hour->line, hour->month,
                                                hour->day,     hour->label_h, apart_min, clock};
    environment->daylight.direct_w_m2 = hour->direct_normal_w_m2;
    environment->daylight.diffuse_w_m2 = hour->diffuse_horizontal_w_m2;
    if (!ask->has_place) environment->daylight.where = weather.place;
    warn_of_clock(&environment->weather, problems);
    return true;
}
