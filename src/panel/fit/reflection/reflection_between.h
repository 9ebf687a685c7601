/* SPDX-License-Identifier: Apache-2.0 */
/* reflection_between.h -- does the tree agree with the table between its rows?
 *
 * At samples the coder sees what the tree misses; between the rows of a coarse table only this
 * does. It compares the tree with reading the table (and its guide), near the mirror direction,
 * halfway between rows.
 * Memory   scratch. Threads: pure functions. Fails: never.
 */
#pragma once
#include "panel/fit/reflection/reflection_model.h"

/* The largest relative difference of a table with a guide, in the middle wavelength; 0 without
 * one: rows are close enough there. */
double reflection_between(const ReflectionModel *model, int table, Arena scratch);
