/* SPDX-License-Identifier: Apache-2.0 */
/* utf8.h -- characters of UTF-8 (RFC 3629).
 *
 * Threads  no shared state. Fails: never.
 */
#pragma once
#include <stdbool.h>
#include <stddef.h>

#define UTF8_BYTES_MAX 4 /* of one character */

/* The length of the well-formed character at the start of `left` bytes, and its code; 0 when
 * there is none. In a terminated text `left` may be UTF8_BYTES_MAX anywhere: the zero is the
 * rest of no character. */
int utf8_decode(const char *at, size_t left, unsigned *code);

/* Writes a character; returns its length. code < 0x110000. */
int utf8_encode(unsigned code, char to[UTF8_BYTES_MAX]);

/* Whether the byte continues a character that began before it. */
static inline bool utf8_continues(char byte) {
    return ((unsigned char)byte & 0xc0) == 0x80;
}
