/* panel_query.h -- the pieces of an emission query that the fit shares. Private to src/panel.
 *
 * Threads  pure functions of a constant Panel. HOT: no allocation, no libm.
 */
#pragma once
#include "panel/query/panel_file.h"

/* The components at a direction (PANEL_COMPONENTS_MAX floats, zero behind the last one);
 * returns cosine_power ln cos theta. */
float panel_emission_components(const Panel *panel, Vec3 direction, float *components);

/* c0, c1, c2 of a source of 1 cd m^-2 for ln XYZ (only the ratios count). */
void panel_bend_lookup(const PanelBend *bend, const float logs[3], float coefficient[3]);
