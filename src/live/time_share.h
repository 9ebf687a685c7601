/* SPDX-License-Identifier: Apache-2.0 */
/* time_share.h -- keeps what is done again and again from taking more than a share of the time.
 *
 * Units    seconds of the monotonic clock.
 * Threads  plain data; one thread at a time.
 */
#pragma once
#include <stdbool.h>

typedef struct TimeShare {
    double share;     /* of all time since begun_s */
    double begun_s;
    double spent_s;   /* in all */
    double latest_s;  /* for the latest one, so far */
    double dearest_s; /* for the one that took longest */
} TimeShare;

/* Whether there is time for one more as dear as the dearest. */
static inline bool time_share_allows(const TimeShare *time, double now_s)
{
    return time->spent_s + time->dearest_s <= time->share * (now_s - time->begun_s);
}

/* Another one begins. */
static inline void time_share_begin(TimeShare *time)
{
    time->latest_s = 0;
}

static inline void time_share_spend(TimeShare *time, double seconds)
{
    time->spent_s += seconds;
    time->latest_s += seconds;
    if (time->latest_s > time->dearest_s) time->dearest_s = time->latest_s;
}
