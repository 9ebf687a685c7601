/* SPDX-License-Identifier: Apache-2.0 */
#include "review/verdict.h"

#include <math.h>

const char *const verdict_names[4] = {"pass", "fail", "too close", "not visible"};
const char *const ambient_names[4] = {"night", "twilight", "day", "sun"};

const char *const remedy_kinds[REMEDY_KINDS] = {"brightness", "tilt",  "hood",
                                                "coating",    "panel", "trim"};
const char *const rest_kinds[REST_KINDS] = {"panel", "material", "eye", "occupant", "limits"};
const char *const rest_bases[REST_BASES] = {
    "measured", "synthetic", "not stated", "guessed", "without data", "given",
    "proposed", "present", "nobody", "read in the standard", "quoted"};

int verdict_rank(Verdict verdict)
{
    static const int RANKS[4] = {[VERDICT_PASS] = 0, [VERDICT_TOO_CLOSE] = 1,
                                 [VERDICT_NOT_VISIBLE] = 2, [VERDICT_FAIL] = 3};
    return RANKS[verdict];
}

double luminance_contrast(double one, double other, double added)
{
    double brighter = fmax(one, other) + added, darker = fmin(one, other) + added;
    return darker > 0 ? brighter / darker : brighter > 0 ? (double)INFINITY : 1;
}
