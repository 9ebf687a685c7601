/* SPDX-License-Identifier: Apache-2.0 */
#include "base/number.h"

#include <errno.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#define DIGITS "0123456789"

/* Where it ends, by its letters alone: strtod would go on into hexadecimal digits, and begins
 * with line feeds, "inf" and "nan" as well. */
static const char *end_of(const char *text) {
    const char *at = text + strspn(text, " \t");
    at += *at == '+' || *at == '-';
    size_t whole = strspn(at, DIGITS), parts = 0;
    at += whole;
    if (*at == '.') {
        parts = strspn(at + 1, DIGITS);
        at += 1 + parts;
    }
    if (!whole && !parts) return NULL;
    bool is_hexadecimal = whole == 1 && at[-1] == '0' && (*at == 'x' || *at == 'X');
    if (*at == 'e' || *at == 'E') {
        const char *power = at + 1 + (at[1] == '+' || at[1] == '-');
        if (strspn(power, DIGITS)) at = power + strspn(power, DIGITS);
    }
    return is_hexadecimal ? NULL : at;
}

const char *number_read(const char *text, double *out) {
    const char *end = end_of(text);
    double value = end ? strtod(text, NULL) : (double)INFINITY;
    if (!isfinite(value)) return NULL;
    *out = value;
    return end;
}

const char *number_read_float(const char *text, float *out) {
    const char *end = end_of(text);
    float value = end ? strtof(text, NULL) : INFINITY;
    if (!isfinite(value)) return NULL;
    *out = value;
    return end;
}

const char *number_read_count(const char *text, uint64_t *out) {
    size_t digits = strspn(text, DIGITS);
    errno = 0;
    uint64_t value = digits ? strtoull(text, NULL, 10) : 0;
    if (!digits || errno) return NULL;
    *out = value;
    return text + digits;
}

bool number_is(const char *text, double *out) {
    double value;
    const char *end = number_read(text, &value);
    if (!end || *end) return false;
    *out = value;
    return true;
}
