/* SPDX-License-Identifier: Apache-2.0 */
/* uri.h -- takes URIs apart (RFC 3986) and decodes those that hold data (RFC 2397).
 *
 * Memory   what is decoded lies in the arena, with a zero byte behind it.
 * Threads  no shared state.
 * Fails    with what is broken; file and place are the caller's to add.
 */
#pragma once
#include "base/arena.h"
#include "base/error.h"
#include "base/file.h"
#include "base/reference.h"

/* The length of the scheme before its colon, 0 when there is none ("C:/x" counts as one). */
size_t uri_scheme_length(const char *uri);
bool uri_is_data(const char *uri);

/* Percent-decoding of a relative reference. A broken escape, an encoded zero byte, or a colon
 * in its first part without a scheme before it, is an error. */
bool uri_decode(const char *uri, Arena *arena, char **out, Error *err);

/* The way from a folder, "/a/b/", to a file, "/a/c d": "../c%20d". Both are absolute, without
 * links, and need not be there. */
const char *uri_between(const char *folder, const char *file, Arena *arena);

/* Whether the file `from` may name another by this URI (base/reference.h). */
bool uri_may_be_named(const char *from, const char *uri, ReferenceReach reach, Arena scratch);

/* The bytes of a data: URI; *media_type (may be NULL) is its type, "" if it has none. */
bool data_uri_decode(const char *uri, Arena *arena, FileBytes *out, const char **media_type,
                     Error *err);
