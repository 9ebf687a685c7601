/* SPDX-License-Identifier: Apache-2.0 */
#include "spectrum/twice.h"

#include <math.h>

#include "spectrum/photometry.h"

double twice_share(double a, double b) {
    double most = fmax(fabs(a), fabs(b));
    return most > 0 ? fabs(a - b) / most : 0;
}

double twice_colour(const double a[3], const double b[3]) {
    double one[2], two[2];
    uv_from_xyz(a, one);
    uv_from_xyz(b, two);
    double du = one[0] - two[0], dv = one[1] - two[1];
    return sqrt(du * du + dv * dv);
}

bool twice_differ(const Twice *twice) {
    return !(twice->apart <= twice->most);
}

#define SHAPE_MOST 0.02

Twice twice_shape(const char *thing, double picture, double place, Arena *arena) {
    return (Twice){thing,
                   {arena_format(arena, "its content's shape of %.4g : 1", picture),
                    arena_format(arena, "the %.4g : 1 that it fills", place)},
                   100 * twice_share(picture, place),
                   100 * SHAPE_MOST,
                   " %"};
}

const char *twice_text(const Twice *twice, Arena *arena) {
    return arena_format(arena, "%s: %s and %s are %.2g%s apart, required: at most %.2g%s",
                        twice->thing, twice->by[0], twice->by[1], twice->apart, twice->unit,
                        twice->most, twice->unit);
}
