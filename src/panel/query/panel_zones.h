/* SPDX-License-Identifier: Apache-2.0 */
/* panel_zones.h -- a panel's local dimming, and what its drives follow. All other queries
 * answer for a full backlight, as it was measured; backlight.h says what a picture makes of it.
 *
 * Threads  any number. Fails: never, but for opening.
 */
#pragma once
#include "panel/query/panel.h"
#include "panel/query/panel_section.h"
#include "panel/zones/backlight.h"

/* NULL: the backlight is one, always full. */
const DimmingZones *panel_zones(const Panel *panel);

/* Light of each primary at whole codes along the normal, over that at 255; of a panel that
 * emits. A level that falls below the one under it counts as that one. */
void panel_level_shares(const Panel *panel, LevelShares *out);

/* Reads PANEL_ZONES into panel->zones. Private to src/panel. */
bool panel_open_zones(const PanelBytes *bytes, Arena *arena, Panel *panel);
