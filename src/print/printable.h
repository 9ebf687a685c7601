/* SPDX-License-Identifier: Apache-2.0 */
/* printable.h -- a foreign text as it may be shown: names of files, nodes and symbols may hold
 * anything, and what a terminal or a page obeys instead of showing it would forge what the
 * program says.
 *
 * Escaped as JSON does it, "\u001B", are the control characters C0 and C1 (U+0000 to 001F and
 * 007F to 009F), the separators of lines and paragraphs (U+2028, 2029), the controls of the
 * bidirectional algorithm (Unicode Standard Annex 9, table 3: U+061C, 200E, 200F, 202A to 202E,
 * 2066 to 2069), what shows nothing and does not join letters (general category Cf: U+00AD,
 * 180E, 200B, 2060 to 2064, 206A to 206F, FEFF, FFF9 to FFFB: two names would look the same)
 * and U+FFFE and FFFF, which XML 1.0 does not allow. A byte that is no UTF-8
 * becomes "\x9B". Escapes are ASCII, so that escaping once more changes nothing.
 *
 * Threads  no shared state. Fails: never.
 */
#pragma once
#include <stddef.h>

#define PRINTABLE_ROOM 8 /* bytes of a character as it may be shown, and a zero */

/* The character at the start of `left` bytes, at least one, as it may be shown. Returns how
 * many bytes it takes. left: may be UTF8_BYTES_MAX anywhere in a terminated text. */
size_t printable_next(const char *at, size_t left, char to[PRINTABLE_ROOM]);

/* How many bytes the whole text takes so, its zero included. */
size_t printable_size(const char *text);

/* The text into `size` bytes, cut between two characters; `from` is no part of `to`. */
void printable_copy(char *to, size_t size, const char *from);
