/* SPDX-License-Identifier: Apache-2.0 */
#include "plot/panel/plot_choice.h"

#include <stdlib.h>

#include "base/units.h"

#define LARGEST 1e7

/* Reads a number above 0 and moves behind it. */
static bool next_number(const char *option, const char *text, const char **at, double *out,
                        Error *err)
{
    char *after;
    *out = strtod(*at, &after);
    if (after == *at || !(*out > 0 && *out <= LARGEST))
        return error_set(err, ERROR_USAGE, "%s is '%s', required: numbers above 0 and up to "
                                           "1e7 with commas between", option, text);
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

/* has_percent: % may stand behind a value. */
static bool read_list(const char *option, const char *text, int most, bool has_percent,
                      PlotContours *out, Error *err)
{
    const char  *at = text;
    PlotContours found = {.count = 0};
    bool         ok = false;
    do {
        int i = found.count;
        if (is_full(option, i, most, err) ||
            !next_number(option, text, &at, &found.value[i], err))
            return false;
        found.is_percent[i] = has_percent && *at == '%';
        at += found.is_percent[i];
        found.count++;
    } while (goes_on(option, text, &at, &ok, err));
    if (ok) *out = found;
    return ok;
}

bool plot_contours_read(const char *text, PlotContours *out, Error *err)
{
    return read_list("--contour", text, PLOT_CONTOURS_MAX, true, out, err);
}

#define DIRECTED_DEG 45.0

bool plot_ambient_read(const char *ambient, const char *directed, PlotAmbient *out, Error *err)
{
    PlotContours even = {.count = 0}, beam = {.value = {0, DIRECTED_DEG}};
    if ((ambient && !read_list("--ambient", ambient, PLOT_AMBIENT_MAX, false, &even, err)) ||
        (directed && !read_list("--directed", directed, 2, false, &beam, err)))
        return false;
    if (beam.count < 2) beam.value[1] = DIRECTED_DEG;
    if (directed && !(beam.value[1] < 90))
        return error_set(err, ERROR_USAGE, "--directed is '%s': %g degrees, required: below 90",
                         directed, beam.value[1]);
    if (directed && !ambient) even.count = 1;
    out->count = even.count;
    for (int i = 0; i < even.count; i++)
        out->light[i] = (PlotLight){even.value[i], directed ? beam.value[0] : 0,
                                    radians_from_degrees(beam.value[1])};
    return true;
}

double plot_contours_level(const PlotContours *contours, int i, double on_axis)
{
    return contours->is_percent[i] ? contours->value[i] / 100 * on_axis : contours->value[i];
}

const char *plot_kind_name(PlotKind kind)
{
    static const char *const NAMES[] = {"all", "luminance", "contrast", "colour-shift",
        "grey-inversion", "grey-levels", "sections", "chromaticity", "spectra", "brdf",
        "brdf-spectrum", "brdf-map", "mirror", "fit", "uniformity"};
    return NAMES[kind];
}
