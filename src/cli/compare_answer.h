/* SPDX-License-Identifier: Apache-2.0 */
/* compare_answer.h -- the answer of `parhelion compare` as text for people.
 *
 * Threads  one at a time. Fails: never; who prints looks at stdout at the end.
 */
#pragma once
#include "cli/compare_request.h"

/* Metrics, notes and the verdict of two files. */
void compare_print_pair(const CompareRequest *request, const Comparison *c);

/* One line for a pair of two folders. */
void compare_print_line(const char *name, const Comparison *c);
