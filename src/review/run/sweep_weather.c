/* SPDX-License-Identifier: Apache-2.0 */
#include "review/run/sweep_weather.h"

#include <math.h>

#include "sky/weather_light.h"

#define LOWEST_SUN_DEG (-4.0) /* of Perez's skies (sky/daylight.h) */
#define HIGH_SUN_DEG 10.0     /* half an hour beside a row's instant it may have set */

/* ---- a step's row ------------------------------------------------------------------------ */

typedef enum HourState {
    HOUR_LIT,
    HOUR_DARK,
    HOUR_WITHOUT_ROW,
    HOUR_INCOMPLETE,
    HOUR_WITHOUT_LIGHT /* gaps */
} HourState;

static const ReviewWeather *weather_of(const ReviewRequest *request,
                                       const ReviewCondition *condition) {
    return &request->weathers[condition->weather_id];
}

static SkyTime step_time(const ReviewCondition *condition, const SweepSun *sun) {
    return sweep_time(condition, condition->step_minutes, sun->step);
}

static const WeatherHour *row_of(const ReviewWeather *weather, const SkyTime *when) {
    double apart_min;
    return weather_clock_row(&weather->weather, &weather->clock, when, &apart_min);
}

static HourState state_of(const WeatherHour *row, WeatherLux lux, double elevation_deg) {
    if (!row) return HOUR_WITHOUT_ROW;
    WeatherRowState state = weather_row_state(row, lux);
    if (state == WEATHER_ROW_WITHOUT_VALUES) return HOUR_INCOMPLETE;
    if (elevation_deg <= LOWEST_SUN_DEG) return HOUR_DARK;
    if (state == WEATHER_ROW_LIT) return HOUR_LIT;
    if (state != WEATHER_ROW_DARK) return HOUR_INCOMPLETE;
    return elevation_deg > HIGH_SUN_DEG ? HOUR_WITHOUT_LIGHT : HOUR_DARK;
}

bool sweep_weather_light(const ReviewRequest *request, const ReviewCondition *condition,
                         const SweepSun *sun, DaylightInput *out) {
    SkyTime when = step_time(condition, sun);
    const WeatherHour *row = row_of(weather_of(request, condition), &when);
    if (state_of(row, condition->weather_lux, sun->elevation_deg) != HOUR_LIT) return false;
    *out = daylight_input_default(DAYLIGHT_PEREZ);
    out->has_time = true;
    out->when = when;
    out->where = condition->where;
    weather_light_take(row, condition->weather_lux, out);
    return true;
}

const char *sweep_weather_text(const ReviewRequest *request, const ReviewCondition *condition,
                               const SweepSun *sun, Arena *arena) {
    Error err;
    Arena none = {0};
    DaylightInput light;
    Daylight sky;
    if (!sweep_weather_light(request, condition, sun, &light)) return "dark by the weather file";
    light.integral_steps = HOUR_SKY_STEPS;
    const char *watts =
        arena_format(arena, "%g W/m2 direct, %g diffuse", light.direct_w_m2, light.diffuse_w_m2);
    if (!daylight_build(&light, &none, &sky, &err)) return watts;
    return arena_format(arena, "%s: %.0f and %.0f lx by %s", watts, sky.metrics.direct_normal_lx,
                        sky.metrics.diffuse_horizontal_lx,
                        light.has_lux ? "the file's columns" : "Perez 1990");
}

/* ---- gaps -------------------------------------------------------------------------------- */

static bool is_new_step(const SweepSuns *suns, int i) {
    return !i || suns->list[i].step != suns->list[i - 1].step;
}

typedef struct Gaps {
    int steps, count;
    HourState state; /* of the first one: */
    const WeatherHour *row;
    const SweepSun *sun;
} Gaps;

static Gaps find_gaps(const ReviewRequest *request, const ReviewCondition *condition,
                      const SweepSuns *suns) {
    Gaps gaps = {0};
    for (int i = 0; i < suns->count; i++) {
        const SweepSun *sun = &suns->list[i];
        if (!is_new_step(suns, i)) continue;
        SkyTime when = step_time(condition, sun);
        const WeatherHour *row = row_of(weather_of(request, condition), &when);
        HourState state = state_of(row, condition->weather_lux, sun->elevation_deg);
        gaps.steps++;
        if (state < HOUR_WITHOUT_ROW) continue;
        if (!gaps.count++) gaps.state = state, gaps.row = row, gaps.sun = sun;
    }
    return gaps;
}

static const char *gap_text(const Gaps *gaps, WeatherLux lux, Arena *arena) {
    switch (gaps->state) {
    case HOUR_INCOMPLETE:
        return weather_row_lacks(gaps->row, weather_row_state(gaps->row, lux), arena);
    case HOUR_WITHOUT_LIGHT:
        return arena_format(arena, "is dark while the sun stands %.0f degrees high",
                            gaps->sun->elevation_deg);
    default: return "has no row within half an hour";
    }
}

