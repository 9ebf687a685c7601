/* SPDX-License-Identifier: Apache-2.0 */
/* panel_open_sampling.h -- how a panel's reflection is sampled, checked and expanded for
 * queries. Private to src/panel.
 *
 * Memory   the arena's. Fails: in bytes->err (panel_section.h).
 */
#pragma once
#include "panel/query/panel_opened.h"
#include "panel/query/panel_section.h"

/* The sampling tree, expanded into the arena; a file without one leaves the panel as it is.
 * The reflection is there. */
bool panel_open_sampling(const PanelBytes *bytes, const Geodesic *geodesic, Arena *arena,
                         Panel *panel);
