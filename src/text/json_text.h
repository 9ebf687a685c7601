/* SPDX-License-Identifier: Apache-2.0 */
/* json_text.h -- a text of any bytes, a number of any kind as a value of a JSON document.
 *
 * Memory   the caller's reference (jansson). Threads: no shared state.
 */
#pragma once
#include <jansson.h>

/* Bytes beyond ASCII become '?' in a text that is not UTF-8: names of files may hold
 * anything. */
json_t *json_text(const char *text);

/* A list of them. */
json_t *json_texts(const char *const *texts, int count);

/* null where it is not finite: JSON has neither NaN nor infinity. */
json_t *json_figure(double value);
