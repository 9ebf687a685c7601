/* SPDX-License-Identifier: Apache-2.0 */
/* json_print.h -- a JSON document as people like to read and to change it: what fits into a
 * line stands in one, members are indented by two.
 *
 * A number has `digits` digits where they are enough to give the same double again, else as
 * many as it takes, 17 at most; or `digits` of them at most.
 *
 * Memory   the text's. Threads: no shared state. Fails: never.
 */
#pragma once
#include <jansson.h>
#include <stdbool.h>

#include "text/text.h"

typedef struct JsonDigits {
    int  digits; /* 1 to 17 */
    bool is_cut; /* no more than that, even with a loss */
} JsonDigits;

/* All of it, with a line's end. */
void json_print(Text *text, const json_t *document, JsonDigits digits);
