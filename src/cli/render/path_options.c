/* SPDX-License-Identifier: Apache-2.0 */
#include "cli/render/path_options.h"

#include <math.h>

#include "base/mathd.h"
#include "base/number.h"
#include "base/units.h"
#include "film/film_sample.h"

#define MOST_DEGREES 360

/* An extinction ratio E:1 is light that is let through over light that is not. */
static bool read_sunglasses(const char *text, PolarisedEye *eye, Error *err) {
    const char *at;
    double degrees, extinction = (double)INFINITY;
    bool is_read = (at = number_read(text, &degrees)) && fabs(degrees) <= MOST_DEGREES &&
                   (!*at || (*at == ':' && number_is(at + 1, &extinction) && extinction >= 1));
    if (!is_read)
        return error_set(err, ERROR_USAGE,
                         "--sunglasses %.80s: required: DEG or DEG:EXTINCTION, degrees from "
                         "-%d to %d and a ratio of at least 1",
                         text, MOST_DEGREES, MOST_DEGREES);
    double angle = radians_from_degrees(degrees);
    eye->has_glasses = true;
    eye->axis[0] = (float)sin_d(angle);
    eye->axis[1] = (float)cos_d(angle);
    eye->lets = 1;
    eye->blocks = (float)(1 / extinction);
    return true;
}

bool polarised_options_read(const PolarisedWords *words, bool wants_all, unsigned *layers,
                            Arena *arena, const PolarisedEye **out, Error *err) {
    bool asks = (*layers & LAYER_STOKES) != 0;
    PolarisedEye *eye = ARENA_NEW(arena, PolarisedEye, 1);
    *out = NULL;
    if (words->sunglasses && !read_sunglasses(words->sunglasses, eye, err)) return false;
    if (!words->is_polarised && !words->sunglasses)
        return !asks || error_set(err, ERROR_USAGE,
                                  "--layers stokes: how light is polarised "
                                  "is followed with --polarised alone");
    if (asks && eye->has_glasses)
        return error_set(err, ERROR_USAGE,
                         "--layers stokes is of light before it meets "
                         "--sunglasses — leave one of them out");
    eye->with_stokes = !eye->has_glasses && (asks || wants_all);
    if (eye->with_stokes) *layers |= LAYER_STOKES;
    *out = eye;
    return true;
}
