/* SPDX-License-Identifier: Apache-2.0 */
/* render_columns.h -- what `parhelion render` answers, as columns.
 *
 * Threads  constants. Fails: never.
 */
#pragma once
#include "table/table.h"

/* Of a frame; of a sample that is replayed. */
extern const TableKind render_answer_kind, render_replay_kind;
