/* SPDX-License-Identifier: Apache-2.0 */
/* json_text.h -- a text of any bytes, a number of any kind as a value of a JSON document; and a
 * document as a text.
 *
 * Memory   the caller's reference (jansson). Threads: no shared state.
 */
#pragma once
#include <jansson.h>
#include <stdbool.h>

#include "base/vec.h"
#include "text/text.h"

/* A text that is not UTF-8 becomes what may be shown of it (printable.h): names of files may
 * hold anything. */
json_t *json_text(const char *text);

/* The same; null for NULL. */
json_t *json_text_or_null(const char *text);

/* A list of texts. */
json_t *json_texts(const char *const *texts, int count);

/* null where it is not finite: JSON has neither NaN nor infinity. */
json_t *json_figure(double value);

/* A direction, or a point of the world, as a list of three numbers. */
json_t *json_vector(Vec3 v);
json_t *json_world_point(const double world_m[3]);

/* Adds the document as jansson writes it with these flags, with what a terminal would obey as
 * \u escapes. False: there is none, or memory is out. */
bool json_dump_text(Text *text, const json_t *value, size_t flags);

/* A number has `digits` digits where they are enough to give the same double again, else as
 * many as it takes, 17 at most; or `digits` of them at most. */
typedef struct JsonDigits {
    int digits;  /* 1 to 17 */
    bool is_cut; /* no more than that, even with a loss */
} JsonDigits;

/* A document as people like to read and to change it: what fits into a line stands in one,
 * members are indented by two. All of it, with a line's end. */
void json_print(Text *text, const json_t *document, JsonDigits digits);
