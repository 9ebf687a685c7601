/* SPDX-License-Identifier: Apache-2.0 */
/* review_json_read.h -- reads a review's JSON, to hold another one against it.
 *
 * Memory   all lies in the arena.
 * Threads  pure.
 * Fails    with the file, the JSON path, what was found and what was required. Keys that a
 *          later version may add are passed over.
 */
#pragma once
#include "base/arena.h"
#include "base/error.h"
#include "review/verdict.h"

/* Reads a file of review_json: every figure to its six digits, null as NaN. All lies in the
 * arena. */
bool review_json_read(const char *file, Arena *arena, Review *out, Error *err);
