/* SPDX-License-Identifier: Apache-2.0 */
#include "print/print.h"

#include <stdarg.h>
#include <stdbool.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include "print/printable.h"
#include "print/utf8.h"

#define SPEC_BYTES 48

/* One conversion, its numbers read: "%-12.3g". */
typedef struct Conversion {
    char flags[8];
    int width, precision; /* precision: -1: none */
    bool is_left;
    char length; /* l, L for ll, z; 0: an int, a double */
    char kind;
} Conversion;

typedef struct Printing {
    FILE *to;
    va_list list;
    int written; /* characters */
} Printing;

/* ---- texts ------------------------------------------------------------------------------- */

/* Characters of `left` bytes as they are shown. to: NULL: they are counted only. */
static int show(FILE *to, const char *text, size_t left) {
    char one[PRINTABLE_ROOM];
    int count = 0;
    for (size_t taken; left && *text; text += taken, left -= taken) {
        taken = printable_next(text, left, one);
        if (to) fputs(one, to);
        for (const char *c = one; *c; c++) count += !utf8_continues(*c);
    }
    return count;
}

static void put_text(Printing *out, const Conversion *how, const char *text) {
    size_t most = how->precision < 0 ? SIZE_MAX : (size_t)how->precision;
    if (!text) text = "(null)";
    int blanks = how->width - show(NULL, text, most);
    if (!how->is_left && blanks > 0) fprintf(out->to, "%*s", blanks, "");
    out->written += show(out->to, text, most);
    if (how->is_left && blanks > 0) fprintf(out->to, "%*s", blanks, "");
    if (blanks > 0) out->written += blanks;
}

/* ---- numbers ----------------------------------------------------------------------------- */

static int put_whole(Printing *out, const Conversion *how, const char *spec) {
    va_list *list = &out->list;
    switch (how->length) {
    case 'l': return fprintf(out->to, spec, va_arg(*list, long));
    case 'L': return fprintf(out->to, spec, va_arg(*list, long long));
    case 'z': return fprintf(out->to, spec, va_arg(*list, size_t));
    default: return fprintf(out->to, spec, va_arg(*list, int));
    }
}

static void put_number(Printing *out, const Conversion *how) {
    static const char *const lengths[] = {['l'] = "l", ['L'] = "ll", ['z'] = "z"};
    char spec[SPEC_BYTES], width[16] = "", precision[16] = "";
    bool is_whole = strchr("diouxX", how->kind);
    if (how->width) snprintf(width, sizeof width, "%d", how->width);
    if (how->precision >= 0) snprintf(precision, sizeof precision, ".%d", how->precision);
    snprintf(spec, sizeof spec, "%%%s%s%s%s%s%c", how->flags, how->is_left ? "-" : "", width,
             precision, how->length ? lengths[(int)how->length] : "", how->kind);
    if (is_whole) out->written += put_whole(out, how, spec);
    else out->written += fprintf(out->to, spec, va_arg(out->list, double));
}

/* ---- the format -------------------------------------------------------------------------- */

/* Digits, or a star for an argument. */
static const char *read_number(const char *at, Printing *out, int *number) {
    char *end;
    if (*at == '*') {
        *number = va_arg(out->list, int);
        return at + 1;
    }
    *number = (int)strtol(at, &end, 10);
    return end;
}

/* Returns what follows the conversion that begins at `at`, behind its percent sign. */
static const char *read_conversion(const char *at, Printing *out, Conversion *how) {
    size_t flags = strspn(at, "-+ #0");
    *how = (Conversion){.precision = -1};
    snprintf(how->flags, sizeof how->flags, "%.*s", (int)flags, at);
    at = read_number(at + flags, out, &how->width);
    how->is_left = how->width < 0 || strchr(how->flags, '-');
    how->width = abs(how->width);
    if (*at == '.') at = read_number(at + 1, out, &how->precision);
    for (; *at && strchr("hlz", *at); at++)
        if (*at != 'h') how->length = how->length == 'l' ? 'L' : *at;
    how->kind = *at;
    return at + (*at != '\0');
}

static int print_list(FILE *to, const char *format, va_list list) {
    Printing out = {.to = to};
    Conversion how;
    va_copy(out.list, list);
    for (const char *at = format; *at;) {
        size_t plain = strcspn(at, "%");
        fwrite(at, 1, plain, to);
        for (size_t i = 0; i < plain; i++) out.written += !utf8_continues(at[i]);
        at += plain;
        if (!*at) break;
        at = read_conversion(at + 1, &out, &how);
        if (how.kind == 's') put_text(&out, &how, va_arg(out.list, const char *));
        else if (how.kind == 'c') put_text(&out, &how, (char[]){(char)va_arg(out.list, int), '\0'});
        else if (how.kind == '%') out.written += fputc('%', to) != EOF;
        else put_number(&out, &how);
    }
    va_end(out.list);
    return out.written;
}

int print_to(FILE *to, const char *format, ...) {
    va_list list;
    va_start(list, format);
    int written = print_list(to, format, list);
    va_end(list);
    return written;
}

void print(const char *format, ...) {
    va_list list;
    va_start(list, format);
    print_list(stdout, format, list);
    va_end(list);
}

void print_own(FILE *to, const char *text) {
    fputs(text, to);
}