bool sweep_weather_check(const ReviewRequest *request, const ReviewCondition *condition,
                         const SweepSuns *suns, Arena scratch, Error *err) {
    Gaps gaps = find_gaps(request, condition, suns);
    if (!gaps.count) return true;
    SkyTime when = step_time(condition, gaps.sun);
    const char *place = gaps.row ? arena_format(&scratch, "line %d", gaps.row->line) : "";
    return error_at(err, ERROR_INPUT, weather_of(request, condition)->path, place,
                    "%s, where '%.60s' needs one (%d-%02d-%02d %02d:%02d UTC, %d of its %d "
                    "steps alike); required direct and diffuse daylight for each",
                    gap_text(&gaps, condition->weather_lux, &scratch), condition->name, when.year,
                    when.month, when.day, when.hour, when.minute, gaps.count, gaps.steps);
}

/* ---- skies ------------------------------------------------------------------------------- */

static bool no_sky(const Setup *setup, const SkyTime *when, Arena scratch, Error *err) {
    const ReviewWeather *weather = weather_of(setup->request, setup->condition);
    const WeatherHour *row = row_of(weather, when);
    return error_at(err, ERROR_INPUT, weather->path, arena_format(&scratch, "line %d", row->line),
                    "%s", arena_format(&scratch, "%s", err->text));
}

bool sweep_weather_skies(const Setup *setup, const SweepSuns *suns, Arena *arena, HourSkies *out,
                         Error *err) {
    int *of_sun = ARENA_NEW(arena, int, suns->count), count = 0, failed;
    Arena scratch = arena_reserve(sizeof(DaylightInput) * ((size_t)suns->count + 1));
    DaylightInput *inputs = ARENA_NEW(&scratch, DaylightInput, suns->count);
    for (int i = 0; i < suns->count; i++) {
        const SweepSun *sun = &suns->list[i];
        if (!is_new_step(suns, i)) of_sun[i] = of_sun[i - 1];
        else if (sweep_weather_light(setup->request, setup->condition, sun, &inputs[count]))
            of_sun[i] = count++;
        else of_sun[i] = NO_ID;
    }
    out->of_sun = of_sun;
    HourInputs hours = {inputs, count};
    bool ok = hour_skies_build(&hours, setup->tools.threads, arena, &out->list, &failed, err) ||
              no_sky(setup, &inputs[failed].when, *arena, err);
    arena_release(&scratch);
    return ok;
}

/* ---- telling ----------------------------------------------------------------------------- */

/* " 3 of its rows do not add up: the first, line 12, has ..."; "": all do. */
static const char *rows_note(const ReviewWeather *weather, Arena *arena) {
    const Weather *of = &weather->weather;
    const char *first = "";
    int count = 0, line = 0;
    for (int i = 0; i < of->count; i++) {
        Arena scratch = *arena;
        const char *doubt = weather_clock_row_doubt(of, &weather->clock, &of->hour[i], &scratch);
        if (!doubt || count++) continue;
        *arena = scratch;
        first = doubt, line = of->hour[i].line;
    }
    return !count ? ""
                  : arena_format(arena,
                                 " %d of its rows do not add up: the first, line "
                                 "%d, %s.",
                                 count, line, first);
}

const char *sweep_weather_note(const ReviewWeather *weather, Arena *arena) {
    const WeatherClock *clock = &weather->clock;
    const char *fit = "whether its light fits the sun is not known";
    if (clock->rows && clock->closes)
        fit = arena_format(arena, "there its light fits the sun to %.1f of %.0f W/m2",
                           clock->closure_w_m2, clock->mean_global_w_m2);
    else if (clock->rows)
        fit = arena_format(arena,
                           "its light fits the sun at no instant (%.1f of %.0f W/m2 at "
                           "best), directions may be wrong",
                           clock->best_closure_w_m2, clock->mean_global_w_m2);
    return arena_format(arena,
                        "Weather: %s (%s); its rows are taken %+.2f h from their labels "
                        "(%s), %s.%s",
                        weather->path, weather->weather.city, clock->offset_h,
                        weather_clock_source_text(clock->source), fit, rows_note(weather, arena));
}

/* Rows with light that have no dew point. */
static int rows_without_water(const Weather *weather) {
    int count = 0;
    for (int i = 0; i < weather->count; i++) {
        const WeatherHour *hour = &weather->hour[i];
        count += hour->diffuse_horizontal_w_m2 > 0 && !hour->has_dew_point;
    }
    return count;
}

const char *sweep_weather_lux_note(const ReviewWeather *weather, WeatherLux lux, Arena *arena) {
    const char *assumed = "";
    if (lux == WEATHER_LUX_FILE)
        return arena_format(arena,
                            "Lux of %s: the file's own columns; its irradiances give "
                            "the sky's shape.",
                            weather->path);
    int missing = rows_without_water(&weather->weather);
    if (missing)
        assumed = arena_format(arena,
                               "; %d of its rows with light have none: %g cm of water "
                               "are assumed there",
                               missing, WATER_USUAL_CM);
    return arena_format(arena,
                        "Lux of %s: its irradiances times Perez 1990's luminous "
                        "efficacies, with water by each row's dew point%s.",
                        weather->path, assumed);
}
