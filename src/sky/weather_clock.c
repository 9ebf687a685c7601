/* SPDX-License-Identifier: Apache-2.0 */
#include "sky/weather_clock.h"

#include <math.h>

#include "base/calendar.h"
#include "base/mathd.h"
#include "base/units.h"

#define ROWS_LEAST 24 /* fewer are not enough to be sure */
#define ROWS_MOST 20000
#define NEAR_H (5 / 60.0) /* closure's own uncertainty: instruments, sky around the sun */
#define CLOSES_SHARE 0.1
#define DIRECT_LEAST_W_M2 1.0
#define ROW_SHARE 0.2 /* a row's three irradiances agree within: instruments, a sunrise */
#define ROW_W_M2 50.0
#define HALF_HOUR_MIN 30.5 /* and a little */

/* The closure of one row: sin(elevation) at an offset turned into an angle w is
 * a + b cos w - c sin w, since within a day only the hour angle moves much. */
typedef struct ClosureRow {
    double a, b, c;
    double direct, rest; /* DNI; GHI - DHI */
} ClosureRow;

/* ---- closure ----------------------------------------------------------------------------- */

static bool tells(const WeatherHour *hour) {
    return hour->has_light && hour->global_horizontal_w_m2 >= 0 &&
           hour->direct_normal_w_m2 >= DIRECT_LEAST_W_M2;
}

static ClosureRow closure_row(const Weather *weather, const WeatherHour *hour) {
    SkyTime midnight = {hour->year, hour->month, hour->day, 0, 0, 0, weather->zone_h};
    double day = sky_julian_day(&midnight) + hour->label_h / 24;
    SunPosition p = sun_position(day, sky_delta_t_s(day), &weather->place);
    double latitude = radians_from_degrees(weather->place.latitude_deg);
    double declination = radians_from_degrees(p.topocentric_declination_deg);
    double angle = radians_from_degrees(p.topocentric_hour_angle_deg);
    double across = cos_d(latitude) * cos_d(declination);
    return (ClosureRow){sin_d(latitude) * sin_d(declination), across * cos_d(angle),
                        across * sin_d(angle), hour->direct_normal_w_m2,
                        hour->global_horizontal_w_m2 - hour->diffuse_horizontal_w_m2};
}

/* Direct light on the horizontal at an offset. */
static double direct_at(const ClosureRow *row, double offset_h) {
    double sine = sin_d(offset_h * PI / 12), cosine = cos_d(offset_h * PI / 12);
    return row->direct * fmax(0, row->a + row->b * cosine - row->c * sine);
}

/* Mean absolute difference: single rows that are wrong do not move its minimum much, and rows
 * of a low sun, whose hour holds a sunrise, weigh as little as their light. */
static double closure_at(const ClosureRow *row, int count, double offset_h) {
    double sum = 0, sine = sin_d(offset_h * PI / 12), cosine = cos_d(offset_h * PI / 12);
    for (int i = 0; i < count; i++)
        sum += fabs(row[i].rest -
                    row[i].direct * fmax(0, row[i].a + row[i].b * cosine - row[i].c * sine));
    return sum / count;
}

static void search(const ClosureRow *row, int count, WeatherClock *clock) {
    int coarse = -720, best = 0;
    double least = HUGE_VAL;
    for (int minute = -720; minute < 720; minute += 10) {
        double value = closure_at(row, count, minute / 60.0);
        if (value < least) least = value, coarse = minute;
    }
    least = HUGE_VAL;
    for (int minute = coarse - 10; minute <= coarse + 10; minute++) {
        double value = closure_at(row, count, minute / 60.0);
        if (value < least) least = value, best = minute;
    }
    clock->best_offset_h = best / 60.0;
    clock->best_closure_w_m2 = least;
    clock->closes = least <= CLOSES_SHARE * clock->mean_global_w_m2;
}

/* ---- choosing ---------------------------------------------------------------------------- */

/* PVGIS's line in an EPW is that of its other formats less one hour. */
static double comment_offset(const Weather *weather) {
    double line = weather->comment_offset_h;
    return line < 0 ? line + 1 : line;
}

static void choose(const Weather *weather, WeatherClock *clock) {
    double best = clock->best_offset_h, comment = weather->comment_offset_h;
    double hour = floor(best - comment + 0.5); /* the line's whole hour by closure */
    bool is_known = clock->rows && clock->closes;
    if (weather->has_comment_offset && !is_known) {
        clock->source = WEATHER_CLOCK_COMMENT;
        clock->offset_h = comment_offset(weather);
    } else if (weather->has_comment_offset && fabs(comment + hour - best) <= NEAR_H) {
        clock->source = WEATHER_CLOCK_COMMENT;
        clock->offset_h = comment + hour;
    } else if (is_known && fabs(clock->offset_h - best) > NEAR_H) {
        clock->source = WEATHER_CLOCK_CLOSURE;
        clock->offset_h = best;
    }
}

