/* SPDX-License-Identifier: Apache-2.0 */
/* goes_on.h -- whether a review goes on.
 *
 * Threads  the one that reviews.
 */
#pragma once
#include "keep/journal.h"

/* False: INT, TERM or HUP requested to stop (signals_stopped: there is no error), or the
 * journal (NULL: none) could not keep what was found. */
bool review_goes_on(const Journal *journal, Error *err);
