/* SPDX-License-Identifier: Apache-2.0 */
#include "sky/epw.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/file.h"

#define WEATHER_BYTES ((size_t)64 << 20)
#define HOURS_MAX 200000
#define FIELDS_MAX 48

/* A file while its lines are read. */
typedef struct EpwReader {
    const char *file;
    char       *next; /* rest of the text; NULL at the end */
    int         line;
    Arena      *arena;
} EpwReader;

/* Fields of the data dictionary, counted from 0. */
enum {
    FIELD_MINUTE = 4, FIELD_DRY_BULB = 6, FIELD_DEW_POINT = 7, FIELD_PRESSURE = 9,
    FIELD_GLOBAL = 13, FIELD_DIRECT = 14, FIELD_DIFFUSE = 15, FIELD_DIRECT_LUX = 17,
    FIELD_DIFFUSE_LUX = 18, FIELD_WATER = 28, FIELD_AEROSOL = 29, FIELDS_LEAST = 16
};

#define DEW_POINT_MISSING 99.9
#define DEW_POINT_MOST 70.0 /* of the data dictionary */
#define LUX_MISSING 999900.0

/* Cuts the next line off and into fields; false at the end. */
static bool next_line(EpwReader *reader, char *field[FIELDS_MAX], int *count)
{
    if (!reader->next || !*reader->next) return false;
    char *line = reader->next, *end = strpbrk(line, "\r\n");
    reader->next = NULL;
    if (end) {
        reader->next = end + (end[0] == '\r' && end[1] == '\n' ? 2 : 1);
        *end = 0;
    }
    reader->line++;
    *count = 0;
    for (char *at = line; at && *count < FIELDS_MAX;) {
        field[(*count)++] = at;
        at = strchr(at, ',');
        if (at) *at++ = 0;
    }
    return true;
}

static bool bad_line(const EpwReader *reader, Error *err, const char *found, const char *wanted)
{
    return error_at(err, ERROR_INPUT, reader->file,
                    arena_format(reader->arena, "line %d", reader->line),
                    "found '%.40s', wanted %s", found, wanted);
}

static bool number(const EpwReader *reader, const char *text, double range[2], double *out,
                   Error *err)
{
    char  *after;
    double value = strtod(text, &after);
    if (after == text || !isfinite(value) || value < range[0] || value > range[1])
        return bad_line(
            reader, err, text,
            arena_format(reader->arena, "a number from %g to %g", range[0], range[1]));
    *out = value;
    return true;
}

static bool read_location(EpwReader *reader, char *field[], int count, Weather *out, Error *err)
{
    double *const target[4] = {&out->place.latitude_deg, &out->place.longitude_deg,
                               &out->zone_h, &out->place.altitude_m};
    double range[4][2] = {{-90, 90}, {-180, 180}, {-14, 14}, {-500, 9000}};
    if (count < 10 || strcmp(field[0], "LOCATION"))
        return bad_line(reader, err, count ? field[0] : "",
                        "LOCATION,city,...,latitude,longitude,zone,elevation");
    for (int i = 0; i < 4; i++)
        if (!number(reader, field[6 + i], range[i], target[i], err)) return false;
    out->city = arena_string(reader->arena, field[1], strlen(field[1]));
    return true;
}

/* 9999 and more stand for a missing value. */
static double or_missing(const char *text, double missing)
{
    double value = strtod(text, NULL);
    return isfinite(value) && value < missing ? value : -1;
}

/* A field of the row's end, which files may leave out. */
static double last_field(char *const field[], int count, int at, double missing)
{
    return count > at && field[at][0] ? or_missing(field[at], missing) : -1;
}

static bool read_dew_point(const EpwReader *reader, const char *text, WeatherHour *out,
                           Error *err)
{
    double any[2] = {-99, 999900};
    if (!number(reader, text, any, &out->dew_point_c, err)) return false;
    out->has_dew_point = out->dew_point_c < DEW_POINT_MISSING;
    return !out->has_dew_point || out->dew_point_c <= DEW_POINT_MOST ||
           bad_line(reader, err, text, "a dew point from -99 to 70 degrees C, or 99.9: none");
}

/* The minute counts where an hour has several rows only: hourly files write 0 or 60 alike. */
static double label_hour(double hour, const char *minute, int rows_per_hour)
{
    if (rows_per_hour == 1) return hour;
    double value = strtod(minute, NULL);
    return hour - 1 + (value > 0 && value <= 60 ? value : 60) / 60;
}