WeatherClock weather_clock_find(const Weather *weather, const double *given_h, Arena scratch) {
    double means = -0.5 / weather->rows_per_hour;
    WeatherClock clock = {.source = WEATHER_CLOCK_MEANS, .offset_h = means};
    int stride = 1 + weather->count / ROWS_MOST, count = 0;
    ClosureRow *row = ARENA_NEW(&scratch, ClosureRow, weather->count / stride + 1);
    for (int i = 0; i < weather->count; i += stride) {
        const WeatherHour *hour = &weather->hour[i];
        if (!tells(hour)) continue;
        row[count++] = closure_row(weather, hour);
        clock.mean_global_w_m2 += hour->global_horizontal_w_m2;
    }
    if (count >= ROWS_LEAST) {
        clock.rows = count;
        clock.mean_global_w_m2 /= count;
        search(row, count, &clock);
    }
    choose(weather, &clock);
    if (given_h) clock.source = WEATHER_CLOCK_GIVEN, clock.offset_h = *given_h;
    if (!clock.rows) return clock;
    clock.closure_w_m2 = closure_at(row, count, clock.offset_h);
    clock.means_closure_w_m2 = closure_at(row, count, means);
    return clock;
}

/* ---- the row of a moment ----------------------------------------------------------------- */

/* Days since the year began. */
static int day_of(int year, int month, int day) {
    static const int before[] = {0, 31, 59, 90, 120, 151, 181, 212, 243, 273, 304, 334};
    return before[month - 1] + (month > 2 && calendar_is_leap(year)) + day - 1;
}

static bool has_leap_day(const Weather *weather) {
    for (int i = 0; i < weather->count; i++)
        if (weather->hour[i].month == 2 && weather->hour[i].day == 29) return true;
    return false;
}

/* Nearer; or as near and later, as an hour begins at its full clock; or of the same year. */
static bool is_better(double apart, bool is_same_year, const WeatherHour *nearest, double held) {
    if (!nearest) return fabs(apart) < HALF_HOUR_MIN;
    if (fabs(fabs(apart) - fabs(held)) > 1e-6) return fabs(apart) < fabs(held);
    return apart > held + 1e-6 || (is_same_year && apart > held - 1e-6);
}

const WeatherHour *weather_clock_row(const Weather *weather, const WeatherClock *clock,
                                     const SkyTime *time, double *apart_min) {
    const WeatherHour *nearest = NULL;
    int day = time->month == 2 && time->day == 29 && !has_leap_day(weather) ? 28 : time->day;
    double year_min = 1440 * (365 + calendar_is_leap(time->year));
    double wanted = 1440 * day_of(time->year, time->month, day) + 60 * time->hour + time->minute +
                    time->second / 60 + 60 * (weather->zone_h - time->zone_h);
    for (int i = 0; i < weather->count; i++) {
        const WeatherHour *hour = &weather->hour[i];
        if (hour->month == 2 && hour->day == 29 && !calendar_is_leap(time->year)) continue;
        double apart = 1440 * day_of(time->year, hour->month, hour->day) +
                       60 * (hour->label_h + clock->offset_h) - wanted;
        apart -= year_min * floor(apart / year_min + 0.5);
        if (!is_better(apart, hour->year == time->year, nearest, *apart_min)) continue;
        nearest = hour;
        *apart_min = apart;
    }
    return nearest;
}

const char *weather_clock_row_doubt(const Weather *weather, const WeatherClock *clock,
                                    const WeatherHour *hour, Arena *arena) {
    double global = hour->global_horizontal_w_m2, diffuse = hour->diffuse_horizontal_w_m2;
    if (!hour->has_light || global < 0 || (clock->rows && !clock->closes)) return NULL;
    ClosureRow row = closure_row(weather, hour);
    double direct = direct_at(&row, clock->offset_h), sum = diffuse + direct;
    if (fabs(global - sum) <= ROW_SHARE * fmax(global, sum) + ROW_W_M2) return NULL;
    return arena_format(arena,
                        "has %g W/m2 of global light, but %g of diffuse and %.0f of "
                        "direct light on the horizontal (%g on its normal): required is their "
                        "sum",
                        global, diffuse, direct, hour->direct_normal_w_m2);
}

const char *weather_clock_source_text(WeatherClockSource source) {
    static const char *const texts[] = {"hour means", "comment line", "closure", "given"};
    return texts[source];
}
