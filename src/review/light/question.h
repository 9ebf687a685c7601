/* SPDX-License-Identifier: Apache-2.0 */
/* question.h -- what a probe has to find, as the key of its answer (keep/journal.h).
 *
 * Everything that decides the answer is in it: the program, the scene's files, its light as it
 * is now, where the probe is and looks, and what it has to find.
 *
 * Threads  pure functions.
 */
#pragma once
#include "keep/journal.h"
#include "kernel/kernel.h"

/* All that decides the answer besides the aim and the light. */
typedef struct Question {
    JournalKey    base; /* program, scene and the files that the request names */
    const char   *kind;
    const double *numbers;
    int           number_count;
    const Vec3   *towards; /* directions */
    int           towards_count;
} Question;

JournalKey question_key(const Question *question, const ProbeAim *aim, Arena scratch);

/* Where the probe is and looks, as a hash. */
uint64_t question_aim(const ProbeAim *aim);
