/* SPDX-License-Identifier: Apache-2.0 */
#include "base/problems.h"

#include <stdio.h>

Problems problems_start(Arena *arena) {
    return (Problems){.arena = arena};
}

static void append(Problems *problems, Severity severity, const char *file, const char *path,
                   const char *message) {
    Arena *arena = problems->arena;
    if (problems->count == problems->capacity) {
        problems->capacity = problems->capacity ? 2 * problems->capacity : 16;
        problems->list =
            ARENA_GROW(arena, Problem, problems->list, problems->count, problems->capacity);
    }
    problems->list[problems->count++] = (Problem){arena_printable(arena, file ? file : ""),
                                                  arena_printable(arena, path ? path : ""),
                                                  arena_printable(arena, message), severity};
    problems->error_count += severity == SEVERITY_ERROR;
}

void problems_add_list(Problems *problems, Severity severity, const char *file, const char *path,
                       const char *format, va_list list) {
    char message[1024];
    vsnprintf(message, sizeof message, format, list);
    append(problems, severity, file, path, message);
}

void problems_add(Problems *problems, Severity severity, const char *file, const char *path,
                  const char *format, ...) {
    va_list list;
    va_start(list, format);
    problems_add_list(problems, severity, file, path, format, list);
    va_end(list);
}

void problems_add_error(Problems *problems, const Error *error) {
    append(problems, SEVERITY_ERROR, error->file, error->path, error->text);
}

bool problems_verdict(const Problems *problems, Error *err) {
    if (!problems->error_count) return true;
    const Problem *first = problems->list;
    while (first->severity != SEVERITY_ERROR) first++;
    if (problems->error_count == 1)
        return error_at(err, ERROR_INPUT, first->file, first->path, "%s", first->message);
    return error_at(err, ERROR_INPUT, first->file, first->path,
                    "%s (and %d more: see `parhelion check`)", first->message,
                    problems->error_count - 1);
}
