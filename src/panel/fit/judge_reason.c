/* SPDX-License-Identifier: Apache-2.0 */
#include "panel/fit/judge_reason.h"

#include <math.h>
#include <stdarg.h>

void judge_reason_add(Judge *judge, JudgeGrade grade, const char *format, ...) {
    Arena scratch = *judge->arena;
    va_list args;
    if (grade == JUDGE_GOOD) return;
    va_start(args, format);
    json_array_append_new(judge->reasons[grade],
                          json_string(arena_format_list(&scratch, 511, format, args)));
    va_end(args);
    if (grade > judge->grade) judge->grade = grade;
}

const char *judge_rounded(const Judge *judge, double value) {
    return arena_format(judge->arena, fabs(value) < 99.5 ? "%.2g" : "%.0f", value);
}

JudgeGrade judge_reason_grade(double value, double care, double unusable) {
    return value > unusable ? JUDGE_UNUSABLE : value > care ? JUDGE_CARE : JUDGE_GOOD;
}
