/* SPDX-License-Identifier: Apache-2.0 */
/* panel_evenness.h -- how even a panel's light is over its active area.
 *
 * Nine points stand at a tenth, a half and nine tenths of width and height, row by row from the
 * upper left corner, as in IDMS (SID, Information Display Measurements Standard).
 *
 * Threads  any number. Fails: never.
 */
#pragma once
#include "panel/query/panel.h"

#define PANEL_NINE 9

/* Luminance along the local normal, cd m^-2. Non-uniformity is 1 - least / most. */
typedef struct PanelEvenness {
    double nine[PANEL_NINE];
    double nine_least, nine_most, nine_mean;
    double least, most, mean; /* over 96 x 54 places */
} PanelEvenness;

/* The place {u, v} of one of the nine. */
void panel_nine_place(int index, float place[2]);

PanelEvenness panel_evenness(const Panel *panel, const float rgb[3]);

/* By how much least is less than most, 0 to 1; 0 where there is no light. */
static inline double panel_non_uniformity(double least, double most)
{
    return most > 0 ? 1 - least / most : 0;
}

/* Places of the spots that were measured, at most PANEL_EVENNESS_SPOTS; and the map's pixels,
 * 0 x 0 without one. Returns how many spots. */
#define PANEL_EVENNESS_SPOTS 49
int panel_spots(const Panel *panel, float place[PANEL_EVENNESS_SPOTS][2], int map[2]);
