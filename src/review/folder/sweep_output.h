/* SPDX-License-Identifier: Apache-2.0 */
/* sweep_output.h -- what a sweep found of every sun: as a table, and as pictures for the page.
 *
 * Memory   from the arena. Threads: pure.
 * Fails    when the table cannot be written.
 */
#pragma once
#include "review/output/review_page.h"
#include "review/run/review_run.h"

/* CSV: a row a sun, azimuths of the compass and of the vehicle. */
bool sweep_table_write(const SweepTable *table, const ReviewCondition *condition, const char *path,
                       Error *err);

/* Contrast over the sun's place in the vehicle's frame: cells of `step_deg`, each with the
 * worst of its suns; of a sweep over the sun its own grid. A cell that the sun of a year passes
 * between two steps has the answer of the one that is nearer in time. */
ReviewMap sweep_map(const SweepTable *table, const ReviewSweep *sweep,
                    const ReviewCondition *condition, double step_deg, Arena *arena);

/* For a year sweep. */
ReviewCalendar sweep_calendar(const SweepTable *table, const ReviewSweep *sweep,
                              const ReviewCondition *condition, Arena *arena);
