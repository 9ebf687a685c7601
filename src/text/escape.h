/* SPDX-License-Identifier: Apache-2.0 */
/* escape.h -- text inside languages that give some of its characters a meaning.
 *
 * Memory   the arena's, or that of the text that grows.
 * Threads  no shared state. Fails: never.
 */
#pragma once
#include "base/arena.h"
#include "text/text.h"

/* Adds `string` as the content of an element or of a quoted attribute, in HTML and in XML 1.0.
 * What is no UTF-8, and characters that XML does not allow, become '?'. NULL adds nothing. */
void escape_markup(Text *text, const char *string);

/* A word as a POSIX shell wants it: itself, or in single quotes. */
const char *escape_shell(const char *word, Arena *arena);
