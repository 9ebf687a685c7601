/* SPDX-License-Identifier: Apache-2.0 */
/* fit_options.h -- what a user may request of a fit, and sentences that its report keeps: what
 * was chosen, missed, assumed.
 *
 * Memory   the notes' arena. Threads: one at a time. Fails: never; beyond FIT_NOTES_MAX
 * sentences, and 511 bytes of one, the rest is dropped.
 */
#pragma once
#include <stdbool.h>

#include "base/arena.h"
#include "base/progress.h"

typedef enum FitBasis { FIT_VERTEX = 0, FIT_HAAR = 1 } FitBasis; /* on the hemisphere */

/* 0 is "choose". */
typedef struct FitOptions {
    int level;         /* of the trees; 0: what the samples need */
    float keep_share;  /* Haar: stored rows over leaves, (0, 1]; 0: what FIT_HAAR_SOURCE of
                          the source's float32 has room for */
    float bound;       /* relative error allowed at every measured sample; 0: 2 %, and
                          2.5 % of noisy tables. Noise allows its own 5 sigma anyway */
    float error_floor; /* share of an emission channel's largest value in a table: of what
                          is less, errors count relative to it */
    FitBasis basis;
    bool force;  /* a panel that is judged not usable is written all the same */
    int threads; /* at least 1; the bytes do not depend on it */
    ProgressMode progress;
} FitOptions;

static inline FitOptions fit_options_default(void) {
    return (FitOptions){.error_floor = 0.001f, .threads = 1, .progress = PROGRESS_NONE};
}

/* The bound that errors are held against. chosen: where the user requires none. */
static inline double fit_required_bound(const FitOptions *options, double chosen) {
    return options->bound > 0 ? (double)options->bound : chosen;
}

#define FIT_HAAR_SOURCE 0.05

/* The share of a Haar tree's rows to keep. numbers: measured ones; leaves, components: of the
 * tree. A row takes two bytes a component, and eight with its node. */
float fit_haar_share(const FitOptions *options, double numbers, double leaves, int components);

#define FIT_NOTES_MAX 32

typedef struct FitNotes {
    const char *text[FIT_NOTES_MAX];
    int count;
    Arena *arena;
} FitNotes;

/* As printf. */
void fit_note(FitNotes *notes, const char *format, ...) __attribute__((format(printf, 2, 3)));
