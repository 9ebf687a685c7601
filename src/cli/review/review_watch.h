/* SPDX-License-Identifier: Apache-2.0 */
/* review_watch.h -- the files that a review was made of, and when one of them is another.
 *
 * Files are looked at twice a second: when they were written, and how long they are. Editors
 * write a file anew in several steps: it counts when nothing has changed for half a second.
 *
 * Memory   its own, until review_watch_end.
 * Threads  one at a time.
 */
#pragma once
#include "base/arena.h"
#include "base/error.h"

typedef struct WatchedFile WatchedFile;

typedef struct ReviewWatch {
    Arena        arena;
    WatchedFile *files;
    int          count, room;
} ReviewWatch;

ReviewWatch review_watch_start(void);
void        review_watch_end(ReviewWatch *watch);

/* A file that is known already is not looked at again. */
void review_watch_add(ReviewWatch *watch, const char *path);

/* Waits until a file was written, made or removed; *changed: the first of them. False: the user
 * requested to stop (signals.h). */
bool review_watch_wait(ReviewWatch *watch, const char **changed);
