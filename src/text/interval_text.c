/* SPDX-License-Identifier: Apache-2.0 */
#include "text/interval_text.h"

#include <math.h>
#include <string.h>

#define ASIDE 0.2 /* of the half width: further from the middle both ends are given */
#define DECIMALS_MOST 20

static double ten_to(int place) {
    double power = 1;
    for (; place > 0; place--) power *= 10;
    for (; place < 0; place++) power /= 10;
    return power;
}

/* The decimal exponent of a figure above 0. */
static int place_of(double value) {
    int place = 0;
    for (; value >= 10; value /= 10) place++;
    for (; value < 1; value *= 10) place--;
    return place;
}

/* Behind the point; below 0: of tens, hundreds, ... */
static int decimals_for(double half) {
    int place = place_of(half);
    return (half < 2.95 * ten_to(place) ? 1 : 0) - place;
}

static const char *rounded(double value, int decimals, Arena *arena) {
    if (decimals > DECIMALS_MOST) return arena_format(arena, "%.3g", value);
    double unit = ten_to(-decimals);
    double whole = decimals < 0 ? floor(value / unit + 0.5) * unit : value;
    const char *text = arena_format(arena, "%.*f", decimals > 0 ? decimals : 0, whole);
    return strspn(text, "-0.") == strlen(text) && text[0] == '-' ? text + 1 : text;
}

const char *interval_text(double value, double low, double high, Arena *arena) {
    double half = 0.5 * (high - low);
    if (isnan(value) || isnan(half)) return isnan(value) ? "unknown" : rounded(value, 3, arena);
    if (isinf(high)) return arena_format(arena, "at least %.3g", low);
    if (!(half > 1e-9 * fabs(value))) return arena_format(arena, "%.4g", value);
    int decimals = decimals_for(half);
    if (fabs(0.5 * (low + high) - value) <= ASIDE * half)
        return arena_format(arena, "%s +- %s", rounded(value, decimals, arena),
                            rounded(half, decimals, arena));
    return arena_format(arena, "%s (%s to %s)", rounded(value, decimals, arena),
                        rounded(low, decimals, arena), rounded(high, decimals, arena));
}

#define DIGITS_ALONE 4 /* of a figure without its interval, at most */

const char *interval_value_text(double value, double low, double high, Arena *arena) {
    double half = 0.5 * (high - low), size = fabs(value);
    if (isnan(value)) return "unknown";
    if (!(half > 1e-9 * size) || !isfinite(half)) return arena_format(arena, "%.4g", value);
    int decimals = -place_of(half); /* without "+-" nobody reads more than one doubtful digit */
    if (size > 0 && decimals > DIGITS_ALONE - 1 - place_of(size))
        decimals = DIGITS_ALONE - 1 - place_of(size);
    return rounded(value, decimals, arena);
}
