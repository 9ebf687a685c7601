/* SPDX-License-Identifier: Apache-2.0 */
#include "vision/human_eye.h"

#include <string.h>

#include "base/number.h"

bool human_eye_parse(const char *text, HumanEye *out, Error *err) {
    HumanEye eye = {0, HUMAN_EYE_PIGMENT_USUAL};
    const char *at = number_read(text, &eye.age_years);
    if (at && *at == ',') at = number_read(at + 1, &eye.pigment);
    bool ok = at && !*at && !text[strspn(text, "0123456789.,")] &&
              eye.age_years >= HUMAN_EYE_AGE_MIN && eye.age_years <= HUMAN_EYE_AGE_MAX &&
              eye.pigment <= HUMAN_EYE_PIGMENT_MAX;
    if (!ok)
        return error_set(err, ERROR_USAGE,
                         "%s: required: AGE or AGE,PIGMENT: %g to %g years, "
                         "0 (very dark) to %g (light blue)",
                         text, HUMAN_EYE_AGE_MIN, HUMAN_EYE_AGE_MAX, HUMAN_EYE_PIGMENT_MAX);
    *out = eye;
    return true;
}
