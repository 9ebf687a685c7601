/* SPDX-License-Identifier: Apache-2.0 */
/* import_states.h -- the files of a display with states: each state's become a set of its own
 * within the whole, which has what all states share.
 *
 * Memory   the set's arena. Threads: one at a time.
 * Fails    as import_run; with a file that is of two states, a table of light that is of none,
 *          and a state without one.
 */
#pragma once
#include "import/import_request.h"

/* As import_run, which it is where the request has no states. The spectra of the primaries and
 * what was measured of the mirror are of all states; a gamma table gives levels to each. */
bool import_run_states(const char *const *file, int count, const ImportRequest *request,
                       ImportSet *set, Error *err);
