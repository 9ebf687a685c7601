/* SPDX-License-Identifier: Apache-2.0 */
/* roff.h -- words of a manual page on stdout, so that what is printed is what was written.
 *
 * Letters that troff reads as its own are escaped; UTF-8 stays itself. Lines begin with no
 * point but that of a request.
 *
 * Threads  one at a time.  Fails  never; main.c looks at stdout in the end.
 */
#pragma once
#include <stddef.h>

void roff_put(const char *text, size_t length);
void roff_string(const char *text);

/* Markdown within a line or a paragraph: `code`, **strong**, [words](target), ![words](target).
 */
void roff_inline(const char *text, size_t length);

/* The line that begins a page: name in lower case, section 1 or 7; then its section NAME. */
void roff_title(const char *name, size_t length, int section);
