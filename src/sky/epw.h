/* SPDX-License-Identifier: Apache-2.0 */
/* epw.h -- weather files of EnergyPlus: a place and the direct and diffuse light of every hour.
 *
 * Source    EnergyPlus, Auxiliary Programs: EPW data dictionary. Header line LOCATION, then
 *           data rows of comma-separated fields, hours 1 to 24 of local standard time: a row's
 *           label is the end of its hour. Which instant its light belongs to is
 *           weather_clock.h's question.
 * Memory    the arena's. Threads: const once read.
 * Fails     with file and line, what was found and what was required. Missing values (9999 or
 *           more nines of an irradiance) are marked by has_light = false, a dew point (99.9) by
 *           has_dew_point.
 */
#pragma once
#include "base/arena.h"
#include "base/error.h"
#include "sky/sun_position.h"

typedef struct WeatherHour {
    int line, year, month, day;
    double label_h; /* end of its span, hours after midnight of the zone, above 0 to 24 */
    double direct_normal_w_m2, diffuse_horizontal_w_m2; /* negative: missing */
    double global_horizontal_w_m2;                      /* negative: missing */
    double direct_normal_lx, diffuse_horizontal_lx;     /* negative: missing */
    double dew_point_c;
    bool has_light, has_dew_point;
} WeatherHour;

typedef struct Weather {
    const char *city;
    SkyPlace place;
    double zone_h;
    int rows_per_hour, fields; /* fields: of every row */
    bool has_comment_offset;   /* a comment "Irradiance Time Offset (h):" (PVGIS) */
    double comment_offset_h;
    WeatherHour *hour;
    int count;
} Weather;

bool weather_read(const char *file, Arena *arena, Weather *out, Error *err);
