/* SPDX-License-Identifier: Apache-2.0 */
/* progress.h -- shows a waiting person how much of long work is done.
 *
 * On a terminal a bar with percent, rate, elapsed and remaining time; in a pipe, a file or a
 * terminal that cannot write a line anew (TERM dumb or missing) a plain line now and then,
 * also where a bar is requested; or one JSON object a line; or nothing. Always on stderr:
 * results own stdout. Colour only on such a terminal and without NO_COLOR; no other escape
 * codes anywhere.
 *
 * Threads  one thread at a time. Fails: never.
 */
#pragma once
#include <stdbool.h>

typedef enum ProgressMode {
    PROGRESS_AUTO, /* a bar on a terminal, plain lines otherwise */
    PROGRESS_BAR,
    PROGRESS_PLAIN,
    PROGRESS_JSON,
    PROGRESS_NONE
} ProgressMode;

typedef struct Progress Progress;
struct Progress {
    ProgressMode mode;       /* never PROGRESS_AUTO once started */
    const char *what;        /* "render": a verb or a file's name */
    const char *unit;        /* what is counted, for the rate: "samples" */
    double total;            /* how much there is to do; may be changed between updates */
    double done;             /* as of the last update */
    double first;            /* done before it began: counts for the share, not for the rate */
    double begun_s, shown_s; /* seconds of the monotonic clock */
    double interval_s;       /* requested between two lines */
    bool has_colour;
    int shown_columns; /* of the bar's longest line so far */
    Progress *outer;   /* this is a part of that; or NULL */
    double outer_from, outer_weight;
};

/* what and unit must outlive the Progress. */
Progress progress_start(ProgressMode mode, const char *what, const char *unit, double total);

/* A part of an outer one, where all of it counts `weight`. Nothing is shown of itself. */
Progress progress_part(Progress *outer, double weight, double total);

/* Shows how much is done when the last line is old enough; cheap otherwise. */
void progress_update(Progress *progress, double done);

/* The last line: always shown, unless nothing ever is. */
void progress_end(Progress *progress, double done);

/* Blanks a bar out so that another line can be printed to stderr. */
void progress_clear(const Progress *progress);

/* Seconds of the monotonic clock. */
double monotonic_seconds(void);

/* A rate with three digits, ready for its unit: "950 ", "12.3 k", "4.56 M". */
void rate_text(double rate, char *buffer, int size);
