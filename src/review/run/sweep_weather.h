/* SPDX-License-Identifier: Apache-2.0 */
/* sweep_weather.h -- the hours of a weather file that a sweep stands under.
 *
 * Each step takes the row whose instant is nearest (weather_clock.h), with the sun where it
 * stands at the step: steps shorter than the file's share its rows. Where a row has no light
 * the step is dark; so is one whose sun stands lower than any Perez sky (-4 degrees).
 *
 * Memory   from the arena.
 * Threads  sweep_weather_skies starts its own; the same skies for any count.
 * Fails    on gaps: with the weather file, its line, the step that needs it, and how many do.
 */
#pragma once
#include "review/suns/sweep_suns.h"

/* The light of one of a sweep's suns, as DAYLIGHT_PEREZ; false: it is dark. After the check. */
bool sweep_weather_light(const ReviewRequest *request, const ReviewCondition *condition,
                         const SweepSun *sun, DaylightInput *out);

/* The file's light at that step: "512 W/m2 direct, 81 diffuse: 48832 and 10170 lx by
 * Perez 1990". */
const char *sweep_weather_text(const ReviewRequest *request, const ReviewCondition *condition,
                               const SweepSun *sun, Arena *arena);

/* Has every step its row, with light in it where the sun is high? */
bool sweep_weather_check(const ReviewRequest *request, const ReviewCondition *condition,
                         const SweepSuns *suns, Arena scratch, Error *err);

bool sweep_weather_skies(const Setup *setup, const SweepSuns *suns, Arena *arena, HourSkies *out,
                         Error *err);

/* A note for readers: where the instants of the file's rows lie, and how well that fits. */
const char *sweep_weather_note(const ReviewWeather *weather, Arena *arena);

/* And by what its lux are known. */
const char *sweep_weather_lux_note(const ReviewWeather *weather, WeatherLux lux, Arena *arena);
