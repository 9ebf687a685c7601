/* SPDX-License-Identifier: Apache-2.0 */
/* review_json_read.h -- review.json back into a Review, to hold another one against it.
 *
 * Memory   everything lies in the arena. Threads: no shared state.
 * Fails    with the file, the JSON path, what was found and what was wanted. Keys that a later
 *          version may add are passed over.
 */
#pragma once
#include "base/arena.h"
#include "base/error.h"
#include "review/verdict.h"

/* Reads a file of review_json: every figure to its six digits, null as NaN. */
bool review_json_read(const char *file, Arena *arena, Review *out, Error *err);
