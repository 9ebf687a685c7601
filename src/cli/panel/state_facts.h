/* SPDX-License-Identifier: Apache-2.0 */
/* state_facts.h -- what `panel fit` and `panel info` say of each state of a file, and which of
 * a set's states a panel is of.
 *
 * Threads  one at a time. Fails with the file.
 */
#pragma once
#include <jansson.h>

#include "base/arena.h"
#include "base/error.h"
#include "panel/query/panel.h"
#include "panel/set/measurement.h"

/* "states" of the report: of each its name, verdict, reasons, total, tables and display. A file
 * of one state adds nothing. panel: the file's, any of its states; path: as the user named
 * it. */
bool state_facts_add(const Panel *panel, const char *path, json_t *report, Arena *arena,
                     Error *err);

/* A set of several states that the panel was fitted from becomes that of the panel's. */
bool state_facts_take(const Panel *panel, Measurement *measured, Error *err);

/* As text: a few lines for each. */
void state_facts_print(const json_t *report);
