/* SPDX-License-Identifier: Apache-2.0 */
#include "review/keep/goes_on.h"

#include "render/signals.h"

bool review_goes_on(const Journal *journal, Error *err)
{
    return signals_stop_requested() ? signals_stopped(err) : journal_ok(journal, err);
}
