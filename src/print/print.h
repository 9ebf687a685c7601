/* SPDX-License-Identifier: Apache-2.0 */
/* print.h -- what a command says on its streams: printf whose texts are foreign.
 *
 * The format is the program's own and goes out as it stands; of every %s what a terminal would
 * obey is escaped (printable.h), a line's end too, so that no name can forge a line. A width
 * counts characters. Nothing else in the program writes to a stream (tests/structure/calls.py).
 *
 * Conversions: d, i, o, u, x, X with nothing, hh, h, l, ll or z before them; the floating ones,
 * c, s and %; flags, widths and precisions, also by *.
 *
 * Threads  one at a time a stream, as printf.
 * Fails    as printf: the stream says so (ferror).
 */
#pragma once
#include <stdio.h>

/* To stdout. */
void print(const char *format, ...) __attribute__((format(printf, 1, 2)));

/* To any stream. Returns how many characters. */
int print_to(FILE *to, const char *format, ...) __attribute__((format(printf, 2, 3)));

/* The program's own text, of many lines, as it stands. */
void print_own(FILE *to, const char *text);
