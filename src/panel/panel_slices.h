/* panel_slices.h -- which slices of incidence a query mixes, and the turn of its frame. Private
 * to src/panel.
 *
 * Frame    slices are stored with the light at azimuth 180 degrees; panel_turned goes there.
 * Threads  pure functions. HOT: no allocation, no libm.
 */
#pragma once
#include "panel/panel_file.h"

/* Which slices an incidence is made of. */
typedef struct SliceMix {
    int   first, count;
    float weight[4];
} SliceMix;

/* The interval of slices that holds theta: theta lies between slices i and i + 1. */
static inline int panel_slice_interval(const PanelReflection *r, float theta, float *t)
{
    int i = 0;
    while (i + 2 < (int)r->slices && r->slice_theta[i + 1] <= theta) i++;
    if (r->slices == 1) {
        *t = 0;
        return 0;
    }
    float span = r->slice_theta[i + 1] - r->slice_theta[i];
    *t = clampf((theta - r->slice_theta[i]) / span, 0, 1);
    return i;
}

static inline SliceMix panel_linear_mix(const PanelReflection *r, float theta)
{
    float    t;
    int      i = panel_slice_interval(r, theta, &t);
    SliceMix mix = {i, r->slices == 1 ? 1 : 2, {1 - t, t, 0, 0}};
    return mix;
}

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
