/* SPDX-License-Identifier: Apache-2.0 */
#include "vision/human_eye.h"

#include <stdlib.h>
#include <string.h>

/* A number of plain digits at *text, which moves behind it. */
static bool read_number(const char **text, double *out) {
    const char *digits_end = *text + strspn(*text, "0123456789.");
    char *end;
    *out = strtod(*text, &end);
    bool ok = end != *text && end == digits_end;
    *text = end;
    return ok;
}

bool human_eye_parse(const char *text, HumanEye *out, Error *err) {
    HumanEye eye = {0, HUMAN_EYE_PIGMENT_USUAL};
    const char *at = text;
    bool ok = read_number(&at, &eye.age_years);
    if (ok && *at == ',') {
        at++;
        ok = read_number(&at, &eye.pigment);
    }
    ok = ok && !*at && eye.age_years >= HUMAN_EYE_AGE_MIN && eye.age_years <= HUMAN_EYE_AGE_MAX &&
         eye.pigment <= HUMAN_EYE_PIGMENT_MAX;
    if (!ok)
        return error_set(err, ERROR_USAGE,
                         "%s: required: AGE or AGE,PIGMENT: %g to %g years, "
                         "0 (very dark) to %g (light blue)",
                         text, HUMAN_EYE_AGE_MIN, HUMAN_EYE_AGE_MAX, HUMAN_EYE_PIGMENT_MAX);
    *out = eye;
    return true;
}
