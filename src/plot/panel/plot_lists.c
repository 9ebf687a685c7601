/* SPDX-License-Identifier: Apache-2.0 */
#include "plot/panel/plot_lists.h"

#include <math.h>
#include <stdlib.h>

#define LARGEST 1e7

/* Reads a number above 0 and moves behind it. */
static bool next_number(const char *option, const char *text, const char **at, double *out,
                        Error *err)
{
    char *after;
    *out = strtod(*at, &after);
    if (after == *at || !(*out > 0 && *out <= LARGEST))
        return error_set(err, ERROR_USAGE, "%s is '%s', wanted numbers above 0 and up to 1e7 "
                         "with commas between", option, text);
    *at = after;
    return true;
}

/* True behind a comma; false at the end (*ok) or at anything else. */
static bool goes_on(const char *option, const char *text, const char **at, bool *ok, Error *err)
{
    *ok = !**at;
    if (*ok) return false;
    if (**at == ',') {
        (*at)++;
        return true;
    }
    error_set(err, ERROR_USAGE, "%s is '%s': '%s' is no comma and no end", option, text, *at);
    return false;
}

static bool is_full(const char *option, int count, int most, Error *err)
{
    if (count < most) return false;
    error_set(err, ERROR_USAGE, "%s has more than %d values", option, most);
    return true;
}

bool plot_contours_read(const char *text, PlotContours *out, Error *err)
{
    static const char option[] = "--contour";
    const char  *at = text;
    PlotContours found = {.count = 0};
    bool         ok = false;
    do {
        int i = found.count;
        if (is_full(option, i, PLOT_CONTOURS_MAX, err) ||
            !next_number(option, text, &at, &found.value[i], err))
            return false;
        found.is_percent[i] = *at == '%';
        at += found.is_percent[i];
        found.count++;
    } while (goes_on(option, text, &at, &ok, err));
    if (ok) *out = found;
    return ok;
}

bool plot_ambient_read(const char *text, PlotAmbient *out, Error *err)
{
    static const char option[] = "--ambient";
    const char *at = text;
    PlotAmbient found = {.count = 0};
    bool        ok = false;
    do {
        if (is_full(option, found.count, PLOT_AMBIENT_MAX, err) ||
            !next_number(option, text, &at, &found.lux[found.count], err))
            return false;
        found.count++;
    } while (goes_on(option, text, &at, &ok, err));
    if (ok) *out = found;
    return ok;
}

double plot_contours_level(const PlotContours *contours, int i, double on_axis)
{
    return contours->is_percent[i] ? contours->value[i] / 100 * on_axis : contours->value[i];
}
