/* SPDX-License-Identifier: Apache-2.0 */
#include "review/keep/goes_on.h"

#include "render/signals.h"

bool review_goes_on(const Journal *journal, Error *err)
{
    int stop = signals_stop_requested();
    if (stop) return error_set(err, (ErrorCode)(128 + stop), "stopped");
    return journal_ok(journal, err);
}
