/* SPDX-License-Identifier: Apache-2.0 */
#include "sky/epw.h"

#include <math.h>
#include <string.h>

#include "base/file.h"
#include "base/number.h"

#define WEATHER_BYTES ((size_t)64 << 20)
#define HOURS_MAX 200000
#define FIELDS_MAX 48

/* A file while its lines are read. */
typedef struct EpwReader {
    const char *file;
    char *next; /* rest of the text; NULL at the end */
    int line;
    Arena *arena;
} EpwReader;

/* Fields of the data dictionary, counted from 0. */
enum {
    FIELD_MINUTE = 4,
    FIELD_DEW_POINT = 7,
    FIELD_GLOBAL = 13,
    FIELD_DIRECT = 14,
    FIELD_DIFFUSE = 15,
    FIELD_DIRECT_LUX = 17,
    FIELD_DIFFUSE_LUX = 18,
    FIELDS_LEAST = 16,
    FIELDS_MOST = 35,
    LOCATION_FIELDS = 10
};

#define DEW_POINT_MISSING 99.9
#define W_M2_MISSING 9999.0
#define LUX_MISSING 999900.0
#define MISSING_MOST 9999999.0 /* nines that stand for a missing value, in any number */

/* A quoted field may hold commas: its text without the quotes, or NULL; *behind: the rest. */
static char *quoted_field(char *at, char **behind) {
    if (*at != '"') return NULL;
    for (char *quote = at + 1; (quote = strchr(quote, '"')); quote++) {
        if (quote[1] && quote[1] != ',') continue;
        *quote = 0;
        *behind = quote + 1;
        return at + 1;
    }
    return NULL;
}

/* Cuts the next line off and into fields; false at the end. */
static bool next_line(EpwReader *reader, char *field[FIELDS_MAX], int *count) {
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
        char *quoted = quoted_field(at, &at);
        field[(*count)++] = quoted ? quoted : at;
        at = strchr(at, ',');
        if (at) *at++ = 0;
    }
    return true;
}

static bool bad_line(const EpwReader *reader, Error *err, const char *found, const char *wanted) {
    return error_at(err, ERROR_INPUT, reader->file,
                    arena_format(reader->arena, "line %d", reader->line),
                    "found '%.40s', required: %s", found, wanted);
}

/* A field, what may stand in it, and from where on a value is none. */
typedef struct EpwField {
    const char *name;
    double low, high, missing; /* missing: above high; 0: every row has it */
    bool is_whole;
} EpwField;

static bool bad_field(const EpwReader *reader, EpwField field, const char *text, Error *err) {
    const char *or_none =
        field.missing > 0 ? arena_format(reader->arena, ", or %g: none", field.missing) : "";
    return bad_line(reader, err, text,
                    arena_format(reader->arena,
                                 "%s, a %snumber from %g to "
                                 "%g%s",
                                 field.name, field.is_whole ? "whole " : "", field.low, field.high,
                                 or_none));
}

/* *out: the number; of a missing one field.missing or more. */
static bool number(const EpwReader *reader, EpwField field, const char *text, double *out,
                   Error *err) {
    double value = 0;
    const char *after = number_read(text, &value);
    bool is_number = after && !after[strspn(after, " \t")];
    bool is_none = field.missing > 0 && value >= field.missing && value <= MISSING_MOST;
    bool is_within = value >= field.low && value <= field.high;
    if (!is_number || (!is_none && !is_within) || (field.is_whole && value != floor(value)))
        return bad_field(reader, field, text, err);
    *out = value;
    return true;
}

static bool read_location(EpwReader *reader, char *field[], int count, Weather *out, Error *err) {
    double *const target[4] = {&out->place.latitude_deg, &out->place.longitude_deg, &out->zone_h,
                               &out->place.altitude_m};
    static const EpwField place[4] = {{"the latitude", -90, 90, 0, false},
                                      {"the longitude", -180, 180, 0, false},
                                      {"the zone", -14, 14, 0, false},
                                      {"the elevation", -500, 9000, 0, false}};
    while (count > LOCATION_FIELDS && !field[count - 1][0]) count--;
    if (count < LOCATION_FIELDS || strcmp(field[0], "LOCATION"))
        return bad_line(reader, err, count ? field[0] : "",
                        "LOCATION,city,...,latitude,longitude,zone,elevation");
    if (count > LOCATION_FIELDS)
        return bad_line(reader, err, arena_format(reader->arena, "%d fields", count),
                        "the 10 of LOCATION: a name that holds a comma stands in quotes");
    for (int i = 0; i < 4; i++)
        if (!number(reader, place[i], field[6 + i], target[i], err)) return false;
    out->city = arena_string(reader->arena, field[1], strlen(field[1]));
    return true;
}

/* An amount of light: negative where it is missing. At the row's end files may leave it out. */
static bool read_light(const EpwReader *reader, EpwField field, const char *text, double *out,
                       Error *err) {
    *out = -1;
    if (!text || !*text) return true;
    if (!number(reader, field, text, out, err)) return false;
    if (*out >= field.missing) *out = -1;
    return true;
}

