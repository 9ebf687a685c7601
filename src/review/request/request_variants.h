/* SPDX-License-Identifier: Apache-2.0 */
/* request_variants.h -- the variants of REVIEW.json, and what its sensitivities are made of.
 *
 * A variant differs from the review in panels, contents, levels, brightness, coatings,
 * glazings, materials, nodes, hoods, eyes, scene files.
 *
 * Memory   the root view's arena. Threads: one at a time.
 * Fails    as request_read.h; names of the scene are found when it is loaded.
 */
#pragma once
#include "review/request/request_fields.h"

bool request_variants_read(RequestReading *reading, Error *err);
