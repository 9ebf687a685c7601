/* SPDX-License-Identifier: Apache-2.0 */
#include "base/problems.h"

#include <stdio.h>
#include <string.h>

#define MORE_BYTES 160

struct ProblemKind {
    const char *format, *file;
    Severity severity;
    int count;
    const char *first; /* message */
    char *more;        /* MORE_BYTES; NULL: there are no more than are listed */
};

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
}

static void count(Problems *problems, Severity severity) {
    if (severity == SEVERITY_ERROR) problems->error_count++;
    else problems->warning_count++;
}

/* NULL for what is put together elsewhere: such messages have nothing in common. */
static ProblemKind *kind_of(Problems *problems, Severity severity, const char *file,
                            const char *format) {
    if (!strcmp(format, "%s")) return NULL;
    for (int i = problems->kind_count - 1; i >= 0; i--) {
        ProblemKind *kind = &problems->kinds[i];
        if (kind->format == format && kind->severity == severity && !strcmp(kind->file, file))
            return kind;
    }
    if (problems->kind_count == problems->kind_capacity) {
        problems->kind_capacity = problems->kind_capacity ? 2 * problems->kind_capacity : 16;
        problems->kinds = ARENA_GROW(problems->arena, ProblemKind, problems->kinds,
                                     problems->kind_count, problems->kind_capacity);
    }
    ProblemKind *made = &problems->kinds[problems->kind_count++];
    *made = (ProblemKind){
        format, arena_string(problems->arena, file, strlen(file)), severity, 0, NULL, NULL};
    return made;
}

/* One entry for all of them, which says each time how many they are by now. */
static void count_more(Problems *problems, ProblemKind *kind, const char *file) {
    if (!kind->more) {
        kind->more = ARENA_NEW(problems->arena, char, MORE_BYTES);
        append(problems, kind->severity, file, "", "");
        problems->list[problems->count - 1].message = kind->more;
    }
    snprintf(kind->more, MORE_BYTES, "and %d more like '%.100s...'", kind->count - PROBLEMS_OF_KIND,
             kind->first);
}

void problems_add_list(Problems *problems, Severity severity, const char *file, const char *path,
                       const char *format, va_list list) {
    char message[1024];
    ProblemKind *kind = kind_of(problems, severity, file ? file : "", format);
    count(problems, severity);
    if (kind && ++kind->count > PROBLEMS_OF_KIND) {
        count_more(problems, kind, file);
        return;
    }
    vsnprintf(message, sizeof message, format, list);
    append(problems, severity, file, path, message);
    if (kind && !kind->first) kind->first = problems->list[problems->count - 1].message;
}

void problems_add(Problems *problems, Severity severity, const char *file, const char *path,
                  const char *format, ...) {
    va_list list;
    va_start(list, format);
    problems_add_list(problems, severity, file, path, format, list);
    va_end(list);
}

void problems_add_error(Problems *problems, const Error *error) {
    count(problems, SEVERITY_ERROR);
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
