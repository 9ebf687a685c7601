/* SPDX-License-Identifier: Apache-2.0 */
#include "base/progress.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>
#include <unistd.h>

#include <jansson.h>

#include "print/print.h"
#include "print/printable.h"

#define BAR_CELLS 24
#define FIRST_S 1 /* of the first line, at the latest */

double monotonic_seconds(void) {
    struct timespec now;
    clock_gettime(CLOCK_MONOTONIC, &now);
    return (double)now.tv_sec + 1e-9 * (double)now.tv_nsec;
}

/* A line on stderr can be written anew. */
static bool has_live_terminal(void) {
    const char *terminal = getenv("TERM");
    return isatty(STDERR_FILENO) && terminal && *terminal && strcmp(terminal, "dumb") != 0;
}

Progress progress_start(ProgressMode mode, const char *what, const char *unit, double total) {
    static const double intervals_s[] = {
        [PROGRESS_BAR] = 0.1, [PROGRESS_PLAIN] = 10, [PROGRESS_JSON] = 1, [PROGRESS_NONE] = 0};
    bool is_live = has_live_terminal();
    const char *no_colour = getenv("NO_COLOR");
    if (mode == PROGRESS_AUTO || mode == PROGRESS_BAR)
        mode = is_live ? PROGRESS_BAR : PROGRESS_PLAIN;
    double now = monotonic_seconds();
    return (Progress){.mode = mode,
                      .what = what,
                      .unit = unit,
                      .total = total,
                      .begun_s = now,
                      .shown_s = now - fmax(intervals_s[mode] - FIRST_S, 0),
                      .interval_s = intervals_s[mode],
                      .has_colour = is_live && !(no_colour && *no_colour)};
}

/* 0:07, 12:30, 1:02:03; "?" when it is not known. */
static void print_time(char *buffer, size_t size, double seconds) {
    if (!(seconds < 360000)) {
        snprintf(buffer, size, "?");
        return;
    }
    int whole = (int)(seconds + 0.5);
    if (whole >= 3600)
        snprintf(buffer, size, "%d:%02d:%02d", whole / 3600, whole / 60 % 60, whole % 60);
    else snprintf(buffer, size, "%d:%02d", whole / 60, whole % 60);
}

void rate_text(double rate, char *buffer, int size) {
    static const char *const prefixes[] = {"", "k", "M", "G"};
    int step = 0;
    while (rate >= 1000 && step < 3) {
        rate /= 1000;
        step++;
    }
    snprintf(buffer, (size_t)size, "%.3g %s", rate, prefixes[step]);
}

typedef struct ProgressState {
    double fraction, rate, elapsed_s, remaining_s;
} ProgressState;

static ProgressState state_of(const Progress *progress, double done, double now) {
    double elapsed = now - progress->begun_s;
    double rate = elapsed > 0 ? (done - progress->first) / elapsed : 0;
    double left = progress->total > done ? progress->total - done : 0;
    double left_s = rate > 0 ? left / rate : INFINITY;
    double share = progress->total > 0 ? fmin(1, done / progress->total) : 1;
    return (ProgressState){.fraction = share,
                           .rate = rate,
                           .elapsed_s = elapsed,
                           .remaining_s = left == 0 ? 0 : left_s};
}

static void show_json(const Progress *progress, double done, const ProgressState *f) {
    char remaining[32] = "null", what[256];
    if (isfinite(f->remaining_s)) snprintf(remaining, sizeof remaining, "%.1f", f->remaining_s);
    printable_copy(what, sizeof what, progress->what);
    json_t *name = json_string(what);
    char *quoted = json_dumps(name, JSON_ENCODE_ANY);
    print_to(stderr,
             "{\"progress\":{\"what\":%s,\"unit\":\"%s\",\"done\":%.0f,\"total\":%.0f,"
             "\"fraction\":%.4f,\"per_s\":%.6g,\"elapsed_s\":%.1f,\"remaining_s\":%s}}\n",
             quoted ? quoted : "null", progress->unit, done, progress->total, f->fraction, f->rate,
             f->elapsed_s, remaining);
    free(quoted);
    json_decref(name);
}

static void show_text(Progress *progress, const ProgressState *f) {
    char rate[32], elapsed[32], remaining[32], bar[BAR_CELLS + 1];
    rate_text(f->rate, rate, (int)sizeof rate);
    print_time(elapsed, sizeof elapsed, f->elapsed_s);
    print_time(remaining, sizeof remaining, f->remaining_s);
    if (progress->mode == PROGRESS_PLAIN) {
        print_to(stderr, "parhelion: %s %.0f%%, %s%s/s, %s elapsed, %s left\n", progress->what,
                 floor(100 * f->fraction), rate, progress->unit, elapsed, remaining);
        return;
    }
    int full = (int)(BAR_CELLS * f->fraction);
    memset(bar, '.', BAR_CELLS);
    memset(bar, '#', (size_t)full);
    bar[BAR_CELLS] = '\0';
    print_own(stderr, "\r");
    int columns = print_to(stderr, "%s %3.0f%% [", progress->what, floor(100 * f->fraction));
    if (progress->has_colour) print_own(stderr, "\033[36m");
    columns += print_to(stderr, "%s", bar);
    if (progress->has_colour) print_own(stderr, "\033[0m");
    columns +=
        print_to(stderr, "] %s%s/s  %s elapsed  %s left", rate, progress->unit, elapsed, remaining);
    if (columns > progress->shown_columns) progress->shown_columns = columns;
    print_to(stderr, "%*s", progress->shown_columns - columns, "");
    fflush(stderr);
}

static void show(Progress *progress, double done, double now) {
    ProgressState f = state_of(progress, done, now);
    progress->shown_s = now;
    if (progress->mode == PROGRESS_JSON) show_json(progress, done, &f);
    else show_text(progress, &f);
}

Progress progress_part(Progress *outer, double weight, double total) {
    return (Progress){.mode = outer->mode,
                      .total = total,
                      .begun_s = monotonic_seconds(),
                      .outer = outer,
                      .outer_from = outer->done,
                      .outer_weight = weight};
}

static void update_outer(const Progress *progress, double share) {
    double inside = fmin(fmax(share, 0), 1);
    progress_update(progress->outer, fmax(progress->outer->done,
                                          progress->outer_from + progress->outer_weight * inside));
}

void progress_update(Progress *progress, double done) {
    progress->done = done;
    if (progress->mode == PROGRESS_NONE) return;
    if (progress->outer) {
        update_outer(progress, progress->total > 0 ? done / progress->total : 0);
        return;
    }
    double now = monotonic_seconds();
    if (now - progress->shown_s >= progress->interval_s) show(progress, done, now);
}

void progress_end(Progress *progress, double done) {
    progress->done = done;
    if (progress->mode == PROGRESS_NONE) return;
    if (progress->outer) {
        update_outer(progress, 1);
        return;
    }
    show(progress, done, monotonic_seconds());
    if (progress->mode == PROGRESS_BAR) print_own(stderr, "\n");
}

void progress_clear(const Progress *progress) {
    if (progress->outer) {
        progress_clear(progress->outer);
        return;
    }
    if (progress->mode == PROGRESS_BAR) print_to(stderr, "\r%*s\r", progress->shown_columns, "");
}
