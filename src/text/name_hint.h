/* SPDX-License-Identifier: Apache-2.0 */
/* name_hint.h -- of a file that is not there, the one that may be meant.
 *
 * Some systems take "Dash.PNG" for "dash.png" (letters of ASCII are compared here); the escapes
 * of URIs ("%20") end up in names. A file that is named so on one of them is not found on
 * another.
 *
 * Memory   the text lies in the arena. Threads: no shared state. Fails: never.
 */
#pragma once
#include "base/arena.h"

/* Of a path that leads nowhere: "; \"Dash.PNG\" is there: its letter case differs". Each folder
 * of the path is looked for as well. "" where nothing is like it. */
const char *name_hint(const char *path, Arena *arena);
