/* SPDX-License-Identifier: Apache-2.0 */
/* number.h -- the one reader of numbers in texts. Decimal, as people and tables write them: a
 * sign, digits with a point among them, an exponent; blanks before it are passed over. Nothing
 * hexadecimal, infinite or "nan"; and it says where a number ends, so that its reader can require
 * what follows.
 *
 * Threads  pure functions.
 */
#pragma once
#include <stdbool.h>
#include <stdint.h>

/* What stands behind the number that `text` begins with; NULL, and *out untouched: it begins
 * with none, or with one beyond the type. */
const char *number_read(const char *text, double *out);
const char *number_read_float(const char *text, float *out);

/* The same of digits alone, without a blank. */
const char *number_read_count(const char *text, uint64_t *out);

/* All of the text is one. */
bool number_is(const char *text, double *out);
