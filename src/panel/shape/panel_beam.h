/* SPDX-License-Identifier: Apache-2.0 */
/* panel_beam.h -- narrow beams of an emission: profiles of the components over the distance
 * from a centre, which no tree of triangles resolves. Private to src/panel.
 *
 * A beam adds to component k a cubic B-spline over u = ln(1 + r^2 / core^2), r the chord from
 * the centre, longer along `narrow`: r^2 = |v|^2 + (narrow . v)^2, v = direction - centre.
 * Knots are PANEL_BEAM_STEP apart from u = 0 on. Over u a Gaussian bends as little as a power
 * law does, and every function of u is even and smooth at the centre. Behind the last stored
 * coefficient they are 0, so a beam ends with its first two derivatives.
 *
 * Stored     PanelBeamHead | float step[components], 0: the component has none | int16
 *            coefficient[knots] of every component that has, multiples of its step.
 * Threads    pure functions. Fails: only panel_beam_open, on bytes that are not whole.
 */
#pragma once
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "base/arena.h"
#include "base/vec.h"

#define PANEL_BEAM_STEP 0.125f
#define PANEL_BEAM_KNOTS_MAX 128
#define PANEL_BEAMS_MAX 4

typedef struct PanelBeamHead {
    float centre[3]; /* a unit vector */
    float narrow[3]; /* across the centre; 0: round */
    float core;      /* chord */
    uint8_t knots, reserved[3];
} PanelBeamHead;

/* Ready for queries. coefficient[knots + 3][stride], the last three rows 0. */
typedef struct PanelBeam {
    Vec3 centre, narrow;
    float core;
    float core_squares; /* core^-2 */
    int knots, stride;
    const float *coefficient;
} PanelBeam;

/* The four weights of coefficients from a knot on, t in [0, 1] behind it. */
static inline void panel_beam_weights(float t, float weight[4]) {
    float s = 1 - t;
    weight[0] = s * s * s * (1.0f / 6);
    weight[1] = (3 * t * t * t - 6 * t * t + 4) * (1.0f / 6);
    weight[2] = (3 * s * s * s - 6 * s * s + 4) * (1.0f / 6);
    weight[3] = t * t * t * (1.0f / 6);
}

/* Packs coefficients [components][knots]; step[k]: the rounding that component k bears,
 * coarser where 16 bits need it. *bytes in the arena; returns their number. */
size_t panel_beam_pack(const PanelBeamHead *head, const float *coefficient, const float *step,
                       int components, Arena *arena, const void **bytes);

/* Checks and expands stored bytes; *used: how many of them. False: no beam of so many
 * components. */
bool panel_beam_open(const void *bytes, size_t size, int components, Arena *arena, PanelBeam *out,
                     size_t *used);
