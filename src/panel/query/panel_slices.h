/* panel_slices.h -- the turn of a query's frame. Private to src/panel.
 *
 * Frame    slices are stored with the light at azimuth 180 degrees; panel_turned goes there.
 * Threads  pure functions. HOT: no allocation, no libm.
 */
#pragma once
#include "panel/query/panel_file.h"

/* `towards` in the frame in which the light's azimuth is 180 degrees. */
static inline Vec3 panel_turned(Vec3 light, Vec3 towards)
{
    float s = safe_sqrtf(light.x * light.x + light.y * light.y);
    if (s < 1e-6f) return towards;
    float ex = -light.x / s, ey = -light.y / s; /* the mirror direction's azimuth */
    return vec3(ex * towards.x + ey * towards.y, ex * towards.y - ey * towards.x, towards.z);
}

static inline Vec3 panel_turned_back(Vec3 light, Vec3 local)
{
    float s = safe_sqrtf(light.x * light.x + light.y * light.y);
    if (s < 1e-6f) return local;
    float ex = -light.x / s, ey = -light.y / s;
    return vec3(ex * local.x - ey * local.y, ey * local.x + ex * local.y, local.z);
}