static bool read_lights(const EpwReader *reader, char *const field[], int count, WeatherHour *out,
                        Error *err) {
    static const EpwField fields[5] = {
        {"global irradiance", 0, W_M2_MISSING, W_M2_MISSING, false},
        {"direct normal irradiance", 0, W_M2_MISSING, W_M2_MISSING, false},
        {"diffuse irradiance", 0, W_M2_MISSING, W_M2_MISSING, false},
        {"direct normal illuminance", 0, LUX_MISSING, LUX_MISSING, false},
        {"diffuse illuminance", 0, LUX_MISSING, LUX_MISSING, false}};
    static const int at[5] = {FIELD_GLOBAL, FIELD_DIRECT, FIELD_DIFFUSE, FIELD_DIRECT_LUX,
                              FIELD_DIFFUSE_LUX};
    double *const target[5] = {&out->global_horizontal_w_m2, &out->direct_normal_w_m2,
                               &out->diffuse_horizontal_w_m2, &out->direct_normal_lx,
                               &out->diffuse_horizontal_lx};
    for (int i = 0; i < 5; i++)
        if (!read_light(reader, fields[i], at[i] < count ? field[at[i]] : NULL, target[i], err))
            return false;
    out->has_light = out->direct_normal_w_m2 >= 0 && out->diffuse_horizontal_w_m2 >= 0;
    return true;
}

static bool read_dew_point(const EpwReader *reader, const char *text, WeatherHour *out,
                           Error *err) {
    static const EpwField field = {"the dew point in degrees C", -99, 70, DEW_POINT_MISSING, false};
    if (!number(reader, field, text, &out->dew_point_c, err)) return false;
    out->has_dew_point = out->dew_point_c < DEW_POINT_MISSING;
    return true;
}

/* The minute counts where an hour has several rows only: hourly files write 0 or 60 alike. */
static double label_hour(double hour, double minute, int rows_per_hour) {
    if (rows_per_hour == 1) return hour;
    return hour - 1 + (minute > 0 ? minute : 60) / 60;
}

/* As many fields as the first row: a comma too many or a field too few would shift them. */
static bool check_count(const EpwReader *reader, int count, const Weather *weather, Error *err) {
    const char *found = arena_format(reader->arena, "%d fields", count);
    if (count < FIELDS_LEAST || count > FIELDS_MOST)
        return bad_line(reader, err, found, "a row of 16 to 35 fields, with decimal points");
    if (!weather->fields || count == weather->fields) return true;
    return bad_line(reader, err, found,
                    arena_format(reader->arena,
                                 "the %d of the rows before "
                                 "it, with decimal points",
                                 weather->fields));
}

static bool read_hour(EpwReader *reader, char *field[], int count, Weather *weather,
                      WeatherHour *out, Error *err) {
    static const EpwField time[5] = {{"the year", -2000, 6000, 0, true},
                                     {"the month", 1, 12, 0, true},
                                     {"the day", 1, 31, 0, true},
                                     {"the hour", 1, 24, 0, true},
                                     {"the minute", 0, 60, 0, false}};
    double when[5];
    if (!check_count(reader, count, weather, err)) return false;
    weather->fields = count;
    for (int i = 0; i < 5; i++)
        if (!number(reader, time[i], field[i], &when[i], err)) return false;
    if (!read_dew_point(reader, field[FIELD_DEW_POINT], out, err) ||
        !read_lights(reader, field, count, out, err))
        return false;
    out->line = reader->line;
    out->year = (int)when[0], out->month = (int)when[1], out->day = (int)when[2];
    out->label_h = label_hour(when[3], when[FIELD_MINUTE], weather->rows_per_hour);
    return true;
}

/* Reads PVGIS's comment from the header. True at its last line (DATA PERIODS, number of
 * periods, rows in an hour). */
static bool read_header(char *field[], int count, Weather *out) {
    static const char offset[] = "Irradiance Time Offset (h):";
    for (int i = 1; i < count && !strncmp(field[0], "COMMENTS", 8); i++) {
        const char *at = strstr(field[i], offset);
        double value;
        if (!at || !number_read(at + sizeof offset - 1, &value) || !(fabs(value) <= 24)) continue;
        out->has_comment_offset = true;
        out->comment_offset_h = value;
    }
    return !strcmp(field[0], "DATA PERIODS");
}

static bool read_rows_per_hour(const EpwReader *reader, char *field[], int count, Weather *out,
                               Error *err) {
    static const EpwField rows = {"the rows of an hour", 1, 60, 0, true};
    double value = 1;
    if (count > 2 && !number(reader, rows, field[2], &value, err)) return false;
    out->rows_per_hour = (int)value;
    return true;
}

bool weather_read(const char *file, Arena *arena, Weather *out, Error *err) {
    FileBytes bytes;
    const char *text;
    char *field[FIELDS_MAX];
    int count;
    bool in_data = false;
    if (!file_read(file, WEATHER_BYTES, arena, &bytes, err) || !file_text(file, &bytes, &text, err))
        return false;
    EpwReader reader = {file, arena_string(arena, text, strlen(text)), 0, arena};
    Weather weather = {.rows_per_hour = 1};
    if (!next_line(&reader, field, &count))
        return error_at(err, ERROR_INPUT, file, "", "is empty, required: an EPW weather file");
    if (!read_location(&reader, field, count, &weather, err)) return false;
    weather.hour = ARENA_NEW(arena, WeatherHour, HOURS_MAX);
    while (next_line(&reader, field, &count)) {
        bool is_blank = count == 1 && !field[0][0];
        if (!in_data) {
            in_data = read_header(field, count, &weather);
            if (in_data && !read_rows_per_hour(&reader, field, count, &weather, err)) return false;
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
                        "has no hours, required: rows behind a line DATA PERIODS");
    *out = weather;
    return true;
}
