/* SPDX-License-Identifier: Apache-2.0 */
#include "panel/query/panel_evenness.h"

#include <math.h>
#include <string.h>

#include "panel/query/panel_opened.h"
#include "panel/query/panel_place.h"

#define COLUMNS 96
#define ROWS 54

static double luminance_at(const Panel *panel, const float place[2], const float rgb[3])
{
    float xyz[3];
    panel_place_emission_xyz(panel, place, vec3(0, 0, 1), rgb, xyz);
    return (double)xyz[1];
}

void panel_nine_place(int index, float place[2])
{
    static const float at[3] = {0.1f, 0.5f, 0.9f};
    place[0] = at[index % 3];
    place[1] = at[index / 3];
}

PanelEvenness panel_evenness(const Panel *panel, const float rgb[3])
{
    PanelEvenness out = {.nine_least = INFINITY, .least = INFINITY};
    for (int i = 0; i < PANEL_NINE; i++) {
        float place[2];
        panel_nine_place(i, place);
        out.nine[i] = luminance_at(panel, place, rgb);
        out.nine_least = fmin(out.nine_least, out.nine[i]);
        out.nine_most = fmax(out.nine_most, out.nine[i]);
        out.nine_mean += out.nine[i] / PANEL_NINE;
    }
    for (int i = 0; i < COLUMNS * ROWS; i++) {
        float  place[2] = {((float)(i % COLUMNS) + 0.5f) / COLUMNS,
                           ((float)(i / COLUMNS) + 0.5f) / ROWS};
        double y = luminance_at(panel, place, rgb);
        out.least = fmin(out.least, y);
        out.most = fmax(out.most, y);
        out.mean += y / (COLUMNS * ROWS);
    }
    return out;
}

_Static_assert(PANEL_EVENNESS_SPOTS >= SPOT_GROUND_MAX, "room for every spot");

int panel_spots(const Panel *panel, float place[PANEL_EVENNESS_SPOTS][2], int map[2])
{
    const PanelPlaces *places = panel->places;
    map[0] = map[1] = 0;
    if (!places) return 0;
    for (int i = 0; i < places->spots; i++)
        memcpy(place[i], places->ground.at[i], sizeof place[i]);
    if (places->map) map[0] = places->map->width, map[1] = places->map->height;
    return places->spots;
}
