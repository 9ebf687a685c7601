/* SPDX-License-Identifier: Apache-2.0 */
/* sweep_responses.h -- the responses of a sweep's probes, and what they read of the scene's own
 * light: of files of an earlier review, or traced and then kept in files.
 *
 * A file that is damaged, or of something else under that name, is a warning; the response is
 * traced again and the file replaced.
 *
 * Memory   from the arena that is passed in.
 * Threads  starts its own; the same numbers for any count.
 * Fails    when a file cannot be written, or the user stops it.
 */
#pragma once
#include "review/light/distant_probe.h"
#include "review/light/response_file.h"
#include "review/pace/work.h"
#include "review/run/job.h"

/* A probe whose aim is set, with room for its answers. */
typedef struct ResponseAsk {
    const char  *name;      /* for people: "driver, speed" */
    DistantProbe *probe;
    OwnLight    *own;
    int          paths;     /* at most */
    double       precision; /* 0: all paths */
    ResponseFile file;
    const char  *shown;     /* the file's name as review.json has it */
    bool         is_kept;   /* it was read, not traced */
    bool         is_left;   /* to another part: nothing is known of it */
} ResponseAsk;

/* Reads those that are there. Sets file, shown and is_kept of all. */
void responses_find(const ReviewRun *run, const Setup *setup, ResponseAsk *asks, int count,
                    Arena *arena);

/* The own light of those that were not there: the scene is dark but for its lamps, or for its
 * lamps and displays at level 1, which is sampled after them. */
bool responses_read_own(const ReviewRun *run, const Setup *setup, const ResponseAsk *asks,
                        int count, bool displays, Error *err);

/* How long it will take; 0: it is not to be traced. */
WorkKind responses_kind(const ResponseAsk *ask);
double   responses_work(const ResponseAsk *ask);

/* Traces and keeps the rest. */
bool responses_trace(const ReviewRun *run, const Setup *setup, ResponseAsk *asks, int count,
                     Arena *arena, Error *err);
