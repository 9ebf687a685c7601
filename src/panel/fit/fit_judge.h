/* SPDX-License-Identifier: Apache-2.0 */
/* fit_judge.h -- is a fitted panel good, usable with care, or not usable, and why?
 *
 * Criteria  each has a limit from where a panel needs care and mostly one from where it is
 *           not usable; a panel's verdict is that of its worst criterion. The limits stand in
 *           judge_limits.h.
 * Memory    the report's. Threads: one at a time. Fails: never.
 */
#pragma once
#include <jansson.h>

#include "panel/fit/fit_file.h"
#include "panel/fit/fit_table.h"
#include "panel/fit/judge_reason.h"

/* Of "judged": true where a measurement was given that the panel does without. */
#define JUDGE_LEFT_OUT "specular_left_out"

/* Deviations summed over all tables. */
typedef struct FitDeviations {
    FitErrors emission, reflection;
} FitDeviations;

/* Puts "verdict" (good, usable with care, not usable) and "reasons", the worst first, into the
 * report, each reason with what to do; and the figures that were judged as "judged". */
void fit_judge(const FitParts *parts, const FitDeviations *all, const FitTable *total,
               json_t *report);

/* The verdict of a report; one without (older files) counts as good. */
JudgeGrade fit_judge_grade(const json_t *report);
