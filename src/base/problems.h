/* SPDX-License-Identifier: Apache-2.0 */
/* problems.h -- collects everything that is wrong with the user's files, not just the first; of
 * one kind, which is one format of one file, a hundred, and in one more entry how many there are
 * besides.
 *
 * Memory   the list grows in its arena. Threads: one thread at a time.
 */
#pragma once
#include <stdarg.h>

#include "base/arena.h"
#include "base/error.h"

typedef enum Severity { SEVERITY_WARNING, SEVERITY_ERROR } Severity;

typedef struct Problem {
    const char *file, *path, *message; /* path: JSON pointer or line, "" if none */
    Severity severity;
} Problem;

#define PROBLEMS_OF_KIND 100

typedef struct ProblemKind ProblemKind;

typedef struct Problems {
    Arena *arena;
    Problem *list;
    int count, capacity;
    int error_count, warning_count; /* of all, listed or not */
    ProblemKind *kinds;
    int kind_count, kind_capacity;
} Problems;

Problems problems_start(Arena *arena);

/* Adds one; texts are copied. */
void problems_add(Problems *problems, Severity severity, const char *file, const char *path,
                  const char *format, ...) __attribute__((format(printf, 5, 6)));

/* The same for a function that is itself like printf. */
void problems_add_list(Problems *problems, Severity severity, const char *file, const char *path,
                       const char *format, va_list list) __attribute__((format(printf, 5, 0)));

/* An Error as an entry. */
void problems_add_error(Problems *problems, const Error *error);

/* False when there is an error in the list: *err is the first one, with the number of the
 * others. */
bool problems_verdict(const Problems *problems, Error *err);
