/* SPDX-License-Identifier: Apache-2.0 */
#include "base/error.h"

#include <stdarg.h>
#include <stdio.h>

#include "print/printable.h"

bool error_at_list(Error *err, ErrorCode code, const char *file, const char *path,
                   const char *format, va_list list) {
    char text[sizeof err->text];
    vsnprintf(text, sizeof text, format, list); /* may quote *err */
    err->code = code;
    printable_copy(err->file, sizeof err->file, file ? file : "");
    printable_copy(err->path, sizeof err->path, path ? path : "");
    printable_copy(err->text, sizeof err->text, text);
    return false;
}

bool error_set(Error *err, ErrorCode code, const char *format, ...) {
    va_list list;
    va_start(list, format);
    error_at_list(err, code, NULL, NULL, format, list);
    va_end(list);
    return false;
}

bool error_at(Error *err, ErrorCode code, const char *file, const char *path, const char *format,
              ...) {
    va_list list;
    va_start(list, format);
    error_at_list(err, code, file, path, format, list);
    va_end(list);
    return false;
}

bool error_at_count(Error *err, const char *file, const char *unit, long number, const char *format,
                    va_list list) {
    char place[48];
    snprintf(place, sizeof place, "%s %ld", unit, number);
    return error_at_list(err, ERROR_INPUT, file, place, format, list);
}

bool error_prefix(Error *err, const char *format, ...) {
    char context[sizeof err->text];
    char whole[2 * sizeof err->text + 4];
    va_list args;
    va_start(args, format);
    vsnprintf(context, sizeof context, format, args);
    va_end(args);
    snprintf(whole, sizeof whole, "%s: %s", context, err->text);
    printable_copy(err->text, sizeof err->text, whole);
    return false;
}

bool error_in_file(Error *err, const char *file) {
    if (!err->file[0]) printable_copy(err->file, sizeof err->file, file ? file : "");
    return false;
}

void error_line(const Error *err, char *buffer, int size) {
    snprintf(buffer, (size_t)size, "%s%s%s%s%s", err->file, err->file[0] ? ": " : "", err->path,
             err->path[0] ? ": " : "", err->text);
}

int error_exit_status(ErrorCode code) {
    if (code == ERROR_MACHINE) return 5;
    return code == ERROR_LIBRARY || code == ERROR_MEMORY ? 3 : (int)code;
}
