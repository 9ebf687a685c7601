/* SPDX-License-Identifier: Apache-2.0 */
/* panel_open_reflection.h -- a panel file's reflection, checked and expanded for queries.
 * Private to src/panel.
 *
 * Memory   the arena's. Fails: in bytes->err (panel_section.h).
 */
#pragma once
#include "panel/query/panel_opened.h"
#include "panel/query/panel_section.h"

/* The reflection's sections into *panel; a file without them is fine. Tables that are derived
 * from the stored ones come from the arena. */
bool panel_open_reflection(const PanelBytes *bytes, const Geodesic *geodesic, Arena *arena,
                           Panel *panel);

/* The sections of a reflection without its sampling; data of reach NULL: there is
 * none. */
typedef struct PanelReflectionBytes {
    PanelBytes numbers, tree, reach;
} PanelReflectionBytes;

/* The reflection alone, into *panel. */
bool panel_expand_reflection(const PanelReflectionBytes *sections, const Geodesic *geodesic,
                             Arena *arena, Panel *panel);
