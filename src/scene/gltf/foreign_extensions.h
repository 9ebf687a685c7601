/* SPDX-License-Identifier: Apache-2.0 */
/* foreign_extensions.h -- extensions of glTF that other makers added for programs of their own:
 * who made one, and what is not shown where it is not read.
 *
 * Threads  no shared state. Fails: never.
 */
#pragma once

enum { FOREIGN_NOTE_SIZE = 200 };

/* For messages, behind the extension's name: " (MAKER: WHAT)", or "" where neither is known.
 * Fills and returns buffer, which holds at least FOREIGN_NOTE_SIZE. */
const char *foreign_extension_note(const char *name, char *buffer);
