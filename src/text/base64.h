/* SPDX-License-Identifier: Apache-2.0 */
/* base64.h -- bytes as text of 64 digits (RFC 4648), both ways.
 *
 * Memory   what is encoded grows the text; what is decoded goes to the caller's bytes.
 * Threads  no shared state.
 */
#pragma once
#include "base/error.h"
#include "text/text.h"

/* Adds the digits, with padding. */
void base64_encode(Text *text, const void *bytes, size_t size);

/* `length` digits of either alphabet, the padding optional. `out` holds 3/4 of the length.
 * Fails for what is no digit and for a length that none has. */
bool base64_decode(const char *digits, size_t length, unsigned char *out, size_t *size, Error *err);
