/* SPDX-License-Identifier: Apache-2.0 */
/* request_read.h -- REVIEW.json becomes a ReviewRequest.
 *
 * Everything that can be known without the scene is checked: keys, kinds, ranges, the files of
 * weathers and skies, and that names meet.
 *
 * Memory   the arena's. Threads: one at a time.
 * Fails    with the file, the JSON path (/conditions/2/sweep/sun), what was found and what was
 *          required, in one line; of an unknown key the nearest known one is named.
 */
#pragma once
#include "base/problems.h"
#include "record/record.h"
#include "review/request/request.h"

extern const RecordFormat review_format; /* of a ReviewRequest */

/* root: a folder whose files may be named as well (--root); NULL: none. Warnings (a sky's
 * picture with broken pixels) go to *problems. */
bool review_request_read(const char *file, const char *root, Arena *arena, Problems *problems,
                         ReviewRequest *out, Error *err);
