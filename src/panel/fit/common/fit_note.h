/* SPDX-License-Identifier: Apache-2.0 */
/* fit_note.h -- sentences about a fit that its report keeps: what was chosen, missed, assumed.
 *
 * Memory   the notes' arena. Threads: one at a time. Fails: never; beyond FIT_NOTES_MAX
 * sentences, and 511 bytes of one, the rest is dropped.
 */
#pragma once
#include "base/arena.h"

#define FIT_NOTES_MAX 32

typedef struct FitNotes {
    const char *text[FIT_NOTES_MAX];
    int         count;
    Arena      *arena;
} FitNotes;

/* As printf. */
void fit_note(FitNotes *notes, const char *format, ...) __attribute__((format(printf, 2, 3)));
