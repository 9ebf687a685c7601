/* SPDX-License-Identifier: Apache-2.0 */
/* review_answer.h -- the page's first screen: pass or fail, every symbol as every eye sees it
 * at its worst, and the worst case of all: its picture, when, why and the remedy.
 *
 * Memory   the document's (jansson) and the arena's. Threads: one at a time.
 * Fails    for a picture that cannot be read.
 */
#pragma once
#include "review/output/review_values.h"

bool values_add_answer(const PageValues *v, Error *err);
