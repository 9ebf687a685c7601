/* comparison_json.h -- a comparison as JSON; the keys are promised to scripts.
 *
 * Memory   documents are jansson's: whoever gets one releases it. Threads: pure.
 */
#pragma once
#include <jansson.h>

#include "compare/comparison.h"

/* {"same", "verdict", "mean", "metrics": {...}, "limits", "reasons", "notes", ...}. A figure
 * that was not computed has no key; an infinite one (psnr of equal pictures) is null. */
json_t *comparison_json(const Comparison *c, const CompareOptions *options);

/* A text as JSON, whatever its bytes: those that are not UTF-8 become '?'. */
json_t *json_of_text(const char *text);
