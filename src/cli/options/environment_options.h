/* SPDX-License-Identifier: Apache-2.0 */
/* environment_options.h -- the command line's options for the surroundings: render and sky.
 *
 * Memory   the command's arena. Fails: ERROR_USAGE with the option, ERROR_INPUT with a file.
 */
#pragma once
#include <jansson.h>

#include "base/problems.h"
#include "cli/options/cli.h"
#include "scene/scene.h"

/* The command line's changes; NULL and false: the scene's. */
typedef struct EnvironmentChange {
    const char *environment; /* "constant:CD_M2", "hdri:FILE", "sky:clear", "cie:N[:LUX]",
                                "perez:DNI,DHI" */
    const char *sun;         /* "auto", "off", "AZ,EL", "AZ,EL,LUX" */
    const char *when, *where, *weather;
    const char *ground; /* "land", "sea", "cloud", "cloud:TOP_M" */
    bool has_hdri_lux, has_forward, has_heading, has_turbidity, has_visibility;
    bool has_weather_offset, has_weather_lux, no_moon;
    int weather_lux;   /* WeatherLux */
    double hdri_lux;   /* lx on a horizontal plane */
    double forward[3]; /* scene vector */
    double heading_deg, turbidity, visibility_km, weather_offset_h;
} EnvironmentChange;

/* Rows of an option table. */
#define ENVIRONMENT_OPTIONS(change) \
    {"--environment", OPTION_TEXT, "KIND", \
     "sky:clear, cie:1..15[:LX], perez:DNI,DHI (W/m2), hdri:FILE or constant:CD_M2", \
     &(change)->environment}, \
        {"--hdri-lux", \
         OPTION_NUMBER, \
         "LX", \
         "scale the HDRI to this horizontal illuminance", \
         &(change)->hdri_lux, \
         .low = 1e-6, \
         .high = 1e9, \
         .given = &(change)->has_hdri_lux}, \
        {"--when", OPTION_TEXT, "TIME", "moment with its zone: 2026-06-21T08:30+02:00", \
         &(change)->when}, \
        {"--where", OPTION_TEXT, "LAT,LON[,ALT]", "degrees north and east, m above the sea", \
         &(change)->where}, \
        {"--weather", OPTION_TEXT, "FILE.epw", \
         "a Perez sky of the light (and the place) of --when's hour", &(change)->weather}, \
        {"--weather-offset", \
         OPTION_NUMBER, \
         "H", \
         "from a row's label to its instant, h (-0.5: hour means); else found from the file", \
         &(change)->weather_offset_h, \
         .low = -12, \
         .high = 12, \
         .given = &(change)->has_weather_offset}, \
        {"--weather-lux", \
         OPTION_CHOICE, \
         "perez|file", \
         "its lux: by Perez 1990's luminous efficacies, or the file's own columns", \
         &(change)->weather_lux, \
         .given = &(change)->has_weather_lux}, \
        {"--sun", OPTION_TEXT, "auto|off|AZ,EL[,LUX]", \
         "of --when and --where; none; degrees from north over east and up, lx", &(change)->sun}, \
        {"--ground", OPTION_TEXT, "land|sea|cloud[:TOP_M]", \
         "what lies below a clear sky (default land; clouds end at 2000 m)", &(change)->ground}, \
        {"--turbidity",        OPTION_NUMBER, "T",        "of sky:clear: 2 very clear, 2.5, 6 hazy", \
         &(change)->turbidity, .low = 1,      .high = 30, .given = &(change)->has_turbidity}, \
        {"--visibility", \
         OPTION_NUMBER, \
         "KM", \
         "of sky:clear, instead of the turbidity", \
         &(change)->visibility_km, \
         .low = 0.1, \
         .high = 400, \
         .given = &(change)->has_visibility}, \
        {"--no-moon", OPTION_FLAG, NULL, "leave the moon out of sky:clear's nights", \
         &(change)->no_moon}, \
        {"--forward", \
         OPTION_NUMBERS, \
         "X,Y,Z", \
         "where the vehicle points (default 0,0,-1)", \
         (change)->forward, \
         .count = 3, \
         .given = &(change)->has_forward}, \
    { \
        "--heading", OPTION_NUMBER, "DEG", "compass heading of the vehicle", \
            &(change)->heading_deg, .low = -360, .high = 360, .given = &(change)->has_heading \
    }

/* Overrides single members of the scene's environment; a file that is read joins the scene's
 * inputs. What was taken as a default goes to *problems as a warning. */
bool environment_change(const EnvironmentChange *change, Scene *scene, Arena *arena,
                        Problems *problems, Error *err);

/* "line 4123 (06-21, hour 12), ...": for the sky's figures and a frame's metadata. NULL: there
 * was no weather file. */
const char *weather_option_text(const Environment *environment, Arena *arena);

/* The same as an object; null without a weather file. */
json_t *weather_option_json(const Environment *environment);
