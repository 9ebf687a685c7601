/* SPDX-License-Identifier: Apache-2.0 */
#include "sky/weather_clock.h"

#include <math.h>

#include "base/calendar.h"
#include "base/mathd.h"
#include "base/sort.h"
#include "base/units.h"
#include "spectrum/twice.h"

#define ROWS_LEAST 24 /* fewer are not enough to be sure */
#define ROWS_MOST 20000
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

/* Of the sun's elevation at an offset from a row's label; below 0: it is down. */
static double sine_at(const Weather *weather, const WeatherHour *hour, double offset_h) {
    double sine = sin_d(offset_h * PI / 12), cosine = cos_d(offset_h * PI / 12);
    ClosureRow row = closure_row(weather, hour);
    return row.a + row.b * cosine - row.c * sine;
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
    } else if (weather->has_comment_offset && fabs(comment + hour - best) <= WEATHER_CLOCK_NEAR_H) {
        clock->source = WEATHER_CLOCK_COMMENT;
        clock->offset_h = comment + hour;
    } else if (is_known && fabs(clock->offset_h - best) > WEATHER_CLOCK_NEAR_H) {
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
    double sine = sine_at(weather, hour, clock->offset_h);
    double direct = hour->direct_normal_w_m2 * fmax(0, sine), sum = diffuse + direct;
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

/* ---- what cannot be meant ---------------------------------------------------------------- */

/* A clear hour is told without a unit, by how its direct and diffuse light compare; so much of
 * the light outside the air must then arrive. No hour can have more than the sun sends. */

#define SUN_W_M2 1361.0
#define SIGN_DEG 3.0 /* a longitude so near to the other sign's is that */

static void add_doubt(WeatherDoubts *doubts, const char *text) {
    if (doubts->count < WEATHER_DOUBTS_MOST) doubts->text[doubts->count++] = text;
}

/* ---- the clock --------------------------------------------------------------------------- */

static double half_turned(double degrees) {
    return degrees - 360 * floor((degrees + 180) / 360);
}

/* What the file says of itself, or the user, needs no other reason. */
static bool is_stated(const Weather *weather, const WeatherClock *clock) {
    double off = clock->best_offset_h - weather->comment_offset_h;
    bool by_file = weather->has_comment_offset &&
                   (fabs(off) <= WEATHER_CLOCK_NEAR_H || fabs(off - 1) <= WEATHER_CLOCK_NEAR_H);
    return by_file || (clock->source == WEATHER_CLOCK_GIVEN &&
                       fabs(clock->offset_h - clock->best_offset_h) <= WEATHER_CLOCK_NEAR_H);
}

/* A row's instant lies in its span: elsewhere the light is that of another place's sun. */
static void doubt_clock(const Weather *weather, const WeatherClock *clock, Arena *arena,
                        WeatherDoubts *doubts) {
    double half = 0.5 / weather->rows_per_hour, best = clock->best_offset_h;
    Twice twice = {"its clock",
                   {"the sun of its light", "the sun of its line LOCATION"},
                   fabs(best + half),
                   half + WEATHER_CLOCK_NEAR_H,
                   " h"};
    if (!clock->rows || !clock->closes || !twice_differ(&twice) || is_stated(weather, clock))
        return;
    double longitude = half_turned(weather->place.longitude_deg + 15 * (best + half));
    bool is_sign = fabs(half_turned(longitude + weather->place.longitude_deg)) < SIGN_DEG;
    add_doubt(
        doubts,
        arena_format(arena,
                     "%s: the place (%.4g N, %.4g E) or the time zone (%+g h) is wrong, and so "
                     "where the sun stands: the light of its rows belongs to %+.2f h from their "
                     "labels, required: %g to 0; it fits longitude %.1f%s, or a zone of %+.1f h",
                     twice_text(&twice, arena), weather->place.latitude_deg,
                     weather->place.longitude_deg, weather->zone_h, best, -2 * half, longitude,
                     is_sign ? " (the sign?)" : "", weather->zone_h - best - half));
}

static void doubt_closure(const WeatherClock *clock, Arena *arena, WeatherDoubts *doubts) {
    if (!clock->rows || clock->closes) return;
    add_doubt(
        doubts,
        arena_format(arena,
                     "GHI = DHI + DNI sin(elevation) holds at no instant: the mean difference is "
                     "at least %.1f W/m2 (%.2f h from the label; %.1f as hour means) of %.1f "
                     "W/m2 in %d rows — their instants are taken %+.2f h from the label (%s), "
                     "the sun may not fit their light; --weather-offset H sets them",
                     clock->best_closure_w_m2, clock->best_offset_h, clock->means_closure_w_m2,
                     clock->mean_global_w_m2, clock->rows, clock->offset_h,
                     weather_clock_source_text(clock->source)));
}

/* ---- the unit ---------------------------------------------------------------------------- */

#define HIGH_SINE 0.35  /* of the sun: lower, its path through the air decides */
#define CLEAR_TIMES 3.0 /* direct on the horizontal over diffuse */
#define CLEAR_LEAST 0.4 /* of the light outside: 0.65 to 0.8 are usual */
#define CLEAR_MOST 1.0
#define BLUE_LEAST 0.02 /* of a clear hour's light, diffuse: 0.06 is the clearest air's */
#define DIM_ROWS 60     /* of a high sun, ten days or so, are not all darker than */
#define DIM_LEAST 0.15
#define DARK_LEAST 0.02 /* nor any few, under the heaviest clouds */
#define ADDS_UP 0.2     /* of the global light: beside what closes, as of single rows */
/* Of the horizontal, what no hour exceeds: Long and Dutton, BSRN Global Network recommended QC
 * tests (2002), "physically possible". */
#define POSSIBLE_TIMES 1.5
#define POSSIBLE_POWER 1.2
#define POSSIBLE_W_M2 100.0

typedef struct UnitSums {
    int high, clear, beyond, adding;
    double *share, *blue; /* of the clear hours */
    double brightest;     /* share of a high sun's hour */
    double apart, global; /* sums over the hours with all three */
    double most_w_m2;
    const WeatherHour *worst;
} UnitSums;

/* The highest sun within a span of the row's instant. */
static double high_sine(const Weather *weather, const WeatherHour *hour, double offset_h) {
    double half = 0.5 / weather->rows_per_hour, most = 0;
    for (int k = -1; k <= 1; k++) most = fmax(most, sine_at(weather, hour, offset_h + k * half));
    return most;
}

static void add_hour(const Weather *weather, const WeatherHour *hour, double offset_h,
                     UnitSums *sums) {
    double sine = sine_at(weather, hour, offset_h);
    double direct = hour->direct_normal_w_m2 * fmax(0, sine),
           diffuse = hour->diffuse_horizontal_w_m2;
    double sum = direct + diffuse, all = fmax(sum, hour->global_horizontal_w_m2);
    double most =
        POSSIBLE_TIMES * SUN_W_M2 * pow_d(high_sine(weather, hour, offset_h), POSSIBLE_POWER) +
        POSSIBLE_W_M2;
    if (all > most) {
        if (all > sums->most_w_m2) sums->worst = hour, sums->most_w_m2 = all;
        sums->beyond++;
    }
    if (sine < HIGH_SINE) return;
    double share = all / (SUN_W_M2 * sine);
    sums->high++;
    sums->brightest = fmax(sums->brightest, share);
    if (hour->global_horizontal_w_m2 >= 0) {
        sums->adding++;
        sums->apart += fabs(hour->global_horizontal_w_m2 - sum);
        sums->global += all;
    }
    if (!(direct > CLEAR_TIMES * diffuse)) return;
    sums->blue[sums->clear] = diffuse / sum;
    sums->share[sums->clear++] = sum / (SUN_W_M2 * sine);
}

static void doubt_beyond(const UnitSums *sums, Arena *arena, WeatherDoubts *doubts) {
    if (!sums->beyond) return;
    add_doubt(
        doubts,
        arena_format(arena,
                     "rows with more light than the sun can send: %d, the most line %d with %g "
                     "W/m2 on the horizontal: is its unit W/m2 (Wh/m2 of an hour), are place and "
                     "time zone right, or is the row wrong?",
                     sums->beyond, sums->worst->line, sums->most_w_m2));
}

/* Of the clear hours the middle one. */
static void doubt_clear(UnitSums *sums, Arena *arena, WeatherDoubts *doubts) {
    double share = sort_median(sums->share, sums->clear);
    double blue = sort_median(sums->blue, sums->clear);
    if (share < CLEAR_LEAST || share > CLEAR_MOST)
        add_doubt(doubts,
                  arena_format(arena,
                               "its %d clear hours (direct light %g times the diffuse or more, the "
                               "sun above %.0f degrees) have %.2g %% of the light outside the air, "
                               "required: %g to %g %%: is its unit W/m2 (Wh/m2 of an hour)%s?",
                               sums->clear, CLEAR_TIMES, 20.0, 100 * share, 100 * CLEAR_LEAST,
                               100 * CLEAR_MOST, share < 2e-3 * CLEAR_MOST ? ", not kW/m2" : ""));
    else if (blue < BLUE_LEAST)
        add_doubt(
            doubts,
            arena_format(arena,
                         "its %d clear hours have %.2g %% of diffuse light, required: %g %% or "
                         "more, as the clearest air has: is the unit of its diffuse light W/m2?",
                         sums->clear, 100 * blue, 100 * BLUE_LEAST));
}

static void doubt_dim(const UnitSums *sums, Arena *arena, WeatherDoubts *doubts) {
    double least = sums->high >= DIM_ROWS ? DIM_LEAST : DARK_LEAST;
    if (sums->clear || !sums->high || sums->brightest >= least) return;
    add_doubt(doubts,
              arena_format(arena,
                           "the brightest of its %d hours with the sun above 20 degrees has "
                           "%.2g %% of the light outside the air, required: %g %% or more: is "
                           "its unit W/m2 (Wh/m2 of an hour)?",
                           sums->high, 100 * sums->brightest, 100 * least));
}

/* Rows without direct light, which tell no clock. */
static void doubt_sum(const UnitSums *sums, Arena *arena, WeatherDoubts *doubts) {
    Twice twice = {"its global light",
                   {"its own column", "diffuse and direct light on the horizontal"},
                   sums->global > 0 ? 100 * sums->apart / sums->global : 0,
                   100 * ADDS_UP,
                   " %"};
    if (sums->adding && twice_differ(&twice))
        add_doubt(doubts, arena_format(arena, "%s (mean of %d hours): are all columns in W/m2?",
                                       twice_text(&twice, arena), sums->adding));
}

static void doubt_unit(const Weather *weather, const WeatherClock *clock, Arena *arena,
                       WeatherDoubts *doubts) {
    UnitSums sums = {.share = ARENA_NEW(arena, double, weather->count),
                     .blue = ARENA_NEW(arena, double, weather->count)};
    for (int i = 0; i < weather->count; i++) {
        const WeatherHour *hour = &weather->hour[i];
        if (hour->has_light && fmax(hour->diffuse_horizontal_w_m2, hour->direct_normal_w_m2) > 0)
            add_hour(weather, hour, clock->offset_h, &sums);
    }
    doubt_beyond(&sums, arena, doubts);
    if (sums.clear) doubt_clear(&sums, arena, doubts);
    doubt_dim(&sums, arena, doubts);
    if (!clock->rows) doubt_sum(&sums, arena, doubts);
}

WeatherDoubts weather_clock_doubts(const Weather *weather, const WeatherClock *clock,
                                   Arena *arena) {
    WeatherDoubts doubts = {0};
    doubt_closure(clock, arena, &doubts);
    doubt_clock(weather, clock, arena, &doubts);
    if (!clock->rows || clock->closes) doubt_unit(weather, clock, arena, &doubts);
    return doubts;
}
