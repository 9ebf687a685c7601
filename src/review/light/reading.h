/* reading.h -- what a probe reads under the light that is there.
 *
 * Paths go out in rounds, each as long as all before it, until the figure that depends on the
 * reading is sure enough. Standard errors come from means of whole chunks of paths, whose
 * samples are well spread among themselves.
 *
 * Units    cd m^-2 (a luxmeter: lx).
 * Memory   scratch only.
 * Threads  starts its own; the same numbers for any count.
 */
#pragma once
#include "base/arena.h"
#include "kernel/kernel.h"

/* When a reading is sure enough: when one standard error moves the contrast of what is shown by
 * less than `precision` of it, or the reading itself. */
typedef struct ReadingGoal {
    double brighter, darker; /* emitted, cd m^-2; both 0: the reading itself counts */
    double precision;        /* relative, above 0 */
    long   most;             /* paths, at most */
} ReadingGoal;

typedef struct ReadingTools {
    const Kernel *kernel;
    int           threads;
} ReadingTools;

typedef struct Reading {
    double reflected;    /* Y; of a luxmeter the illuminance */
    double sigma;        /* its standard error */
    double mirror;       /* of it, by way of the display's mirror */
    double found_share;  /* paths whose first surface was a display */
    long   paths;
} Reading;

Reading reading_take(const ProbeAim *aim, const ReadingGoal *goal, const ReadingTools *tools,
                     Arena scratch);
