/* SPDX-License-Identifier: Apache-2.0 */
/* panel_reach.h -- which leaving directions of a reflection table were measured: its samples'
 * hull. Private to src/panel.
 *
 * Frame    the table's own: the light at azimuth 180 degrees.
 * Hull     a star about a centre: the largest angle to it at every tenth degree around it,
 *          linear between them. Azimuths around the centre count from the direction in which
 *          theta rises, towards rising phi.
 * Threads  pure functions. Fails: never.
 */
#pragma once
#include <stdbool.h>

#include "base/mathf.h"
#include "base/units.h"
#include "base/vec.h"
#include "panel/query/panel_file.h"

/* A direction as the hull's centre sees it. */
typedef struct PanelReachPlace {
    float angle, turn; /* radians; turn in [0, 2 pi) */
} PanelReachPlace;

static inline void panel_reach_axes(const PanelReachStored *s, Vec3 axis[3]) {
    float sine[2], cosine[2];
    sincos_turns((float)s->theta * (0.25f / 65535), &sine[0], &cosine[0]);
    sincos_turns((float)s->phi * (1.0f / 65536), &sine[1], &cosine[1]);
    axis[0] = vec3(cosine[0] * cosine[1], cosine[0] * sine[1], -sine[0]);
    axis[1] = vec3(-sine[1], cosine[1], 0);
    axis[2] = vec3(sine[0] * cosine[1], sine[0] * sine[1], cosine[0]);
}

static inline PanelReachPlace panel_reach_place(const Vec3 axis[3], Vec3 local) {
    float x = vec3_dot(local, axis[0]), y = vec3_dot(local, axis[1]);
    float turn = atan2_f(y, x);
    return (PanelReachPlace){atan2_f(safe_sqrtf(x * x + y * y), vec3_dot(local, axis[2])),
                             turn < 0 ? turn + 2 * PI_F : turn};
}

/* Of its sides, radians. */
static inline float panel_reach_unit(const PanelReachStored *s) {
    return (float)s->most * (PI_F / 65535 / 255);
}

/* The hull's edge at a turn, radians from its centre. */
static inline float panel_reach_edge(const PanelReachStored *s, float turn) {
    float at = turn * (PANEL_REACH_SIDES / (2 * PI_F));
    int side = (int)at;
    float t = at - (float)side;
    float here = (float)s->side[side % PANEL_REACH_SIDES];
    float next = (float)s->side[(side + 1) % PANEL_REACH_SIDES];
    return (here + (next - here) * t) * panel_reach_unit(s);
}

/* How far a direction lies inside its edge; negative outside. Radians, towards the centre. */
static inline float panel_reach_room(const PanelReachStored *s, Vec3 local) {
    Vec3 axis[3];
    panel_reach_axes(s, axis);
    PanelReachPlace at = panel_reach_place(axis, local);
    return panel_reach_edge(s, at.turn) - at.angle;
}

/* Radians: where values begin to be held, a bend of the surface, no sample stands. */
#define PANEL_REACH_ROOM 0.006f

/* The direction itself inside the hull; else the one just outside of its edge, towards the
 * centre. */
static inline Vec3 panel_reach_inside(const PanelReachStored *s, Vec3 local) {
    Vec3 axis[3];
    float sine, cosine, across, along;
    panel_reach_axes(s, axis);
    PanelReachPlace at = panel_reach_place(axis, local);
    float edge = panel_reach_edge(s, at.turn) + PANEL_REACH_ROOM;
    if (at.angle <= edge) return local;
    sincos_turns(at.turn * (0.5f / PI_F), &sine, &cosine);
    sincos_turns(edge * (0.5f / PI_F), &across, &along);
    Vec3 sum = vec3_scale(axis[2], along);
    sum = vec3_add(sum, vec3_scale(axis[0], across * cosine));
    return vec3_add(sum, vec3_scale(axis[1], across * sine));
}
