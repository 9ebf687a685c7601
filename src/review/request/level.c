/* SPDX-License-Identifier: Apache-2.0 */
#include "review/request/level.h"

#include <string.h>

#include "base/mathd.h"

double review_level_of_lux(const ReviewLevel *level, double lux)
{
    int last = level->point_count - 1, i = 1;
    if (!(lux > level->lux[0])) return level->level[0];
    if (lux >= level->lux[last]) return level->level[last];
    while (level->lux[i] < lux) i++;
    double lux0 = level->lux[i - 1], lux1 = level->lux[i];
    double level0 = level->level[i - 1], level1 = level->level[i];
    if (!(lux0 > 0) || !(level0 > 0))
        return level0 + (level1 - level0) * (lux - lux0) / (lux1 - lux0);
    return level0 * pow_d(level1 / level0, log_d(lux / lux0) / log_d(lux1 / lux0));
}

/* The level under one name, else `value`. */
static double fixed_level(const ReviewLevel *level, const char *name, double value)
{
    for (int i = 0; i < level->fixed_count; i++)
        if (!strcmp(level->fixed[i].display, name)) return level->fixed[i].level;
    return value;
}

double review_level_at(const ReviewLevel *level, ReviewDisplayName display, double scene_level,
                       double sensor_lux)
{
    if (level->is_curve) return review_level_of_lux(level, sensor_lux);
    double others = fixed_level(level, "*", scene_level);
    return fixed_level(level, display.name, fixed_level(level, display.material, others));
}
