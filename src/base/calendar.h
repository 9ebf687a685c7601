/* SPDX-License-Identifier: Apache-2.0 */
/* calendar.h -- the months of the Gregorian calendar.
 *
 * Units    months and days count from 1.  Threads  pure functions.  Fails  never.
 */
#pragma once
#include <stdbool.h>

bool calendar_is_leap(int year);

/* How many days a month has; month: 1..12. */
int calendar_days_of_month(int year, int month);
