/* SPDX-License-Identifier: Apache-2.0 */
/* state_print.h -- a report's "states" (state_facts.h) as text: a few lines for each.
 *
 * Threads  one at a time. Fails: never.
 */
#pragma once
#include <jansson.h>

void state_print(const json_t *report);
