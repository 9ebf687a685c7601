/* SPDX-License-Identifier: Apache-2.0 */
/* panel_open.h -- opens and closes a panel file.
 *
 * Memory   the file is read once; what queries need is made in the arena. panel_close gives the
 *          copy of the file back.
 * Fails    with the file, the place in it and what is wrong there: every byte is checked.
 */
#pragma once
#include <stdbool.h>
#include <stddef.h>

#include "base/arena.h"
#include "base/error.h"
#include "panel/query/panel.h"

/* Opens and checks a .panel file (version, checksum, every offset). */
bool panel_open(const char *path, Arena *arena, Panel **out, Error *err);

#define PANEL_FILE_BYTES_MAX ((size_t)256 << 20)

/* The same for a file in memory, aligned to 8 bytes, which stays the caller's and must outlive
 * the panel. name: of the file, for messages. */
bool panel_open_memory(const void *data, size_t size, const char *name, Arena *arena, Panel **out,
                       Error *err);
void panel_close(Panel *panel); /* NULL is fine */

/* As panel_open_memory, before the sampling of the reflection is there. */
bool panel_from_bytes(const void *bytes, size_t size, const char *name, Arena *arena, Panel **out,
                      Error *err);

/* ---- coarser ---------------------------------------------------------------------------- */

/* Trees to be read coarser. */
#define PANEL_COARSE_EMISSION 1u
#define PANEL_COARSE_REFLECTION 2u
#define PANEL_COARSE_ALL 3u

/* The finest level of the trees. */
int panel_coarse_finest(const Panel *panel);

/* From now on all queries of values read the trees of `parts` down to `level` (from 0 on; a
 * tree that ends before is read whole), those of several spots too. The arena lives as long as
 * the panel; nobody else may use it while it changes. */
void panel_coarsen(Panel *panel, int level, unsigned parts, Arena *arena);
