/* SPDX-License-Identifier: Apache-2.0 */
#include "text/effect_text.h"

#include <math.h>
#include <string.h>

#include "base/mathd.h"
#include "text/interval_text.h"

static const char BETWEEN[] = " +- "; /* interval_text's */

/* Without its unit. */
static const char *signed_words(double value, double half, double least, Arena *arena) {
    bool is_sure = half < 0.5 * least;
    double to_place = is_sure ? 5 * least : half; /* one digit of it: least's place */
    double size = fabs(value);
    const char *text = interval_text(size, size - to_place, size + to_place, arena);
    const char *end = strstr(text, BETWEEN);
    const char *sign = value < 0 ? "−" : "+";
    int figure = end ? (int)(end - text) : (int)strlen(text);
    if (is_sure) return arena_format(arena, "%s%.*s ± less than %.2g", sign, figure, text, least);
    if (!end) return arena_format(arena, "%s%s", sign, text); /* without an interval */
    return arena_format(arena, "%s%.*s ± %s", sign, figure, text, end + strlen(BETWEEN));
}

/* What an effect that may be 0 does not exceed, up to its next second digit. */
static const char *at_most_words(double most, Arena *arena) {
    double place = pow_d(10, floor(log10_d(most)) - 1);
    double up = place * ceil(most / place - 1e-9);
    return arena_format(arena, up < 100 ? "%.2g" : "%.0f", up);
}

static double half_of(MeanInterval range) {
    return 0.5 * (range.high - range.low);
}

bool effect_is_none(double share, MeanInterval range, double least) {
    return fabs(share) < 0.5 * least && half_of(range) < 0.5 * least;
}

const char *effect_text(double share, MeanInterval range, double least, Arena *arena) {
    if (isnan(share)) return "–";
    if (effect_is_none(share, range, least)) return EFFECT_NONE;
    if (range.low <= 0 && range.high >= 0)
        return arena_format(arena, "none above %s %%",
                            at_most_words(100 * fmax(-range.low, range.high), arena));
    return arena_format(arena, "%s %%",
                        signed_words(100 * share, 100 * half_of(range), 100 * least, arena));
}
