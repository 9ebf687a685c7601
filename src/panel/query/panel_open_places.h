/* SPDX-License-Identifier: Apache-2.0 */
/* panel_open_places.h -- a panel file's spots and map, checked and made ready for queries.
 * Private to src/panel.
 *
 * Memory   the arena's. Fails: in bytes->err (panel_section.h).
 */
#pragma once
#include "panel/query/panel_opened.h"
#include "panel/query/panel_section.h"

/* The spots and the map; *out NULL: the file has neither. The panels of the spots are still to
 * be opened: panel [0] is the file's own. */
bool panel_read_places(const PanelBytes *bytes, Arena *arena, PanelPlaces **out);

/* Once all panels are opened: checks that every spot has what the file has, and reads the map
 * at each panel's place. The ranges of their primaries' warps grow by the map's colours. */
bool panel_finish_places(const PanelBytes *bytes, Arena *arena, PanelPlaces *places);
