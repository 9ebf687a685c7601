/* SPDX-License-Identifier: Apache-2.0 */
/* review_card.h -- what is said of one case of a review, whoever shows it: its card, the grid,
 * a matrix, the list; and the pictures of a page.
 *
 * Memory   the document's (jansson) and the arena's. Threads: one at a time.
 * Fails    for a picture that cannot be read.
 */
#pragma once
#include "review/output/review_values.h"

/* Of every case and every sweep's worst. */
bool values_add_cases(const PageValues *v, Error *err);

/* What picture.html shows: bytes, or a file's name. */
bool values_add_picture(json_t *to, const ReviewPicture *p, Arena scratch, Error *err);

/* words_directions for a case's sun; NULL: what its azimuth counts from is not known. */
const char *const *values_directions(const PageValues *v, const ReviewCase *c);
