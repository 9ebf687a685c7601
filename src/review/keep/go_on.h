/* SPDX-License-Identifier: Apache-2.0 */
/* go_on.h -- whether a review goes on: the user may ask it to stop, a disk may be full.
 *
 * Threads  one at a time.
 */
#pragma once
#include "review/keep/journal.h"

/* False: INT, TERM or HUP asked to stop, and the error's code is 128 and the signal's number;
 * or the journal could not keep what was found. */
bool review_goes_on(const Journal *journal, Error *err);
