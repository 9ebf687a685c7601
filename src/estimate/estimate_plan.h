/* SPDX-License-Identifier: Apache-2.0 */
/* estimate_plan.h -- how many paths an estimate takes.
 *
 * A pilot decides it, whose paths are never reported: an estimate that stops when it pleases is
 * wrong more often than its interval states, and one that stops because nothing was found says
 * that nothing is there. The number hangs on none of the paths that are reported; so their
 * interval means 95 %.
 *
 * Threads  the asker's.
 */
#pragma once
#include <stdbool.h>

typedef struct EstimatePlan {
    long pilot;       /* its paths, at first */
    long least, most; /* that are reported: least, doubled as often as it takes, up to most */
    int reach;        /* the pilot grows until it requires no more than so many times its own:
                         the number that a shorter one finds is too uncertain, a longer one
                         costs more than it saves */
    void *user;
    void (*read_pilot)(void *user, long paths);          /* on, to so many in all */
    bool (*will_do)(void *user, long pilot, long paths); /* would so many fresh ones, by what
                                                        the pilot of so many found? */
} EstimatePlan;

/* Reads the pilot, and reports how many fresh ones there should be. No pilot is read where
 * there is no choice. */
long estimate_plan(const EstimatePlan *plan);
