/* SPDX-License-Identifier: Apache-2.0 */
/* comparison_json.h -- a comparison as JSON; the keys are promised to scripts.
 *
 * Memory   documents are jansson's: the caller releases them. Threads: pure.
 */
#pragma once
#include <jansson.h>

#include "compare/comparison.h"

/* {"name", "same", "outcome", "verdict", "metrics": {...}, "limits", "rows", "reasons", "notes",
 * ...}. A metric that was not computed has no key; an infinite one (psnr of equal pictures) is
 * null. name: of the pair. */
json_t *comparison_json(const Comparison *c, const char *name);
