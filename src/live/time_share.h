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
    double dearest_s; /* what took longest */
} TimeShare;

/* Whether there is time for one more as dear as the dearest. */
static inline bool time_share_allows(const TimeShare *time, double now_s)
{
    return time->spent_s + time->dearest_s <= time->share * (now_s - time->begun_s);
}

static inline void time_share_spend(TimeShare *time, double seconds)
{
    time->spent_s += seconds;
    if (seconds > time->dearest_s) time->dearest_s = seconds;
}
