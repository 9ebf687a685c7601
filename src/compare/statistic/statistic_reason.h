/* SPDX-License-Identifier: Apache-2.0 */
/* statistic_reason.h -- the test's answer in words.
 *
 * Threads  pure.
 */
#pragma once
#include "compare/statistic/statistic_blocks.h"

/* Fills `reason` of a result that is otherwise complete. */
void statistic_reason(const NoisyPair *pair, const BlockGrid grids[2],
                      const BlockFinding *found, double level, StatisticResult *out);
