/* SPDX-License-Identifier: Apache-2.0 */
/* judge_reason.h -- the reasons against a fitted panel, as they are found.
 *
 * Memory   the texts are in the JSON lists. Threads: one at a time. Fails: never.
 */
#pragma once
#include <jansson.h>

#include "base/arena.h"

typedef enum JudgeGrade { JUDGE_GOOD = 0, JUDGE_CARE, JUDGE_UNUSABLE } JudgeGrade;

typedef struct Judge {
    JudgeGrade grade;      /* of the worst reason */
    json_t    *reasons[3]; /* texts, by grade */
    json_t    *figures;    /* an object of what was judged */
    Arena     *arena;
} Judge;

/* One more reason, as printf. */
void judge_reason_add(Judge *judge, JudgeGrade grade, const char *format, ...)
    __attribute__((format(printf, 3, 4)));

/* The grade of a value that should be small. */
JudgeGrade judge_reason_grade(double value, double care, double unusable);