static bool read_hour(EpwReader *reader, char *field[], int count, const Weather *weather,
                      WeatherHour *out, Error *err)
{
    double when[4], range[4][2] = {{-2000, 6000}, {1, 12}, {1, 31}, {1, 24}};
    double direct[2] = {0, 9999}, any[2] = {-99, 999900};
    if (count < FIELDS_LEAST)
        return bad_line(reader, err, field[0], "a row of at least 16 fields");
    for (int i = 0; i < 4; i++)
        if (!number(reader, field[i], range[i], &when[i], err)) return false;
    if (!number(reader, field[FIELD_DIRECT], direct, &out->direct_normal_w_m2, err) ||
        !number(reader, field[FIELD_DIFFUSE], direct, &out->diffuse_horizontal_w_m2, err) ||
        !number(reader, field[FIELD_DRY_BULB], any, &out->dry_bulb_c, err) ||
        !read_dew_point(reader, field[FIELD_DEW_POINT], out, err) ||
        !number(reader, field[FIELD_PRESSURE], any, &out->pressure_mbar, err))
        return false;
    out->pressure_mbar /= 100;
    out->line = reader->line;
    out->year = (int)when[0], out->month = (int)when[1], out->day = (int)when[2];
    out->label_h = label_hour(when[3], field[FIELD_MINUTE], weather->rows_per_hour);
    out->global_horizontal_w_m2 = or_missing(field[FIELD_GLOBAL], 9999);
    out->has_light = out->direct_normal_w_m2 < 9999 && out->diffuse_horizontal_w_m2 < 9999;
    out->direct_normal_lx = last_field(field, count, FIELD_DIRECT_LUX, LUX_MISSING);
    out->diffuse_horizontal_lx = last_field(field, count, FIELD_DIFFUSE_LUX, LUX_MISSING);
    out->precipitable_water_cm = last_field(field, count, FIELD_WATER, 999) / 10;
    out->aerosol_depth = last_field(field, count, FIELD_AEROSOL, 0.999);
    return true;
}

/* Reads from the header PVGIS's comment and the number of rows an hour has (DATA PERIODS,
 * number of periods, rows in an hour). True at the last header line. */
static bool read_header(char *field[], int count, Weather *out)
{
    static const char offset[] = "Irradiance Time Offset (h):";
    for (int i = 1; i < count && !strncmp(field[0], "COMMENTS", 8); i++) {
        char  *at = strstr(field[i], offset), *after;
        double value = at ? strtod(at + sizeof offset - 1, &after) : 0;
        if (!at || after == at + sizeof offset - 1 || !(fabs(value) <= 24)) continue;
        out->has_comment_offset = true;
        out->comment_offset_h = value;
    }
    if (strcmp(field[0], "DATA PERIODS")) return false;
    int rows = count > 2 ? atoi(field[2]) : 1;
    out->rows_per_hour = rows > 1 && rows <= 60 ? rows : 1;
    return true;
}

bool weather_read(const char *file, Arena *arena, Weather *out, Error *err)
{
    FileBytes   bytes;
    const char *text;
    char       *field[FIELDS_MAX];
    int         count;
    bool        in_data = false;
    if (!file_read(file, WEATHER_BYTES, arena, &bytes, err) ||
        !file_text(file, &bytes, &text, err))
        return false;
    EpwReader reader = {file, arena_string(arena, text, strlen(text)), 0, arena};
    Weather   weather = {.file = file, .rows_per_hour = 1};
    if (!next_line(&reader, field, &count))
        return error_at(err, ERROR_INPUT, file, "", "is empty, wanted an EPW weather file");
    if (!read_location(&reader, field, count, &weather, err)) return false;
    weather.hour = ARENA_NEW(arena, WeatherHour, HOURS_MAX);
    while (next_line(&reader, field, &count)) {
        bool is_blank = count == 1 && !field[0][0];
        if (!in_data) {
            in_data = read_header(field, count, &weather);
            continue;
        }
        if (is_blank) continue;
        if (weather.count == HOURS_MAX)
            return bad_line(&reader, err, field[0], "at most 200000 hours");
        if (!read_hour(&reader, field, count, &weather, &weather.hour[weather.count++], err))
            return false;
    }
    if (!weather.count)
        return error_at(err, ERROR_INPUT, file, "",
                        "has no hours, wanted rows behind a line DATA PERIODS");
    *out = weather;
    return true;
}
