/* SPDX-License-Identifier: Apache-2.0 */
/* panel_origin.h -- where a panel's figures come from, as its own file states it.
 *
 * Nothing is measured that a simulated instrument read (`panel simulate` writes that into its
 * sets), or whose name or note calls it synthetic.
 *
 * Memory   texts in the arena. Threads: pure. Fails: never; what the file does not state is "".
 */
#pragma once
#include <stdbool.h>

#include "base/arena.h"
#include "panel/query/panel.h"

typedef struct PanelOrigin {
    const char *name;       /* the product's */
    const char *instrument; /* with which it was measured, and by whom where that stands there */
    bool        is_synthetic;
} PanelOrigin;

PanelOrigin panel_origin(const Panel *panel, Arena *arena);
