/* SPDX-License-Identifier: Apache-2.0 */
/* weather_clock.h -- which instant a row of a weather file belongs to, and the row of a moment.
 *
 * By the format's word a row holds the means of the hour that ends at its label: the sun stands
 * as at the label less half an hour. Many files hold the light of an instant instead. The file
 * itself shows it: GHI = DHI + DNI sin(elevation of the sun) holds at the right instant only
 * ("closure"), so that is searched minute by minute over a day. A comment "Irradiance Time
 * Offset (h):" (PVGIS) gives the minutes more finely; it counts from another hour than the
 * label in files that were seen, so its whole hour is the closure's.
 *
 * Units     hours from the label to the instant (hour means: -0.5); W m^-2.
 * Threads   pure functions. Fails: never.
 */
#pragma once
#include "base/arena.h"
#include "sky/epw.h"

/* Closure's own uncertainty: instruments, the sky around the sun. */
#define WEATHER_CLOCK_NEAR_H (5 / 60.0)

typedef enum WeatherClockSource {
    WEATHER_CLOCK_MEANS,   /* as the format has it */
    WEATHER_CLOCK_COMMENT, /* the file's comment */
    WEATHER_CLOCK_CLOSURE, /* where the file closes */
    WEATHER_CLOCK_GIVEN    /* by the user */
} WeatherClockSource;

typedef struct WeatherClock {
    WeatherClockSource source;
    double offset_h;
    int rows;                  /* that count; 0: too few have sun and all three irradiances */
    bool closes;               /* within a tenth of mean_global_w_m2, somewhere */
    double closure_w_m2;       /* mean of |GHI - DHI - DNI sin el| at offset_h */
    double means_closure_w_m2; /* the same, read as means that end at the label */
    double best_offset_h, best_closure_w_m2;
    double mean_global_w_m2; /* of the rows that count */
} WeatherClock;

/* given_h: the user's offset, or NULL. scratch: 48 bytes a row. */
WeatherClock weather_clock_find(const Weather *weather, const double *given_h, Arena scratch);

/* The row whose instant is nearest to a moment, by month, day and clock, of any year (of
 * equally near ones that of the same year). 29 February is read as the 28th where the file has
 * none. *apart_min: minutes from the moment to the row's instant. NULL: none within half an
 * hour. */
const WeatherHour *weather_clock_row(const Weather *weather, const WeatherClock *clock,
                                     const SkyTime *time, double *apart_min);

/* How a row's global irradiance differs from its diffuse and direct light at its instant; NULL:
 * not by more than instruments do, or there is no telling. */
const char *weather_clock_row_doubt(const Weather *weather, const WeatherClock *clock,
                                    const WeatherHour *hour, Arena *arena);

/* "hour means", ...: for people and scripts. */
const char *weather_clock_source_text(WeatherClockSource source);

#define WEATHER_DOUBTS_MOST 4

/* A sentence each, without the file's name. */
typedef struct WeatherDoubts {
    int count;
    const char *text[WEATHER_DOUBTS_MOST];
} WeatherDoubts;

/* What of the file cannot be meant: rows that fit no sun, a place or a time zone whose sun is
 * not that of the light, another unit. */
WeatherDoubts weather_clock_doubts(const Weather *weather, const WeatherClock *clock, Arena *arena);
