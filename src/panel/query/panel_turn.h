/* SPDX-License-Identifier: Apache-2.0 */
/* panel_turn.h -- the angles and the frame of a query. Private to src/panel.
 *
 * Frame    tables are stored with the light at azimuth 180 degrees; panel_turned goes there.
 * Threads  pure functions. HOT: no allocation, no libm.
 */
#pragma once
#include "base/mathf.h"
#include "base/vec.h"
#include "panel/query/panel_opened.h"

/* `towards` in the frame in which the light's azimuth is 180 degrees. */
static inline Vec3 panel_turned(Vec3 light, Vec3 towards) {
    float s = safe_sqrtf(light.x * light.x + light.y * light.y);
    if (s < 1e-6f) return towards;
    float ex = -light.x / s, ey = -light.y / s; /* the mirror direction's azimuth */
    return vec3(ex * towards.x + ey * towards.y, ex * towards.y - ey * towards.x, towards.z);
}

static inline Vec3 panel_turned_back(Vec3 light, Vec3 local) {
    float s = safe_sqrtf(light.x * light.x + light.y * light.y);
    if (s < 1e-6f) return local;
    float ex = -light.x / s, ey = -light.y / s;
    return vec3(ex * local.x - ey * local.y, ey * local.x + ex * local.y, local.z);
}

/* Position in a table over theta: *t in [0, 1] from node to node + 1. */
static inline int panel_angle_node(float theta, float *t) {
    float at = clampf(theta * 114.59155902616465f, 0, PANEL_ANGLES - 1); /* half degrees */
    int node = (int)at;
    if (node > PANEL_ANGLES - 2) node = PANEL_ANGLES - 2;
    *t = at - (float)node;
    return node;
}

/* Polar angle of a direction, accurate near the pole too. */
static inline float panel_polar_angle(Vec3 d) {
    return atan2_f(safe_sqrtf(d.x * d.x + d.y * d.y), d.z);
}
