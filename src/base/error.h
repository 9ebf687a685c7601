/* SPDX-License-Identifier: Apache-2.0 */
/* error.h -- carries one failure, with its context, back to the command line.
 *
 * A function that can fail returns bool and takes `Error *err` last. On false, *err is
 * filled and every output argument is left untouched. The caller owns the Error; threads
 * never share one. What a foreign file holds may be quoted: its texts are escaped
 * (printable.h), so that a message stays one line and gives a terminal no commands.
 */
#pragma once
#include <stdarg.h>
#include <stdbool.h>

#ifdef __cplusplus
extern "C" {
#endif

/* Kinds of failure; the values are the exit status, unless another one is stated. */
typedef enum ErrorCode {
    ERROR_NONE = 0,     /* also of what a signal stopped (signals_stopped) */
    ERROR_UNUSABLE = 1, /* what it would write is not fit for use */
    ERROR_USAGE = 2,    /* the command line is wrong */
    ERROR_INPUT = 3,    /* missing, malformed or not supported input */
    ERROR_OUTPUT = 4,   /* an output cannot be written */
    ERROR_LIBRARY = 5,  /* a library refused for a reason of its own: exit status 3 */
    ERROR_MEMORY = 6,   /* out of memory: exit status 3 */
    ERROR_MACHINE = 7   /* this machine cannot, another may: exit status 5 */
} ErrorCode;

typedef struct Error {
    ErrorCode code;
    char file[512];  /* the file in question as the user named it, or "" */
    char path[256];  /* the place inside it ("/materials/3", "line 12"), or "" */
    char text[1024]; /* what was found and what was required; outermost context first */
} Error;

/* Fills *err (file and path empty). Always returns false, so `return error_set(...)`. */
bool error_set(Error *err, ErrorCode code, const char *format, ...)
    __attribute__((format(printf, 3, 4)));

/* As error_set, naming the file and the place inside it (NULL or "" = none). */
bool error_at(Error *err, ErrorCode code, const char *file, const char *path, const char *format,
              ...) __attribute__((format(printf, 5, 6)));
bool error_at_list(Error *err, ErrorCode code, const char *file, const char *path,
                   const char *format, va_list list) __attribute__((format(printf, 5, 0)));

/* An ERROR_INPUT at a numbered place: `unit` "line" and number 12 are "line 12". */
bool error_at_count(Error *err, const char *file, const char *unit, long number, const char *format,
                    va_list list) __attribute__((format(printf, 5, 0)));

/* Puts "context: " in front of the text; keeps the rest; returns false. */
bool error_prefix(Error *err, const char *format, ...) __attribute__((format(printf, 2, 3)));

/* Names the file unless one is named already; returns false. */
bool error_in_file(Error *err, const char *file);

/* The whole failure as one line, "FILE: PATH: text". buffer holds at least size chars. */
void error_line(const Error *err, char *buffer, int size);

/* The process's exit status for a code (cli.md's table). */
int error_exit_status(ErrorCode code);

#ifdef __cplusplus
}
#endif
