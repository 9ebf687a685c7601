/* SPDX-License-Identifier: Apache-2.0 */
/* review_task.h -- a review that is a job's, or a part of one: what was planned of it. */
#pragma once
#include "review/run/job.h"

/* A review, or a part of one, that was planned. */
typedef struct ReviewTask {
    const char  *name;        /* of the part, for messages */
    const char  *identity;    /* what its conditions have to be of */
    const char  *isa;         /* taken where the words name none */
    ReviewShare  share;       /* count 0: all, as a user's own command */
    const char  *answers;     /* of a part: the file that it writes, and */
    JournalKey   mark;        /* what that gets last */
    const char **found;       /* files of answers that were found before: those of a part may
                                 be damaged, those of the whole may not */
    int          found_count;
    const char  *responses;   /* where the parts' are, unless the words name a folder; and what
                                 they learnt */
    const char  *resume_line; /* the command that goes on with it */
} ReviewTask;
