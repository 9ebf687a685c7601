/* SPDX-License-Identifier: Apache-2.0 */
/* judge_reach.h -- what the instrument could not see: mirrors and lobes narrower than its image
 * and the steps of its directions.
 *
 * Every reason begins with "coarse: " and ends with what to measure; the report's "judged" has
 * the ranges as "coarse".
 * Memory   scratch. Threads: one at a time. Fails: never.
 */
#pragma once
#include "panel/fit/fit_file.h"
#include "panel/fit/judge_reason.h"

void judge_reach(Judge *judge, const FitParts *parts);
