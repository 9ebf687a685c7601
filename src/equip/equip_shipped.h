/* SPDX-License-Identifier: Apache-2.0 */
/* equip_shipped.h -- panels and contents that lie with the program, by their names.
 *
 * Memory   the arena's.
 * Threads  no shared state.
 * Fails    ERROR_INPUT for an unknown name, with those there are; ERROR_LIBRARY when the folder
 *          is not installed (the package parhelion-scenes has it).
 */
#pragma once
#include "base/arena.h"
#include "base/error.h"

typedef struct ShippedKind {
    const char *what, *folder, *ending; /* "panel", "assets/panels", ".panel" */
} ShippedKind;

extern const ShippedKind shipped_panels, shipped_contents, shipped_scenes;

/* Whether a text is such a name: no path, no ending. */
bool equip_shipped_is_name(const char *text);

/* The file of that name. */
bool equip_shipped_find(const ShippedKind *kind, const char *name, Arena *arena, const char **path,
                        Error *err);

/* The folder of all that ships, which any model may name; NULL where it is missing. */
const char *equip_shipped_assets(Arena *arena);

/* All names, sorted; none where the folder is missing. */
const char **equip_shipped_names(const ShippedKind *kind, int *count, Arena *arena);
