/* SPDX-License-Identifier: Apache-2.0 */
/* review_privacy.h -- what is said of a symbol that must not be read (vision/privacy.h).
 *
 * Memory   the document's (jansson), the arena's. Threads: pure. Fails: never.
 */
#pragma once
#include <jansson.h>

#include "base/arena.h"
#include "review/private_image.h"

/* V and S with their 95 % intervals, whose ends are those of the contrast, the other way round.
 * NaN where the contrast is. */
typedef struct PrivacyFigures {
    double v, v_low, v_high, s, s_low, s_high;
} PrivacyFigures;

PrivacyFigures privacy_figures(const ReviewCase *c);

/* Of its image in a pane: "can be read, reversed: V 1.2 (1.1 to 1.3), S 0.08 (0.04 to 0.11);
 * 0.21 and 0.002 cd/m² over 0.1; 24 arc minutes high, all of it shown". */
const char *privacy_image_words(const CaseImage *image, Arena *arena);

/* From where in an eye box or ellipse it can be read, as inline SVG: a plan of each height,
 * seen from above, x to the right and z down as the scene has them, the heights from the top
 * on; of more than nine one plan, those that can read it on top. NULL: it has one place. */
const char *privacy_places_drawn(const ReviewCase *c, Arena *arena);

/* What review.json says of it: those figures, and what keeps it from being read. What is
 * infinite is null. NULL: it may be read. */
json_t *privacy_json(const ReviewCase *c);
