#include "spectrum/curve.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define MAX_POINTS 4096 /* 0.1 nm over the visible range */
#define VALUE_MAX 1e30

void curve_from_points(const double *nm, const double *value, int count, Curve *out)
{
    int next = 0; /* first point at or above the nanometre */
    for (int i = 0; i < CURVE_COUNT; i++) {
        double here = CURVE_FIRST_NM + i;
        while (next < count && nm[next] < here) next++;
        if (next == 0)
            out->value[i] = (float)value[0];
        else if (next == count)
            out->value[i] = (float)value[count - 1];
        else {
            double t = (here - nm[next - 1]) / (nm[next] - nm[next - 1]);
            out->value[i] = (float)(value[next - 1] + t * (value[next] - value[next - 1]));
        }
    }
}

typedef struct Points {
    double nm[MAX_POINTS], value[MAX_POINTS];
    int    count;
} Points;

/* Nothing but white space from here on? */
static bool is_blank(const char *text)
{
    while (*text == ' ' || *text == '\t' || *text == '\r' || *text == '\n') text++;
    return *text == '\0';
}

/* Two numbers, with a comma, semicolon or white space between. */
static bool parse_row(const char *line, double *nm, double *value)
{
    char *end, *last;
    *nm = strtod(line, &end);
    if (end == line) return false;
    while (*end == ' ' || *end == '\t') end++;
    if (*end == ',' || *end == ';') end++;
    *value = strtod(end, &last);
    return last != end && is_blank(last);
}

static bool add_row(Points *points, const char *path, const char *place, double nm,
                    double value, Error *err)
{
    int n = points->count;
    if (!(nm > 0 && nm < 1e6) || !(fabs(value) <= VALUE_MAX))
        return error_at(err, ERROR_INPUT, path, place,
                        "wavelength %g nm with value %g: wanted finite numbers, nm above 0, "
                        "up to %g", nm, value, VALUE_MAX);
    if (n && !(nm > points->nm[n - 1]))
        return error_at(err, ERROR_INPUT, path, place,
                        "wavelength %g nm after %g nm: wanted rising wavelengths", nm,
                        points->nm[n - 1]);
    if (n == MAX_POINTS)
        return error_at(err, ERROR_INPUT, path, place, "more than %d rows", MAX_POINTS);
    points->nm[n] = nm;
    points->value[n] = value;
    points->count++;
    return true;
}

/* Copies a line of text, or as much of it as fits, and returns what follows it. */
static const char *next_line(const char *text, char *line, size_t size)
{
    size_t length = strcspn(text, "\n");
    snprintf(line, size, "%.*s", (int)(length < size ? length : size - 1), text);
    return text + length + (text[length] == '\n');
}

/* One line may be a header: the first that is neither blank nor a comment. */
static bool read_points(const char *text, const char *path, Points *points, Error *err)
{
    char line[512], place[32];
    bool may_be_header = true;
    for (int number = 1; *text; number++) {
        double nm, value;
        text = next_line(text, line, sizeof line);
        if (line[0] == '#' || is_blank(line)) continue;
        snprintf(place, sizeof place, "line %d", number);
        if (parse_row(line, &nm, &value)) {
            if (!add_row(points, path, place, nm, value, err)) return false;
        } else if (!may_be_header) {
            line[strcspn(line, "\r\n")] = '\0';
            return error_at(err, ERROR_INPUT, path, place,
                            "found \"%.60s\", wanted two numbers: nm,value", line);
        }
        may_be_header = false;
    }
    if (!points->count)
        return error_at(err, ERROR_INPUT, path, NULL, "no rows of nm,value");
    return true;
}

bool curve_parse(const char *text, const char *path, Curve *out, Error *err)
{
    Points *points = calloc(1, sizeof *points);
    bool    ok = points ? read_points(text, path, points, err) :
                          error_at(err, ERROR_MEMORY, path, NULL, "no memory to read it");
    if (ok) curve_from_points(points->nm, points->value, points->count, out);
    free(points);
    return ok;
}

Spectrum curve_lookup(const Curve *curve, const Wavelengths *wavelengths)
{
    Spectrum     place = wavelengths->nm - spectrum_all(CURVE_FIRST_NM), low, high;
    SpectrumMask cell = __builtin_convertvector(place, SpectrumMask);
    cell -= 1 + ((cell - (CURVE_COUNT - 1)) >> 31); /* the last wavelength ends the last cell */
    spectrum_neighbours(curve->value, cell, &low, &high);
    return low + (high - low) * (place - __builtin_convertvector(cell, Spectrum));
}
