/* SPDX-License-Identifier: Apache-2.0 */
#include "plot/draw/polar_disc.h"

#include <math.h>

double polar_disc_position(const PolarMap *map, double value)
{
    double t = map->is_log ? log(value / map->low) / log(map->high / map->low)
                           : (value - map->low) / (map->high - map->low);
    return t > 0 ? (t < 1 ? t : 1) : 0;
}

Ink polar_disc_ink(const PolarDisc *disc, double value)
{
    double at = polar_disc_position(disc->map, value);
    bool   light = colour_map_wants_light_ink(disc->map->map, at);
    return light ? ink_hex(0xffffff) : ink_hex(0x14181c);
}

double polar_disc_letter_size(const PolarDisc *disc)
{
    return disc->radius < 60 ? 7 : disc->radius > 180 ? 10.5 : SIZE_SMALL;
}

void polar_disc_reserve(PolarDisc *disc, Box box)
{
    if (disc->box_count < POLAR_BOXES_MAX) disc->box[disc->box_count++] = box;
}

bool polar_disc_is_free(const PolarDisc *disc, Box box)
{
    for (int i = 0; i < disc->box_count; i++) {
        const Box *b = &disc->box[i];
        if (box.x < b->x + b->w && b->x < box.x + box.w && box.y < b->y + b->h &&
            b->y < box.y + box.h)
            return false;
    }
    return true;
}
