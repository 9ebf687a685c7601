/* SPDX-License-Identifier: Apache-2.0 */
/* weather_option.h -- a weather file's row as the light of a sky, and what was done to find it.
 *
 * Memory   the command's arena. Fails: ERROR_INPUT with the file.
 */
#pragma once
#include <jansson.h>

#include "base/problems.h"
#include "scene/scene.h"

typedef struct WeatherAsk {
    const char   *file;
    SkyTime       when;
    bool          has_place;    /* the user's own: the station's is not taken */
    const double *offset_h;     /* --weather-offset, or NULL */
} WeatherAsk;

/* Sets the irradiances, the place and how they were found. A file that closes nowhere, or whose
 * clock is hours off, goes to *problems as a warning. */
bool weather_option_apply(const WeatherAsk *ask, Environment *environment, Arena *arena,
                          Problems *problems, Error *err);

/* "line 4123 (06-21, hour 12), ...": for the sky's figures and a frame's metadata. NULL: there
 * was no weather file. */
const char *weather_option_text(const Environment *environment, Arena *arena);

/* The same as an object; null without a weather file. */
json_t *weather_option_json(const Environment *environment);
