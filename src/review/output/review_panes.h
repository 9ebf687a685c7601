/* SPDX-License-Identifier: Apache-2.0 */
/* review_panes.h -- what pages and the console say of displays in glass.
 *
 * Memory   the document's (jansson) and the arena's. Threads: one at a time. Fails: never.
 */
#pragma once
#include "review/output/review_values.h"
#include "review/pane_verdict.h"

/* Nothing of a review without any. */
void values_add_panes(const PageValues *v);
