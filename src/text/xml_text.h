/* SPDX-License-Identifier: Apache-2.0 */
/* xml_text.h -- an XML file's bytes as UTF-8, by its byte order mark and the encoding that it
 * declares (XML 1.0, 4.3.3 and appendix F).
 *
 * Read are UTF-8, UTF-16 of both orders, ISO-8859-1, US-ASCII and windows-1252. The declaration
 * is left as it stands: who parses the text ignores it.
 *
 * Memory   the arena's. Threads: no shared state.
 * Fails    ERROR_INPUT with the file: another encoding, by name; a mark or bytes that are not
 *          the declared one's, with the line.
 */
#pragma once
#include "base/arena.h"
#include "base/error.h"
#include "base/file.h"

/* *out is terminated and holds no zero. */
bool xml_text_read(const char *file, const FileBytes *bytes, Arena *arena, const char **out,
                   Error *err);
