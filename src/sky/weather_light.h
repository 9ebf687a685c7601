/* SPDX-License-Identifier: Apache-2.0 */
/* weather_light.h -- the light of a weather file's row as a Perez sky: one rule for every
 * command that names a weather file.
 *
 * The irradiances give the sky's shape; its lux are theirs by luminous_efficacy.h's fit, with
 * the water of the row's dew point, or the file's own columns of illuminance. A row without a
 * dew point has WATER_USUAL_CM, which is reported (weather_light_rule_text).
 *
 * Units    W m^-2, lx, cm. Memory: texts from the arena. Threads: pure functions.
 * Fails    never: what a row lacks is its state.
 */
#pragma once
#include "sky/daylight.h"
#include "sky/epw.h"

/* By what a row's illuminances are known. */
typedef enum WeatherLux { WEATHER_LUX_PEREZ, WEATHER_LUX_FILE } WeatherLux;

typedef enum WeatherRowState {
    WEATHER_ROW_LIT,
    WEATHER_ROW_DARK, /* dark: no light at all */
    /* it cannot be taken: */
    WEATHER_ROW_WITHOUT_VALUES,
    WEATHER_ROW_WITHOUT_SKY,
    WEATHER_ROW_TOO_BRIGHT,
    WEATHER_ROW_WITHOUT_LUX
} WeatherRowState;

/* Too bright: more than the sun's 1361 W/m2 at its nearest, or 140,000 lx. An illuminance is
 * missing where it is marked so; where it is 0 although its irradiance is not (at least 1 W/m2
 * of diffuse light, which rounds to 100 lx; 20 of direct, which a low sun may have without
 * lux); and where diffuse light has less than 50 or more than 300 lm/W: another unit. */
WeatherRowState weather_row_state(const WeatherHour *hour, WeatherLux lux);

/* "has no direct or no diffuse radiation", ...: what is wrong in one of the last states. */
const char *weather_row_lacks(const WeatherHour *hour, WeatherRowState state, Arena *arena);

/* Irradiances, lux and water of a lit row, into a Perez sky's input. */
void weather_light_take(const WeatherHour *hour, WeatherLux lux, DaylightInput *out);

/* "perez 1990" or "file": for scripts. */
const char *weather_lux_text(WeatherLux lux);

/* Of a Perez sky's lux: what set them. "Perez 1990's luminous efficacies, 2.00 cm of water
 * (dew point)", "the file's own lux columns". */
const char *weather_light_rule_text(const DaylightInput *input, Arena *arena);

/* "dew point", "given" or "assumed". */
const char *weather_water_text(WaterSource source);
