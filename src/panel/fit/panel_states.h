/* SPDX-License-Identifier: Apache-2.0 */
/* panel_states.h -- panel files of one display, each in another state, become one file.
 *
 * The first is the file's own: who opens it without naming a state gets that one, with the
 * bytes of its sections as they were; the others lie behind it as they are (panel_file.h:
 * PANEL_STATES).
 *
 * Memory   the arena's. Threads: one at a time.
 * Fails    with the file, where a state's name or file is none, or has states already.
 */
#pragma once
#include "base/arena.h"
#include "base/error.h"
#include "base/file.h"

typedef struct PanelStateFile {
    const char *name, *path;
} PanelStateFile;

/* A state's panel file in memory. */
typedef struct PanelStateBytes {
    const char *name;
    FileBytes   file;
} PanelStateBytes;

/* Writes `path`, of 2 to 16 states, each a panel file of one state. */
bool panel_states_write(const PanelStateBytes *states, int count, const char *path,
                        Arena *arena, Error *err);

/* The same of files. */
bool panel_states_join(const PanelStateFile *states, int count, const char *path, Arena *arena,
                       Error *err);
