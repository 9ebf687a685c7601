/* SPDX-License-Identifier: Apache-2.0 */
/* panel_open_emission.h -- a panel file's emission, checked and expanded for queries. Private
 * to src/panel.
 *
 * Memory   the arena's. Fails: in bytes->err (panel_section.h).
 */
#pragma once
#include "panel/query/panel_opened.h"
#include "panel/query/panel_section.h"

/* The emission's sections into *panel; a file without them is fine. */
bool panel_open_emission(const PanelBytes *bytes, const Geodesic *geodesic, Arena *arena,
                         Panel *panel);

/* How the primaries' spectra warp: a few milliseconds, once everything else is in order. */
void panel_open_warps(Panel *panel);
