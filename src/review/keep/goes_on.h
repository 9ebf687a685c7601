/* SPDX-License-Identifier: Apache-2.0 */
/* goes_on.h -- whether a review goes on.
 *
 * Threads  the one that reviews.
 */
#pragma once
#include "keep/journal.h"

/* False: INT, TERM or HUP asked to stop, and the error's code is 128 and the signal's number;
 * or the journal (NULL: none) could not keep what was found. */
bool review_goes_on(const Journal *journal, Error *err);
